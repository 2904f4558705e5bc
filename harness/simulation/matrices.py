"""Matrices of a motion at a state, for the solves with pivots.

They are those of A a - J^T lambda = h, J a = -c, with the constraints f and their time derivative df/dt.
"""

import math
import re
from collections.abc import Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..failures import ErrorKind, HolonomError
from ..program.motion_problem import MotionProblem, require_signs_known
from ..program.precision import read_precision
from .evaluation import Numbers, batch_evaluation, evaluation_once
from .inputs import Inputs
from .nominal import Nominal, nominal_of

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
INDEXED = re.compile(r"(\w+)\[(\d+)(?:,(\d+))?\]")


class Matrices(NamedTuple):
    """The equations of motion at one state of n coordinates under g constraints."""

    mass: Matrix  # shape (n, n): A, symmetric
    force: Vector  # shape (n,): h
    jacobian: Matrix  # shape (g, n): J; its rows may be dependent
    curvature: Vector  # shape (g,): c
    # residual, residual_rate: shape (g,): f and df/dt
    residual: Vector
    residual_rate: Vector
    finite: bool | NDArray[np.bool_]  # whether all of them are numbers, none infinite

    def under(self, constraints: Sequence[int]) -> "Matrices":
        """Return the matrices under some of the constraints alone.

        Parameters
        ----------
        constraints : sequence of int
            Indices of constraints, counted from 0.

        Returns
        -------
        Matrices
        """
        of_constraints = ("jacobian", "curvature", "residual", "residual_rate")
        return self._replace(**{name: getattr(self, name)[list(constraints)] for name in of_constraints})


class MotionMatrices:
    """The matrices of a motion as a function of its state.

    Attributes
    ----------
    nominal : Nominal
        Sizes of the motion's quantities.
    """

    def __init__(self, problem: MotionProblem) -> None:
        require_signs_known(problem)
        self._problem, self._independent = problem, problem.independent
        self._layout = _Layout(problem)
        self._evaluate = evaluation_once(problem, problem.matrices, read_precision("double"))
        self._inputs = Inputs(problem)

    @cached_property
    def nominal(self) -> Nominal:
        """The nominal sizes, computed at their first use."""
        return nominal_of(self._problem)

    def __call__(self, t: float | Vector, state: Vector) -> Matrices:
        """Evaluate the matrices.

        Parameters
        ----------
        t : float or ndarray, shape (k,)
        state : ndarray, shape (2n,) or (k, 2n)
            Coordinates, then velocities.

        Returns
        -------
        Matrices
            At k states, each with a first axis more, of length k.
        """
        return self._layout.matrices_at_each(self._evaluate(self._inputs(t, state.T)).T)

    def unbalanced(self, t: float, states: Matrix, accelerations: Vector, multipliers: Vector) -> Matrix:
        """Return h - A a + J^T lambda at k states, a and lambda the same.

        Its cost grows with the entries of A and J that are not zero by structure.

        Parameters
        ----------
        t : float
            Time of the states.
        states : ndarray, shape (k, 2n)
        accelerations : ndarray, shape (n,)
            a.
        multipliers : ndarray, shape (g,)
            lambda.

        Returns
        -------
        ndarray, shape (n, k)
        """
        return self._layout.unbalanced(self._evaluate(self._inputs(t, states.T)), accelerations, multipliers)

    def independent(self, t: float, state: Vector) -> Matrices:
        """Evaluate the matrices of the independent constraints.

        Parameters
        ----------
        t : float
            Time of the state.
        state : ndarray, shape (2n,)
            Coordinates, then velocities.

        Returns
        -------
        Matrices
        """
        return self(t, state).under(self._independent)


