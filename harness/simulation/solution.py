"""What the equations of motion determine at states of a motion: accelerations, multipliers, constraint forces."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..program.motion_problem import MotionProblem
from ..program.precision import Precision
from .evaluation import Numbers, evaluation, zeros


class Solutions(NamedTuple):
    """Solutions at k states.

    Attributes
    ----------
    accelerations : ndarray, shape (n, k)
    multipliers : ndarray, shape (g, k)
    constraint_forces : ndarray, shape (n, k), or (0, k) where the scene does not observe them
    """

    accelerations: NDArray[Any]
    multipliers: NDArray[Any]
    constraint_forces: NDArray[Any]


Solve = Callable[[Numbers, Numbers], Solutions]


def program_solution(problem: MotionProblem, precision: Precision) -> Solve:
    """The solution by the motion program.

    Parameters
    ----------
    problem : MotionProblem
        Without an obstacle.
    precision : Precision

    Returns
    -------
    callable
        Takes instants, shape (k,), and states, shape (2n, k), to `Solutions`.
    """
    n, g = len(problem.coordinates), len(problem.multipliers)
    evaluate = evaluation(problem.motion, precision)

    def solve(instants: Numbers, states: Numbers) -> Solutions:
        inputs = np.concatenate([np.reshape(instants, (1, -1)), states, zeros(precision, g, len(instants))])
        found = evaluate(np.ascontiguousarray(inputs))
        return Solutions(found[:n], found[n : n + g], found[n + g :])

    return solve
