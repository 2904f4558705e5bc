"""Integrators that others have written: SciPy's, and SUNDIALS through scikit-sundae."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...failures import Failure, HolonomError, missing_package
from .candidates import Candidate, Group, Prepared
from .errors import State, numbers_of
from .right_hand_side import RightHandSide, acceleration_program, compiled_right_hand_side

if TYPE_CHECKING:
    from fractions import Fraction

    from ...program.motion_problem import MotionProblem

MOST_STEPS = 10_000_000  # of SUNDIALS, whose own limit of 500 is meant for one output after the other

Floats = NDArray[np.float64]
Solver = Callable[[RightHandSide, tuple[float, float], Floats, float], Floats]


def scipy_solver(method: str, motion: RightHandSide, span: tuple[float, float], start: Floats, tol: float) -> Floats:
    """The state at the end, by one of the methods of `scipy.integrate.solve_ivp`.

    Parameters
    ----------
    method : str
        ``DOP853``, ``LSODA`` or ``Radau``.
    span : (float, float)
        First and last instant.
    tol : float
        Relative and absolute.

    Raises
    ------
    HolonomError
        The method gave up; says why.
    """
    from scipy.integrate import solve_ivp

    solution = solve_ivp(motion, span, start, method=method, rtol=tol, atol=tol)
    if not solution.success:
        raise HolonomError(Failure.METHOD_GAVE_UP, detail=f"SciPy {method}: {solution.message}")
    return solution.y[:, -1]


def sundials_solver(method: str, motion: RightHandSide, span: tuple[float, float], start: Floats, tol: float) -> Floats:
    """The state at the end, by CVODE of SUNDIALS.

    Parameters
    ----------
    method : str
        ``Adams`` or ``BDF``.
    motion, span, start, tol
        As for `scipy_solver`.

    Raises
    ------
    HolonomError
        scikit-sundae is not installed; CVODE gave up.
    """
    try:
        from sksundae.cvode import CVODE
    except ImportError:
        raise missing_package("scikit-sundae") from None
    solver = CVODE(motion.fill, method=method, rtol=tol, atol=tol, max_num_steps=MOST_STEPS)
    solution = solver.solve(np.array(span), start)
    if not solution.success:
        raise HolonomError(Failure.METHOD_GAVE_UP, detail=f"SUNDIALS CVODE {method}: {solution.message}")
    return solution.y[-1]


SOLVERS: Mapping[str, Solver] = {
    **{f"SciPy {method}": partial(scipy_solver, method) for method in ("DOP853", "LSODA", "Radau")},
    **{f"SUNDIALS {method}": partial(sundials_solver, method) for method in ("Adams", "BDF")},
}


def solver_ladder(problem: MotionProblem, until: Fraction, tolerances: Sequence[float]) -> Iterator[Candidate]:
    """Each solver on the compiled motion program, tolerance by tolerance.

    Parameters
    ----------
    problem : MotionProblem
        Without an obstacle.
    """
    for name, solver in SOLVERS.items():
        for tol in tolerances:
            prepare = partial(_prepare, problem, until, solver, tol)
            yield Candidate(Group.SOLVER, name, f"tol {tol:g}", until, prepare)


def _prepare(problem: MotionProblem, until: Fraction, solver: Solver, tol: float) -> Prepared:
    motion, operations = compiled_right_hand_side(problem), acceleration_program(problem).operations
    span = float(problem.start["t"]), float(until)
    start = np.array([float(problem.start[name]) for name in problem.state])

    def run() -> Floats:
        motion.evaluations = 0
        return solver(motion, span, start, tol)

    def numbers(values: Floats) -> State:
        return numbers_of(map(repr, map(float, values)))

    return Prepared(run, numbers, lambda: motion.evaluations * operations)
