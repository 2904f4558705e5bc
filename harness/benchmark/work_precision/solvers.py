"""Integrators of SciPy and of SUNDIALS (scikit-sundae) on a compiled motion."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...extras import missing_package
from ...failures import ErrorKind, HolonomError
from ...program.c_function import compile_c
from ...program.rewriting import computing
from ...simulation.matrices import start_of
from .measurement import Prepared, doubles

if TYPE_CHECKING:
    from fractions import Fraction

    from ...program.motion_problem import MotionProblem


class RightHandSide:
    """The time derivative of the state, from a compiled function of t and the state.

    Parameters
    ----------
    accelerations : callable
        A function of ctypes, of the addresses of its arguments (t, q, dot q, and unused inputs) and of ddot q.
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
        """Return the time derivative of the state in a new array, as SciPy requires."""
        rates = np.empty(2 * self.coordinates)
        self.fill(t, state, rates)
        return rates

    def fill(self, t: float, state: NDArray[np.float64], rates: NDArray[np.float64]) -> None:
        """Write the time derivatives into an array, as SUNDIALS requires.

        Parameters
        ----------
        t : float
            Time, in the scene's unit.
        state : ndarray, shape (2n,)
            Coordinates and velocities.
        rates : ndarray, shape (2n,)
            Array to fill with velocities and accelerations.
        """
        self.evaluations += 1
        self._given[0] = t
        self._state[:] = state
        self._accelerations(*self._addresses)
        rates[: self.coordinates] = self._state[self.coordinates :]
        rates[self.coordinates :] = self._found


def _compiled_right_hand_side(problem: MotionProblem) -> RightHandSide:
    """Return the motion program of a problem, compiled by the system's C compiler."""
    program = computing(problem.motion, problem.accelerations)
    return RightHandSide(compile_c(program).one, len(problem.coordinates), len(program.inputs))


MOST_STEPS = 10_000_000  # of SUNDIALS, whose own limit of 500 is meant for one output after the other

Floats = NDArray[np.float64]
# Takes the first and last time, the initial state, and a relative and absolute tolerance, to the final state.
Solver = Callable[[RightHandSide, tuple[float, float], Floats, float], Floats]


def _scipy_solver(method: str, motion: RightHandSide, span: tuple[float, float], start: Floats, tol: float) -> Floats:
    """Return the final state by one of the methods of `scipy.integrate.solve_ivp`."""
    from scipy.integrate import solve_ivp

    solution = solve_ivp(motion, span, start, method=method, rtol=tol, atol=tol)
    if not solution.success:
        raise HolonomError(ErrorKind.METHOD_GAVE_UP, detail=f"SciPy {method}: {solution.message}")
    return solution.y[:, -1]


def _sundials_solver(
    method: str, motion: RightHandSide, span: tuple[float, float], start: Floats, tol: float
) -> Floats:
    """Return the final state by CVODE of SUNDIALS."""
    try:
        from sksundae.cvode import CVODE
    except ImportError:
        raise missing_package("scikit-sundae") from None
    solver = CVODE(motion.fill, method=method, rtol=tol, atol=tol, max_num_steps=MOST_STEPS)
    solution = solver.solve(np.array(span), start)
    if not solution.success:
        raise HolonomError(ErrorKind.METHOD_GAVE_UP, detail=f"SUNDIALS CVODE {method}: {solution.message}")
    return solution.y[-1]


SOLVERS: Mapping[str, Solver] = {
    **{f"SciPy {method}": partial(_scipy_solver, method) for method in ("DOP853", "LSODA", "Radau")},
    **{f"SUNDIALS {method}": partial(_sundials_solver, method) for method in ("Adams", "BDF")},
}


def prepare_solver(problem: MotionProblem, until: Fraction, solver: Solver, tol: float) -> Prepared:
    """Compile the motion program for one solver and tolerance.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    until : Fraction
        Final time, in the scene's unit.
    solver : callable
        One of `SOLVERS`.
    tol : float
        Relative and absolute tolerance.

    Returns
    -------
    Prepared
        The solver, ready to run.
    """
    motion, operations = _compiled_right_hand_side(problem), computing(problem.motion, problem.accelerations).operations
    begin, start = start_of(problem)

    def run() -> Floats:
        motion.evaluations = 0
        return solver(motion, (begin, float(until)), start, tol)

    return Prepared(run, doubles, lambda: motion.evaluations * operations)
