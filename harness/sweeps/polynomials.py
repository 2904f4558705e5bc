"""Functions of many polynomials at once, compiled by heyoka for each number of powers.

Each takes coefficients, the constants first, shape (powers, m), with rows of its own below them where it says so, and
returns an array of shape (results, m). What comes out for a polynomial does not hang on the others.
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

from ..program.heyoka_function import import_heyoka
from ..simulation.evaluation import Evaluation, in_full_vectors

NEWTON = 4  # steps of Newton's method, which from near samples reach rounding
DIFFERENT = 8  # numbers of powers whose functions are kept


@lru_cache(DIFFERENT)
def values_at(powers: int, places: tuple[float, ...]) -> Evaluation:
    """Compile the values at some places."""
    polynomial = _coefficients(powers)
    return _compiled([_value(polynomial, _number(place)) for place in places], polynomial)


@lru_cache(DIFFERENT)
def sizes_of(powers: int) -> Evaluation:
    """Compile bounds for |x| <= 1: how far values can be from the constant, and slopes from the linear coefficient."""
    polynomial = _coefficients(powers)
    parts = [polynomial[1:], _slope(polynomial)[1:]]
    return _compiled([import_heyoka().sum([_number(0.0), *map(_size, part)]) for part in parts], polynomial)


@lru_cache(2 * DIFFERENT)
def half_of(powers: int, side: float) -> Evaluation:
    """Compile the coefficients of p((x + side)/2), those of the lower or the upper half of |x| <= 1: side -1 or 1."""
    polynomial = _coefficients(powers)
    halved = [_number(0.5**power) * coefficient for power, coefficient in enumerate(polynomial)]
    for done in range(powers - 1):
        for power in reversed(range(done, powers - 1)):
            halved[power] = halved[power] + _number(side) * halved[power + 1]
    return _compiled(halved, polynomial)


@lru_cache(DIFFERENT)
def peak_of(powers: int) -> Evaluation:
    """Compile the largest value that Newton's method sees from a place on, between two others: the last three rows."""
    heyoka, polynomial = import_heyoka(), _coefficients(powers)
    here, low, high = given = heyoka.make_vars("x", "low", "high")
    best, slope = _value(polynomial, here), _slope(polynomial)
    for _ in range(NEWTON):
        moved = here - _value(slope, here) / _value(_slope(slope), here)
        moved = heyoka.select(heyoka.eq(moved, moved), moved, here)  # no number where the slope is the same all over
        here = heyoka.select(heyoka.lt(moved, low), low, heyoka.select(heyoka.gt(moved, high), high, moved))
        value = _value(polynomial, here)
        best = heyoka.select(heyoka.gt(value, best), value, best)
    return _compiled([best], [*polynomial, *given])


@lru_cache(DIFFERENT)
def root_of(powers: int) -> Evaluation:
    """Compile the zero between two places of opposite signs, the last two rows.

    By Newton's method, and by halving where that leaves the places between which the zero is.
    """
    heyoka, polynomial = import_heyoka(), _coefficients(powers)
    low, high = given = heyoka.make_vars("low", "high")
    here, beyond, slope = (low + high) / _number(2.0), _value(polynomial, high), _slope(polynomial)
    for _ in range(3 * NEWTON):
        value = _value(polynomial, here)
        lies_before = heyoka.lt(value * beyond, _number(0.0))
        low, high = heyoka.select(lies_before, here, low), heyoka.select(lies_before, high, here)
        moved = here - value / _value(slope, here)
        inside = heyoka.logical_and([heyoka.gte(moved, low), heyoka.lte(moved, high)])
        here = heyoka.select(inside, moved, (low + high) / _number(2.0))
    return _compiled([here], [*polynomial, *given])


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


def _compiled(results: Sequence[Any], given: Sequence[Any]) -> Evaluation:
    return in_full_vectors(import_heyoka().cfunc([_number(0.0) + result for result in results], vars=list(given)))
