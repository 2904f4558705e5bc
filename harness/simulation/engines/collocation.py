"""Gauss collocation across a singular configuration, on projected states.

If the constraints lose rank, branches of motion meet, and the equations of motion are undetermined. A step that
evaluates them near there amplifies its own errors and may leave on the wrong branch. The motion itself is analytic
through it. So one long step spans the singular configuration: a polynomial whose second derivative is the acceleration
at Gauss nodes on both sides of it, none of them near it (Hairer, Lubich & Wanner, Geometric Numerical Integration,
section II.1.4). At each node the state is projected onto the constraints, which keeps it on the branch of the
polynomial. The polynomial is found by iteration from the extrapolated motion. The decay of its Legendre coefficients
gives its error, and a collocation step is rejected if the motion is not analytic.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

from ..constraints.directions import EPSILON
from ..constraints.projection import InconsistentConstraints
from ..matrices import Matrix, Vector

NODES = 16
POINTS, WEIGHTS = legendre.leggauss(NODES)
# Values at the nodes to coefficients of Legendre's polynomials; Gauss's rule is exact for the products needed.
TO_COEFFICIENTS = (np.arange(NODES)[:, None] + 0.5) * WEIGHTS * legendre.legvander(POINTS, NODES - 1).T
TAIL = 2  # coefficients whose size is taken for the error of the polynomial
ITERATIONS = 50
ROUNDING = 4 * EPSILON  # relative change of the coordinates that is none
CONTRACTION = 0.5  # smallest ratio of a change to the last one that is rounding if it is small, else divergence
SMALL = 1e-9
WARMING_UP = 3  # iterations that need not contract

Accelerations = Callable[[Vector, Matrix], Matrix]


@dataclass(frozen=True)
class Collocation:
    """A polynomial motion between two times."""

    start: float
    end: float
    # coordinates, velocities: coefficients of Legendre's polynomials over the collocation step
    coordinates: Matrix
    velocities: Matrix

    def __call__(self, times: Vector) -> Matrix:
        """States at times of the collocation step, shape (2n, times)."""
        places = (2 * np.asarray(times) - self.start - self.end) / (self.end - self.start)
        return np.concatenate([legendre.legval(places, self.coordinates), legendre.legval(places, self.velocities)])

    def accelerations(self, times: Vector) -> Matrix:
        """Return the accelerations at times of the collocation step.

        Parameters
        ----------
        times : ndarray, shape (k,)
            Between start and end.

        Returns
        -------
        ndarray, shape (n, k)
        """
        half = (self.end - self.start) / 2
        places = (times - self.start) / half - 1
        return legendre.legval(places, legendre.legder(self.velocities, scl=1 / half))

    def error(self, sizes: Vector) -> float:
        """Return the relative truncation error of the coordinates.

        It is extrapolated from the last coefficients.

        Parameters
        ----------
        sizes : ndarray, shape (n,)
            Nominal sizes of the coordinates.

        Returns
        -------
        float
        """
        return _size(self.coordinates[-TAIL:], self, sizes)

    @property
    def last(self) -> Vector:
        """State at the end, shape (2n,)."""
        return self(np.array([self.end]))[:, 0]


def collocated(
    compute: Accelerations, start: float, end: float, state: Vector, guess: Matrix, sizes: Vector
) -> Collocation | None:
    """Return the motion from a state across a singular configuration to a later time.

    Parameters
    ----------
    compute : callable
        Takes times, shape (NODES,), and states near the constraints, shape (NODES, 2n), to the accelerations, shape
        (NODES, n), at the nearest states that satisfy them.
    start, end : float
        The singular configuration lies well between them.
    state : ndarray, shape (2n,)
        At the initial time.
    guess : ndarray, shape (NODES, n)
        Accelerations at Gauss's nodes to begin with.
    sizes : ndarray, shape (n,)
        Nominal ones of the coordinates.

    Returns
    -------
    Collocation or None
        None if the iteration finds no motion.
    """
    times, last = (start + end) / 2 + (end - start) / 2 * POINTS, np.inf
    collocation = _integrated(start, end, state, guess)
    for iteration in range(ITERATIONS):
        try:
            found = compute(times, collocation(times).T)
        except InconsistentConstraints:
            return None
        before, collocation = collocation, _integrated(start, end, state, found)
        change = _size(collocation.coordinates - before.coordinates, collocation, sizes)
        if change <= ROUNDING or CONTRACTION * last < change <= SMALL:
            return collocation
        if not np.isfinite(change) or (iteration > WARMING_UP and change > CONTRACTION * last):
            return None
        last = change
    return None


def _integrated(start: float, end: float, state: Vector, accelerations: Matrix) -> Collocation:
    n, half = len(state) // 2, (end - start) / 2
    velocities = legendre.legint(TO_COEFFICIENTS @ accelerations, lbnd=-1, scl=half)
    velocities[0] += state[n:]
    coordinates = legendre.legint(velocities, lbnd=-1, scl=half)
    coordinates[0] += state[:n]
    return Collocation(start, end, coordinates, velocities)


def _size(coefficients: Matrix, collocation: Collocation, sizes: Vector) -> float:
    """Return a bound on a sum of Legendre polynomials, relative to the coordinates.

    Both are taken in terms of nominal sizes.
    """
    extent = max(1.0, float(np.max(np.abs(collocation.coordinates[0]) / sizes, initial=0.0)))
    return float(np.max(np.sum(np.abs(coefficients), axis=0) / sizes, initial=0.0)) / extent
