"""Projection onto the constraints by the projection program, and its distance.

It takes one step of Newton's method for the position and one for the velocity at the new position. The remaining
residuals are of second order.
"""

from functools import cached_property
from typing import Any

import numpy as np

from ...program.motion_problem import MotionProblem
from ...program.precision import Precision
from ..evaluation import Evaluation, Numbers, as_floats, evaluation_once
from ..inputs import Inputs
from ..nominal import Vector, nominal_of


class ProgramProjection:
    """Projects states in the mass metric, by the pivots of the motion program."""

    def __init__(self, problem: MotionProblem, precision: Precision) -> None:
        self._problem, self._precision, self._sizes = problem, precision, nominal_of(problem).state
        self._inputs = Inputs(problem, precision)

    @cached_property
    def _corrections(self) -> Evaluation:
        return evaluation_once(self._problem, self._problem.projection, self._precision)

    def project(self, time: Any, state: Numbers) -> float:
        """Move a state, in place, to the nearest one that satisfies the constraints.

        Parameters
        ----------
        time : number
            Time of the state.
        state : ndarray, shape (2n,)
            Coordinates, then velocities. Changed in place.

        Returns
        -------
        float
            The way that the state has moved, by `distance`.
        """
        found = nearest_state(self._corrections, self._inputs(time, state), len(state))
        changed = distance(state, found, self._sizes)
        state[:] = found
        return float(changed)


def nearest_state(corrections: Evaluation, inputs: Numbers, size: int) -> Numbers:
    """Return the nearest states of motions that satisfy the constraints.

    Parameters
    ----------
    corrections : callable
        Projection program of the motion.
    inputs : ndarray, shape (inputs,) or (inputs, k)
        Inputs at the states. Changed in place.
    size : int
        Number 2n of coordinates and velocities.

    Returns
    -------
    ndarray, shape (2n,) or (2n, k)
        A view of the inputs.
    """
    state, half = inputs[1 : 1 + size], size // 2
    state[:half] += corrections(inputs)[:half]
    state[half:] += corrections(inputs)[half:]
    return state


def distance(before: Numbers, after: Numbers, sizes: Vector) -> Vector:
    """Return the length of a change of one state or of k states.

    It is relative to (s^2 + x^2)^(1/2) of each number x of nominal size s.

    Parameters
    ----------
    before, after : ndarray, shape (2n,) or (2n, k)
        Coordinates, then velocities.
    sizes : ndarray, shape (2n,)
        Nominal sizes.

    Returns
    -------
    float or ndarray, shape (k,)
        Dimensionless.
    """
    change, numbers = as_floats(after - before), as_floats(before)
    return np.linalg.norm(change.T / np.hypot(sizes, numbers.T), axis=-1)
