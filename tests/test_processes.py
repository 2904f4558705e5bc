"""Processes that end together, and what they take."""

import subprocess
import sys

import psutil
import pytest

from holonom.processes import count_threads, descendants, memory_in_use

STARTS_A_HOG = (
    "import subprocess, sys; subprocess.run([sys.executable, '-c', "
    "'memory = bytearray(10**8); print(flush=True); import time; time.sleep(60)'])"
)


@pytest.mark.parametrize("proc", ["with /proc", "without /proc"])
def test_descendants_and_their_memory_are_found(proc, monkeypatch):
    if proc == "without /proc":
        monkeypatch.setattr("holonom.processes.os.path.exists", lambda path: not path.startswith("/proc"))
    process = subprocess.Popen([sys.executable, "-c", STARTS_A_HOG], stdout=subprocess.PIPE)
    try:
        process.stdout.readline()
        found = descendants(process.pid)
        assert found == [each.pid for each in psutil.Process(process.pid).children(recursive=True)]
        assert memory_in_use(found[-1]) > 10**8
    finally:
        for each in [*psutil.Process(process.pid).children(), process]:
            each.kill()
        process.communicate()


def test_ended_process_takes_nothing():
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    assert memory_in_use(process.pid) == 0
    assert descendants(process.pid) == []


def test_threads_are_counted():
    script = "import threading; [threading.Thread(target=input).start() for _ in range(5)]; print(flush=True)"
    process = subprocess.Popen([sys.executable, "-c", script], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    process.stdout.readline()
    assert count_threads(process.pid) >= 5
    process.communicate(b"\n" * 5)
