"""Holonom's engines in measurements. Each run starts anew with compiled code.

Their problems have no singular configurations on the way.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ...language import translatable
from ...program.expense import order_for
from ...program.motion_problem import MotionProblem
from ...program.precision import Precision, read_precision
from ...program.rewriting import computing
from ...simulation.engines.engine import Engine, Task, advance
from ...simulation.engines.runge_kutta import RungeKuttaEngine
from ...simulation.engines.taylor import TaylorEngine
from ...simulation.request import Stabilization
from .measurement import Prepared, State, doubles, numbers_of
from .operations import expansion_operations

if TYPE_CHECKING:
    from fractions import Fraction

LARGEST_UNROLLED = 130  # operations of a motion program whose fastest code compiles in about a second
HARDWARE = ("double", "extended")  # numbers for which the way of compiling matters
RUNGE_KUTTA = translatable("Runge-Kutta engine")


def taylor_name(precision: str) -> str:
    """Return the name of the Taylor engine in a precision.

    Parameters
    ----------
    precision : str
        Such as ``double``, or a number of decimal digits.

    Returns
    -------
    str
    """
    if precision.isdecimal():
        return translatable("Taylor, %(digits)s digits", digits=precision)
    return translatable("Taylor, %(precision)s", precision=precision)


def prepare_taylor(
    problem: MotionProblem,
    until: Fraction,
    precision: str,
    tol: float,
    stabilization: Stabilization = Stabilization.PROJECTION,
) -> Prepared:
    """Compile the Taylor engine for one precision and tolerance.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    until : Fraction
        Final time, in the scene's unit.
    precision : str
        Numbers to compute with.
    tol : float
        Tolerance of a step.
    stabilization : Stabilization
        How the constraints are satisfied: by projection or a stabilization.

    Returns
    -------
    Prepared
        The compiled engine, ready to run.
    """
    numbers = read_precision(precision)
    asked = {"precision": precision, "tol": tol, "stabilization": stabilization}
    motion = TaylorEngine(Task.of(problem, **asked, compact=_compact(problem, precision)))
    run = Repeated(motion, numbers.ratio(until), lambda: motion.steps)
    return Prepared(run, partial(state_of, numbers), lambda: run.work * operations_of_a_step(problem, motion.tol))


class Repeated:
    """A motion that is integrated to a time repeatedly from its initial state.

    `work` is the number of steps or evaluations of the last run.
    """

    def __init__(self, motion: Engine, last: Any, counted: Callable[[], int]) -> None:
        self._motion, self._last, self._counted = motion, last, counted
        self._begin, self._start = motion.time, np.array(motion.state)
        self.work = 0

    def __call__(self) -> Any:
        """Integrate the motion once. Return the final state."""
        before = self._counted()
        self._motion.restart(self._begin, self._start)
        advance(self._motion, self._last)
        self.work = self._counted() - before
        return self._motion.state


def operations_of_a_step(problem: MotionProblem, tol: float) -> int:
    """Return the operations of the expansion that a step takes, without stabilization.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    tol : float
        Tolerance of the step, which determines the order.

    Returns
    -------
    int
    """
    return expansion_operations(computing(problem.motion, problem.accelerations), order_for(-math.log10(tol)))


def state_of(numbers: Precision, values: Any) -> State:
    """Return a state as numbers of a precision, with all digits.

    Parameters
    ----------
    numbers : Precision
    values : sequence of numbers of the precision
        Coordinates and velocities.

    Returns
    -------
    State
    """
    return numbers_of(map(numbers.text, values))


def _compact(problem: MotionProblem, precision: str) -> bool | None:
    """Return True if heyoka compiles compact code, None if the engine decides."""
    return problem.motion.operations > LARGEST_UNROLLED if precision in HARDWARE else None


def prepare_runge_kutta(problem: MotionProblem, until: Fraction, tol: float) -> Prepared:
    """Compile the Runge-Kutta engine for one tolerance.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    until : Fraction
        Final time, in the scene's unit.
    tol : float
        Tolerance of a step.

    Returns
    -------
    Prepared
        The compiled engine, ready to run.
    """
    motion = RungeKuttaEngine(Task.of(problem, tol=tol))
    operations = computing(problem.motion, problem.accelerations).operations
    run = Repeated(motion, float(until), lambda: motion.evaluations)
    return Prepared(run, doubles, lambda: run.work * operations)
