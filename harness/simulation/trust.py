"""Whether a result may be called one: what it misses beside what its tolerance lets expect.

A method whose steps each err by its tolerance errs, over so many steps, by no more than their product times some power
of ten, relative to the size of what is computed. A constraint or an energy that is missed by more was not followed: a
feature was stepped over, digits were lost, or the tolerance was not held.
"""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from .matrices import Matrices, Vector

MARGIN = 1e4
FINEST = 1e-15  # relative error of a step, however fine its tolerance: residuals are computed in double precision


class Doubt(NamedTuple):
    """A quantity that is out of proportion.

    Attributes
    ----------
    quantity : str
        ``position``, ``velocity``, ``energy``, or ``acceleration``: of the equations of motion within a step.
    missed, expected : float
        Relative: what was found, and the most that the tolerance lets expect.
    """

    quantity: str
    missed: float
    expected: float


def doubts(missed: Mapping[str, float], tol: float, steps: int) -> Iterator[Doubt]:
    """What is out of proportion to the tolerance.

    Parameters
    ----------
    missed : mapping of str to float
        By quantity, relative to its size.
    """
    expected = MARGIN * max(tol, FINEST) * max(1, steps)
    for quantity, value in missed.items():
        if not value <= expected:
            yield Doubt(quantity, value, expected)


def energy_scale(at: Matrices, state: Vector) -> float:
    """Size of the energies that are exchanged at a state: v^T A v and |h_s q_s|, which rounding is relative to.

    Parameters
    ----------
    state : ndarray, shape (2n,)
    """
    q, v = np.abs(np.split(state, 2))
    return float(v @ np.abs(at.mass) @ v + np.abs(at.force) @ q)
