"""A confined process: each limit ends it, and nothing of it stays behind."""

import os
import sys
import time
from pathlib import Path

import pytest

from holonom.confined import LimitExceeded, Limits, run_confined
from holonom.failures import Failure

LIMITS = Limits(seconds=5, memory_mib=200, output_mib=1, file_mib=1)


def run(program: str, directory: Path, limits: Limits = LIMITS) -> bytes:
    printed = bytearray()
    run_confined([sys.executable, "-c", program], directory, os.environ, limits, printed)
    return bytes(printed)


def test_collects_all_that_is_printed(tmp_path):
    assert run("import sys; print('out', flush=True); print('err', file=sys.stderr)", tmp_path) == b"out\nerr\n"


def test_standard_input_is_at_its_end(tmp_path):
    assert run("import sys; print(repr(sys.stdin.read()))", tmp_path) == b"''\n"


@pytest.mark.parametrize(
    ("program", "failure"),
    [
        ("import time; time.sleep(60)", Failure.TOO_LONG),
        ("while True: pass", Failure.TOO_LONG),
        ("hog = []\nwhile True: hog.append(bytearray(10**6))", Failure.TOO_LARGE),
        ("while True: print('so it goes on')", Failure.TOO_MUCH_TEXT),
    ],
)
def test_a_limit_ends_the_process(program, failure, tmp_path):
    started = time.monotonic()
    with pytest.raises(LimitExceeded) as exceeded:
        run(program, tmp_path, Limits(seconds=2, memory_mib=200, output_mib=1))
    assert exceeded.value.failure is failure
    assert time.monotonic() - started < 4


def test_no_file_grows_beyond_its_limit(tmp_path):
    run("with open('large', 'wb') as file:\n    while True: file.write(bytes(10**6))", tmp_path)
    assert (tmp_path / "large").stat().st_size <= 2**20


def test_children_end_with_the_process(tmp_path):
    spawn = "import subprocess, sys; print(subprocess.Popen([sys.executable, '-c', {child!r}]).pid, flush=True)"
    child = "import os, time; os.close(1); os.close(2); time.sleep(60)"
    pid = int(run(spawn.format(child=child), tmp_path))
    deadline = time.monotonic() + 5
    while is_running(pid) and time.monotonic() < deadline:
        time.sleep(0.01)
    assert not is_running(pid)


def is_running(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False
