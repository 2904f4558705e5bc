"""Projection onto the constraints in the mass metric.

The nearest state is found as in Garcia de Jalon & Bayo, section 5.3. Positions by Newton's method: the least d with J d
= -f, until d is rounding. Then velocities, in one linear step: the least e with J e = -df/dt. Constraints may be
dependent, since the rank is used.
"""

import numpy as np
from numpy.typing import NDArray

from ...failures import ErrorKind, HolonomError
from ...language import translatable
from ..matrices import Matrix, MotionMatrices, Vector
from ..place_and_reason import OVERFLOW, place_and_reason
from .directions import EPSILON
from .factorization import FactoredConstraints, factored_constraints

ROUNDING = 8 * EPSILON  # relative size of a correction that is none
CONSISTENT = 1e-9  # relative change of its coordinates, by which a constraint that holds may be changed
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
        change, sizes = factored.correction(at.residual), np.maximum(np.abs(state[..., :n]), nominal.coordinates)
        size, holds = factored.length(change), _holds(at.residual, at.jacobian, sizes)
        settled |= np.all(np.abs(change) <= ROUNDING * sizes, axis=-1) | ((CONTRACTION * last < size) & holds)
        if np.all(settled) or not np.all(np.isfinite(size)):
            break
        moved = state[..., :n] + np.where(settled[..., None], 0.0, change)
        state, last = np.concatenate([moved, state[..., n:]], axis=-1), size
    _require(holds, t, at.residual, factored)
    change = factored.correction(at.residual_rate)
    left = at.residual_rate + np.matvec(at.jacobian, change)
    sizes = np.maximum(np.abs(state[..., n:]), nominal.velocities)
    _require(_holds(left, at.jacobian, sizes), t, left, factored)
    return np.concatenate([state[..., :n], state[..., n:] + change], axis=-1), factored


def _holds(residual: Vector, jacobian: Matrix, sizes: Vector) -> NDArray[np.bool_]:
    """Return True if residuals are small for the coordinates of each constraint."""
    return np.all(np.abs(residual) <= CONSISTENT * np.matvec(np.abs(jacobian), sizes), axis=-1)


def _require(holds: NDArray[np.bool_], t: float | Vector, residual: Vector, factored: FactoredConstraints) -> None:
    if not np.all(holds):
        left = np.max(factored.distances(residual), axis=-1, initial=0.0)
        raise InconsistentConstraints(_where_not(holds, t)[0], _where_not(holds, left)[0])


def _where_not(good: NDArray[np.bool_], values: float | Vector) -> Vector:
    return np.atleast_1d(values)[~np.atleast_1d(good)]
