"""Evaluate expressions at many points, as steps that are found once.

The number of digits may change between points. Intermediate values may be complex. A step without a value, such as a
division by zero, has none, and neither have expressions that depend on it. The other values remain.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache, partial
from typing import NamedTuple, TypeVar

import sympy as sp
from mpmath import mp

from ..expression.functions import Behaviour
from ..expression.mathjson import CLASSES
from .irregular_point import IrregularPoint
from .points import FUNCTIONS

Number = mp.mpf | mp.mpc
Numbers = list[Number | None]
Values = Mapping[sp.Symbol, Number | None]
T = TypeVar("T")

LARGEST_EXPONENT = 10**8
"""Largest exponent of which a power is formed."""

LARGEST = {
    Behaviour.CHANGING: LARGEST_EXPONENT,
    Behaviour.PERIODIC: 10**12,
}
LARGEST_SPECIAL = 10**2
"""Largest arguments of functions: by behaviour, and that of functions that mpmath takes a series for."""

LIMITS = {
    function: LARGEST_SPECIAL if each.special else LARGEST.get(each.behaviour) for each, function in CLASSES.items()
}

REMEMBERED = 2**12
"""Number of cached values: several expressions contain the same function at the same point."""

FAILURES = (ZeroDivisionError, OverflowError, ValueError, TypeError, mp.NoConvergence)


class Step(NamedTuple):
    """A function and the places of the values that it is applied to."""

    function: Callable[..., Number | None]
    places: tuple[int, ...]


class Steps:
    """The operations from values of symbols to values of expressions."""

    def __init__(self, expressions: Sequence[sp.Expr]) -> None:
        self._places: dict[sp.Expr, int] = {}
        self._steps: list[Step | sp.Symbol] = []
        self._results = [self._place(expression) for expression in expressions]

    def at(self, values: Values, real: bool = False) -> Numbers:
        """Evaluate the expressions in mpmath's working precision.

        Parameters
        ----------
        values : Values
            Values of the symbols.
        real : bool
            If True, complex values count as missing.

        Returns
        -------
        Numbers
            One for each expression, or None for an expression without a value.
        """
        found: Numbers = []
        for step in self._steps:
            value = _taken(step, found) if isinstance(step, Step) else values.get(step)
            found.append(None if real and isinstance(value, mp.mpc) else value)
        return [found[place] for place in self._results]

    def applied(self, of_symbol: Callable[[sp.Symbol], T], apply: Callable[[Callable, list[T]], T]) -> list[T]:
        """Evaluate the expressions in another arithmetic.

        Parameters
        ----------
        of_symbol : callable
            Value of a symbol.
        apply : callable
            Value of a function, given the values of its arguments.

        Returns
        -------
        list of T
            One for each expression.
        """
        found: list[T] = []
        for step in self._steps:
            known = isinstance(step, Step)
            found.append(apply(step.function, [found[i] for i in step.places]) if known else of_symbol(step))
        return [found[place] for place in self._results]

    def real_at(self, values: Values) -> list[mp.mpf]:
        """Evaluate the expressions in real numbers.

        Parameters
        ----------
        values : Values
            Values of the symbols.

        Returns
        -------
        list of mpf
            One for each expression.

        Raises
        ------
        IrregularPoint
            One of them has no value.
        """
        found = self.at(values, real=True)
        if any(value is None for value in found):
            raise IrregularPoint
        return found

    def _place(self, expression: sp.Expr) -> int:
        """Return the place of an expression's value, after the places of its arguments."""
        waiting = [expression]
        while waiting:
            part = waiting[-1]
            missing = [argument for argument in _arguments(part) if argument not in self._places]
            if part in self._places or not missing:
                waiting.pop()
                self._append(part)
            else:
                waiting += missing
        return self._places[expression]

    def _append(self, part: sp.Expr) -> None:
        if part not in self._places:
            self._places[part] = len(self._steps)
            self._steps.append(self._step(part))

    def _step(self, part: sp.Expr) -> Step | sp.Symbol:
        if isinstance(part, sp.Symbol):
            return part
        return Step(_function(part), tuple(self._places[argument] for argument in _arguments(part)))


def _taken(step: Step, found: Numbers) -> Number | None:
    arguments = [found[place] for place in step.places]
    for argument in arguments:
        if argument is None:  # `None in arguments` would make a number of None to compare it
            return None
    try:
        value = step.function(*arguments)
    except FAILURES:
        return None
    return value if value is not None and mp.isfinite(value) else None


def _arguments(part: sp.Expr) -> tuple[sp.Expr, ...]:
    match part:
        case sp.Pow(args=(base, sp.Integer())):
            return (base,)
        case sp.Add() | sp.Mul() | sp.Pow() | sp.Function():
            return part.args
        case _:
            return ()


def _function(part: sp.Expr) -> Callable[..., Number | None]:
    match part:
        case sp.Rational():
            return lambda: mp.mpf(part.p) / part.q
        case sp.Float():
            return _function(sp.Rational(part))
        case sp.NumberSymbol():
            return lambda: mp.mpf(part._to_mpmath(mp.prec))
        case sp.Add():
            return total
        case sp.Mul():
            return product
        case sp.Pow(args=(_, sp.Integer() as exponent)):
            return partial(whole_power, int(exponent))
        case sp.Pow():
            return _power
        case sp.Function() if part.func in FUNCTIONS:
            return partial(_applied, part.func)
        case _:
            return lambda *_: None


def total(*terms: Number) -> Number:
    """Return the sum of numbers.

    Parameters
    ----------
    *terms : Number
        Numbers to add.

    Returns
    -------
    Number
    """
    return mp.fsum(terms)


def product(*factors: Number) -> Number:
    """Return the product of numbers.

    Parameters
    ----------
    *factors : Number
        Numbers to multiply.

    Returns
    -------
    Number
    """
    return mp.fprod(factors)


def whole_power(exponent: int, base: Number) -> Number:
    """Return a power with a whole exponent.

    Parameters
    ----------
    exponent : int
        The exponent.
    base : Number
        The base.

    Returns
    -------
    Number

    Raises
    ------
    OverflowError
        The exponent is too large.
    """
    _require_size(exponent, LARGEST_EXPONENT)
    return base**exponent


def _require_size(number: Number, largest: int) -> None:
    if abs(number) > largest:
        raise OverflowError


def _power(base: Number, exponent: Number) -> Number | None:
    if not base:
        return mp.zero if mp.re(exponent) > 0 else None
    _require_size(exponent * mp.log(base), LARGEST_EXPONENT)
    return mp.power(base, exponent)


def _applied(kind: type, *arguments: Number) -> Number | None:
    largest = LIMITS.get(kind)
    if largest is None:
        return FUNCTIONS[kind](*arguments)
    for argument in arguments:
        _require_size(argument, largest)
    return _remembered(kind, mp.prec, *arguments)


@lru_cache(REMEMBERED)
def _remembered(kind: type, precision: int, *arguments: Number) -> Number:
    """Return the value of a function in the working precision, which is `precision`."""
    return FUNCTIONS[kind](*arguments)
