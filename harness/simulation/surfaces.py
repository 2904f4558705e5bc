"""Switching functions along a motion: where the first of them changes its sign within a step.

They are sampled at Chebyshev's points of a step and interpolated between, by polynomials of degree 32; a step of an
engine is resolved by fewer. Two zeros close together show by the polynomial's minimum between them. The instant is
found by halving, to the last bit of its numbers.
"""

from abc import ABC, abstractmethod
from collections.abc import Collection, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from ..program.motion_problem import MotionProblem
from ..program.motion_program import Program
from ..program.precision import Precision
from ..program.sign_pattern import HELD, Pattern, switching_function
from .engines.engine import Piece
from .evaluation import Numbers, as_floats, evaluation
from .matrices import Vector
from .open_values import BesideState

DEGREE, FINE = 32, 256
NODES = np.concatenate([[0.0], np.sort(1 + chebyshev.chebpts1(DEGREE + 1)) / 2, [1.0]])
PLACES = np.linspace(0.0, 1.0, FINE + 1)
TO_COEFFICIENTS = np.linalg.inv(chebyshev.chebvander(2 * NODES[1:-1] - 1, DEGREE))
BETWEEN = chebyshev.chebvander(2 * PLACES - 1, DEGREE)
CORRECTIONS = 4  # of a minimum, by Newton's method


class Crossing(NamedTuple):
    """An instant at which a motion reaches the end of its pattern of signs."""

    t: Any
    name: str  # the sign that changes
    to: int  # its value then


class SignedFunctions(ABC):
    """Functions along a motion, each with the sign that it has until its first crossing."""

    def __init__(self, precision: Precision) -> None:
        self._precision = precision
        self._rows: list[tuple[str, int, int]] = []  # name, value after the crossing, sign before it

    @abstractmethod
    def values(self, instants: Numbers, states: Numbers) -> Numbers:
        """Each function times its sign, negative behind its crossing, at instants (k,) and states (2n, k).

        Returns
        -------
        ndarray of float, shape (functions, k)
        """

    def first_crossing(self, piece: Piece, left: Sequence[str]) -> Crossing | None:
        """Where the motion first leaves its pattern within a step.

        Parameters
        ----------
        left : sequence of str
            Signs whose surfaces the motion has just left at the beginning of the step, where rounding decides.
        """
        if not self._rows:
            return None
        places, values = self._samples(piece, NODES)
        for row, (name, *_) in enumerate(self._rows):
            if name in left:
                values[row, 0] = max(values[row, 0], 0.0)
        found = [self._in_row(piece, row, places, values[row]) for row in range(len(self._rows))]
        return min((crossing for crossing in found if crossing), key=lambda crossing: crossing.t, default=None)

    def _in_row(self, piece: Piece, row: int, places: Numbers, values: Numbers) -> Crossing | None:
        name, to, _ = self._rows[row]
        negative = np.flatnonzero(values < 0)
        last = negative[0] if negative.size else len(values)
        if last == 0:
            return Crossing(piece.start, name, to)
        before, after = (places[last - 1], places[last]) if negative.size else (None, None)
        dip = self._dip(piece, row, values, NODES[last] if negative.size else 1.0)
        if dip is not None:
            before, after = dip
        return None if after is None else Crossing(self._halved(piece, row, before, after), name, to)

    def _dip(self, piece: Piece, row: int, values: Numbers, end: float) -> tuple[Any, Any] | None:
        """Between two samples, instants between which the function becomes negative to rise again."""
        inner = values[1:-1]
        if not np.isfinite(inner).all() or np.min(inner) > np.ptp(inner):
            return None
        coefficients = TO_COEFFICIENTS @ inner
        between = BETWEEN @ coefficients
        places = np.flatnonzero((between < 0) & (PLACES > 0) & (end > PLACES))
        around = PLACES[places[0] + np.array([-1, 0])] if places.size else _narrow_dip(coefficients, between, end)
        if around is None:
            return None
        instants, found = self._samples(piece, around)
        return tuple(instants) if found[row, 0] >= 0 > found[row, 1] else None

    def _samples(self, piece: Piece, places: Numbers) -> tuple[Numbers, Numbers]:
        """Instants of a step, and the functions there, shape (surfaces, k)."""
        numbers = np.array([self._precision.number(repr(float(place))) for place in places])
        instants = piece.start + (piece.end - piece.start) * numbers
        if places[-1] == 1.0:
            instants[-1] = piece.end
        return instants, self.values(instants, piece.states(instants))

    def _halved(self, piece: Piece, row: int, before: Any, after: Any) -> Any:
        half = self._precision.number("0.5")
        while before < (middle := before + half * (after - before)) < after:
            at = np.array([middle])
            if self.values(at, piece.states(at))[row, 0] < 0:
                after = middle
            else:
                before = middle
        return before


class Surfaces(SignedFunctions):
    """The surfaces on which a pattern of signs ends, but for signs whose changes are known without looking."""

    def __init__(
        self, problem: MotionProblem, pattern: Pattern, precision: Precision, known: Collection[str] = ()
    ) -> None:
        super().__init__(precision)
        self._others = BesideState(problem, precision)
        for sign in problem.signs:
            if sign.name not in known:
                value = pattern[sign.name]
                self._rows += [(sign.name, to, -to) for to in ((1, -1) if value == HELD else (-value,))]
        what = "surfaces", precision.name, frozenset(pattern.items()), frozenset(known)
        self._functions = problem.once(
            what,
            problem.switching,
            lambda: [evaluation(_inside(problem, pattern, name, to), precision) for name, to, _ in self._rows],
        )

    def values(self, instants: Numbers, states: Numbers) -> Numbers:
        """How far inside of its pattern the motion is, by each surface; negative outside."""
        beside = self._others(instants)
        inputs = np.ascontiguousarray(np.concatenate([np.reshape(instants, (1, -1)), states, beside]))
        found = [as_floats(function(inputs)[0]) for function in self._functions]
        inside = np.array([side for *_, side in self._rows], dtype=float)
        return inside[:, None] * np.reshape(found, (len(self._rows), len(instants)))


def _inside(problem: MotionProblem, pattern: Pattern, name: str, to: int) -> Program:
    """The function whose sign tells on which side of a surface the motion is."""
    if pattern[name] == HELD:
        return switching_function(problem, "drive", name, {**pattern, name: to})
    return switching_function(problem, "switch", name, pattern)


def _narrow_dip(coefficients: Vector, between: Vector, end: float) -> Vector | None:
    """A place and a later one where a polynomial that no sample shows negative is so: the first minimum below zero."""
    slope = chebyshev.chebder(coefficients)
    bend = chebyshev.chebder(slope)
    for least in 1 + np.flatnonzero((between[1:-1] <= between[:-2]) & (between[1:-1] <= between[2:])):
        low, place, high = 2 * PLACES[least - 1 : least + 2] - 1
        for _ in range(CORRECTIONS):
            if (curvature := chebyshev.chebval(place, bend)) <= 0:
                break
            place = min(max(place - chebyshev.chebval(place, slope) / curvature, low), high)
        if chebyshev.chebval(place, coefficients) < 0 and (1 + place) / 2 < end:
            return (1 + np.array([low, place])) / 2
    return None
