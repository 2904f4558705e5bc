"""Chunks handed to workers: each once, with the bytes that this process computes, or an error of the right kind."""

import asyncio
import warnings
from itertools import pairwise
from types import SimpleNamespace

import distributed
import pytest
from refusing import failing

from holonom.failures import ErrorKind, HolonomError, HolonomWarning
from holonom.sweeps import workers
from holonom.sweeps.dataset import Chunk

CHUNKS = [Chunk(index, 2 * index, 2 * index + 2) for index in range(5)]


@pytest.fixture(scope="module")
def plan(rows_of):
    return rows_of("pendulum.mac", "final", "m=1:2:10").plan


@pytest.fixture(scope="module")
def scheduler():
    """A scheduler with one worker, in this process, whose threads would share what RowMaker stores."""
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None) as here:
        yield here.scheduler_address


def taken(*given) -> dict[Chunk, bytes]:
    found: list[tuple[Chunk, bytes]] = []
    workers.compute(given[0], CHUNKS, lambda *part: found.append(part), *given[1:])
    assert sorted(chunk.index for chunk, _ in found) == [chunk.index for chunk in CHUNKS]
    return dict(found)


@pytest.mark.long
def test_workers_of_a_scheduler_write_the_bytes_that_this_process_writes(plan, scheduler):
    assert taken(plan, 4, scheduler) == taken(plan, 1, None)


@pytest.mark.parametrize(("count", "busy"), [(1, 1), (7, 2), (100, 1), (100, 4), (1000, 16)])
def test_tasks_are_all_chunks_in_order_and_no_larger_towards_the_end(count, busy):
    tasks = list(workers._tasks(range(count), busy))
    assert [chunk for task in tasks for chunk in task] == list(range(count))
    sizes = [len(task) for task in tasks]
    assert all(later <= earlier for earlier, later in pairwise(sizes))
    assert sizes[0] == max(1, min(workers.TOGETHER, count // (2 * workers.AHEAD * busy)))
    assert sizes[-1] == 1


def test_a_scheduler_without_workers_is_waited_for_with_its_address():
    known = {}
    client = SimpleNamespace(
        scheduler=SimpleNamespace(address="tcp://10.0.0.1:8786"), scheduler_info=lambda n_workers: {"workers": known}
    )
    with pytest.warns(HolonomWarning, match="tcp://10.0.0.1:8786"):
        assert workers._workers_of(client) == 1
    known |= {"a": {}, "b": {}, "c": {}}
    with warnings.catch_warnings(action="error"):
        assert workers._workers_of(client) == 3


@pytest.mark.parametrize(
    "error",
    [
        distributed.KilledWorker("task", SimpleNamespace(address="tcp://10.0.0.2:1"), 1),
        distributed.comm.CommClosedError("first\nsecond"),
        distributed.CancelledError("first"),
        asyncio.CancelledError(),
        TimeoutError("first"),
        OSError("first"),
    ],
)
def test_lost_workers_are_one_error_whatever_is_raised(error):
    with failing(ErrorKind.WORKERS_LOST) as caught, workers._loss_reported():
        raise error
    assert "\n" not in str(caught.value.detail)
    assert caught.value.detail


@pytest.mark.parametrize("error", [HolonomError(ErrorKind.DISK_FULL), ZeroDivisionError()])
def test_other_errors_pass(error):
    with pytest.raises(type(error)) as caught, workers._loss_reported():
        raise error
    assert caught.value is error


def test_a_scheduler_that_asks_for_certificates_is_none():
    with failing(ErrorKind.NOT_A_SCHEDULER, "tls://127.0.0.1:9"):
        workers._connected("tls://127.0.0.1:9")


@pytest.mark.parametrize("failures", [0, 2, 3])
def test_workers_that_end_while_they_start_are_started_three_times(failures, monkeypatch):
    started = []

    def start(**options):
        started.append(options)
        if len(started) <= failures:
            raise RuntimeError("ended\nhere")
        return "cluster"

    monkeypatch.setattr(distributed, "LocalCluster", start)
    if failures == 3:
        with failing(ErrorKind.WORKERS_LOST, "ended"):
            workers._cluster(4)
    else:
        assert workers._cluster(4) == "cluster"
    assert len(started) == min(failures + 1, 3)
    assert all(each["n_workers"] == 4 and each["threads_per_worker"] == 1 for each in started)
    assert all(each["security"] and each["host"] == "127.0.0.1" for each in started)  # as others use the machine too
