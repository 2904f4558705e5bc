"""Compare expressions with functions taken as independent of their arguments.

By Schwartz and Zippel's lemma this is a stronger test than points. In exp(x y + 2 z) the products of symbols are
replaced by symbols of their own, exp(p1 + 2 p2), so that random values of x, y, z and of p1, p2 give the function any
value, independent of x, y and z. Addition theorems remain valid: the symbols are the same in all functions. If two
expressions agree then, they are equal as polynomials of functions and symbols, up to a negligible probability. A
narrow well, exp(-10^6 (x - 1)^2), cannot hide. If they differ, the test is inconclusive.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import sympy as sp

from ..expression.functions import Behaviour
from ..expression.mathjson import CLASSES
from .linear import LinearEquations

if TYPE_CHECKING:
    from .verdict import Comparison

INDEPENDENT = tuple(function for each, function in CLASSES.items() if each.behaviour is not Behaviour.MODERATE)
"""Functions that are taken for independent of their argument."""

LARGEST_ARGUMENT = 200
"""Operations of an argument up to which it is expanded."""


def with_independent_functions(comparison: Comparison) -> Comparison:
    """Return the comparison with functions independent of their arguments.

    Parameters
    ----------
    comparison : Comparison

    Returns
    -------
    Comparison
    """
    made = _Independent(comparison.given)
    return replace(
        comparison,
        pairs=tuple(
            pair._replace(derived=made.of(pair.derived), independent=made.of(pair.independent))
            for pair in comparison.pairs
        ),
        given={symbol: made.of(meaning) for symbol, meaning in comparison.given.items()},
        solves=tuple(
            LinearEquations(equations.unknowns, tuple(map(made.of, equations.residuals)))
            for equations in comparison.solves
        ),
    )


class _Independent:
    """The symbols in place of products in the arguments of functions.

    There is one for each product and its largest coefficient.
    """

    def __init__(self, given: Mapping[sp.Symbol, sp.Expr]) -> None:
        self._given: dict[sp.Symbol, sp.Expr] = {}
        for symbol, meaning in given.items():
            self._given[symbol] = meaning.xreplace(self._given)
        self._made: dict[sp.Expr, sp.Expr] = {}
        self._symbols: dict[sp.Expr, sp.Expr] = {}

    def of(self, expression: sp.Expr) -> sp.Expr:
        """Return an expression with the arguments of its functions replaced."""
        made = self._made.get(expression)
        if made is None:
            made = self._made[expression] = self._replaced(expression)
        return made

    def _replaced(self, expression: sp.Expr) -> sp.Expr:
        match expression:
            case sp.Function() if isinstance(expression, INDEPENDENT):
                return expression.func(self._argument(expression.args[0]))
            case sp.Pow(args=(base, exponent)) if not exponent.is_number:
                whole, rest = exponent.as_coeff_Add(rational=True)
                return self.of(base) ** whole * sp.exp(self._argument(rest * sp.log(base)))
            case _ if expression.args and not isinstance(expression, sp.Indexed):
                return expression.func(*map(self.of, expression.args))
            case _:
                return expression

    def _argument(self, argument: sp.Expr) -> sp.Expr:
        argument = argument.xreplace(self._given)
        if argument.count_ops() <= LARGEST_ARGUMENT:
            argument = sp.expand(argument)
        return sp.Add(*(self._term(term) for term in sp.Add.make_args(argument)))

    def _term(self, term: sp.Expr) -> sp.Expr:
        coefficient, product = term.as_coeff_Mul(rational=True)
        if product.has(sp.pi):
            return term
        if product not in self._symbols:
            symbol = sp.Symbol(f"independent{len(self._symbols)}", real=True)
            self._symbols[product] = symbol / abs(coefficient)
        return coefficient * self._symbols[product]
