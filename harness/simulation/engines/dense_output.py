"""Pieces of a motion: what an engine hands over of each step, so that states between the steps can be asked for."""

from collections.abc import Callable
from typing import Any, NamedTuple

from numpy.typing import NDArray


class Piece(NamedTuple):
    """A step of the motion: its two instants, and its states between them.

    Attributes
    ----------
    start, end : number
    states : callable
        Takes instants of the step, shape (k,), to states, shape (2n, k): coordinates, then velocities.
    """

    start: Any
    end: Any
    states: Callable[[NDArray[Any]], NDArray[Any]]
