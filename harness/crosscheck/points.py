"""Expressions evaluated at random rational points, at a working precision beyond the one stated."""

from __future__ import annotations

import random
from collections.abc import Iterable, Mapping

import sympy as sp
from mpmath import mp

from ..elliptic import JacobiCn, JacobiDn, JacobiSn
from .irregular_point import IrregularPoint

PARTS = 1_000_003
"""Coordinates of a random point are multiples of its inverse, up to two: small, rarely special, too many to foresee."""

FUNCTIONS = {
    sp.sin: mp.sin,
    sp.cos: mp.cos,
    sp.tan: mp.tan,
    sp.asin: mp.asin,
    sp.acos: mp.acos,
    sp.atan: mp.atan,
    sp.atan2: mp.atan2,
    sp.sinh: mp.sinh,
    sp.cosh: mp.cosh,
    sp.tanh: mp.tanh,
    sp.asinh: mp.asinh,
    sp.acosh: mp.acosh,
    sp.atanh: mp.atanh,
    **{
        getattr(sp, name): getattr(mp, name)
        for name in ("sec", "csc", "cot", "sech", "csch", "coth", "asec", "acsc", "acot", "asech", "acsch", "acoth")
    },
    sp.erf: mp.erf,
    sp.erfc: mp.erfc,
    sp.gamma: mp.gamma,
    sp.polygamma: mp.polygamma,
    sp.besselj: mp.besselj,
    sp.bessely: mp.bessely,
    sp.besseli: mp.besseli,
    sp.besselk: mp.besselk,
    sp.airyai: mp.airyai,
    sp.airybi: mp.airybi,
    sp.airyaiprime: lambda x: mp.airyai(x, derivative=1),
    sp.airybiprime: lambda x: mp.airybi(x, derivative=1),
    JacobiSn: lambda u, m: mp.ellipfun("sn", u, m=m),
    JacobiCn: lambda u, m: mp.ellipfun("cn", u, m=m),
    JacobiDn: lambda u, m: mp.ellipfun("dn", u, m=m),
    sp.exp: mp.exp,
    sp.log: mp.log,
    sp.Abs: abs,
    sp.sign: mp.sign,
    sp.DiracDelta: lambda x, order=0: mp.zero if x else mp.inf,
}


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
