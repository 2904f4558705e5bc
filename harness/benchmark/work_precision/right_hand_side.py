"""A compiled motion as the first-order equations that integrators in Python take."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...program.c_function import compile_c
from ...program.motion_problem import computing

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...program.motion_problem import MotionProblem
    from ...program.motion_program import Program


class RightHandSide:
    """The rate of the state (q, dot q), from a compiled function of t and the state.

    Parameters
    ----------
    accelerations : callable
        A function of ctypes, of two addresses: t, q, dot q and what else it takes, of which it makes no use; ddot q.
    inputs : int
        How many numbers it takes.
    """

    def __init__(self, accelerations: Callable[[int, int], None], coordinates: int, inputs: int) -> None:
        self.evaluations = 0
        self.coordinates = coordinates
        self._accelerations = accelerations
        self._given, self._found = np.zeros(inputs), np.empty(coordinates)
        self._state = self._given[1 : 2 * coordinates + 1]
        self._addresses = ctypes.c_void_p(self._given.ctypes.data), ctypes.c_void_p(self._found.ctypes.data)

    def __call__(self, t: float, state: NDArray[np.float64]) -> NDArray[np.float64]:
        """Rates in a new array, as SciPy asks for them."""
        rates = np.empty(2 * self.coordinates)
        self.fill(t, state, rates)
        return rates

    def fill(self, t: float, state: NDArray[np.float64], rates: NDArray[np.float64]) -> None:
        """Rates in an array that is given, as SUNDIALS asks for them."""
        self.evaluations += 1
        self._given[0] = t
        self._state[:] = state
        self._accelerations(*self._addresses)
        rates[: self.coordinates] = self._state[self.coordinates :]
        rates[self.coordinates :] = self._found


def acceleration_program(problem: MotionProblem) -> Program:
    """The part of a motion program that computes the accelerations alone."""
    return computing(problem.motion, {f"ddot({name})" for name in problem.coordinates})


def compiled_right_hand_side(problem: MotionProblem) -> RightHandSide:
    """The motion program of a problem, compiled by the system's C compiler.

    Parameters
    ----------
    problem : MotionProblem
        Without an obstacle.

    Raises
    ------
    HolonomError
        As `holonom.program.c_function.compile_c`.
    """
    program = acceleration_program(problem)
    return RightHandSide(compile_c(program).one, len(problem.coordinates), len(program.inputs))
