"""Expressions evaluated at random rational points, at a working precision beyond the one stated."""

from __future__ import annotations

import random
from collections.abc import Iterable, Mapping

import sympy as sp
from mpmath import mp

from ..elliptic import JacobiCn, JacobiDn, JacobiSn
from ..mathjson import CLASSES
from .irregular_point import IrregularPoint

PARTS = 1_000_003
"""Coordinates of a random point are multiples of its inverse, up to two: small, rarely special, too many to foresee."""

OTHERWISE = {
    sp.Abs: abs,
    sp.airyaiprime: lambda x: mp.airyai(x, derivative=1),
    sp.airybiprime: lambda x: mp.airybi(x, derivative=1),
    JacobiSn: lambda u, m: mp.ellipfun("sn", u, m=m),
    JacobiCn: lambda u, m: mp.ellipfun("cn", u, m=m),
    JacobiDn: lambda u, m: mp.ellipfun("dn", u, m=m),
    sp.polygamma: mp.polygamma,
    sp.DiracDelta: lambda x, order=0: mp.zero if x else mp.inf,
}
FUNCTIONS = {function: getattr(mp, each.in_sympy, None) for each, function in CLASSES.items()} | OTHERWISE
"""Values of SymPy's functions, by mpmath's of the same names but for some."""


def random_point(names: Iterable[str], attempt: int, seed: str) -> dict[sp.Symbol, sp.Rational]:
    """Draw a rational point, the same for the same names, number of the draw and seed on every machine.

    Every second attempt is positive throughout, for the sake of logarithms and roots.
    """
    draw = random.Random(f"{seed} {attempt}")
    lowest = -2 * PARTS if attempt % 2 else 1
    return {sp.Symbol(name, real=True): sp.Rational(draw.randint(lowest, 2 * PARTS), PARTS) for name in sorted(names)}


class Valuation:
    """Values of expressions at a point, each subexpression evaluated once."""

    def __init__(self, point: Mapping[sp.Symbol, sp.Rational]) -> None:
        self._values: dict[sp.Expr, mp.mpf] = {}
        for symbol, number in point.items():
            self.define(symbol, self(number))

    def define(self, symbol: sp.Symbol, number: mp.mpf) -> None:
        """Give a symbol its value."""
        self._values[symbol] = number

    def __call__(self, expression: sp.Expr) -> mp.mpf:
        """Value of an expression.

        Raises
        ------
        IrregularPoint
            The value is not a finite real number.
        """
        known = self._values.get(expression)
        if known is None:
            known = self._values[expression] = _finite_real(self._evaluate(expression))
        return known

    def _evaluate(self, expression: sp.Expr) -> mp.mpf:
        match expression:
            case sp.Rational():
                return mp.mpf(expression.p) / expression.q
            case sp.Float() | sp.NumberSymbol():
                return mp.mpf(expression._to_mpmath(mp.prec))
            case sp.Add():
                return mp.fsum(map(self, expression.args))
            case sp.Mul():
                return mp.fprod(map(self, expression.args))
            case sp.Pow():
                return self._power(*expression.args)
            case sp.Function() if expression.func in FUNCTIONS:
                return FUNCTIONS[expression.func](*map(self, expression.args))
            case _:
                raise IrregularPoint

    def _power(self, base: sp.Expr, exponent: sp.Expr) -> mp.mpf:
        if exponent.is_Integer:
            return self(base) ** int(exponent)
        return mp.power(self(base), self(exponent))


def _finite_real(number: mp.mpf | mp.mpc) -> mp.mpf:
    if isinstance(number, mp.mpf) and mp.isfinite(number):
        return number
    raise IrregularPoint
