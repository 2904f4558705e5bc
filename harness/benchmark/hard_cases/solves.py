"""Accelerations and multipliers at one state, by every solve on offer and by the textbook's formula.

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
from .case import Result, ours, theirs
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

    Without a name, of the file's last one.

    Each takes the instant and the state of shape (2n,), coordinates and then velocities.
    """
    matrices = MotionMatrices(problem(file, scene))
    return {
        TEXTBOOK: lambda t, state: textbook(matrices(t, state)),
        DIRECT: programmed(problem(file, scene)),
        ORTHOGONAL: programmed(problem(file, scene, Solve.ORTHOGONAL)),
        PIVOTED: lambda t, state: pivoted(matrices(t, state)),
    }


def solves_kept(
    quantity: str, digits: Mapping[str, float], needed: float, compared: tuple[str, ...] = (TEXTBOOK, DIRECT)
) -> Iterator[Result]:
    """Yield what each solve keeps; those that are there for comparison may lose it."""
    for name, kept in digits.items():
        yield (theirs if name in compared else ours)(name, quantity, kept, needed)


def textbook(matrices: Matrices) -> Solved:
    """As it is printed: lambda = -G^-1 (c + J A^-1 h), a = A^-1 (h + J^T lambda), G = J A^-1 J^T."""
    J = matrices.jacobian
    try:
        inverse_mass = np.linalg.inv(matrices.mass)
        inverse_of_G = np.linalg.inv(J @ inverse_mass @ J.T)
    except np.linalg.LinAlgError:
        return Solved(np.full(J.shape[1], np.nan), np.full(J.shape[0], np.nan))
    multipliers = -inverse_of_G @ (matrices.curvature + J @ inverse_mass @ matrices.force)
    return Solved(inverse_mass @ (matrices.force + J.T @ multipliers), multipliers)


def pivoted(matrices: Matrices) -> Solved:
    """As the robust engine solves."""
    factored = factored_constraints(matrices.mass, matrices.jacobian)
    sides = matrices.force, matrices.curvature
    return Solved(factored.accelerations(*sides), factored.multipliers(*sides))


def programmed(motion: MotionProblem) -> SolveAt:
    """As the motion program solves."""
    evaluate, n = NumpyFunction(motion.motion), len(motion.coordinates)
    inputs, g = Inputs(motion), len(motion.multipliers)

    def solve(t: float, state: Vector) -> Solved:
        values = evaluate(inputs(t, state))
        return Solved(values[:n], values[n : n + g])

    return solve
