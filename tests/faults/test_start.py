"""A command that is interrupted, or finds no processes, before it has begun."""

import signal
import subprocess
import sys

INTERRUPTED = """
import os, signal, sys
from importlib.abc import MetaPathFinder
from holonom.__main__ import main

class Interruption(MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name == "holonom.cli":
            os.kill(os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, Interruption())
main()
"""
NO_PROCESSES = """
import errno, os
from holonom.__main__ import main

def refuse():
    raise BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN))

os.fork = refuse
main()
"""


def run(script: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)


def test_an_interruption_of_the_imports_ends_without_a_word():
    done = run(INTERRUPTED)
    assert (done.returncode, done.stdout, done.stderr) == (-signal.SIGINT, "", "")


def test_a_machine_without_processes_is_one_sentence():
    done = run(NO_PROCESSES)
    assert done.returncode == 3
    assert done.stderr.startswith("holonom: error: the operating system reports: ")
    assert done.stderr.count("\n") == 1
