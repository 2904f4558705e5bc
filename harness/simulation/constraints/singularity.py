"""How many constraints count along a motion, and how near it is to a configuration where fewer do.

In the mass metric and scaled to length one, the constraints' directions have singular values. Of those that redundant
constraints leave, the least vanishes in a singular configuration, in proportion to the way that is left.
"""

import numpy as np

from ..matrices import MotionMatrices, Vector
from .factorization import DEPENDENT, rank_of, weighted_constraints
from .projection import InconsistentConstraints, settle

PROBE = 1e-4  # of a unit, the way that the coordinates go to see which constraints stay dependent
NEXT_TO = 3e-4  # of a unit, the way to a singular configuration that is no way
GROWN = 3.0  # times, on this way, that a singular value grows from next to a singular configuration


def probed(matrices: MotionMatrices, t: float, state: Vector) -> tuple[int, float]:
    """How many constraints are independent along the motion, and how near a singular configuration is.

    Constraints that are dependent at a state may be so everywhere, or in a singular configuration; the next state
    tells. A small way on, what was lost to a singular configuration has grown like the way, and what rounding and the
    way's curvature make of redundant constraints like its square.

    Parameters
    ----------
    matrices : MotionMatrices
    t : float
    state : ndarray, shape (2n,)
        It keeps the constraints.

    Returns
    -------
    int
        The rank of J on the constraints.
    float
        Time until the least singular value that counts vanishes, if it goes on so; infinite where it grows, zero so
        near a singular configuration that the state stands for one.
    """
    n, speed = len(state) // 2, float(np.max(np.abs(state[len(state) // 2 :]), initial=0.0))
    later, way = t + PROBE / max(1.0, speed), PROBE * min(1.0, speed)
    here = singular_values_at(matrices, t, state)
    moved = np.concatenate([state[:n] + (later - t) * state[n:], state[n:]])
    kept_rank = rank_of(singular_values_at(matrices, later, moved), max(way**1.5, DEPENDENT))
    try:
        there = settle(matrices, later, moved, kept_rank)[1].weighted.singular_values()
    except InconsistentConstraints:
        return rank_of(here), np.inf
    rank = max(rank_of(here), rank_of(there, max(way**1.5, DEPENDENT)))
    until = vanishing(t, least_of(here, rank), later, least_of(there, rank)) - t
    grown = least_of(there, rank) > GROWN * least_of(here, rank)
    return rank, 0.0 if grown or until * speed < NEXT_TO else until


def vanishing(before: float, last: float, now: float, least: float) -> float:
    """Instant at which a singular value vanishes that goes on as between two instants; infinite where it grows."""
    return now + least * (now - before) / (last - least) if last > least else np.inf


def least_of(singular_values: Vector, rank: int) -> float:
    """The least singular value that counts; without constraints, one."""
    return float(singular_values[rank - 1]) if rank else 1.0


def singular_values_at(matrices: MotionMatrices, t: float, state: Vector) -> Vector:
    """Singular values of the scaled constraints at a state, the largest first."""
    at = matrices(t, state)
    return weighted_constraints(at.mass, at.jacobian).singular_values()
