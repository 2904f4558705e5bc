"""Projection onto the constraints in the mass metric.

The nearest state is found as in Garcia de Jalon & Bayo, section 5.3. Positions by Newton's method: the least d with J d
= -f, until d is rounding. Then velocities, in one linear step: the least e with J e = -df/dt. Constraints may be
dependent, since the rank is used.
"""

import numpy as np
from numpy.typing import NDArray

from ...failures import ErrorKind, HolonomError
from ...language import translatable
from ..matrices import MotionMatrices, Vector
from ..place_and_reason import OVERFLOW, place_and_reason
from .directions import EPSILON
from .factorization import FactoredConstraints, factored_constraints

ROUNDING = 8 * EPSILON  # relative size of a correction that is none
CONSISTENT = 1e-9  # distance from a constraint, relative to the coordinates, that cannot be rounding
CONTRACTION = 0.5  # smallest ratio of a small correction to the last one at which it is rounding, too
ITERATIONS = 25


class InconsistentConstraints(HolonomError):
    """No state nearby satisfies the constraints.

    Parameters
    ----------
    residual : float
        The smallest residual that was found: the distance from the constraint that is violated most, in the mass
        metric and to first order.
    """

    def __init__(self, t: float, residual: float) -> None:
        super().__init__(
            ErrorKind.INCONSISTENT,
            detail=translatable("%(time)s; what remains is %(residual)s", time=f"{t:.10g}", residual=f"{residual:.2g}"),
        )
        self.residual = residual


def settle(
    matrices: MotionMatrices, t: float | Vector, state: Vector, rank: int | None = None
) -> tuple[Vector, FactoredConstraints]:
    """Return the nearest state on the constraints, and their factors there.

    Parameters
    ----------
    matrices : MotionMatrices
        Matrices and residuals of the motion.
    t : float or ndarray, shape (k,)
        Time of each state.
    state : ndarray, shape (2n,) or (k, 2n)
        Coordinates, then velocities. Several states are settled at once if the rank is given.
    rank : int or None
        Number of independent constraints. None to determine it at each position.

    Returns
    -------
    state : ndarray, shape (2n,) or (k, 2n)
    factored : FactoredConstraints

    Raises
    ------
    InconsistentConstraints
        No state satisfies them, or Newton's method finds none.
    HolonomError
        The equations of motion are not finite there.
    """
    n, last, settled, nominal = state.shape[-1] // 2, np.inf, np.False_, matrices.nominal
    for _ in range(ITERATIONS):
        at = matrices(t, state)
        if not np.all(at.finite):
            first = _where_not(at.finite, t)[0]
            raise HolonomError(ErrorKind.NO_WAY_ON, detail=place_and_reason(first, OVERFLOW))
        factored = factored_constraints(at.mass, at.jacobian, rank)
        change = factored.correction(at.residual)
        size, extent = factored.length(change), _extent(factored, state[..., :n], nominal.coordinates)
        settled |= (size <= ROUNDING * extent) | ((CONTRACTION * last < size) & (size <= CONSISTENT * extent))
        if np.all(settled) or not np.all(np.isfinite(size)):
            break
        moved = state[..., :n] + np.where(settled[..., None], 0.0, change)
        state, last = np.concatenate([moved, state[..., n:]], axis=-1), size
    _require_small(t, at.residual, factored, extent)
    change = factored.correction(at.residual_rate)
    left = at.residual_rate + np.matvec(at.jacobian, change)
    _require_small(t, left, factored, _extent(factored, state[..., n:], nominal.velocities))
    return np.concatenate([state[..., :n], state[..., n:] + change], axis=-1), factored


def _extent(factored: FactoredConstraints, numbers: Vector, sizes: Vector) -> Vector:
    """Return the length of coordinates or velocities in the mass metric.

    Each counts with at least its nominal size.
    """
    return factored.length(np.maximum(np.abs(numbers), sizes))


def _require_small(t: float | Vector, residual: Vector, factored: FactoredConstraints, extent: Vector) -> None:
    left = np.max(factored.distances(residual), axis=-1, initial=0.0)
    if not np.all(small := left <= CONSISTENT * extent):
        raise InconsistentConstraints(_where_not(small, t)[0], _where_not(small, left)[0])


def _where_not(good: NDArray[np.bool_], values: float | Vector) -> Vector:
    return np.atleast_1d(values)[~np.atleast_1d(good)]
