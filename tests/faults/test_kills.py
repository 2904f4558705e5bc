"""Whatever ends a command, nothing that it started runs on, and no file of it stays."""

import os
import signal
import subprocess
import sys
from collections.abc import Container, Iterable
from pathlib import Path

import psutil
import pytest
from shell import SHELL
from waiting import soon

ENDLESS = f'load("holonom.mac")$ {SHELL} in_a_shell("(sleep 1000 >/dev/null 2>&1 &); true")$ for i do 1$'
VERBS = {
    "derive": ["--json", "out.json"],
    "check": ["--json", "out.json"],
    "free": ["--json", "out.json"],
    "series": ["--order", "4", "--json", "out.json"],
    "program": ["-o", "out.json"],
    "effects": ["--json", "out.json"],
    "simulate": ["--until", "1", "-o", "out.csv"],
    "sweep": ["--grid", "m=1:2:3", "-o", "runs"],
    "accuracy": ["--json", "out.json"],
    "companion": ["-o", "pages"],
}
SIGNALS = (signal.SIGTERM, signal.SIGHUP, signal.SIGINT, signal.SIGKILL)


OF_THEIR_OWN = {"errata": ["--json", "out.json"], "stability": ["--json", "out.json"]}
"""Verbs that run scenes of the package."""


def cases(verbs: Iterable[str], short: Container[tuple[str, int]]) -> list:
    """Each verb by each signal, and those that belong to the short form."""
    return [
        pytest.param(verb, number, marks=[] if (verb, number) in short else [pytest.mark.long])
        for verb in verbs
        for number in SIGNALS
    ]


ONCE_OR_TWICE = {("derive", each) for each in SIGNALS} | {("simulate", signal.SIGTERM)}


@pytest.mark.parametrize(("verb", "number"), cases(VERBS, ONCE_OR_TWICE))
def test_a_signal_ends_all_and_leaves_nothing(verb, number, tmp_path):
    (tmp_path / "here").mkdir()
    (tmp_path / "here" / "scene.mac").write_text(ENDLESS, encoding="utf-8")
    end_in_the_middle([verb, "scene.mac", *VERBS[verb]], number, tmp_path, "sleep")
    assert [path.name for path in (tmp_path / "here").iterdir()] == ["scene.mac"]


@pytest.mark.parametrize(
    ("verb", "number"), cases(OF_THEIR_OWN, {("errata", signal.SIGKILL), ("stability", signal.SIGTERM)})
)
def test_a_signal_ends_what_runs_scenes_of_its_own(verb, number, tmp_path):
    (tmp_path / "here").mkdir()
    end_in_the_middle([verb, *OF_THEIR_OWN[verb]], number, tmp_path, "")
    assert list((tmp_path / "here").iterdir()) == []


def end_in_the_middle(command: list[str], number: int, place: Path, begun: str) -> None:
    """Run a command in a folder `here`, end it once a program of that name runs in it, and see that nothing is left."""
    temporary = place / "temporary"
    temporary.mkdir()
    environment = os.environ | {"TMPDIR": str(temporary)}
    process = subprocess.Popen(
        [sys.executable, "-m", "holonom", *command],
        cwd=place / "here",
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert soon(lambda: any(begun in name for name in names(running(process))))
    started = running(process)
    process.send_signal(number)
    said = process.communicate(timeout=60)[1].decode()
    assert process.returncode == (-number if number == signal.SIGKILL else 128 + number)
    assert "Traceback" not in said
    assert soon(lambda: ended(started))
    assert list(temporary.iterdir()) == []


def test_the_supervisor_tells_a_crash_of_its_command(tmp_path):
    """A command that crashes, here by a signal of its own, is told in one sentence."""
    crash = "import os, signal\nfrom holonom.failures import HolonomError\n"
    crash += "from holonom.supervisor import doing, supervise\n"
    crash += "def command():\n    with doing('compiling'):\n        os.kill(os.getpid(), signal.SIGSEGV)\n"
    crash += "try:\n    supervise(command)\nexcept HolonomError as error:\n"
    crash += "    print(error.kind.name, error.kind.status, error.detail)"
    done = subprocess.run([sys.executable, "-c", crash], capture_output=True, text=True, env=os.environ, check=True)
    assert done.stdout.split() == ["COMMAND_CRASHED", "3", "SIGSEGV", "while", "compiling"]


@pytest.mark.parametrize("kill", [os.kill, os.killpg])
def test_what_no_parent_ends_is_ended_when_the_command_is_killed(kill, tmp_path):
    """As bubblewrap's child, which waits for ever if bubblewrap is killed before that may start."""
    command = "import subprocess, time\nfrom holonom.supervisor import supervise\ndef command():\n"
    command += "    subprocess.Popen(['sleep', '1000'], start_new_session=True)\n    print(flush=True)\n"
    command += "    time.sleep(200)\nsupervise(command)"
    process = subprocess.Popen(
        [sys.executable, "-c", command],
        stdout=subprocess.PIPE,
        env=os.environ | {"TMPDIR": str(tmp_path)},
        start_new_session=True,
    )
    process.stdout.readline()
    started = running(process)
    assert "sleep" in names(started)
    kill(process.pid, signal.SIGKILL)
    process.communicate()
    assert soon(lambda: ended(started))
    assert list(tmp_path.iterdir()) == []


def test_where_the_kernel_kills_no_child_of_a_killed_parent_the_child_ends_all_the_same():
    """As on macOS, which has no prctl."""
    command = "lambda: print(flush=True) or time.sleep(200)"
    script = (
        f"import sys, time; from holonom.supervisor import supervise; sys.platform = 'darwin'; supervise({command})"
    )
    process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE)
    process.stdout.readline()
    started = running(process)
    process.kill()
    process.communicate()
    assert started
    assert soon(lambda: ended(started))


def running(process: subprocess.Popen[bytes]) -> list[psutil.Process]:
    try:
        return psutil.Process(process.pid).children(recursive=True)
    except psutil.NoSuchProcess:
        return []


def ended(processes: list[psutil.Process]) -> bool:
    return not any(each.is_running() and each.status() != psutil.STATUS_ZOMBIE for each in processes)


def names(processes: list[psutil.Process]) -> list[str]:
    found = []
    for each in processes:
        try:
            found.append(each.name())
        except psutil.NoSuchProcess:
            continue
    return found
