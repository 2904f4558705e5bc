"""Largest values and zeros of what is followed along motions, from its polynomials step by step.

A Taylor step ends well inside the circle of convergence, so the polynomial of a step falls off like a geometric series:
its coefficients bound it, few steps can hold the largest value, and a few samples tell the shape of it in one.

Every operation is done element by element: what comes out for a motion does not hang on the others beside it.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

SAMPLES = 17  # of a step
NEWTON = 4  # steps of Newton's method, which from such samples reach rounding
MARGIN = 1e-9  # of the sizes of the coefficients: rounding of the bound, generously

Floats = NDArray[np.float64]


class Steps(NamedTuple):
    """A quantity along motions, step by step.

    Attributes
    ----------
    coefficients : ndarray, shape (steps, powers, lanes)
        In powers of x.
    middle, length : ndarray, shape (steps, lanes)
        The time is middle + x length.
    least : float
        x runs from this, 0 or -1, to 1.
    """

    coefficients: Floats
    middle: Floats
    length: Floats
    least: float

    def negative(self) -> "Steps":
        """The quantity with the opposite sign."""
        return self._replace(coefficients=-self.coefficients)


def largest(steps: Steps) -> Floats:
    """The largest value on the way, for each lane.

    Returns
    -------
    ndarray, shape (lanes,)
    """
    coefficients = np.moveaxis(steps.coefficients, 1, 0)
    found = np.maximum(_value(coefficients, steps.least), _value(coefficients, 1.0)).max(axis=0)
    step, lane = np.nonzero(coefficients[0] + _reach(coefficients) >= found)
    chosen = coefficients[:, step, lane]
    np.maximum.at(found, lane, _peak(chosen, steps.least))
    return found


def largest_size(steps: Steps) -> Floats:
    """The largest absolute value on the way, for each lane.

    Returns
    -------
    ndarray, shape (lanes,)
    """
    coefficients = np.moveaxis(steps.coefficients, 1, 0)
    ends = [np.abs(_value(coefficients, place)).max(axis=0) for place in (steps.least, 1.0)]
    found = np.maximum(*ends)
    step, lane = np.nonzero(np.abs(coefficients[0]) + _reach(coefficients) >= found)
    chosen = coefficients[:, step, lane]
    values = _value(chosen[:, None], np.linspace(steps.least, 1.0, SAMPLES)[:, None])
    best = np.argmax(np.abs(values), axis=0)
    sign = np.where(np.take_along_axis(values, best[None], axis=0)[0] < 0, -1.0, 1.0)
    np.maximum.at(found, lane, _refined(chosen * sign, values * sign, best, steps.least))
    return found


def first_zero(steps: Steps) -> Floats:
    """The first instant at which the quantity changes its sign, for each lane; nan where it does not.

    Returns
    -------
    ndarray, shape (lanes,)
    """
    coefficients = np.moveaxis(steps.coefficients, 1, 0)
    first, last = np.sign(coefficients[0]), np.sign(coefficients[0])
    change = np.full(first.shape, -1)
    step, lane = np.nonzero(np.abs(coefficients[0]) <= _reach(coefficients))
    places = np.linspace(steps.least, 1.0, SAMPLES)
    signs = np.sign(_value(coefficients[:, step, lane][:, None], places[:, None]))
    first[step, lane], last[step, lane], change[step, lane] = _changes(signs)
    sign, found = first[0].copy(), np.full(first.shape[1], np.nan)
    for now in range(len(first)):
        open_, before = np.isnan(found), steps.middle[now] + steps.least * steps.length[now]
        between = open_ & (sign * first[now] < 0)
        found[between] = before[between]
        inside = np.flatnonzero(open_ & ~between & (change[now] >= 0))
        if len(inside):
            root = _root(coefficients[:, now, inside], places[change[now, inside]], places[change[now, inside] + 1])
            found[inside] = steps.middle[now, inside] + root * steps.length[now, inside]
        sign = np.where(last[now] != 0, last[now], np.where(sign != 0, sign, first[now]))
    return found


def _value(coefficients: Floats, x: Floats | float) -> Floats:
    """The polynomial, its powers on the first axis."""
    value = np.empty(np.broadcast_shapes(coefficients[0].shape, np.shape(x)))
    value[...] = coefficients[-1]
    for coefficient in coefficients[-2::-1]:
        value *= x
        value += coefficient
    return value


def _reach(coefficients: Floats) -> Floats:
    """How far from its constant a polynomial can be for |x| <= 1."""
    sizes = np.abs(coefficients)
    reach = sizes[-1]
    for size in sizes[-2:0:-1]:
        reach = reach + size
    return reach + MARGIN * (reach + sizes[0])


def _derivative(coefficients: Floats) -> Floats:
    powers = np.arange(1, len(coefficients)).reshape(-1, *[1] * (coefficients.ndim - 1))
    return coefficients[1:] * powers


def _peak(coefficients: Floats, least: float) -> Floats:
    """The largest value of polynomials, shape (powers, m)."""
    places = np.linspace(least, 1.0, SAMPLES)
    values = _value(coefficients[:, None], places[:, None])
    return _refined(coefficients, values, np.argmax(values, axis=0), least)


def _refined(coefficients: Floats, values: Floats, best: NDArray[np.intp], least: float) -> Floats:
    """The largest value, by Newton's method, near the best of samples, shape (samples, m)."""
    places = np.linspace(least, 1.0, SAMPLES)
    found, x = np.take_along_axis(values, best[None], axis=0)[0], places[best]
    low, high = places[np.maximum(best - 1, 0)], places[np.minimum(best + 1, SAMPLES - 1)]
    slope = _derivative(coefficients)
    bend = _derivative(slope)
    for _ in range(NEWTON):
        with np.errstate(all="ignore"):
            moved = x - _value(slope, x) / _value(bend, x)
        x = np.where(np.isfinite(moved), np.clip(moved, low, high), x)
        found = np.maximum(found, _value(coefficients, x))
    return found


def _changes(signs: Floats) -> tuple[Floats, Floats, NDArray[np.int64]]:
    """First and last sign that is not zero, and the sample before the first change; -1 where there is none."""
    first, last, change = signs[0].copy(), signs[0].copy(), np.full(signs.shape[1], -1)
    for place, sign in enumerate(signs[1:]):
        change = np.where((change < 0) & (last * sign < 0), place, change)
        first, last = np.where(first == 0, sign, first), np.where(sign != 0, sign, last)
    return first, last, change


def _root(coefficients: Floats, low: Floats, high: Floats) -> Floats:
    """The zero between two places of opposite sign, or one of them zero: Newton's method, halving where it leaves."""
    slope, x = _derivative(coefficients), (low + high) / 2
    left = np.sign(_value(coefficients, high))
    for _ in range(3 * NEWTON):
        value = _value(coefficients, x)
        low, high = np.where(value * left < 0, x, low), np.where(value * left >= 0, x, high)
        with np.errstate(all="ignore"):
            moved = x - value / _value(slope, x)
        x = np.where((moved >= low) & (moved <= high), moved, (low + high) / 2)
    return x
