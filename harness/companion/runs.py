"""The runs of chapters, and their execution, two at a time.

They are performed by processes, not by threads: mpmath's precision belongs to the whole process.
"""

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errata import errata  # noqa: F401, for the heads of pages
from ..failures import ErrorKind, HolonomError
from ..processes import die_with_parent
from ..record import derived_record
from ..sandbox import Limits
from ..scene import Scene
from ..source import Source

if TYPE_CHECKING:
    from ..crosscheck.report import CheckReport
    from ..record import Record

WORKERS = 2
Settings = tuple[tuple[str, Any], ...]
NO_SETTINGS: Settings = ()
DEFAULT_LIMITS = Limits()


@dataclass(frozen=True)
class Run:
    """A computation that chapters share. Equal runs are performed once."""

    compute: Callable[..., Any]  # a function of a module, for it may be called in another process
    arguments: tuple[Any, ...] = ()  # what it is given; hashable


@dataclass(frozen=True)
class Derived:
    """A record and the verdicts on it."""

    record: "Record"
    report: "CheckReport"


def derive(
    file: Path,
    settings: Settings = NO_SETTINGS,
    limits: Limits = DEFAULT_LIMITS,
) -> Derived:
    """Return the derivation of a scene file, cross-checked.

    Parameters
    ----------
    file : Path
        Scene file.
    settings : Settings
        Values of parameters.
    limits : Limits
        Limits of Maxima's runs.

    Returns
    -------
    Derived
        Record and verdicts.
    """
    from ..crosscheck.check import check_record

    source = Source(file, limits)
    record = derived_record(source, dict(settings), limits)
    return Derived(record, check_record(record, source.description(dict(settings))))


def answer(
    method: str,
    file: Path,
    scene: str | None = None,
    options: Settings = NO_SETTINGS,
    settings: Settings = NO_SETTINGS,
    limits: Limits = DEFAULT_LIMITS,
) -> Any:
    """Return the result of a method of a scene.

    Parameters
    ----------
    method : str
        Name of a method of `Scene`.
    file : Path
        Scene file.
    scene : str or None
        Name of the scene.
    options : tuple of pairs
        Keyword arguments of the method, by name.
    settings : Settings
        Values of parameters.
    limits : Limits
        Limits of Maxima's runs.

    Returns
    -------
    Any
        Value of the method. Of a power series the radius of convergence is estimated, too.
    """
    found = getattr(Scene(file, scene, dict(settings), limits), method)(**dict(options))
    if method == "series":
        found.radius  # noqa: B018
    return found


def perform(runs: Iterable[Run], done: Callable[[], None]) -> dict[Run, Any]:
    """Perform runs two at a time, equal ones once, and call `done` after each.

    Parameters
    ----------
    runs : iterable of Run
        Runs.
    done : callable
        Function that is called after each run.

    Returns
    -------
    dict of Run to Any
        Results by run.
    """
    with ProcessPoolExecutor(WORKERS, get_context("spawn"), die_with_parent, (os.getpid(),)) as processes:
        waiting = {processes.submit(run.compute, *run.arguments): run for run in dict.fromkeys(runs)}
        results = {}
        try:
            for future in as_completed(waiting):
                results[waiting[future]] = future.result()
                done()
        except BrokenProcessPool:
            raise HolonomError(ErrorKind.WORKER_ENDED) from None
        except BaseException:
            processes.shutdown(cancel_futures=True)
            raise
    return results
