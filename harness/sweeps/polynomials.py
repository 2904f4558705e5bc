"""Functions of many polynomials at once, compiled by heyoka for each degree.

Each takes coefficients, the constants first, shape (powers, m). Some functions take further rows below them. Each
returns an array of shape (results, m). The result for a polynomial does not depend on the others.
"""

from collections.abc import Sequence
from functools import cached_property, lru_cache, reduce
from typing import Any

from ..program.heyoka_function import import_heyoka
from ..simulation.evaluation import Evaluation, in_full_vectors

NEWTON = 4  # steps of Newton's method, which from near samples reach rounding
LAST = 2  # coefficients of a step, which are small where the polynomial is near
DIFFERENT = 8  # numbers of powers whose functions are known


@lru_cache(DIFFERENT)
def rates_of(powers: int, scale: float) -> Evaluation:
    """Compile the slopes of polynomials without a constant, in units of a length.

    The length is the last row.

    Parameters
    ----------
    powers : int
        Number of coefficients of each polynomial, the linear one first.
    scale : float
        A factor of the results.

    Returns
    -------
    Evaluation
        Function with `powers` results.
    """
    polynomial, length = _coefficients(powers), import_heyoka().expression("length")
    scaled, slopes = _number(scale), []
    for power, coefficient in enumerate(polynomial, start=1):
        slopes.append(_number(float(power)) * coefficient * scaled)
        scaled = scaled * length
    return _compiled(slopes, [*polynomial, length])


@lru_cache(DIFFERENT)
def values_at(powers: int, places: tuple[float, ...]) -> Evaluation:
    """Compile the values at some places.

    Parameters
    ----------
    powers : int
        Number of coefficients of each polynomial.
    places : tuple of float
        Values of x.

    Returns
    -------
    Evaluation
        Function with one result for each place.
    """
    polynomial = _coefficients(powers)
    return _compiled([_value(polynomial, _number(place)) for place in places], polynomial)


class Polynomials:
    """Functions of polynomials of one length, each compiled when first needed."""

    def __init__(self, powers: int) -> None:
        self._polynomial = _coefficients(powers)

    @cached_property
    def sizes(self) -> Evaluation:
        """Bounds of p(x) - p(0) and p'(x) - p'(0) for |x| <= 1, and sizes.

        The sizes are those of the largest coefficient, and of the largest of the last ones.
        """
        polynomial = self._polynomial
        sizes, bends = list(map(_size, polynomial)), list(map(_size, _slope(polynomial)))
        bounds = [import_heyoka().sum([_number(0.0), *part[1:]]) for part in (sizes, bends)]
        return _compiled([*bounds, reduce(_larger, sizes), reduce(_larger, sizes[-LAST:])], polynomial)

    @cached_property
    def lower_half(self) -> Evaluation:
        """Coefficients of p((x - 1)/2), the lower half of |x| <= 1."""
        return self._half(-1.0)

    @cached_property
    def upper_half(self) -> Evaluation:
        """Coefficients of p((x + 1)/2), the upper half of |x| <= 1."""
        return self._half(1.0)

    def _half(self, side: float) -> Evaluation:
        powers = len(self._polynomial)
        halved = [_number(0.5**power) * coefficient for power, coefficient in enumerate(self._polynomial)]
        for done in range(powers - 1):
            for power in reversed(range(done, powers - 1)):
                halved[power] = halved[power] + _number(side) * halved[power + 1]
        return _compiled(halved, self._polynomial)

    @cached_property
    def peak(self) -> Evaluation:
        """The largest value that Newton's method finds between two bounds.

        The starting place and the bounds are the last three rows.
        """
        heyoka, polynomial = import_heyoka(), self._polynomial
        here, low, high = given = heyoka.make_vars("x", "low", "high")
        best, slope = _value(polynomial, here), _slope(polynomial)
        for _ in range(NEWTON):
            moved = here - _value(slope, here) / _value(_slope(slope), here)
            moved = heyoka.select(
                heyoka.eq(moved, moved), moved, here
            )  # no number where the slope is the same all over
            here = heyoka.select(heyoka.lt(moved, low), low, heyoka.select(heyoka.gt(moved, high), high, moved))
            value = _value(polynomial, here)
            best = heyoka.select(heyoka.gt(value, best), value, best)
        return _compiled([best], [*polynomial, *given])

    @cached_property
    def root(self) -> Evaluation:
        """The place x of the zero between two of opposite signs, and its error.

        The method is Newton's, with bisection if a step leaves the interval that contains the zero. The last three rows
        are the places and the rounding of a value.
        """
        heyoka, polynomial = import_heyoka(), self._polynomial
        low, high, rounding = given = heyoka.make_vars("low", "high", "rounding")
        here, beyond, slope = (low + high) / _number(2.0), _value(polynomial, high), _slope(polynomial)
        for _ in range(3 * NEWTON):
            value = _value(polynomial, here)
            lies_before = heyoka.lt(value * beyond, _number(0.0))
            low, high = heyoka.select(lies_before, here, low), heyoka.select(lies_before, high, here)
            moved = here - value / _value(slope, here)
            inside = heyoka.logical_and([heyoka.gte(moved, low), heyoka.lte(moved, high)])
            here = heyoka.select(inside, moved, (low + high) / _number(2.0))
        off = (_size(_value(polynomial, here)) + rounding) / _size(_value(slope, here))
        return _compiled([here, off], [*polynomial, *given])


polynomials = lru_cache(DIFFERENT)(Polynomials)


def _coefficients(powers: int) -> list[Any]:
    return [import_heyoka().expression(f"c{power}") for power in range(powers)]


def _number(value: float) -> Any:
    return import_heyoka().expression(value)


def _value(polynomial: Sequence[Any], place: Any) -> Any:
    value = _number(0.0)
    for coefficient in reversed(polynomial):
        value = value * place + coefficient
    return value


def _slope(polynomial: Sequence[Any]) -> list[Any]:
    return [_number(float(power)) * polynomial[power] for power in range(1, len(polynomial))]


def _size(value: Any) -> Any:
    heyoka = import_heyoka()
    return heyoka.select(heyoka.lt(value, _number(0.0)), -value, value)


def _larger(first: Any, second: Any) -> Any:
    return import_heyoka().select(import_heyoka().lt(first, second), second, first)


def _compiled(results: Sequence[Any], given: Sequence[Any]) -> Evaluation:
    return in_full_vectors(import_heyoka().cfunc([_number(0.0) + result for result in results], vars=list(given)))
