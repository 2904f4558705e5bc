"""Limits and isolation of one process."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from uuid import uuid4

import psutil
import pytest
from waiting import living, soon

from holonom.failures import ErrorKind
from holonom.sandbox import LimitExceeded, Limits, Place, Sandbox, run_process

READABLE = (Path(sys.prefix), Path(sys.base_prefix))
LIMITS = Limits(seconds=60, memory_mib=200, output_mib=1, file_mib=1)


def run(program: str, directory: Path, limits: Limits = LIMITS) -> bytes:
    printed = bytearray()
    run_process([sys.executable, "-c", program], Place(directory, os.environ, limits, READABLE), printed)
    return bytes(printed)


def test_a_sandbox_given_as_text_was_none():
    limits = Limits(sandbox="required", allow=["data.csv"])
    assert limits.sandbox is Sandbox.REQUIRED
    assert limits.allow == (Path("data.csv"),)
    with pytest.raises(ValueError, match="strict"):
        Limits(sandbox="strict")


def test_collects_all_that_is_printed(tmp_path):
    assert run("import sys; print('out', flush=True); print('err', file=sys.stderr)", tmp_path) == b"out\nerr\n"


def test_standard_input_is_at_its_end(tmp_path):
    assert run("import sys; print(repr(sys.stdin.read()))", tmp_path) == b"''\n"


@pytest.mark.parametrize(
    ("program", "seconds", "failure"),
    [
        ("import time; time.sleep(1e9)", 1, ErrorKind.TOO_LONG),
        ("while True: pass", 1, ErrorKind.TOO_LONG),
        ("hog = []\nwhile True: hog.append(bytearray(10**6))", 100, ErrorKind.TOO_LARGE),
        ("while True: print('so it goes on')", 100, ErrorKind.TOO_MUCH_TEXT),
    ],
)
def test_a_limit_ends_the_process(program, seconds, failure, tmp_path):
    with pytest.raises(LimitExceeded) as exceeded:
        run(program, tmp_path, Limits(seconds=seconds, memory_mib=200, output_mib=1))
    assert exceeded.value.kind is failure


def test_a_process_that_may_not_be_ended_was_a_traceback(monkeypatch, tmp_path):
    """What runs with other rights; and macOS refuses the signal to a group without living processes."""

    def denied(_: psutil.Process) -> None:
        raise psutil.AccessDenied

    def killed_and_denied(group: int, number: int) -> None:
        kill_group(group, number)
        raise PermissionError

    kill_group = os.killpg
    monkeypatch.setattr(psutil.Process, "kill", denied)
    monkeypatch.setattr(os, "killpg", killed_and_denied)
    with pytest.raises(LimitExceeded):
        run("import time; time.sleep(60)", tmp_path, Limits(seconds=0.5, sandbox=Sandbox.TRUSTED))


def test_no_file_grows_beyond_its_limit(tmp_path):
    large = tmp_path / "large"
    large.touch()
    program = "with open('large', 'wb') as file:\n    while True: file.write(bytes(10**6))"
    place = Place(tmp_path, os.environ, LIMITS, READABLE, outputs=[large])
    run_process([sys.executable, "-c", program], place, bytearray())
    assert 0 < large.stat().st_size <= 2**20


@pytest.mark.parametrize("sandbox", [Sandbox.TRUSTED, Sandbox.WHERE_POSSIBLE])
def test_what_it_started_ends_with_the_process(sandbox, tmp_path):
    mark = uuid4().hex
    child = f"import os, time; os.close(1); os.close(2); time.sleep(60)  # {mark}"
    run(f"import subprocess, sys; subprocess.Popen([sys.executable, '-c', {child!r}])", tmp_path, trusting(sandbox))
    assert soon(lambda: not living(mark))  # the kernel clears up after a kill


@pytest.mark.parametrize("sandbox", [Sandbox.TRUSTED, Sandbox.WHERE_POSSIBLE])
def test_a_killed_parent_takes_all_with_it(sandbox, tmp_path):
    mark = uuid4().hex
    sleeper = (
        f"import subprocess, sys, time; subprocess.run([sys.executable, '-c', 'import time; time.sleep(60)  # {mark}'])"
    )
    starter = (
        "import os, sys; from pathlib import Path\n"
        "from holonom.sandbox import Limits, Place, Sandbox, run_process\n"
        f"readable, limits = {list(map(str, READABLE))}, Limits(sandbox=Sandbox({sandbox.value!r}))\n"
        f"place = Place(Path({str(tmp_path)!r}), os.environ, limits, list(map(Path, readable)))\n"
        f"run_process([sys.executable, '-c', {sleeper!r}], place, bytearray())"
    )
    parent = subprocess.Popen([sys.executable, "-c", starter])
    assert soon(lambda: len(living(f"sleep(60)  # {mark}'")) > 0 or len(living(mark)) > 1)
    parent.kill()
    parent.wait()
    assert soon(lambda: not living(mark))


def trusting(sandbox: Sandbox) -> Limits:
    return replace(LIMITS, sandbox=sandbox)
