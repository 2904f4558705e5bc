"""Evaluate expressions with bounds on their rounding errors.

A number has the radius of a disc around it that contains the exact value. Sums, products and powers add up the errors
of their arguments, as in Rump's ball arithmetic. A function is evaluated at both ends of its argument's range: its
error is the larger change if the changes are nearly opposite. If they are not, no bound is known, as at a pole.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from enum import IntEnum
from functools import partial, reduce
from typing import NamedTuple

import sympy as sp
from mpmath import mp

from .evaluation import FAILURES, Number, Steps, product, total, whole_power

ROUNDINGS = 8
"""Units in the last place that a function of mpmath may be wrong by."""

NEARLY_OPPOSITE = 4
"""The sum of two nearly opposite changes is at most the sum of their sizes over this."""


class NoValue(IntEnum):
    """A reason for which an expression has no value, the strongest last."""

    LOST = 1  # its error has no bound, as that of the reciprocal of a rounding error
    TOO_LARGE = 2  # an argument exceeds the limits of the evaluation
    UNDEFINED = 3


class Bounded(NamedTuple):
    """A number, and a bound on its error."""

    value: Number
    error: mp.mpf

    @property
    def is_zero(self) -> bool:
        """True if the number is exactly zero."""
        return not self.value and not self.error

    @property
    def is_nonzero(self) -> bool:
        """True if the bound excludes zero."""
        return abs(self.value) > self.error


Result = Bounded | NoValue
BoundedValues = Mapping[sp.Symbol, Result]


def rational(number: sp.Rational) -> Bounded:
    """Return a rational number in the working precision.

    Parameters
    ----------
    number : Rational
        The number.

    Returns
    -------
    Bounded
    """
    return _constant(lambda: mp.mpf(number.p) / number.q)


def bounded(steps: Steps, values: BoundedValues) -> list[Result]:
    """Evaluate expressions in mpmath's working precision.

    Parameters
    ----------
    steps : Steps
        Operations of the expressions.
    values : BoundedValues
        Values of the symbols.

    Returns
    -------
    list of Result
        One for each expression.
    """
    return steps.applied(lambda symbol: values.get(symbol, NoValue.UNDEFINED), apply)


def apply(function: Callable[..., Number | None], arguments: Sequence[Result]) -> Result:
    """Apply a function to numbers with errors.

    Parameters
    ----------
    function : callable
        Function of a step.
    arguments : sequence of Result
        Its arguments.

    Returns
    -------
    Result
    """
    if missing := [each for each in arguments if isinstance(each, NoValue)]:
        return max(missing)
    if not arguments:
        return _constant(function)
    if function is total:
        return _total(arguments)
    if function is product:
        return reduce(_product, arguments)
    try:
        if isinstance(function, partial) and function.func is whole_power and function.args[0] > 0:
            return _whole_power(function, *arguments)
        return _composed(function, arguments)
    except OverflowError:
        return NoValue.TOO_LARGE


def solution(rows: Sequence[Sequence[Result]], right: Sequence[Result]) -> list[Result]:
    """Solve linear equations by elimination, with bounds on the errors.

    Parameters
    ----------
    rows : sequence of sequence of Result
        Square matrix, row by row.
    right : sequence of Result
        Right side.

    Returns
    -------
    list of Result
        Value of each unknown.
    """
    table = [[*row, end] for row, end in zip(rows, right, strict=True)]
    missing = [each for row in table for each in row if isinstance(each, NoValue)]
    reason = max(missing) if missing else _eliminated(table)
    if reason is not None:
        return [reason] * len(rows)
    found: list[Bounded] = []  # the last unknown first
    for k in range(len(table) - 1, -1, -1):
        end = table[k][-1]
        for factor, each in zip(reversed(table[k][k + 1 : -1]), found, strict=True):
            end = _less_product(end, factor, each)
        found.append(_quotient(end, table[k][k]))
    return found[::-1]


def negative(number: Result) -> Result:
    """Return a number with the opposite sign.

    Parameters
    ----------
    number : Result
        The number.

    Returns
    -------
    Result
    """
    return number if isinstance(number, NoValue) else Bounded(-number.value, number.error)


def _unit() -> mp.mpf:
    return mp.ldexp(1, -mp.prec)


def _constant(function: Callable[[], Number | None]) -> Result:
    value = _value(function, ())
    if value is None:
        return NoValue.UNDEFINED
    with mp.workprec(2 * mp.prec):
        difference = function() - value
    return Bounded(value, 2 * abs(difference))


def _total(terms: Sequence[Bounded]) -> Bounded:
    rounding = 2 * _unit() * mp.fsum((each.value for each in terms), absolute=True)
    return Bounded(mp.fsum(each.value for each in terms), rounding + mp.fsum(each.error for each in terms))


def _product(a: Bounded, b: Bounded) -> Bounded:
    value = a.value * b.value
    return Bounded(value, abs(a.value) * b.error + a.error * (abs(b.value) + b.error) + 2 * _unit() * abs(value))


def _quotient(a: Bounded, b: Bounded) -> Bounded:
    """Divide by a number whose bound excludes zero."""
    value = a.value / b.value
    error = (a.error + abs(value) * b.error) / (abs(b.value) - b.error)
    return Bounded(value, error + 4 * _unit() * abs(value))


def _less_product(a: Bounded, b: Bounded, c: Bounded) -> Bounded:
    if b.is_zero or c.is_zero:
        return a
    return _total([a, negative(_product(b, c))])


def _whole_power(power: partial, base: Bounded) -> Bounded:
    exponent, largest = power.args[0], abs(base.value) + base.error
    value = power(base.value)
    return Bounded(value, exponent * base.error * largest ** (exponent - 1) + ROUNDINGS * _unit() * abs(value))


def _composed(function: Callable[..., Number | None], arguments: Sequence[Bounded]) -> Result:
    """Return the value of a function and its changes over the ranges of its arguments."""
    values = [each.value for each in arguments]
    value = _value(function, values)
    rounding = mp.zero if value is None else ROUNDINGS * _unit() * abs(value)
    error, is_defined_nearby = rounding, False
    for place, each in enumerate(arguments):
        for step in _steps_of(each):
            ends = [_value(function, _moved(values, place, by)) for by in (step, -step)]
            is_defined_nearby = is_defined_nearby or ends != [None, None]
            if value is None:
                continue
            if None in ends:
                return NoValue.LOST
            up, down = ends[0] - value, ends[1] - value
            if abs(up + down) > (abs(up) + abs(down)) / NEARLY_OPPOSITE + 4 * rounding:
                return NoValue.LOST
            error += 2 * max(abs(up), abs(down))
    if value is None:
        return NoValue.LOST if is_defined_nearby else NoValue.UNDEFINED
    return Bounded(value, error)


def _steps_of(argument: Bounded) -> list[Number]:
    """Return the directions in which an argument may be wrong."""
    if not argument.error:
        return []
    step = 2 * argument.error
    return [step, mp.mpc(0, step)] if isinstance(argument.value, mp.mpc) else [step]


def _moved(values: Sequence[Number], place: int, by: Number) -> list[Number]:
    return [value + by if i == place else value for i, value in enumerate(values)]


def _value(function: Callable[..., Number | None], values: Sequence[Number]) -> Number | None:
    """Return a finite value, or None.

    Raises
    ------
    OverflowError
        An argument is too large to be evaluated.
    """
    try:
        value = function(*values)
    except OverflowError:
        raise
    except mp.NoConvergence as error:
        raise OverflowError from error
    except FAILURES:
        return None
    return value if value is not None and mp.isfinite(value) else None


def _eliminated(table: list[list[Bounded]]) -> NoValue | None:
    """Bring a table of equations to upper triangular form, in place.

    The pivot is the largest entry of its column, relative to the row that it stood in.
    """
    scales = [max(abs(each.value) for each in row[:-1]) or mp.one for row in table]
    for k in range(len(table)):
        places = [i for i in range(k, len(table)) if table[i][k].is_nonzero]
        if not places:
            is_singular = all(row[k].is_zero for row in table[k:])
            return NoValue.UNDEFINED if is_singular else NoValue.LOST
        pivot = max(places, key=lambda i: abs(table[i][k].value) / scales[i])
        table[k], table[pivot] = table[pivot], table[k]
        scales[k], scales[pivot] = scales[pivot], scales[k]
        for row in table[k + 1 :]:
            if not row[k].is_zero:
                factor = _quotient(row[k], table[k][k])
                row[k + 1 :] = [
                    _less_product(a, factor, b) for a, b in zip(row[k + 1 :], table[k][k + 1 :], strict=True)
                ]
    return None
