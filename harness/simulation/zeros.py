"""First sign change of functions along a motion within a step.

A step is examined in parts, each a small part of the time span, and shorter if a function is not resolved. A function
is sampled at the Chebyshev points of a part and interpolated by a polynomial of degree 32, whose last coefficients show
the resolution. So no feature is missed that lasts longer than 1/2048 of the time span. The length of a step depends
only on the smoothness of the state, not of the functions. Two zeros close together are found by the polynomial's
minimum between them. The time is found by taking sections, to the last bit of its numbers.

Short steps are examined many at a time by polynomials of degree 8: those whose coefficients exclude a zero are done.
"""

from abc import ABC, abstractmethod
from bisect import bisect_right
from collections.abc import Callable, Collection, Iterator, Sequence
from fractions import Fraction
from itertools import pairwise
from math import ceil
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from ..failures import HolonomError
from ..program.precision import Precision
from .engines.engine import Block, Step
from .evaluation import Numbers, as_floats
from .matrices import Vector
from .nominal import first_order_changes

DEGREE, FINE = 32, 256
NODES = np.concatenate([[0.0], np.sort(1 + chebyshev.chebpts1(DEGREE + 1)) / 2, [1.0]])
ENDS = np.append(NODES, 1.0)  # after the last sample there is none
PLACES = np.linspace(0.0, 1.0, FINE + 1)
TO_COEFFICIENTS = np.linalg.inv(chebyshev.chebvander(2 * NODES[1:-1] - 1, DEGREE))
BETWEEN = chebyshev.chebvander(2 * PLACES - 1, DEGREE)
CONSTANT = np.eye(DEGREE + 1)[0]  # coefficients of the polynomial one
CORRECTIONS = 4  # of a minimum, by Newton's method
PARTS, SHORTEST = 128, 1 / 1024  # of the time span: parts that are looked at, at least; parts that are not halved
SECTIONS = 32  # of an interval with a zero, of which the one that has it is taken
ROUNDED_TIME = 4 * np.finfo(float).eps  # of a time: how far rounding moves it
SURE = 2  # digits that a function loses relative to its largest value: one that touches zero may be that much below
ZERO = 1e-12  # of the change of a function at nominal sizes: it has no sign
LAST, RESOLVED = 4, 1e-8  # coefficients of a polynomial, and what they are of the largest where it is near
FEW_DEGREE, SHORT = 8, 1 / 512  # of the time span: steps at whose nodes nothing is missed that lasts 1/2048 of it
UNCLEAR = 1e-6  # of the largest coefficient: values that a polynomial does not distinguish from zero
FEW = 16  # steps that are examined first; then twice as many
FEW_NODES = np.sort(1 + chebyshev.chebpts1(FEW_DEGREE + 1)) / 2
TO_FEW_COEFFICIENTS = np.linalg.inv(chebyshev.chebvander(2 * FEW_NODES - 1, FEW_DEGREE))


class Crossing(NamedTuple):
    """A time at which a motion reaches the end of its pattern of signs."""

    t: Any
    name: str  # the sign that changes
    to: int  # its value then


class _Portion(NamedTuple):
    """Consecutive steps of a block that are examined together."""

    block: Block
    first: int  # place of the first one
    clear: list[bool]  # for each step: whether no function vanishes there
    sizes: Numbers  # shape (functions, steps): the largest that each function has been from the first one on


