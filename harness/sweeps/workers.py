"""Workers that compute chunks: this process, own processes or a Dask scheduler's.

A worker gets the plan with each chunk, compiles the programs once and returns the bytes of the chunk's file. The
command that started the sweep writes the files. So the result does not depend on the worker, or on lost workers.
"""

import logging
import pickle
import re
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from functools import lru_cache
from itertools import islice
from typing import TYPE_CHECKING, Any

from ..failures import ErrorKind, HolonomError, HolonomWarning
from ..language import translatable
from ..simulation.evaluation import one_blas_thread
from .dataset import Chunk, part_of
from .rows import Plan, RowMaker

if TYPE_CHECKING:
    from distributed import Client, LocalCluster

AHEAD = 3  # tasks that wait at each worker
TOGETHER = 4  # chunks of a task at most: to hand one out and to fetch it takes a tenth of what a quick chunk takes
ALLOCATOR_TRIM = (
    2**29
)  # bytes that a worker does not give back at once; Dask's 64 KiB are given back and fetched each step
LARGEST_BLOCK = 2**25  # bytes of the largest part of the outputs
STARTS = 3  # attempts to start workers
ADDRESS = re.compile(r"((tcp|tls|ws|wss)://)?([\w.-]+|\[[\da-fA-F:.]+\]):(?P<port>\d{1,5})", re.ASCII)
PORTS = range(1, 2**16)
ATTEMPTS = 10  # workers that a chunk may outlive
PATIENCE = 20  # seconds that a scheduler may take to answer

Take = Callable[[Chunk, bytes], None]


def require_address(scheduler: str | None) -> None:
    """Reject an invalid address of a Dask scheduler.

    Parameters
    ----------
    scheduler : str or None
        Such as ``tcp://host:8786``, or None for no scheduler.

    Raises
    ------
    HolonomError
        It is not of this form, or its port is out of range.
    """
    if scheduler is None:
        return
    found = ADDRESS.fullmatch(scheduler)
    if not found or int(found["port"]) not in PORTS:
        raise HolonomError(ErrorKind.NOT_A_SCHEDULER, detail=scheduler or translatable("nothing"))


def compute(plan: Plan, chunks: Sequence[Chunk], take: Take, workers: int, scheduler: str | None) -> None:
    """Compute chunks in any order.

    Parameters
    ----------
    plan : Plan
        The sweep.
    chunks : sequence of Chunk
        Chunks to compute.
    take : callable
        Is given each chunk with the bytes of its file.
    workers : int
        Processes to start. With one, or for one chunk, this process does it.
    scheduler : str or None
        Address of a Dask scheduler that is to be used instead.

    Raises
    ------
    HolonomError
        As `RowMaker`, or the workers are lost.
    """
    if scheduler is None and min(workers, len(chunks)) <= 1:
        maker = RowMaker(plan)
        with one_blas_thread():
            for chunk in chunks:
                take(chunk, part_of(maker.table(chunk.first, chunk.last)))
        return
    with _client(min(workers, len(chunks)), scheduler) as client:
        _compute_by(client, plan, chunks, take)


def _make_parts(plan: bytes, chunks: Sequence[Chunk]) -> list[bytes]:
    """Compute the files of chunks in a worker."""
    with one_blas_thread():
        return [part_of(_maker(plan).table(chunk.first, chunk.last)) for chunk in chunks]


@lru_cache(maxsize=2)
def _maker(plan: bytes) -> RowMaker:
    return RowMaker(pickle.loads(plan))


def _compute_by(client: "Client", plan: Plan, chunks: Sequence[Chunk], take: Take) -> None:
    """Keep all workers busy, and few chunks on their way."""
    from distributed import as_completed

    written = pickle.dumps(plan)
    workers = _workers_of(client)
    waiting = _tasks(chunks, workers)
    doing = {_submitted(client, written, task): task for task in islice(waiting, AHEAD * workers)}
    arriving = as_completed(list(doing), with_results=False)
    for future in arriving:
        for chunk, content in zip(doing.pop(future), future.result(), strict=True):
            take(chunk, content)
        for task in islice(waiting, 1):
            following = _submitted(client, written, task)
            doing[following] = task
            arriving.add(following)


