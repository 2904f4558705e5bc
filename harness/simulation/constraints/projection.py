"""The nearest state, in the mass metric, that keeps the constraints (Garcia de Jalon & Bayo, section 5.3).

Positions by Newton's method: the least d with J d = -f, until d is rounding; then velocities, in one linear step:
the least e with J e = -df/dt. Dependent constraints do no harm: so many of them count as the rank says.
"""

import numpy as np

from ...failures import Failure, HolonomError
from ..matrices import Matrices, MotionMatrices, Vector
from .factorization import EPSILON, FactoredConstraints, factored_constraints, rank_of, weighted_constraints

ROUNDING = 8 * EPSILON  # relative size of a correction that is none
CONSISTENT = 1e-9  # distance from a constraint, relative to the coordinates, that cannot be rounding
CONTRACTION = 0.5  # a small correction at least that large beside the last one is rounding, too
ITERATIONS = 25


class InconsistentConstraints(HolonomError):
    """No state nearby satisfies the constraints.

    Parameters
    ----------
    residual : float
        The smallest residual that was found: the distance from the constraint that is missed most, in the mass
        metric and to first order.
    """

    def __init__(self, t: float, residual: float) -> None:
        super().__init__(Failure.INCONSISTENT, detail=f"{t:.10g}; what remains is {residual:.2g}")
        self.residual = residual


def project(matrices: MotionMatrices, t: float, state: Vector, rank: int | None = None) -> Vector:
    """Nearest state that keeps the constraints.

    Parameters
    ----------
    state : ndarray, shape (2n,)
        Coordinates, then velocities.
    rank : int or None
        How many of the constraints are independent; None to find out at each position.

    Returns
    -------
    ndarray, shape (2n,)

    Raises
    ------
    InconsistentConstraints
        No state does, or Newton's method finds none.
    """
    return settle(matrices, t, state, rank)[0]


def settle(
    matrices: MotionMatrices, t: float, state: Vector, rank: int | None = None
) -> tuple[Vector, FactoredConstraints]:
    """Nearest state that keeps the constraints, and the constraints as factored there. Arguments as for `project`.

    Raises
    ------
    InconsistentConstraints
        As `project`.
    HolonomError
        The equations of motion are not finite there.
    """
    n, last = len(state) // 2, np.inf
    for _ in range(ITERATIONS):
        at = matrices(t, state)
        if not at.finite:
            raise HolonomError(Failure.NO_WAY_ON, detail=f"{t:.10g}, where numbers overflow")
        factored = _factored(at, rank)
        change = factored.correction(at.residual)
        size, extent = factored.weighted.length(change), _extent(factored, state[:n])
        if size <= ROUNDING * extent or CONTRACTION * last < size <= CONSISTENT * extent:
            break
        state, last = np.concatenate([state[:n] + change, state[n:]]), size
    _require_small(t, at.residual, factored, extent)
    change = factored.correction(at.residual_rate)
    _require_small(t, at.residual_rate + at.jacobian @ change, factored, _extent(factored, state[n:]))
    return np.concatenate([state[:n], state[n:] + change]), factored


def _factored(at: Matrices, rank: int | None) -> FactoredConstraints:
    weighted = weighted_constraints(at.mass, at.jacobian)
    return factored_constraints(weighted, rank_of(weighted.singular_values()) if rank is None else rank)


def _extent(factored: FactoredConstraints, numbers: Vector) -> float:
    """Length, in the mass metric, of coordinates or velocities, each at least one."""
    return factored.weighted.length(np.maximum(np.abs(numbers), 1.0))


def _require_small(t: float, residual: Vector, factored: FactoredConstraints, extent: float) -> None:
    left = float(np.max(np.abs(factored.weighted.scale * residual), initial=0.0))
    if not left <= CONSISTENT * extent:
        raise InconsistentConstraints(t, left)
