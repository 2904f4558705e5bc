"""Measurement of benchmark cases: a run for the error, then others for times.

A first run counts only if it is too long to be repeated, because it fills caches for the next one. heyoka's code is
compiled without its caches.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

from ...failures import HolonomError
from ...language import translatable
from ...program.heyoka_function import import_heyoka
from ...program.timing import Batch, python_batch, shortest_times
from .measurement import BenchmarkCase, Measurement, Omission, Prepared, relative_error

if TYPE_CHECKING:
    from .reference import Reference


@contextmanager
def without_caches() -> Iterator[None]:
    """Disable heyoka's caches, in memory and on disk, inside the block.

    Yields
    ------
    None

    Raises
    ------
    HolonomError
        heyoka is not installed.
    """
    state = import_heyoka().llvm_state
    limit, enabled = state.get_memcache_limit(), state.get_diskcache_enabled()
    state.set_memcache_limit(0)
    state.set_diskcache_enabled(False)
    try:
        yield
    finally:
        state.set_memcache_limit(limit)
        state.set_diskcache_enabled(enabled)


PATIENCE = 2.0  # seconds of a run after which a method is not tried again
REPEATED = 0.02  # seconds of a run up to which it is repeated: what disturbs a longer one matters less
PASSES = 3

Key = TypeVar("Key")
Result = Measurement | Omission


def measure(cases: Iterable[BenchmarkCase], reference: Reference, advance: Callable[[], None]) -> list[Result]:
    """Measure errors and times, in the order of the cases.

    Parameters
    ----------
    cases : iterable of BenchmarkCase
        Settings of a method one after the other, the least demanding first.
    reference : Reference
        True states at the times of the cases.
    advance : callable
        Called without arguments after each case.

    Returns
    -------
    list of Result
        One for each case: its measurement, or the reason of its omission.
    """
    results: list[Result] = []
    repeated: dict[int, Prepared] = {}
    impatient: set[str] = set()
    for case in cases:
        if case.method in impatient:
            results.append(
                _omission(case, translatable("the setting before it took more than %(time)g s", time=PATIENCE))
            )
        else:
            result, prepared = _first_run(case, reference)
            if isinstance(result, Measurement) and result.seconds > PATIENCE:
                impatient.add(case.method)
            elif isinstance(result, Measurement) and result.seconds < REPEATED:
                repeated[len(results)] = prepared
            results.append(result)
        advance()
    return _with_shortest_times(results, repeated)


def _times_in_turns(batches: Mapping[Key, Batch]) -> dict[Key, float]:
    """Measure short runs: the shortest times of several passes, in seconds."""
    passes = [shortest_times(batches) for _ in range(PASSES)]
    return {key: min(times[key] for times in passes) for key in batches}


def _first_run(case: BenchmarkCase, reference: Reference) -> tuple[Result, Prepared | None]:
    begun = time.perf_counter()
    try:
        prepared = case.prepare()
        ready = time.perf_counter()
        outcome = prepared.run()
        seconds = time.perf_counter() - ready
        if seconds < PATIENCE:
            seconds = min(seconds, python_batch(_run(prepared), ())(1))
    except HolonomError as refusal:
        return _omission(case, str(refusal)), None
    error = relative_error(prepared.state(outcome), reference.states[case.time])
    if not reference.can_tell(error):
        return _omission(
            case, translatable("its error, %(error).1g, is smaller than that of the reference", error=error)
        ), None
    return (
        Measurement(
            group=case.group,
            method=case.method,
            setting=case.setting,
            time=case.time,
            error=error,
            seconds=seconds,
            preparation_seconds=ready - begun,
            operations=prepared.operations(),
        ),
        prepared,
    )


def _with_shortest_times(results: list[Result], repeated: dict[int, Prepared]) -> list[Result]:
    shortest = _times_in_turns({index: python_batch(_run(prepared), ()) for index, prepared in repeated.items()})
    return [
        replace(result, seconds=min(result.seconds, shortest[index])) if index in shortest else result
        for index, result in enumerate(results)
    ]


def _run(prepared: Prepared) -> Callable[[Any], Any]:
    return lambda _: prepared.run()


def _omission(case: BenchmarkCase, reason: str) -> Omission:
    return Omission(case.method, case.setting, reason)
