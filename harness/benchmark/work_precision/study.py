"""A work-precision study of one scene: all methods and settings, one reference."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import partial
from pathlib import Path

from ...failures import ErrorKind, HolonomError
from ...language import translatable
from ...program.motion_problem import MotionProblem, motion_problem, require_analytic
from ...program.precision import read_precision
from ...program.request import Request, Solve
from ...sandbox import Limits
from ...simulation.engines.engine import Task, advance
from ...simulation.engines.taylor import TaylorEngine
from ...simulation.request import Stabilization
from ...simulation.simulate import last_time
from ...source import Source, source_of
from ...structs import entry
from ..machine import Machine, this_machine
from .advice import Advice, Price, cheapest_methods, prices
from .engines import (
    RUNGE_KUTTA,
    operations_of_a_step,
    prepare_runge_kutta,
    prepare_taylor,
    taylor_name,
)
from .measurement import EXACT_TIME, BenchmarkCase, Group, Measurement, Omission, Prepared
from .reference import MORE_DIGITS, Reference, find_reference
from .runner import measure, without_caches
from .series import EXACT, Expansion, double_series, expansion_of, maxima_series, series_name
from .solvers import SOLVERS, prepare_solver


@dataclass(frozen=True)
class Plan:
    """The methods and settings of a study."""

    until: Fraction | None = None  # end of the motion; None for that of the scene's time span
    # of the Taylor engine, by precision, least demanding first; precisions ascend
    tolerances: Mapping[str, Sequence[float]] = field(
        default_factory=lambda: {
            "double": (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16),
            "extended": (1e-14, 1e-16, 1e-18, 1e-19),
            "quadruple": (1e-16, 1e-20, 1e-24, 1e-28, 1e-32, 1e-34),
            "50": (1e-20, 1e-30, 1e-40, 1e-50),
            "100": (1e-40, 1e-60, 1e-80, 1e-100),
        }
    )
    solver_tolerances: Sequence[float] = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13)  # of the Runge-Kutta engine, too
    orders: Sequence[int] = (10, 20, 30, 40, 60, 80)  # of a single series
    series_digits: int = 30  # of rounded coefficients
    compared_tolerance: float = 1e-10  # at which stabilizations and solves are compared
    longest_reference: float = 15.0  # seconds that a run for the reference may be expected to take

    @property
    def most_digits(self) -> int:
        """Digits of the most precise numbers."""
        return max(read_precision(precision).digits for precision in self.tolerances)

    @property
    def steps(self) -> int:
        """Largest number of cases."""
        ladders = sum(map(len, self.tolerances.values()))
        solvers = (len(SOLVERS) + 1) * len(self.solver_tolerances)  # the one is the Runge-Kutta engine
        return len(self.orders) + ladders + solvers + len(Stabilization) + len(Solve)


Method = tuple[Group, str, Sequence[float], Callable[[float], Prepared]]
"""Its group and name, its tolerances, and its preparation for one."""

SECONDS_OF_MANY_DIGITS = 5e-8  # of an operation on numbers of 50 to 130 digits, measured on the pendulum and Andrews


@dataclass(frozen=True)
class Study:
    """The results of a work-precision study of one scene."""

    scene: str = entry("Name of the scene.")
    title: str = entry("Title of the scene.")
    until: Fraction = entry("Last time of the motion.", pattern=EXACT_TIME)
    machine: Machine = entry("Computer of the measurement.")
    reference: Reference = entry(
        "Two runs: digits computed with, orders of expansion, and the largest relative difference."
    )
    measurements: tuple[Measurement, ...] = entry("Each method at each tolerance: its error and its time.")
    omissions: tuple[Omission, ...] = entry("Measurements that were left out, with the reason.")
    advice: tuple[Advice, ...] = entry("The cheapest method for each number of digits.")
    prices: tuple[Price, ...] = entry("By what factor the time grows with one more digit.")


def study(
    file: Source | Path, request: Request, limits: Limits, plan: Plan, advance: Callable[[], None] = lambda: None
) -> Study:
    """Measure time and operations against accuracy.

    Parameters
    ----------
    file : Source or Path
        Scene file.
    request : Request
        Scene, solve and settings. The solve is used in all comparisons but that of the two solves.
    limits : Limits
        Limits of each run of Maxima.
    plan : Plan
        Methods and settings.
    advance : callable
        Called without arguments at most `plan.steps` times, for the progress.

    Returns
    -------
    Study

    Raises
    ------
    HolonomError
        As `holonom.program.motion_problem.motion_problem`, or the scene has no motion program or names no end.
    """
    source = source_of(file, limits)
    problems, unsolved = _problems(source, request, plan)
    problem, until = problems[0], _end_of(problems[0], plan)
    plan, beyond = _within_reach(plan, problem, until)
    expansion, unexpanded = _expansion(problem, until)
    times = sorted({until, expansion.time} if expansion else {until})
    reference = find_reference(problem, times, plan.most_digits)
    series, unexpandable = _series(source, request, expansion, plan, reference)
    with without_caches():
        results = measure(_benchmark_cases(problems, until, expansion, plan), reference, advance)
    measurements = [*series, *(r for r in results if isinstance(r, Measurement))]
    omissions = [*unsolved, *unexpanded, *unexpandable, *beyond, *(r for r in results if isinstance(r, Omission))]
    return Study(
        scene=problem.scene,
        title=problem.title,
        until=until,
        machine=this_machine(),
        reference=reference,
        measurements=tuple(measurements),
        omissions=tuple(omissions),
        advice=tuple(cheapest_methods(measurements)),
        prices=tuple(prices(measurements)),
    )


def _problems(source: Source, request: Request, plan: Plan) -> tuple[list[MotionProblem], list[Omission]]:
    """Return the problem with the requested solve, and with the other one if solvable."""
    digits = plan.most_digits + MORE_DIGITS
    problem = motion_problem(source, request, source.limits, digits)
    if problem.obstruction is not None:
        raise HolonomError(ErrorKind.NO_MOTION_PROGRAM, source.file, problem.obstruction)
    require_analytic(problem)
    other = next(solve for solve in Solve if solve is not request.solve)
    by_other = motion_problem(source, replace(request, solve=other), source.limits, digits)
    if by_other.obstruction is not None:
        return [problem], [Omission(_solve_name(other), "all tolerances", by_other.obstruction)]
    return [problem, by_other], []


def _end_of(problem: MotionProblem, plan: Plan) -> Fraction:
    """Return the last time exactly.

    Raises as `last_time`, or if an event may end the motion.
    """
    last_time(problem, plan.until, read_precision("double"))
    if problem.ends.until and plan.until is None:
        raise HolonomError(ErrorKind.NO_COMMON_END, problem.scene)
    return Fraction(problem.time_span[1]) if plan.until is None else plan.until


def _within_reach(plan: Plan, problem: MotionProblem, until: Fraction) -> tuple[Plan, list[Omission]]:
    """Return the plan without the precisions whose reference would take too long."""
    rehearsal = TaylorEngine(Task.of(problem, stabilization=Stabilization.NONE))
    advance(rehearsal, float(until))
    tolerances, beyond = dict(plan.tolerances), []
    for precision in reversed(plan.tolerances):
        digits = read_precision(precision).digits + MORE_DIGITS
        operations = rehearsal.steps * operations_of_a_step(problem, 10.0**-digits)
        seconds = SECONDS_OF_MANY_DIGITS * operations
        if seconds <= plan.longest_reference or len(tolerances) == 1:
            break
        tolerances.pop(precision)
        reason = f"its reference would take about {seconds:.2g} s, more than {plan.longest_reference:g} s"
        beyond.append(Omission(taylor_name(precision), "all tolerances", reason))
    return replace(plan, tolerances=tolerances), beyond


def _solve_name(solve: Solve) -> str:
    return translatable("solve: %(solve)s", solve=solve)


def _expansion(problem: MotionProblem, until: Fraction) -> tuple[Expansion | None, list[Omission]]:
    try:
        return expansion_of(problem, until), []
    except HolonomError as refusal:
        return None, [Omission("series", translatable("all orders"), str(refusal))]


def _series(
    source: Source, request: Request, expansion: Expansion | None, plan: Plan, reference: Reference
) -> tuple[list[Measurement], list[Omission]]:
    """Measure the series that Maxima finds, if any."""
    measurements, omissions = [], []
    for digits in (EXACT, plan.series_digits) if expansion else ():
        try:
            found = list(maxima_series(source, request, source.limits, expansion, plan.orders, digits, reference))
        except HolonomError as refusal:
            omissions.append(Omission(series_name(digits), translatable("all orders"), str(refusal)))
            continue
        for m in found:
            if reference.can_tell(m.error):
                measurements.append(m)
            else:
                omissions.append(
                    Omission(m.method, m.setting, translatable("its error is smaller than that of the reference"))
                )
        omissions += [
            Omission(
                series_name(digits),
                translatable("order %(order)s", order=order),
                translatable("the order before it took too long"),
            )
            for order in plan.orders[len(found) :]
        ]
    return measurements, omissions


def _benchmark_cases(
    problems: Sequence[MotionProblem], until: Fraction, expansion: Expansion | None, plan: Plan
) -> Iterator[BenchmarkCase]:
    """Yield each method at each of its settings, Maxima's series left out."""
    if expansion:
        yield from double_series(expansion, plan.orders)
    for group, method, tolerances, prepare in _methods(problems, until, plan):
        for tol in tolerances:
            yield BenchmarkCase(group, method, f"tol {tol:g}", until, partial(prepare, tol))


def _methods(problems: Sequence[MotionProblem], until: Fraction, plan: Plan) -> Iterator[Method]:
    problem, compared = problems[0], (plan.compared_tolerance,)
    for precision, tolerances in plan.tolerances.items():
        yield Group.TAYLOR, taylor_name(precision), tolerances, partial(prepare_taylor, problem, until, precision)
    yield Group.RUNGE_KUTTA, RUNGE_KUTTA, plan.solver_tolerances, partial(prepare_runge_kutta, problem, until)
    for name, solver in SOLVERS.items():
        yield Group.SOLVER, name, plan.solver_tolerances, partial(prepare_solver, problem, until, solver)
    for each in Stabilization:
        name = translatable("stabilization: %(method)s", method=each)
        yield Group.STABILIZATION, name, compared, partial(prepare_taylor, problem, until, "double", stabilization=each)
    for each in problems:
        yield Group.SOLVE, _solve_name(each.motion.solve), compared, partial(prepare_taylor, each, until, "double")
