"""Nominal sizes of coordinates, velocities and time.

Tolerances, projections, events, switchings and residuals are relative to these sizes, so that a motion does not depend
on units. A scene may give them, ``nominal = [x = 1e-6]``. The others are found. A coordinate is as large as at the
start or, if it starts near zero, as the least of the others in the mass metric: A_ii q_i^2 is the same. If all start at
zero, the distance counts that velocities, forces or moving constraints make in the time span. The time is the length of
the span, or the time that the first velocities take for the size of the coordinates. Both give the size of velocities.
"""

from dataclasses import replace
from math import log
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..program.motion_problem import MotionProblem
from ..program.numpy_function import NumpyFunction
from ..program.sign_pattern import program_in
from .inputs import Inputs

TIMES = 65  # of the time span at which forces and constraints are looked at where a motion starts at zero
COARSE = 1e3  # power in which tolerances change: what is compiled with one serves many motions
NEAR_ZERO = 1e-3  # of the largest coordinate, as it is and in the mass metric: a light one is small in that alone

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]


class Nominal(NamedTuple):
    """The sizes of a motion's quantities, with a further axis for k motions."""

    time: float | Vector
    state: Vector  # shape (2n,): of coordinates, then of velocities

    @property
    def coordinates(self) -> Vector:
        """Shape (n,)."""
        return self.state[: len(self.state) // 2]

    @property
    def velocities(self) -> Vector:
        """Shape (n,)."""
        return self.state[len(self.state) // 2 :]

    @property
    def accelerations(self) -> Vector:
        """Shape (n,)."""
        return self.velocities / self.time

    def absolute(self) -> float:
        """Return the tolerance factor of a method relative to the largest of all numbers.

        Such a method takes the tolerance as absolute if all numbers are below one. A velocity is relative to the size
        of a coordinate divided by that of the time, and its errors are, too. A share of a power of `COARSE` is accurate
        enough.

        Returns
        -------
        float
            At most one.
        """
        largest = np.max(self.state, initial=1.0)
        coordinates = np.min(self.coordinates, initial=np.inf) / min(1.0, self.time)
        velocities = np.min(self.velocities, initial=np.inf) / min(1.0, 1 / self.time)
        share = min(1.0, float(min(coordinates, velocities) / largest))
        return COARSE ** round(log(share) / log(COARSE))

    def energy(self, mass: Matrix) -> float:
        """Return the energy of the nominal velocities: the largest A_ii v_i^2.

        Parameters
        ----------
        mass : ndarray, shape (n, n)
            A.

        Returns
        -------
        float
            In the scene's unit.
        """
        return float(np.max(mass.diagonal() * self.velocities**2, initial=0.0))

    def share(self, change: Vector, state: Vector) -> float:
        """Return the largest relative change of a state, as `share_of`.

        Parameters
        ----------
        change : ndarray, shape (2n,)
            Difference of two states.
        state : ndarray, shape (2n,)
            Coordinates, then velocities.

        Returns
        -------
        float
        """
        return float(share_of(change, state, self.state))


def share_of(change: Matrix, numbers: Matrix, sizes: Vector) -> Vector:
    """Return the largest change of numbers, relative to the largest number.

    All numbers are in units of their nominal sizes. The largest number counts as one at least.

    Parameters
    ----------
    change : ndarray, shape (n,) or (n, k)
        Differences of the numbers.
    numbers : ndarray, shape (n,) or (n, k)
        The numbers.
    sizes : ndarray, shape (n,)
        Nominal sizes.

    Returns
    -------
    float or ndarray, shape (k,)
    """
    change, numbers = np.abs(change.T) / sizes, np.abs(numbers.T) / sizes
    return np.max(change, axis=-1, initial=0.0) / np.max(numbers, axis=-1, initial=1.0)


def with_nominal(problem: MotionProblem, span: float) -> MotionProblem:
    """Return the motion with nominal sizes for a time span of the given length.

    Parameters
    ----------
    problem : MotionProblem
        The motion. Sizes that the scene gives are kept.
    span : float
        Length of the time span, in the scene's unit.

    Returns
    -------
    MotionProblem
    """
    sizes = _completed(problem, span)
    named = zip(("t", *problem.state), (sizes.time, *map(float, sizes.state)), strict=True)
    return replace(problem, nominal=dict(named))


def nominal_of(problem: MotionProblem) -> Nominal:
    """Return the nominal sizes of a motion.

    Parameters
    ----------
    problem : MotionProblem
        The motion. Missing sizes follow from the scene's time span.

    Returns
    -------
    Nominal
    """
    known = problem.nominal
    if known.keys() >= {"t", *problem.state}:
        return Nominal(known["t"], np.array([known[name] for name in problem.state]))
    first, last = map(float, problem.time_span or (0, 0))
    return _completed(problem, last - first)


def nominal_at_each(problem: MotionProblem, mass: Matrix, states: Matrix, span: float) -> Nominal:
    """Return the nominal sizes of k motions of one problem.

    One whose coordinates all start at zero has those of the problem's own motion.

    Parameters
    ----------
    problem : MotionProblem
        The common problem.
    mass : ndarray, shape (n, n, k)
        A at the start of each motion.
    states : ndarray, shape (2n, k)
        Initial state of each motion.
    span : float
        Length of the time span, in the scene's unit.

    Returns
    -------
    Nominal
        Shapes (k,) and (2n, k).
    """
    own = nominal_of(problem)
    roots = _roots(np.moveaxis(np.diagonal(mass), -1, 0))
    with np.errstate(all="ignore"):
        found, time = _sizes(roots, states, span, 0.0)
    zero = ~states.any(axis=0)
    found[:, zero], time[zero] = own.coordinates[:, None], own.time
    return _with_given(problem, found, time)


def _completed(problem: MotionProblem, span: float) -> Nominal:
    """Return the sizes that the scene gives, and those found."""
    if not problem.start.keys() >= {*problem.state}:  # a parameter without a value decides about the start
        return Nominal(1.0, np.ones(len(problem.state)))
    state = np.array([[float(problem.start[name])] for name in problem.state])
    roots, reach = np.ones((len(problem.coordinates), 1)), 0.0
    with np.errstate(all="ignore"):
        if problem.values.keys() >= {*problem.parameters}:
            start = _Start(problem, state, span)
            roots, reach = start.roots, start.reach()
        found, time = _sizes(roots, state, span, reach)
    sizes = _with_given(problem, found, time)
    return Nominal(float(sizes.time[0]), sizes.state[:, 0])


def _with_given(problem: MotionProblem, coordinates: Matrix, time: Vector) -> Nominal:
    """Return the sizes of coordinates, shape (n, k), and times, shape (k,).

    Sizes that the scene gives replace those found.
    """

    def chosen(name: str, found: Vector) -> Vector:
        return np.full_like(found, problem.nominal[name]) if name in problem.nominal else found

    time = chosen("t", time)
    coordinates = np.array(list(map(chosen, problem.coordinates, coordinates))).reshape(coordinates.shape)
    velocities = np.array(list(map(chosen, problem.state[len(coordinates) :], coordinates / time)))
    return Nominal(time, np.concatenate([coordinates, velocities.reshape(coordinates.shape)]))


def _sizes(roots: Matrix, states: Matrix, span: float, reach: float) -> tuple[Matrix, Vector]:
    """Return the sizes of the coordinates and of the time of k motions.

    Coordinates have shape (n, k), times (k,).

    Parameters
    ----------
    roots : ndarray, shape (n, k)
        Of the masses on the diagonal.
    states : ndarray, shape (2n, k)
        At the start.
    span : float
        Length of the time span, zero where there is none.
    reach : float
        How far, in the mass metric, a motion goes whose coordinates all start at zero, at rest.
    """
    q, v = np.abs(np.split(states, 2))
    size, speed = (np.max(roots * part, axis=0, initial=0.0) for part in (q, v))
    time = np.where((size > 0) & (speed > 0), size / speed, np.inf)
    time = np.minimum(time, span or np.inf)
    time = np.where(time < np.inf, time, 1.0)
    size = np.where(size > 0, size, np.maximum(speed * time, reach))
    own = np.maximum(q, v * time)
    felt = (roots * own >= NEAR_ZERO * size) | (own >= NEAR_ZERO * np.max(own, axis=0, initial=0.0))
    felt &= own > 0
    least = np.min(np.where(felt, roots * own, np.inf), axis=0, initial=np.inf)
    found = np.where(felt, own, np.where(least < np.inf, least, size) / roots)
    return np.where((size > 0) & (size < np.inf), found, 1.0), time


def _roots(masses: Matrix) -> Matrix:
    """Return the roots of the masses, shape (n, k).

    If a mass is zero, it is the mean root of the others.
    """
    there = masses > 0
    mean = np.where(there, masses, 0.0).sum(axis=0) / np.maximum(1, there.sum(axis=0))
    return np.sqrt(np.where(there, masses, np.where(mean > 0, mean, 1.0)))


class _Start:
    """The initial state, with matrices at the initial time and later.

    Signs are taken to be positive, because sizes depend on them little.

    Attributes
    ----------
    roots : ndarray, shape (n, 1)
        Of the masses on the diagonal.
    """

    def __init__(self, problem: MotionProblem, state: Matrix, span: float) -> None:
        self._span, self._g = span, len(problem.multipliers)
        times = float(problem.start["t"]) + span * np.linspace(0, 1, TIMES)
        pattern = {sign.name: 1 for sign in problem.signs}
        program = program_in(problem, problem.matrices, pattern) if pattern else problem.matrices
        inputs = Inputs(problem)(times, np.repeat(state, TIMES, axis=1))
        self._values = dict(zip(program.outputs, NumpyFunction(program).at_points(inputs), strict=True))
        self._places = range(1, len(problem.coordinates) + 1)
        self.roots = _roots(np.array([self._at(f"A[{s},{s}]")[:1] for s in self._places]).reshape(-1, 1))

    def reach(self) -> float:
        """Return the distance from rest in the time span, in the mass metric.

        The mean force or moving constraints make it.
        """
        forces = np.array([np.abs(self._at(f"h[{s}]")) for s in self._places]) / self.roots
        largest = np.max(forces, axis=0, initial=0.0)
        known = largest[np.isfinite(largest)]
        farthest = float(known.mean()) * self._span**2 if known.size else 0.0
        for beta in range(1, self._g + 1):
            gradient = np.array([self._at(f"J[{beta},{s}]") for s in self._places]) / self.roots
            distance = np.abs(self._at(f"residual[{beta}]")) / np.linalg.norm(gradient, axis=0)
            farthest = np.max(distance, initial=farthest, where=np.isfinite(distance))
        return float(farthest)

    def _at(self, output: str) -> Vector:
        """Return an output of the program at the times, zero if it is so by structure."""
        return self._values.get(output, np.zeros(TIMES))
