"""Sweeps by Dask workers: the same rows, whatever is killed on the way."""

import json
import re
import signal
import subprocess
import sys
from pathlib import Path

import psutil
import pyarrow.dataset
import pytest
from refusing import message_of
from waiting import soon

from holonom.failures import ErrorKind

CRANE = Path(__file__).parents[2] / "examples" / "crane.mac"
SWEEP = [sys.executable, "-m", "holonom", "sweep", str(CRANE), "--grid", "m=50:500:400", "--grid", "c=0:40:400"]
ASKED = [*SWEEP, "--chunk", "1600", "--keep", "final,max(abs(lambda1))"]

pytestmark = pytest.mark.long


def rows(folder: Path):
    return pyarrow.dataset.dataset(folder, format="parquet").to_table().sort_by("row")


def begun(folder: Path, *options: str) -> subprocess.Popen:
    command = [*ASKED, "-o", str(folder), *options]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def parts(folder: Path) -> int:
    return len(list(folder.glob("part-*.parquet")))


def workers_of(process: subprocess.Popen) -> list[psutil.Process]:
    return [child for child in psutil.Process(process.pid).children(recursive=True) if is_worker(child)]


def is_worker(process: psutil.Process) -> bool:
    try:
        return "spawn_main" in " ".join(process.cmdline())
    except psutil.Error:  # it has just ended
        return False


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("undisturbed") / "runs"
    assert begun(folder, "--workers", "1").communicate(timeout=600)[1] == ""
    return folder


def test_a_killed_worker_is_replaced(undisturbed, tmp_path):
    process = begun(tmp_path / "runs", "--workers", "2")
    assert soon(lambda: parts(tmp_path / "runs") > 3)
    workers_of(process)[-1].kill()
    assert (process.communicate(timeout=600)[1], process.returncode) == ("", 0)
    assert rows(tmp_path / "runs").equals(rows(undisturbed))


@pytest.mark.parametrize(("killed", "status"), [(1, 0), (100, 3)])
def test_a_worker_killed_while_it_starts_is_started_anew_some_times(killed, status, undisturbed, tmp_path):
    process = begun(tmp_path / "runs", "--workers", "2")
    seen: set[int] = set()
    while process.poll() is None and len(seen) < killed:
        for worker in workers_of(process):
            if worker.pid not in seen:
                seen.add(worker.pid)
                worker.kill()
    said = process.communicate(timeout=600)[1]
    assert process.returncode == status
    assert said.count("\n") == (status > 0)
    assert status or rows(tmp_path / "runs").equals(rows(undisturbed))


def test_a_killed_command_leaves_whole_parts_and_the_same_command_the_rest(undisturbed, tmp_path):
    process = begun(tmp_path / "runs", "--workers", "2")
    assert soon(lambda: parts(tmp_path / "runs") > 3)
    started = workers_of(process)
    process.send_signal(signal.SIGKILL)
    process.communicate(timeout=60)
    assert soon(lambda: not any(worker.is_running() and worker.status() != psutil.STATUS_ZOMBIE for worker in started))
    assert 3 < parts(tmp_path / "runs") < 100
    assert begun(tmp_path / "runs", "--workers", "1", "--resume").communicate(timeout=600)[1] == ""
    assert rows(tmp_path / "runs").equals(rows(undisturbed))


def test_a_scheduler_s_workers_are_waited_for_and_used_and_its_end_reported(undisturbed, tmp_path):
    file = tmp_path / "scheduler.json"
    dask = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--scheduler-file", str(file), "--no-dashboard"]
    work = [sys.executable, "-m", "distributed.cli.dask_worker", "--scheduler-file", str(file), "--nthreads", "1"]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": tmp_path}
    scheduler = subprocess.Popen([*dask, "--host", "127.0.0.1", "--port", "0"], **quiet)
    assert soon(file.exists)
    address = json.loads(file.read_text())["address"]
    process = begun(tmp_path / "runs", "--dask", address)
    assert address in process.stderr.readline()  # it waits for workers there
    worker = subprocess.Popen([*work, "--no-dashboard", "--death-timeout", "60"], **quiet)
    try:
        assert soon(lambda: parts(tmp_path / "runs") > 3)
        scheduler.kill()
        _, said = process.communicate(timeout=200)
        assert process.returncode == 3
        assert re.search(message_of(ErrorKind.WORKERS_LOST), said)
        assert said.count("\n") == 1
    finally:
        scheduler.kill()
        worker.kill()
        scheduler.wait()
        worker.wait()
    assert begun(tmp_path / "runs", "--workers", "1").communicate(timeout=600)[1] == ""
    assert rows(tmp_path / "runs").equals(rows(undisturbed))