def _workers_of(client: "Client") -> int:
    """Return the number of workers, one if the first has yet to come."""
    if workers := len(client.scheduler_info(n_workers=-1)["workers"]):
        return workers
    address = client.scheduler.address
    warnings.warn(f"the scheduler has no workers; waiting for `dask worker {address}`", HolonomWarning, stacklevel=2)
    return 1


def _tasks(chunks: Sequence[Chunk], workers: int) -> Iterator[Sequence[Chunk]]:
    """Return groups of chunks, smaller towards the end, to balance the workers."""
    first = 0
    while first < len(chunks):
        last = first + max(1, min(TOGETHER, (len(chunks) - first) // (2 * AHEAD * workers)))
        yield chunks[first:last]
        first = last


def _submitted(client: "Client", plan: bytes, chunks: Sequence[Chunk]) -> Any:
    return client.submit(_make_parts, plan, chunks, pure=False)


@contextmanager
def _client(workers: int, scheduler: str | None) -> Iterator["Client"]:
    """Provide a client of the given scheduler, or of a temporary one with its workers."""
    import dask
    import distributed  # noqa: F401

    for name in ("distributed", *logging.root.manager.loggerDict):
        if name.startswith(("distributed", "tornado")):  # their errors arrive as exceptions
            logging.getLogger(name).setLevel(logging.CRITICAL)
    settings = {
        "distributed.scheduler.allowed-failures": ATTEMPTS,
        "distributed.comm.timeouts.connect": PATIENCE,
        "distributed.admin.system-monitor.gil.enabled": False,
        "distributed.worker.profile.enabled": False,  # which looks at each worker a hundred times a second
        "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": ALLOCATOR_TRIM,
        "distributed.nanny.pre-spawn-environ.MALLOC_MMAP_THRESHOLD_": LARGEST_BLOCK,
    }
    with (
        dask.config.set(settings),
        _loss_reported(),
        _cluster(workers) if scheduler is None else nullcontext(scheduler) as place,
        _connected(place) as client,
    ):
        yield client


def _connected(place: "LocalCluster | str") -> "Client":
    from distributed import Client

    try:
        return Client(place, timeout=PATIENCE)
    except (TypeError, ValueError) as error:  # as of tls without certificates
        raise HolonomError(ErrorKind.NOT_A_SCHEDULER, detail=f"{place} ({_first_line(error)})") from None


def _cluster(workers: int) -> "LocalCluster":
    """Return a scheduler with its workers. Start it again if one ends during startup."""
    from distributed import LocalCluster

    for _ in range(STARTS):
        try:
            return LocalCluster(
                n_workers=workers,
                threads_per_worker=1,
                host="127.0.0.1",
                security=True,  # other users of this machine reach its address, too
                dashboard_address="127.0.0.1:0",  # any port that is free, for another sweep may run
                memory_limit=0,
                silence_logs=logging.CRITICAL,
            )
        except (RuntimeError, OSError, TimeoutError) as error:
            failed = error
    raise HolonomError(ErrorKind.WORKERS_LOST, detail=_first_line(failed))


@contextmanager
def _loss_reported() -> Iterator[None]:
    """Raise an error if the workers are lost inside the block."""
    from asyncio import CancelledError

    from distributed import CancelledError as TaskCancelled
    from distributed import KilledWorker
    from distributed.comm import CommClosedError

    try:
        yield
    except HolonomError:
        raise
    except (KilledWorker, CommClosedError, TaskCancelled, CancelledError, TimeoutError, OSError) as error:
        raise HolonomError(ErrorKind.WORKERS_LOST, detail=_first_line(error)) from None


def _first_line(error: BaseException) -> str:
    return next(iter(str(error).splitlines()), "") or translatable("they do not answer")
