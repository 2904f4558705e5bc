"""Commands ended at random times: nothing half-written, no process and no temporary file left, statuses right."""

import csv
import json
import os
import random
import signal
import subprocess
import sys
from pathlib import Path

import psutil
import pytest
from particle import PARTICLE
from waiting import soon

HOLONOM = [sys.executable, "-m", "holonom"]
EXAMPLES = Path(__file__).parents[2] / "examples"
PENDULUM = str(EXAMPLES / "pendulum.mac")
ROWS = 40
COMMANDS = {
    "derive": ["derive", PENDULUM, "--json", "out.json"],
    "check": ["check", PENDULUM, "--json", "out.json"],
    "free": ["free", PENDULUM, "--json", "out.json"],
    "program": ["program", PENDULUM, "-o", "out.json"],
    "simulate": ["simulate", PENDULUM, "-o", "out.csv", "--samples", "101"],
    "sweep": ["sweep", PENDULUM, "--grid", f"m=1:2:{ROWS}", "--chunk", "4", "-o", "runs"],
}
ENDS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL, signal.SIGPIPE)
DURATION = 3.0  # seconds within which a command is ended; one that is over by then counts, too


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.long) for seed in range(1, 60))])
@pytest.mark.parametrize("number", ENDS)
def test_command_ended_at_a_random_time_leaves_all_whole(number, seed, tmp_path):
    draw = random.Random(f"{number} {seed}")
    here, temporary = tmp_path / "here", tmp_path / "temporary"
    here.mkdir()
    temporary.mkdir()
    environment = os.environ | {"TMPDIR": str(temporary)}
    command = COMMANDS[draw.choice(list(COMMANDS))]
    status = ended_after(draw.uniform(0.0, DURATION), number, [*HOLONOM, *command], here, environment)
    assert status in allowed(number)
    assert soon(lambda: not left_over(str(temporary)))
    assert_outputs_whole(here)
    assert os.listdir(temporary) == []
    if status == 0 or command[0] != "sweep":
        return
    again = subprocess.run([*HOLONOM, *command], cwd=here, env=environment, capture_output=True, check=False)
    assert again.returncode == 0
    assert rows_in(here / "runs") == ROWS


def allowed(number: int) -> set[int]:
    """Return the statuses of a command that was ended, or that was over before."""
    ended = -number if number == signal.SIGKILL else 128 + number
    # An interpreter that has just started, or is about to end, has the signal's own action.
    return {0, ended, -number}


def ended_after(seconds: float, number: int, command: list[str], here: Path, environment: dict[str, str]) -> int:
    process = subprocess.Popen(command, cwd=here, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    try:
        process.wait(seconds)
    except subprocess.TimeoutExpired:
        if number == signal.SIGPIPE:  # the reader is gone
            process.stdout.close()
        else:
            process.send_signal(number)
    said = process.stderr.read().decode()
    status = process.wait(120)
    if "Traceback" in said:  # the interpreter itself was still starting
        assert number == signal.SIGINT
        assert any("<frozen" in line or "Fatal Python error: init" in line for line in said.splitlines()[:4]), said
        return -number
    return status


def left_over(mark: str) -> list[psutil.Process]:
    """Return the processes on whose command line, or in whose environment, a text stands."""
    found = []
    for each in psutil.process_iter():
        try:
            texts = [*each.cmdline(), *each.environ().values()]
        except (psutil.Error, OSError):
            continue
        if each.pid != os.getpid() and any(mark in text for text in texts):
            found.append(each)
    return found


def assert_outputs_whole(here: Path) -> None:
    names = {path.name for path in here.iterdir()}
    assert names <= {"out.json", "out.csv", "runs"}
    if "out.json" in names:
        json.loads((here / "out.json").read_text(encoding="utf-8"))
    if "out.csv" in names:
        with (here / "out.csv").open(newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        assert len(rows) == 102
        assert len({len(row) for row in rows}) == 1
    if "runs" in names:
        assert rows_in(here / "runs") <= ROWS


def rows_in(folder: Path) -> int:
    """Return the number of rows of a sweep; every file with rows can be read."""
    from pyarrow import parquet

    return sum(parquet.read_metadata(file).num_rows for file in folder.glob("*.parquet"))


@pytest.mark.long
def test_sweep_killed_a_hundred_times_ends_with_all_rows(tmp_path):
    draw, command = random.Random(100), [*HOLONOM, *COMMANDS["sweep"]]
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    environment = os.environ | {"TMPDIR": str(temporary)}
    for _ in range(100):
        assert ended_after(draw.uniform(0.0, DURATION), signal.SIGKILL, command, tmp_path, environment) in {0, -9}
        if (tmp_path / "runs").is_dir():
            assert rows_in(tmp_path / "runs") <= ROWS
    assert subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, check=False).returncode == 0
    assert rows_in(tmp_path / "runs") == ROWS
    assert soon(lambda: not left_over(str(temporary)))
    assert os.listdir(temporary) == []


@pytest.mark.long
def test_twenty_commands_at_once_without_an_image_agree(tmp_path):
    (tmp_path / "scene.mac").write_text(PARTICLE, encoding="utf-8")
    environment = os.environ | {"XDG_CACHE_HOME": str(tmp_path / "cache")}
    command = [*HOLONOM, "derive", "scene.mac", "--json", "-"]
    started = [
        subprocess.Popen(command, cwd=tmp_path, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        for _ in range(20)
    ]
    printed = {process.communicate(timeout=600)[0] for process in started}
    assert {process.returncode for process in started} == {0}
    assert len(printed) == 1
    assert len(list((tmp_path / "cache" / "holonom").glob("*.image"))) <= 1
