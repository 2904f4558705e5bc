"""The Runge-Kutta engine at work for a measurement: every run starts anew, compiled once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ...simulation.engines.runge_kutta import RungeKuttaEngine
from .candidates import Candidate, Group, Prepared
from .errors import State, numbers_of
from .right_hand_side import acceleration_program

if TYPE_CHECKING:
    from fractions import Fraction

    from numpy.typing import NDArray

    from ...program.motion_problem import MotionProblem

RUNGE_KUTTA = "Runge-Kutta engine"


def runge_kutta_ladder(problem: MotionProblem, until: Fraction, tolerances: Sequence[float]) -> Iterator[Candidate]:
    """The Runge-Kutta engine, tolerance by tolerance.

    Parameters
    ----------
    problem : MotionProblem
        Without an obstacle.
    """
    for tol in tolerances:
        yield Candidate(Group.RUNGE_KUTTA, RUNGE_KUTTA, f"tol {tol:g}", until, partial(_prepare, problem, until, tol))


def _prepare(problem: MotionProblem, until: Fraction, tol: float) -> Prepared:
    motion, operations = RungeKuttaEngine(problem, tol), acceleration_program(problem).operations
    begin, start, end = motion.time, motion.state.copy(), float(until)
    before = 0

    def run() -> NDArray[np.float64]:
        nonlocal before
        before = motion.evaluations
        motion.restart(begin, start)
        motion.advance(end)
        return motion.state

    def numbers(values: NDArray[np.float64]) -> State:
        return numbers_of(map(repr, map(float, values)))

    return Prepared(run, numbers, lambda: (motion.evaluations - before) * operations)