class SignedFunctions(ABC):
    """Functions along a motion, each with its sign before the first crossing."""

    touching = 0.0  # of the largest that a function is nearby: a minimum below that counts as a zero

    def __init__(self, precision: Precision, span: float) -> None:
        self._precision, self._span = precision, span
        self._rows: list[tuple[str, int, int]] = []  # name, value after the crossing, sign before it
        self._sizes: dict[str, float] = {}  # the largest that each function has been
        self._unsure = 10.0 ** (SURE - precision.sure_digits)  # of these: rounding
        self._nodes, self._places = precision.numbers(NODES), precision.numbers(FEW_NODES)
        self._portion: _Portion | None = None
        self._sections = np.array([precision.ratio(Fraction(place, SECTIONS)) for place in range(1, SECTIONS)])

    @property
    def names(self) -> list[str]:
        """Names of the functions."""
        return [name for name, *_ in self._rows]

    @abstractmethod
    def values(self, times: Numbers, states: Numbers) -> Numbers:
        """Return each function times its sign, negative after its crossing.

        Parameters
        ----------
        times : ndarray, shape (k,)
            Times of the states.
        states : ndarray, shape (2n, k)
            Coordinates, then velocities.

        Returns
        -------
        ndarray of float, shape (functions, k)
        """

    def _is_clear(self, step: Step) -> bool:
        """Return True if no function with a sign can vanish in a step."""
        if step.block is None:
            return False
        place, known = bisect_right(step.block.times, step.start) - 1, self._portion
        if known is None or known.block is not step.block:
            known = self._portion = self._examined(step.block, place, FEW)
        elif place >= known.first + len(known.clear):
            known = self._portion = self._examined(step.block, place, 2 * len(known.clear))
        if not known.clear[place - known.first]:
            return False
        for (name, *_), size in zip(self._rows, known.sizes[:, place - known.first], strict=True):
            self._sizes[name] = max(self._sizes.get(name, 0.0), size)
        return True

    def _examined(self, block: Block, first: int, count: int) -> _Portion:
        """Examine a number of steps of a block together."""
        times = np.array(block.times[first : first + count + 1])
        clear = as_floats(times[1:] - times[:-1]) <= SHORT * self._span
        sizes = np.zeros((len(self._rows), len(clear)))
        if clear.any():
            try:
                without, sizes = self._without_zero(times, block.states)
            except HolonomError:  # beyond the next switching a quantity may have no value
                without = False
            clear &= without
        return _Portion(block, first, clear.tolist(), np.maximum.accumulate(sizes, axis=1))

    def _without_zero(self, times: Numbers, states: Callable[[Numbers], Numbers]) -> tuple[Numbers, Numbers]:
        """Return steps in which polynomials exclude a zero, and sizes of functions.

        The steps are those between the times. Shapes are (steps,) and (functions, steps).
        """
        inside = times[:-1, None] + (times[1:] - times[:-1])[:, None] * self._places
        at = np.concatenate([inside, times[1:, None]], axis=1)
        values = self.values(at.ravel(), states(at.ravel())).reshape(-1, *at.shape)
        coefficients = values[..., :-1] @ TO_FEW_COEFFICIENTS.T
        sizes = np.abs(coefficients)
        largest, reach = sizes.max(axis=-1), sizes[..., 1:].sum(axis=-1)
        resolved = sizes[..., -2:].max(axis=-1) <= RESOLVED * largest
        away = (coefficients[..., 0] - reach > UNCLEAR * largest) & (values[..., -1] > 0)
        return (resolved & away).all(axis=0), np.abs(values).max(axis=-1)

    def first_crossing(self, step: Step, left: dict[str, Any]) -> Crossing | None:
        """Return the time within a step at which the motion first leaves its pattern.

        Parameters
        ----------
        step : Step
            A step of the mode.
        left : dict of str to number
            Signs whose switching surfaces the motion has left, with the times. Each stays here until its function is
            beyond rounding, which may take several steps if these are short.

        Returns
        -------
        Crossing or None
        """
        if not self._rows or (not left and self._is_clear(step)):
            return None
        rounding = self._least_after_zero(step) if left else None
        for part, places, values in self._looked_at(step):
            begun = self._begun(values, rounding, left) if left else [0] * len(values)
            found = self._first_in(part, places, values, begun)
            if found is not None:
                return found
            for (name, *_), first in zip(self._rows, begun, strict=True):
                if first < values.shape[1]:
                    left.pop(name, None)
        return None

    def _least_after_zero(self, step: Step) -> Numbers:
        """Return sizes without a sign after a zero, shape (functions, 1)."""
        nominal, start = step.mode.matrices.nominal, np.array([step.start])
        changes = first_order_changes(self.values, start, step.states(start), nominal)
        return changes * max(ZERO, ROUNDED_TIME * abs(float(step.start)) / nominal.time)

    def _begun(self, values: Numbers, rounding: Numbers, left: Collection[str]) -> list[int]:
        """Return the sample from which on each function has a sign."""
        clear = np.abs(values) > rounding
        clear[:, 0] = False
        return [
            (int(np.argmax(row)) if row.any() else len(row)) if name in left else 0
            for (name, *_), row in zip(self._rows, clear, strict=True)
        ]

    def _looked_at(self, step: Step) -> Iterator[tuple[Step, Numbers, Numbers]]:
        """Yield the parts of a step in order, each with its samples."""
        waiting = list(reversed(self._cut(step, ceil(float(step.end - step.start) / self._span * PARTS))))
        while waiting:
            part = waiting.pop()
            places, values = self._samples(part, NODES)
            shortest = max(SHORTEST * self._span, ROUNDED_TIME * abs(float(part.start)))
            if float(part.end - part.start) > shortest and not _is_resolved(values):
                waiting += reversed(self._cut(part, 2))
            else:
                yield part, places, values

    def _cut(self, step: Step, count: int) -> list[Step]:
        """Return a step in parts of equal length."""
        if count <= 1:
            return [step]
        numbers = np.array([self._precision.ratio(Fraction(place, count)) for place in range(count)])
        edges = [*(step.start + (step.end - step.start) * numbers), step.end]
        return [step._replace(start=start, end=end) for start, end in pairwise(edges)]

    def _first_in(self, step: Step, places: Numbers, values: Numbers, begun: Sequence[int]) -> Crossing | None:
        """Return the first crossing among the samples of each function with a sign."""
        for (name, *_), size in zip(self._rows, np.abs(values).max(axis=1), strict=True):
            self._sizes[name] = max(self._sizes.get(name, 0.0), size)
        clear = values.min(axis=1) > np.ptp(values, axis=1)
        rows = [row for row, is_clear in enumerate(clear) if not is_clear]
        found = [self._in_row(step, row, places, values[row], begun[row]) for row in rows]
        return min((crossing for crossing in found if crossing), key=lambda crossing: crossing.t, default=None)

    def _in_row(self, step: Step, row: int, places: Numbers, values: Numbers, first: int) -> Crossing | None:
        name, to, _ = self._rows[row]
        values[:first] = np.maximum(values[:first], 0.0)
        touched = self.touching * np.max(np.abs(values), where=np.isfinite(values), initial=0.0)
        low = np.flatnonzero(values < min(touched, self._unsure * self._sizes[name]))
        last = _least_after(values, low[0]) if low.size else len(values)
        if last == 0:
            return Crossing(step.start, name, to)
        before, after = (places[last - 1], places[last]) if low.size else (None, None)
        dip = self._dip(step, row, values, touched, *ENDS[[first, last]])
        if dip is not None:
            before, after = dip
        if after is None:
            return None

        def inside(times: Numbers) -> Vector:
            return self.values(times, step.states(times))[row]

        return Crossing(self._last_inside(inside, before, after), name, to)

    def _dip(
        self, step: Step, row: int, values: Numbers, touched: float, begin: float, end: float
    ) -> tuple[Any, Any] | None:
        """Return times between two samples of which the second has a negative value.

        Or one that touches zero. The function becomes positive again before the later sample.
        """
        inner = values[1:-1]
        if not np.isfinite(inner).all() or np.min(inner) > np.ptp(inner):
            return None
        coefficients = TO_COEFFICIENTS @ inner
        between = BETWEEN @ coefficients
        places = np.flatnonzero((between < 0) & (begin < PLACES) & (end > PLACES))
        if places.size:
            around = PLACES[places[0] + np.array([-1, 0])]
        else:
            around = narrow_dip(coefficients - touched * CONSTANT, between, begin, end)
        if around is None:
            return None
        times, found = self._samples(step, around)
        least = touched - self._unsure * self._sizes[self._rows[row][0]]
        return tuple(times) if found[row, 0] >= 0 and found[row, 1] < least else None

    def _samples(self, step: Step, places: Numbers) -> tuple[Numbers, Numbers]:
        """Return the times of a step, and the functions there, shape (functions, k)."""
        numbers = self._nodes if places is NODES else self._precision.numbers(places)
        times = step.start + (step.end - step.start) * numbers
        if places[-1] == 1.0:
            times[-1] = step.end
        return times, self.values(times, step.states(times))

    def _last_inside(self, values: Callable[[Numbers], Vector], before: Any, after: Any) -> Any:
        """Return the last time before a function becomes negative, between two times.

        An evaluation at several times takes as long as one at one time.
        """
        while True:
            between = before + (after - before) * self._sections
            between = between[(before < between) & (between < after)]
            if not between.size:
                return before
            edges = [before, *between, after]
            negative = np.flatnonzero(values(between) < 0)
            first = 1 + int(negative[0]) if negative.size else len(edges) - 1
            before, after = edges[first - 1], edges[first]


