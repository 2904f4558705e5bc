"""`make bench`: five motions simulated by Holonom and its peers, one table and one figure.

    python tests/benchmarks/simulation.py build/benchmarks

Every method starts from the scene's initial state and is measured at a relative error of 1e-9 against one reference:
its tolerance is tightened until the error is below, and its time interpolated between the last two tolerances, both
logarithmically. All runs of a motion take turns. Where code comes to lie in memory changes the time of a short run by
a quarter: each is compiled several times, and the shortest counts. Compilation is timed apart, as it is the first time.
"""

import math
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
from simulation_bars import RUNGE_KUTTA, TAYLOR, Bar, Ratios, bars_of, faster_engine, general_bars, unprojected
from simulation_motions import MOTIONS, Motion
from simulation_peers import HEYOKA, PEERS, Prepared, Run, State
from simulation_report import write_report

from holonom.benchmark.work_precision.measurement import numbers_of, relative_error
from holonom.benchmark.work_precision.reference import Reference, find_reference
from holonom.benchmark.work_precision.runner import _times_in_turns, without_caches
from holonom.failures import HolonomError
from holonom.program.motion_problem import MotionProblem, motion_problem
from holonom.program.request import Request
from holonom.program.timing import Batch, python_batch
from holonom.sandbox import Limits
from holonom.simulation.engines.engine import Task, advance
from holonom.simulation.engines.program_engine import ProgramEngine
from holonom.simulation.engines.runge_kutta import RungeKuttaEngine
from holonom.simulation.engines.taylor import TaylorEngine
from holonom.simulation.request import Stabilization

ERROR = 1e-9
TOLERANCES = tuple(float(f"1e-{n}") for n in range(5, 16))
DIGITS = 20  # more than any method has; the reference has `MORE_DIGITS` on top
PATIENCE = 5.0  # seconds of a run after which a method is given up
REPEATED = 0.05  # seconds of a run up to which it takes many turns
PLACES = 4  # compilations of a method at a tolerance


@dataclass(frozen=True)
class Setting:
    """A method at one tolerance, its error, the seconds that it takes to compile and to run, and how it is compiled."""

    tolerance: float
    error: float
    compile: float
    seconds: float
    run: Run
    again: Callable[[], Run]


@dataclass(frozen=True)
class Row:
    """What a method takes for a motion at `ERROR`; None where it does not get there, and why."""

    motion: str
    method: str
    seconds: float | None
    compile: float | None
    reason: str = ""


def main(directory: Path) -> None:
    """Measure, then write ``simulation.json``, ``simulation.txt`` and ``simulation.svg`` into a directory."""
    rows: list[Row] = []
    bars: list[Bar] = []
    for motion in MOTIONS:
        problem = motion_problem(motion.file, Request(motion.scene, settings=motion.settings), Limits(), DIGITS + 40)
        with without_caches():
            settings, reasons = compared(motion, problem)
        found = {name: row_of(motion, name, settings[name], reasons[name]) for name in settings}
        rows += found.values()
        bars += bars_of(motion, problem, found, ratios_of(settings, faster_engine(found)))
    write_report(rows, [*bars, *general_bars(MOTIONS[0])], directory)


def compared(motion: Motion, problem: MotionProblem) -> tuple[dict[str, list[Setting]], dict[str, str]]:
    """The last two settings of each method, timed in turns; none, and the reason, where it does not get there.

    Our engines are timed at heyoka's tolerances, too; without projection at those with projection.
    """
    reference = find_reference(problem, [motion.until], DIGITS)
    settings: dict[str, list[Setting]] = {}
    reasons: dict[str, str] = {}
    for name, peer in PEERS.items():
        found, reasons[name] = tighten(partial(peer, motion, problem), motion, reference, TOLERANCES)
        settings[name] = last_two(found, reasons[name])
        print(f"{motion.name}: {name} {reasons[name]}", file=sys.stderr)
    as_heyoka = TOLERANCES[TOLERANCES.index(settings[HEYOKA][0].tolerance) :]
    for engine, set_up, tolerances in ((TAYLOR, unrolled, as_heyoka), (RUNGE_KUTTA, in_c, TOLERANCES)):
        compared_at = {s.tolerance for s in settings[HEYOKA]}
        for name, stabilization in ((engine, Stabilization.PROJECTION), (unprojected(engine), Stabilization.NONE)):
            prepare = partial(holonom, motion, problem, partial(set_up, stabilization=stabilization))
            found, reasons[name] = tighten(prepare, motion, reference, tolerances)
            last = last_two(found, reasons[name])
            settings[name] = [s for s in found if s.tolerance in compared_at and s not in last] + last
            compared_at |= {s.tolerance for s in last}
    return with_turns(settings), reasons