class BatchMatrices:
    """The matrices of many motions of one problem, each with its own parameter values."""

    def __init__(self, problem: MotionProblem) -> None:
        require_signs_known(problem)
        self._layout, self._inputs = _Layout(problem), Inputs(problem)
        self._evaluate = batch_evaluation(problem, problem.matrices)

    def __call__(self, t: float | Numbers, states: Numbers, values: Numbers) -> Matrices:
        """Evaluate the matrices.

        Parameters
        ----------
        states : ndarray, shape (2n, k)
        values : ndarray, shape (p, k)
            Of the open parameters.

        Returns
        -------
        Matrices
            Each with a last axis more, of length k.
        """
        return self._layout.matrices(self._evaluate(self._inputs(t, states, values=values)))


class _Layout:
    """The layout of the outputs of the program of the matrices."""

    def __init__(self, problem: MotionProblem) -> None:
        n, g = len(problem.coordinates), len(problem.multipliers)
        shapes = {"A": (n, n), "h": (n,), "J": (g, n), "c": (g,), "residual": (g,), "residual_rate": (g,)}
        ends = np.cumsum([math.prod(shape) for shape in shapes.values()])
        self._parts = [
            (slice(end - math.prod(shape), end), shape) for end, shape in zip(ends, shapes.values(), strict=True)
        ]
        starts = {name: part.start for name, (part, _) in zip(shapes, self._parts, strict=True)}
        self._size = int(ends[-1])
        self._places = np.array([_place(name, starts, n) for name in problem.matrices.outputs], dtype=int)

    def unbalanced(self, outputs: Numbers, accelerations: Vector, multipliers: Vector) -> Matrix:
        """Return h - A a + J^T lambda of the program's outputs, shape (outputs, k)."""
        n = len(accelerations)
        mass, force, jacobian = (self._within(part) for part, _ in self._parts[:3])
        entries = np.concatenate([mass[0], force[0], jacobian[0]])
        rows = np.concatenate([mass[1] // n, force[1], jacobian[1] % n])
        ones = np.ones(len(force[0]))
        weights = np.concatenate([-accelerations[mass[1] % n], ones, multipliers[jacobian[1] // n]])
        order = np.argsort(rows, kind="stable")
        present, starts = np.unique(rows[order], return_index=True)
        sums = np.zeros((n, outputs.shape[1]))
        sums[present] = np.add.reduceat(weights[order, None] * outputs[entries[order]], starts, axis=0)
        return sums

    def _within(self, part: slice) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Return which outputs are in a part, and their places in it."""
        entries = np.flatnonzero((part.start <= self._places) & (self._places < part.stop))
        return entries, self._places[entries] - part.start

    def matrices(self, outputs: Numbers) -> Matrices:
        """Return the program's outputs, shape (outputs, ...), as matrices (..., ...)."""
        rest = outputs.shape[1:]
        values = np.zeros((self._size, *rest))
        values[self._places] = outputs
        finite = np.isfinite(outputs).all(axis=0)
        return Matrices(*(values[part].reshape(*shape, *rest) for part, shape in self._parts), finite)

    def matrices_at_each(self, outputs: Numbers) -> Matrices:
        """Return matrices of the program's outputs, shape (..., outputs).

        Each matrix has the leading axes (...), followed by its own shape.
        """
        rest = outputs.shape[:-1]
        values = np.zeros((*rest, self._size))
        values[..., self._places] = outputs
        finite = np.isfinite(outputs).all(axis=-1)
        return Matrices(*(values[..., part].reshape(*rest, *shape) for part, shape in self._parts), finite)


def start_of(problem: MotionProblem) -> tuple[float, Vector]:
    """Return the time and the state at which a motion starts.

    Parameters
    ----------
    problem : MotionProblem
        The motion, with numbers for its start.

    Returns
    -------
    (float, ndarray of shape (2n,))

    Raises
    ------
    HolonomError
        A number exceeds a double.
    """
    state = np.array([float(problem.start[name]) for name in problem.state])
    if not np.isfinite(state).all():
        raise HolonomError(ErrorKind.NUMBER_TOO_LARGE)
    return float(problem.start["t"]), state


def _place(output: str, starts: dict[str, int], n: int) -> int:
    name, row, column = INDEXED.fullmatch(output).groups()
    within = int(row) - 1 if column is None else (int(row) - 1) * n + int(column) - 1
    return starts[name] + within