def _is_resolved(values: Numbers) -> bool:
    """Return True if polynomials through the samples are near the functions.

    Samples have shape (functions, samples).
    """
    inner = values[:, 1:-1]
    if not np.isfinite(inner).all():
        return False
    sizes = np.abs(inner @ TO_COEFFICIENTS.T)
    return bool((sizes[:, -LAST:].max(axis=1) <= RESOLVED * sizes.max(axis=1)).all())


def _least_after(values: Numbers, place: int) -> int:
    """Return the least sample that touches zero from a place on.

    It is the place itself if its value is negative.
    """
    while place + 1 < len(values) and 0 <= values[place + 1] < values[place]:
        place += 1
    return place


def narrow_dip(coefficients: Vector, between: Vector, begin: float, end: float) -> Vector | None:
    """Return a place and a later one, the first minimum of a polynomial below zero.

    Newton's method for the slope refines each minimum.

    Parameters
    ----------
    coefficients : ndarray, shape (DEGREE + 1,)
        Of Chebyshev polynomials.
    between : ndarray, shape (FINE + 1,)
        Samples of the polynomial, or of one that differs by a constant.
    begin, end : float
        Places between which the minimum is.

    Returns
    -------
    ndarray, shape (2,), or None
    """
    slope = chebyshev.chebder(coefficients)
    bend = chebyshev.chebder(slope)
    for least in 1 + np.flatnonzero((between[1:-1] <= between[:-2]) & (between[1:-1] <= between[2:])):
        low, place, high = 2 * PLACES[least - 1 : least + 2] - 1
        for _ in range(CORRECTIONS):
            curvature = chebyshev.chebval(place, bend)
            if curvature <= 0:
                break
            place = min(max(place - chebyshev.chebval(place, slope) / curvature, low), high)
        if chebyshev.chebval(place, coefficients) < 0 and begin < (1 + place) / 2 < end:
            return (1 + np.array([low, place])) / 2
    return None