def unrolled(problem: MotionProblem, tolerance: float, stabilization: Stabilization) -> TaylorEngine:
    """The Taylor engine, its code unrolled, which is heyoka's own default."""
    return TaylorEngine(Task.of(problem, tol=tolerance, stabilization=stabilization, compact=False))


def in_c(problem: MotionProblem, tolerance: float, stabilization: Stabilization) -> RungeKuttaEngine:
    """The Runge-Kutta engine."""
    return RungeKuttaEngine(Task.of(problem, tol=tolerance, stabilization=stabilization))


def holonom(
    motion: Motion, problem: MotionProblem, set_up: Callable[[MotionProblem, float], ProgramEngine]
) -> Prepared:
    """One of our engines."""

    def at_tolerance(tolerance: float) -> Run:
        follower = set_up(problem, tolerance)
        begin, start, end = follower.time, np.array(follower.state), float(motion.until)

        def run() -> State:
            follower.restart(begin, start)
            advance(follower, end)
            return follower.state.copy()

        return run

    return at_tolerance


def tighten(
    prepare: Callable[[], Prepared], motion: Motion, reference: Reference, tolerances: Sequence[float]
) -> tuple[list[Setting], str]:
    """Tighten the tolerance until the error is small enough; the reason says why it does not get so."""
    begun = time.perf_counter()
    at_tolerance = prepare()
    prepared = time.perf_counter() - begun
    found: list[Setting] = []
    for tolerance in tolerances:
        try:
            setting = first_run(at_tolerance, tolerance, motion, reference)
        except HolonomError as refusal:
            return found, str(refusal)
        found.append(replace(setting, compile=prepared + setting.compile))
        if setting.error <= ERROR:
            return found, ""
        if setting.seconds > PATIENCE:
            break
    last = found[-1]
    return found, f"error {last.error:.1g} after {last.seconds:.2g} s at tolerance {last.tolerance:g}"


def last_two(found: Sequence[Setting], reason: str) -> list[Setting]:
    """The last two settings of a method that gets there."""
    return [] if reason else list(found[-2:])


def first_run(at_tolerance: Prepared, tolerance: float, motion: Motion, reference: Reference) -> Setting:
    """Compile for a tolerance and run once."""
    begun = time.perf_counter()
    run = at_tolerance(tolerance)
    compiled = time.perf_counter()
    state = run()
    seconds = time.perf_counter() - compiled
    error = relative_error(numbers_of(map(repr, map(float, state))), reference.states[motion.until])
    return Setting(tolerance, error, compiled - begun, seconds, run, partial(at_tolerance, tolerance))


def with_turns(settings: Mapping[str, list[Setting]]) -> dict[str, list[Setting]]:
    """The settings with the shortest of many times; runs that take long are timed twice."""
    once = {(name, s.tolerance): min(s.seconds, seconds_of(s.run)(1)) for name, row in settings.items() for s in row}
    batches = {
        (name, s.tolerance, place): seconds_of(s.again() if place else s.run)
        for name, row in settings.items()
        for s in row
        for place in range(PLACES)
        if once[name, s.tolerance] < REPEATED
    }
    for (name, tolerance, _), seconds in _times_in_turns(batches).items():
        once[name, tolerance] = min(once[name, tolerance], seconds)
    return {name: [replace(s, seconds=once[name, s.tolerance]) for s in row] for name, row in settings.items()}


def seconds_of(run: Run) -> Batch:
    """Many runs timed together."""
    return python_batch(lambda _: run(), ())


def row_of(motion: Motion, name: str, settings: Sequence[Setting], reason: str) -> Row:
    """A method's time at `ERROR`, interpolated between its two settings."""
    if reason:
        return Row(motion.name, name, None, None, reason)
    first, last = settings[-2:][0], settings[-1]
    if first is last or first.error <= last.error:
        return Row(motion.name, name, last.seconds, last.compile)
    share = math.log(first.error / ERROR) / math.log(first.error / last.error)
    return Row(motion.name, name, first.seconds * (last.seconds / first.seconds) ** share, last.compile)


def ratios_of(settings: Mapping[str, Sequence[Setting]], engine: str) -> Ratios:
    """How times at equal tolerance compare."""
    return Ratios(
        same_settings(settings, unprojected(TAYLOR), HEYOKA),
        same_settings(settings, TAYLOR, HEYOKA),
        *(same_settings(settings, each, unprojected(each)) - 1 for each in (engine, TAYLOR)),
    )


def same_settings(settings: Mapping[str, Sequence[Setting]], one: str, other: str) -> float:
    """Ratio of two methods' times at the finest tolerance that both were run at."""
    times = [{s.tolerance: s.seconds for s in settings[name]} for name in (one, other)]
    finest = min(times[0].keys() & times[1].keys())
    return times[0][finest] / times[1][finest]


if __name__ == "__main__":
    main(Path(sys.argv[1]))
