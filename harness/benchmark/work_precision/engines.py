"""Our engines at work for a measurement: every run starts anew, compiled once. Their problems have no obstacle."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ...language import translatable
from ...program.expense import order_for
from ...program.motion_problem import MotionProblem
from ...program.precision import Precision, read_precision
from ...program.request import Solve
from ...simulation.engines.runge_kutta import RungeKuttaEngine
from ...simulation.engines.taylor import TaylorEngine
from ...simulation.request import Stabilization
from .measurement import Candidate, Group, Prepared, State, doubles, numbers_of
from .operations import acceleration_program, expansion_operations

if TYPE_CHECKING:
    from fractions import Fraction

    from ...simulation.engines.engine import Engine

LARGEST_UNROLLED = 130  # operations of a motion program whose fastest code compiles in about a second
HARDWARE = ("double", "extended")  # numbers for which the way of compiling matters


def taylor_ladder(
    problem: MotionProblem, until: Fraction, precision: str, tolerances: Sequence[float]
) -> Iterator[Candidate]:
    """Yield the Taylor engine in one precision, tolerance by tolerance."""
    for tol in tolerances:
        prepare = partial(prepare_taylor, problem, until, precision, tol, Stabilization.PROJECTION)
        yield Candidate(Group.TAYLOR, taylor_name(precision), f"tol {tol:g}", until, prepare)


def taylor_name(precision: str) -> str:
    """Name of the method, given its precision."""
    if precision.isdecimal():
        return translatable("Taylor, %(digits)s digits", digits=precision)
    return translatable("Taylor, %(precision)s", precision=precision)


def solve_name(solve: Solve) -> str:
    """Name of the Taylor engine on the program of one solve."""
    return translatable("solve: %(solve)s", solve=solve)


def stabilizations(problem: MotionProblem, until: Fraction, tol: float) -> Iterator[Candidate]:
    """Yield the stabilizations at one tolerance, in double precision; arguments as of `taylor_ladder`."""
    for drift in Stabilization:
        prepare = partial(prepare_taylor, problem, until, "double", tol, drift)
        yield Candidate(Group.DRIFT, translatable("drift: %(cure)s", cure=drift), f"tol {tol:g}", until, prepare)


def the_two_solves(problems: Sequence[MotionProblem], until: Fraction, tol: float) -> Iterator[Candidate]:
    """Yield the same motion by each of its programs at one tolerance, in double precision."""
    for problem in problems:
        prepare = partial(prepare_taylor, problem, until, "double", tol, Stabilization.PROJECTION)
        yield Candidate(Group.SOLVE, solve_name(problem.motion.solve), f"tol {tol:g}", until, prepare)


def prepare_taylor(
    problem: MotionProblem, until: Fraction, precision: str, tol: float, drift: Stabilization
) -> Prepared:
    """Compile the Taylor engine for one precision and tolerance."""
    numbers = read_precision(precision)
    motion = TaylorEngine(problem, tol, numbers, drift, compact=_compact(problem, precision))
    run = Repeated(motion, numbers.ratio(until), lambda: motion.steps)
    return Prepared(run, partial(state_of, numbers), lambda: run.work * operations_of_a_step(problem, motion.tol))


class Repeated:
    """A motion followed to an instant, again and again from its start; `work` is the steps or evaluations it took."""

    def __init__(self, motion: Engine, last: Any, counted: Callable[[], int]) -> None:
        self._motion, self._last, self._counted = motion, last, counted
        self._begin, self._start = motion.time, np.array(motion.state)
        self.work = 0

    def __call__(self) -> Any:
        """Follow the motion once; return the state at its end."""
        before = self._counted()
        self._motion.restart(self._begin, self._start)
        self._motion.advance(self._last)
        self.work = self._counted() - before
        return self._motion.state


def operations_of_a_step(problem: MotionProblem, tol: float) -> int:
    """Operations of the expansion that a step takes; stabilizations are not counted."""
    return expansion_operations(acceleration_program(problem), order_for(-math.log10(tol)))


def state_of(numbers: Precision, values: Any) -> State:
    """Return a state in numbers of some precision, digit by digit."""
    return numbers_of(map(numbers.text, values))


def _compact(problem: MotionProblem, precision: str) -> bool | None:
    """Return whether compact code is compiled, once and for all; the engine's own choice beyond hardware numbers."""
    return problem.motion.operations > LARGEST_UNROLLED if precision in HARDWARE else None


RUNGE_KUTTA = translatable("Runge-Kutta engine")


def runge_kutta_ladder(problem: MotionProblem, until: Fraction, tolerances: Sequence[float]) -> Iterator[Candidate]:
    """Yield the Runge-Kutta engine, tolerance by tolerance."""
    for tol in tolerances:
        prepare = partial(_prepare_runge_kutta, problem, until, tol)
        yield Candidate(Group.RUNGE_KUTTA, RUNGE_KUTTA, f"tol {tol:g}", until, prepare)


def _prepare_runge_kutta(problem: MotionProblem, until: Fraction, tol: float) -> Prepared:
    motion, operations = RungeKuttaEngine(problem, tol), acceleration_program(problem).operations
    run = Repeated(motion, float(until), lambda: motion.evaluations)
    return Prepared(run, doubles, lambda: run.work * operations)
