"""What is kept of a motion while an engine follows it: states at instants, and the work done until then."""

from collections import deque
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from .engines.engine import Piece
from .evaluation import Numbers
from .piecewise import PiecewiseMotion


class Recording:
    """States of a motion at instants.

    Parameters
    ----------
    motion : PiecewiseMotion
    instants : sequence of numbers, or None
        In order; None for the ends of the pieces.
    zero : number

    Attributes
    ----------
    instants : list of number
    states : list of ndarray, shape (2n,)
    works : list of number
        Work done until each instant.
    work : number
        Work done in all.
    """

    def __init__(self, motion: PiecewiseMotion, instants: Sequence[Any] | None, zero: Any) -> None:
        self._motion, self._waiting = motion, None if instants is None else deque(instants)
        self.instants: list[Any] = []
        self.states: list[Numbers] = []
        self.works: list[Any] = []
        self.work = zero

    def begin(self, instant: Any, state: Numbers) -> None:
        """Keep the first state, if it is wanted."""
        if self._wanted(instant):
            self._keep(instant, state.copy())

    def take(self, piece: Piece) -> None:
        """Keep what is wanted of a piece.

        Parameters
        ----------
        piece : Piece
            It begins where the last one ended.
        """
        for part in self._parts(piece):
            self.work = self.work + self._motion.work(part)
            if self._wanted(part.end):
                self._keep(part.end, part.states(np.array([part.end]))[:, 0])

    def end(self, instant: Any, state: Numbers) -> None:
        """Keep the last state, projected as it is, in the place of the one that the last piece ended with."""
        if self.instants and self.instants[-1] == instant:
            self.states[-1] = state.copy()
        else:
            self._keep(instant, state.copy())

    def _keep(self, instant: Any, state: Numbers) -> None:
        self.instants.append(instant)
        self.states.append(state)
        self.works.append(self.work)
        if self._waiting:
            self._waiting.popleft()

    def _wanted(self, instant: Any) -> bool:
        return self._waiting is None or (bool(self._waiting) and self._waiting[0] == instant)

    def _parts(self, piece: Piece) -> Iterator[Piece]:
        """The piece, cut at the instants wanted."""
        start = piece.start
        while self._waiting and self._waiting[0] < piece.end:
            end = self._waiting[0]
            yield Piece(start, end, piece.states)
            start = end
        yield Piece(start, piece.end, piece.states)
