"""Largest values and zeros of what is followed along motions, from its polynomials step by step.

A Taylor step ends well inside the circle of convergence of the state, so the polynomial of a step falls off like a
geometric series, if what is made of the state does not change much faster: its coefficients bound it and its slope, few
steps can hold the largest value, and a few samples tell the shape of it in one. Polynomials are evaluated by functions
that heyoka compiles, many at a time.

Every operation is done element by element: what comes out for a motion does not hang on the others beside it.
"""

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .polynomials import peak_of, root_of, sizes_of, values_at

SAMPLES = 17  # of a step
LAST, RESOLVED = 2, 1e-6  # coefficients of a step, and what they are of the largest where the polynomial is near
MARGIN = 1e-9  # of the sizes of the coefficients: rounding of the bound, generously

Floats = NDArray[np.float64]


class Steps(NamedTuple):
    """A quantity along motions, step by step."""

    coefficients: Floats  # shape (powers, steps, lanes): in powers of x
    # middle, length: shape (steps, lanes): the time is middle + x length
    middle: Floats
    length: Floats
    least: float  # x runs from this, 0 or -1, to 1

    def negative(self) -> "Steps":
        """The quantity with the opposite sign."""
        return self._replace(coefficients=-self.coefficients)

    def resolved(self) -> NDArray[np.bool_]:
        """Whether polynomials are near the quantity, their last coefficients small, in each lane, shape (lanes,)."""
        sizes = np.abs(self.coefficients)
        return sizes[-LAST:].max(axis=(0, 1)) <= RESOLVED * sizes.max(axis=(0, 1))

    def of(self, lanes: Any) -> "Steps":
        """Some of the lanes."""
        return Steps(self.coefficients[:, :, lanes], self.middle[:, lanes], self.length[:, lanes], self.least)


def largest(steps: Steps) -> Floats:
    """The largest value on the way, for each lane.

    Returns
    -------
    ndarray, shape (lanes,)
    """
    return _largest(steps, np.positive)


def largest_size(steps: Steps) -> Floats:
    """The largest absolute value on the way, for each lane.

    Returns
    -------
    ndarray, shape (lanes,)
    """
    return _largest(steps, np.abs)


def first_zero(steps: Steps) -> Floats:
    """The first instant at which the quantity changes its sign, for each lane; nan where it does not.

    Returns
    -------
    ndarray, shape (lanes,)
    """
    polynomials, places = steps.coefficients, _places(steps.least)
    reach, _ = _bounds(polynomials)
    first, last = np.sign(polynomials[0]), np.sign(polynomials[0])
    change = np.full(first.shape, -1)
    step, lane = np.nonzero(np.abs(polynomials[0]) <= reach)
    signs = np.sign(_values(polynomials[:, step, lane], places))
    first[step, lane], last[step, lane], change[step, lane] = _changes(signs)
    between = _sign_before(first, last) * first < 0
    crossed = between | (change >= 0)
    lanes, found = np.flatnonzero(crossed.any(axis=0)), np.full(first.shape[1], np.nan)
    where = np.argmax(crossed, axis=0)[lanes], lanes
    ends = np.array(places)[[change[where], change[where] + 1]]
    (root,) = root_of(len(polynomials))(np.concatenate([polynomials[:, *where], ends]))
    found[lanes] = steps.middle[where] + np.where(between[where], steps.least, root) * steps.length[where]
    return found


def _largest(steps: Steps, size: Callable[[Floats], Floats]) -> Floats:
    """The largest size of a value: at the ends of the steps, or inside of those that can hold one that is larger."""
    polynomials, places = steps.coefficients, _places(steps.least)
    found = size(_values(polynomials, (steps.least, 1.0))).max(axis=(0, 1))
    reach, turns = _bounds(polynomials)
    step, lane = np.nonzero(turns & (size(polynomials[0]) + reach >= found))
    chosen = polynomials[:, step, lane]
    values = _values(chosen, places)
    best = np.argmax(size(values), axis=0)
    at_best = np.take_along_axis(values, best[None], axis=0)[0]
    sign = np.where(size(at_best) == at_best, 1.0, -1.0)
    near = np.array(places)[[best, np.maximum(best - 1, 0), np.minimum(best + 1, SAMPLES - 1)]]
    (peak,) = peak_of(len(polynomials))(np.concatenate([chosen * sign, near]))
    np.maximum.at(found, lane, peak)
    return found


@cache
def _places(least: float) -> tuple[float, ...]:
    return tuple(np.linspace(least, 1.0, SAMPLES).tolist())


def _values(polynomials: Floats, places: tuple[float, ...]) -> Floats:
    """Values of polynomials, shape (powers, ...), at some places: shape (places, ...)."""
    powers, *shape = polynomials.shape
    return values_at(powers, places)(polynomials.reshape(powers, -1)).reshape(len(places), *shape)


def _bounds(polynomials: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    """How far from its constant a polynomial can be for |x| <= 1, and whether its slope can vanish there."""
    powers, *shape = polynomials.shape
    reach, bend = sizes_of(powers)(polynomials.reshape(powers, -1)).reshape(2, *shape)
    sizes = np.abs(polynomials[:2])
    return reach + MARGIN * (reach + sizes[0]), sizes[1] <= bend + MARGIN * (bend + sizes[1])


def _changes(signs: Floats) -> tuple[Floats, Floats, NDArray[np.int64]]:
    """First and last sign that is not zero, and the sample before the first change; -1 where there is none."""
    first, last, change = signs[0].copy(), signs[0].copy(), np.full(signs.shape[1], -1)
    for place, sign in enumerate(signs[1:]):
        change = np.where((change < 0) & (last * sign < 0), place, change)
        first, last = np.where(first == 0, sign, first), np.where(sign != 0, sign, last)
    return first, last, change


def _sign_before(first: Floats, last: Floats) -> Floats:
    """The last sign before each step that is not zero; in the first step its own, shape (steps, lanes)."""
    latest = np.maximum.accumulate(np.where(last != 0, np.arange(len(last))[:, None], -1), axis=0)
    after = np.where(latest >= 0, np.take_along_axis(last, np.maximum(latest, 0), axis=0), first[0])
    return np.concatenate([first[:1], after[:-1]])
