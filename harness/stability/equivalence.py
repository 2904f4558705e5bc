"""Coordinates of one state: whole turns of angles, signs of Euler parameters."""

from typing import NamedTuple

import numpy as np

from ..simulation.matrices import Vector

TURN = 2 * np.pi
HALF = 0.5 + 1e-6  # of a turn: the angle pi, not -pi


class Equivalence(NamedTuple):
    """The changes of coordinates that leave a state as it is.

    Attributes
    ----------
    turns : list of int
        Indices of angles.
    reversals : list of list of int
        Indices of the Euler parameters of each body: e and -e are the same orientation.
    """

    turns: list[int]
    reversals: list[list[int]]

    def chosen(self, q: Vector) -> Vector:
        """Return the coordinates that are chosen for a state.

        Angles are in (-pi, pi]. The first Euler parameter that is not zero is positive.

        Parameters
        ----------
        q : ndarray, shape (n,)
            Coordinates of the state.

        Returns
        -------
        ndarray, shape (n,)
        """
        q = q.copy()
        q[self.turns] -= TURN * np.ceil(q[self.turns] / TURN - HALF)
        for places in self.reversals:
            if q[places][np.flatnonzero(q[places])[:1]].sum() < 0:
                q[places] *= -1
        return q

    def apart(self, one: Vector, other: Vector) -> Vector:
        """Return the least differences of two states' coordinates.

        Parameters
        ----------
        one, other : ndarray, shape (n,)
            Coordinates of the states.

        Returns
        -------
        ndarray, shape (n,)
        """
        apart = one - other
        apart[self.turns] -= TURN * np.round(apart[self.turns] / TURN)
        for places in self.reversals:
            if one[places] @ other[places] < 0:
                apart[places] = one[places] + other[places]
        return apart
