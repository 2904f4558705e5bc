"""Accelerations and multipliers at a state, by each solve and a textbook formula.

A a - J^T lambda = h,   J a = -c.
"""

from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

import numpy as np

from ...language import translatable
from ...program.motion_problem import MotionProblem
from ...program.numpy_function import NumpyFunction
from ...program.request import Solve
from ...simulation.constraints.factorization import factored_constraints
from ...simulation.inputs import Inputs
from ...simulation.matrices import Matrices, MotionMatrices, Vector
from .case import Result, graded
from .runs import problem

TEXTBOOK, DIRECT = translatable("textbook formula"), translatable("direct")
ORTHOGONAL, PIVOTED = translatable("orthogonal"), translatable("pivoted")


class Solved(NamedTuple):
    """Accelerations a, shape (n,), and multipliers lambda, shape (g,)."""

    accelerations: Vector
    multipliers: Vector


SolveAt = Callable[[float, Vector], Solved]


def every_solve(file: str, scene: str | None = None) -> Mapping[str, SolveAt]:
    """Return each way to solve the equations of motion of a scene among the examples.

    Parameters
    ----------
    file : str
        Path below the folder of examples.
    scene : str or None
        Name of the scene, or None for the file's last one.

    Returns
    -------
    mapping of str to SolveAt
        By name, a function of the time and of the state, shape (2n,).
    """
    matrices = MotionMatrices(problem(file, scene))
    return {
        TEXTBOOK: lambda t, state: _textbook(matrices(t, state)),
        DIRECT: _programmed(problem(file, scene)),
        ORTHOGONAL: _programmed(problem(file, scene, Solve.ORTHOGONAL)),
        PIVOTED: lambda t, state: _pivoted(matrices(t, state)),
    }


def solve_digits(
    quantity: str, digits: Mapping[str, float], needed: float, compared: tuple[str, ...] = (TEXTBOOK, DIRECT)
) -> Iterator[Result]:
    """Yield the digits of each solve. The solves in `compared` may lose digits.

    Parameters
    ----------
    quantity : str
        Name of the quantity.
    digits : mapping of str to float
        Correct digits of each solve, by its name.
    needed : float
        Required number of correct digits.
    compared : tuple of str
        Names of the solves for comparison.

    Yields
    ------
    Result
        One solve's digits.
    """
    for name, correct in digits.items():
        yield graded(name, quantity, correct, needed, name in compared)


def _textbook(matrices: Matrices) -> Solved:
    """Solve by the textbook formula, nan if a matrix is singular.

    It is lambda = -G^-1 (c + J A^-1 h), a = A^-1 (h + J^T lambda), G = J A^-1 J^T.
    """
    J = matrices.jacobian
    try:
        inverse_mass = np.linalg.inv(matrices.mass)
        inverse_of_G = np.linalg.inv(J @ inverse_mass @ J.T)
    except np.linalg.LinAlgError:
        return Solved(np.full(J.shape[1], np.nan), np.full(J.shape[0], np.nan))
    multipliers = -inverse_of_G @ (matrices.curvature + J @ inverse_mass @ matrices.force)
    return Solved(inverse_mass @ (matrices.force + J.T @ multipliers), multipliers)


def _pivoted(matrices: Matrices) -> Solved:
    """Solve by the factorization of the robust engine."""
    factored = factored_constraints(matrices.mass, matrices.jacobian)
    return Solved(*factored.unknowns(matrices.force, matrices.curvature))


def _programmed(motion: MotionProblem) -> SolveAt:
    """Return a function that solves by the motion program."""
    evaluate, n = NumpyFunction(motion.motion), len(motion.coordinates)
    inputs, g = Inputs(motion), len(motion.multipliers)

    def solve(t: float, state: Vector) -> Solved:
        values = evaluate(inputs(t, state))
        return Solved(values[:n], values[n : n + g])

    return solve
