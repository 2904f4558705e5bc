"""Largest values and zeros of quantities along motions, by the steps' polynomials.

A Taylor step ends well inside the circle of convergence of the state. So the polynomial of a step falls off like a
geometric series if the quantity does not change much faster than the state. Its coefficients bound it and its slope,
few steps can contain the largest value, and a few samples show its shape in one step. Steps that can contain a zero are
halved until the bounds decide. Polynomials are evaluated by functions that heyoka compiles, many at a time.

Every operation is done element by element. The result for a motion does not depend on the other elements.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..simulation.events import ZERO
from .polynomials import polynomials, values_at

SAMPLES = 17  # of a step
RESOLVED = 1e-10  # what the last coefficients of a step are of the largest where the polynomial is near
PLACED = 1e-10  # of a step: how far rounding may move a zero
MARGIN = 1e-9  # of the sizes of the coefficients: rounding of the bound, generously
ROUNDING = 1e-13  # of the largest value that may be: no sign
ENDED = 1e-10  # of the largest value: zero, where a zero ends the motion
HALVINGS = 60  # of a step; below that numbers are too coarse to distinguish its parts

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Steps:
    """A quantity along motions, step by step."""

    coefficients: Floats  # shape (powers, steps, elements): in powers of x
    # middle, length: shape (steps, elements): the time is middle + x length
    middle: Floats
    length: Floats
    least: float  # x runs from this, 0 or -1, to 1

    @cached_property
    def sizes(self) -> Floats:
        """Bounds and sizes of each polynomial, as `Polynomials.sizes` has them."""
        return _sizes(self.coefficients)

    def negative(self) -> "Steps":
        """Return the quantity with the opposite sign.

        Returns
        -------
        Steps
        """
        return replace(self, coefficients=-self.coefficients)

    def resolved(self, least: float | Floats = 0.0) -> NDArray[np.bool_]:
        """Return True for elements with a quantity resolved relative to its largest size.

        Parameters
        ----------
        least : float or ndarray, shape (elements,)
            A size relative to which smaller ones do not count.

        Returns
        -------
        ndarray of bool, shape (elements,)
        """
        bounds, _, sizes, last = self.sizes
        resolved = last.max(axis=0) <= RESOLVED * np.maximum(sizes.max(axis=0), least)
        return resolved & np.isfinite(bounds).all(axis=0)

    def resolved_until(self, times: Floats) -> NDArray[np.bool_]:
        """Return True for elements with a quantity resolved in each step by itself.

        Parameters
        ----------
        times : ndarray, shape (elements,)
            Steps that begin later do not count. nan counts all steps.

        Returns
        -------
        ndarray of bool, shape (elements,)
        """
        bounds, _, sizes, last = self.sizes
        later = self.middle + self.least * self.length > times
        return (later | (last <= RESOLVED * sizes) & np.isfinite(bounds)).all(axis=0)


def largest(steps: Steps) -> Floats:
    """Return the largest value on the way, for each element.

    Parameters
    ----------
    steps : Steps
        The quantity along the motions.

    Returns
    -------
    ndarray, shape (elements,)
    """
    return _largest(steps, np.positive)


def largest_size(steps: Steps) -> Floats:
    """Return the largest absolute value on the way, for each element.

    Parameters
    ----------
    steps : Steps
        The quantity along the motions.

    Returns
    -------
    ndarray, shape (elements,)
    """
    return _largest(steps, np.abs)


def first_zero(steps: Steps) -> Floats:
    """Return the first time of a sign change for each element, nan without one.

    Close zeros count if they are distinct beyond rounding. A quantity that begins at zero within rounding has no sign
    there.

    Parameters
    ----------
    steps : Steps
        The quantity along the motions.

    Returns
    -------
    ndarray, shape (elements,)
        inf where rounding decides: it moves the zero, or the quantity has been so large that its sign is rounding.
    """
    sizes = np.abs(steps.coefficients[0]) + _bounds(steps.coefficients, steps.sizes)[0]
    parts = _without_turns(steps, ROUNDING * sizes)
    found = _first_crossing(steps, parts, ROUNDING * sizes)
    of_largest = _first_crossing(steps, parts, ROUNDING * np.maximum.accumulate(sizes))
    return np.where((found == of_largest) | (np.isnan(found) & np.isnan(of_largest)), found, np.inf)


def zeros_with_end(zeros: Floats, ends: Floats | float, last: Floats, sizes: Floats) -> Floats:
    """Add zeros that end motions.

    No step leads across them.

    Parameters
    ----------
    zeros : ndarray
        First zeros, nan without one.
    ends : ndarray or float
        Times at which motions end with a zero of some quantity, nan for other motions.
    last, sizes : ndarray
        Values of the quantities at the end, and their largest sizes.

    Returns
    -------
    ndarray
        The end where there was none, and the value at the end is zero to the accuracy of the zero.
    """
    return np.where(np.isnan(zeros) & (np.abs(last) <= ENDED * sizes), ends, zeros)


def _first_crossing(steps: Steps, parts: "_Parts", rounding: Floats) -> Floats:
    """Return the time of the first sign change for each element.

    Values smaller than rounding, shape (steps, elements), have no sign.
    """
    begun = np.searchsorted(parts.element, np.arange(rounding.shape[1]))  # the first part of each element
    small = np.repeat(rounding[parts.step, parts.element, None], 2, axis=1)
    small[begun, 0] *= ZERO / ROUNDING
    values = _values(parts.coefficients, (-1.0, 1.0)).T
    signs = np.where(np.abs(values) > small, np.sign(values), 0.0).ravel()
    latest = np.maximum.accumulate(np.where(signs != 0, np.arange(len(signs)), -1))
    before = np.concatenate([[-1], latest[:-1]])
    crossed = np.flatnonzero((before >= 2 * begun[parts.element].repeat(2)) & (signs * signs[before] < 0))
    there, first = np.unique(parts.element[crossed // 2], return_index=True)
    crossing, inside = parts.of(crossed[first] // 2), signs[crossed[first] - 1] * (crossed[first] % 2) != 0
    ends = np.repeat([[-1.0], [1.0]], len(there), axis=1)
    given = np.concatenate([crossing.coefficients, ends, small[crossed[first] // 2, 1:].T])
    root, off = polynomials(len(steps.coefficients)).root(given)
    found, at = np.full(rounding.shape[1], np.nan), (crossing.step, there)
    place = crossing.middle + np.where(inside, root, -1.0) * crossing.half
    found[there] = np.where(off * crossing.half <= PLACED, steps.middle[at] + place * steps.length[at], np.inf)
    return found


class _Parts(NamedTuple):
    """Parts of steps, each with a polynomial of its own in x from -1 to 1."""

    coefficients: Floats  # shape (powers, m)
    # of which step and element, and where in it, shape (m,)
    step: NDArray[np.int64]
    element: NDArray[np.int64]
    middle: Floats
    half: Floats

    def of(self, places: Any) -> "_Parts":
        """Return some of the parts."""
        return _Parts(*(each[..., places] for each in self))

    def half_of(self, side: float) -> "_Parts":
        """Return the lower half of each part, or the upper one: side -1 or 1."""
        functions = polynomials(len(self.coefficients))
        halved = (functions.lower_half if side < 0 else functions.upper_half)(self.coefficients)
        return self._replace(coefficients=halved, middle=self.middle + side / 2 * self.half, half=self.half / 2)


def _without_turns(steps: Steps, rounding: Floats) -> _Parts:
    """Return parts in which a quantity has one sign, is monotonic or is only rounding.

    Each element has its own parts. Rounding has the shape (steps, elements).
    """
    powers, *shape = steps.coefficients.shape
    step, element = np.indices(shape).reshape(2, -1)
    waiting = _Parts(steps.coefficients.reshape(powers, -1), step, element, np.zeros(step.shape), np.ones(step.shape))
    if steps.least == 0:
        waiting = waiting.half_of(1.0)
    found = []
    for _ in range(HALVINGS):
        reach, turns = _bounds(waiting.coefficients, _sizes(waiting.coefficients))
        size = np.abs(waiting.coefficients[0])
        open_ = turns & (size <= reach) & (size + reach > rounding[waiting.step, waiting.element])
        found.append(waiting.of(~open_))
        if not open_.any():
            break
        waiting = _joined([waiting.of(open_).half_of(side) for side in (-1.0, 1.0)])
    parts = _joined(found)
    return parts.of(np.lexsort((parts.middle, parts.step, parts.element)))


def _joined(parts: Sequence[_Parts]) -> _Parts:
    return _Parts(*(np.concatenate(each, axis=-1) for each in zip(*parts, strict=True)))


def _largest(steps: Steps, size: Callable[[Floats], Floats]) -> Floats:
    """Return the largest size of a value.

    It is at the ends of the steps, or inside of steps that can contain a larger one.
    """
    coefficients, places = steps.coefficients, _places(steps.least)
    found = size(_values(coefficients, (steps.least, 1.0))).max(axis=(0, 1))
    reach, turns = _bounds(coefficients, steps.sizes)
    step, element = np.nonzero(turns & (size(coefficients[0]) + reach >= found))
    values = _values(coefficients[:, step, element], places)
    sizes = np.full((SAMPLES + 2, len(step)), -np.inf)
    sizes[1:-1] = size(values)
    best, chosen = np.nonzero((sizes[1:-1] >= sizes[:-2]) & (sizes[1:-1] >= sizes[2:]))
    at_best = values[best, chosen]
    sign = np.where(size(at_best) == at_best, 1.0, -1.0)
    near = np.array(places)[[best, np.maximum(best - 1, 0), np.minimum(best + 1, SAMPLES - 1)]]
    given = np.concatenate([coefficients[:, step[chosen], element[chosen]] * sign, near])
    (peak,) = polynomials(len(coefficients)).peak(given)
    np.maximum.at(found, element[chosen], peak)
    return found


@cache
def _places(least: float) -> tuple[float, ...]:
    return tuple(np.linspace(least, 1.0, SAMPLES).tolist())


def _values(coefficients: Floats, places: tuple[float, ...]) -> Floats:
    """Return values of polynomials, shape (powers, ...), as shape (places, ...)."""
    powers, *shape = coefficients.shape
    return values_at(powers, places)(coefficients.reshape(powers, -1)).reshape(len(places), *shape)


def _bounds(coefficients: Floats, sizes: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    """Bound the distance of polynomials from their constants for |x| <= 1.

    The second array is True if the slope can vanish there.
    """
    reach, bend, *_ = sizes
    constant, slope = np.abs(coefficients[:2])
    return reach + MARGIN * (reach + constant), slope <= bend + MARGIN * (bend + slope)


def _sizes(coefficients: Floats) -> Floats:
    powers, *shape = coefficients.shape
    return polynomials(powers).sizes(coefficients.reshape(powers, -1)).reshape(-1, *shape)
