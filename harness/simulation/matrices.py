"""The matrices of a motion at a state: what the solves with pivots start from.

A a - J^T lambda = h,  J a = -c, beside the constraints f and their rate df/dt.
"""

import math
import re
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..program.motion_problem import MotionProblem, require_analytic
from ..program.precision import read_precision
from .evaluation import evaluation

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
INDEXED = re.compile(r"(\w+)\[(\d+)(?:,(\d+))?\]")


class Matrices(NamedTuple):
    """The equations of motion at one state of n coordinates under g constraints.

    Attributes
    ----------
    mass : ndarray, shape (n, n)
        A, symmetric.
    force : ndarray, shape (n,)
        h.
    jacobian : ndarray, shape (g, n)
        J; its rows may be dependent.
    curvature : ndarray, shape (g,)
        c.
    residual, residual_rate : ndarray, shape (g,)
        f and df/dt.
    finite : bool
        Whether all of them are numbers, none infinite.
    """

    mass: Matrix
    force: Vector
    jacobian: Matrix
    curvature: Vector
    residual: Vector
    residual_rate: Vector
    finite: bool


class MotionMatrices:
    """The matrices of a motion as a function of its state.

    Parameters
    ----------
    problem : MotionProblem
    """

    def __init__(self, problem: MotionProblem) -> None:
        require_analytic(problem)
        n, g = len(problem.coordinates), len(problem.multipliers)
        shapes = {"A": (n, n), "h": (n,), "J": (g, n), "c": (g,), "residual": (g,), "residual_rate": (g,)}
        ends = np.cumsum([math.prod(shape) for shape in shapes.values()])
        self._parts = [
            (slice(end - math.prod(shape), end), shape) for end, shape in zip(ends, shapes.values(), strict=True)
        ]
        starts = {name: part.start for name, (part, _) in zip(shapes, self._parts, strict=True)}
        self._size = int(ends[-1])
        self._places = np.array([_place(name, starts, n) for name in problem.matrices.outputs], dtype=int)
        self._evaluate = evaluation(problem.matrices, read_precision("double"))
        self._inputs = np.zeros(1 + 2 * n + g)

    def __call__(self, t: float, state: Vector) -> Matrices:
        """Evaluate the matrices.

        Parameters
        ----------
        t : float
        state : ndarray, shape (2n,)
            Coordinates, then velocities.

        Returns
        -------
        Matrices
        """
        self._inputs[0] = t
        self._inputs[1 : 1 + len(state)] = state
        values = np.zeros(self._size)
        values[self._places] = self._evaluate(self._inputs)
        finite = bool(np.isfinite(values).all())
        return Matrices(*(values[part].reshape(shape) for part, shape in self._parts), finite)


def start_of(problem: MotionProblem) -> tuple[float, Vector]:
    """Instant and state at which a motion starts.

    Parameters
    ----------
    problem : MotionProblem

    Returns
    -------
    (float, ndarray of shape (2n,))
    """
    return float(problem.start["t"]), np.array([float(problem.start[name]) for name in problem.state])


def _place(output: str, starts: dict[str, int], n: int) -> int:
    name, row, column = INDEXED.fullmatch(output).groups()
    within = int(row) - 1 if column is None else (int(row) - 1) * n + int(column) - 1
    return starts[name] + within
