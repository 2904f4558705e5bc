"""Prove that an expression is identically zero, by a common denominator.

Every symbol, function value and root is a generator of a polynomial ring over the rationals. An expression becomes a
numerator and a product of denominators, which are never multiplied out. The numerator is then reduced by relations of
the generators,

    sin(x)^2 = 1 - cos(x)^2,    cosh(x)^2 = 1 + sinh(x)^2,    (b^(1/q))^q = b,    |x|^2 = x^2,

and the expression is identically zero if the numerator becomes zero. Otherwise, or if the work exceeds its allowance,
the method is inconclusive. The allowance counts terms read and products of terms made, not seconds: the same
expression has the same outcome on every machine.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import islice
from typing import NamedTuple

import sympy as sp
from sympy.polys.rings import PolyElement

ALLOWANCE = 100_000
"""Terms read and products of terms made that one proof may take: a second or so."""

ADDITION_THEOREMS = (sp.sin, sp.cos, sp.tan, sp.sinh, sp.cosh, sp.tanh, sp.exp)
"""Functions whose sums and multiples can be taken out of the argument."""


LARGEST_MULTIPLE, MOST_TERMS, LONGEST_ARGUMENT = 12, 12, 200
"""Of an argument that addition theorems are applied to: its largest factor, its terms, its operations."""


class EffortLimitExceeded(Exception):
    """The proof would take more work than it is allowed."""


class Quotient(NamedTuple):
    """A polynomial over a product of powers of polynomials."""

    numerator: PolyElement
    denominators: Mapping[PolyElement, int]


class RootRelation(NamedTuple):
    """The relation generator^degree = value, with earlier generators in the value."""

    generator: sp.Expr
    degree: int
    value: sp.Expr


def is_identically_zero(expressions: Iterable[sp.Expr], allowance: int = ALLOWANCE) -> bool:
    """Return True if all expressions are proved to be identically zero.

    Parameters
    ----------
    expressions : iterable of Expr
        Expressions to examine.
    allowance : int
        Largest number of terms read and products of terms made.

    Returns
    -------
    bool
        True is a proof. False is inconclusive.
    """
    canonical = []
    for expression in expressions:
        allowance -= sum(1 for _ in islice(sp.preorder_traversal(expression), allowance))
        if allowance <= 0:
            return False
        canonical.append(_in_basic_functions(expression))
    try:
        forms = NormalForms(canonical, allowance)
        return not any(forms.numerator(expression) for expression in canonical)
    except (EffortLimitExceeded, ZeroDivisionError):  # nothing is shown of a quotient by what is identically zero
        return False


class NormalForms:
    """Numerators of expressions over one polynomial ring.

    The symbols, functions and roots of the expressions are its generators. The allowance is of products of terms.
    """

    def __init__(self, expressions: Iterable[sp.Expr], allowance: int) -> None:
        self._left = allowance
        generators = list(dict.fromkeys(g for e in expressions for g in _generators(e)))
        self._ring, *polynomials = sp.ring([f"g{i}" for i in range(len(generators))], sp.QQ)
        self._position = {generator: i for i, generator in enumerate(generators)}
        self._relations = [r for g in reversed(generators) for r in _relations_of(g)]
        self._quotients = {
            generator: self._whole(polynomial) for generator, polynomial in zip(generators, polynomials, strict=True)
        }

    def numerator(self, expression: sp.Expr) -> PolyElement:
        """Return the numerator of an expression, reduced by the relations.

        It is zero for an identical zero.

        Parameters
        ----------
        expression : Expr
            Expression in the generators of the ring.

        Returns
        -------
        PolyElement

        Raises
        ------
        EffortLimitExceeded
            The allowance is used up.
        """
        numerator = self._quotient(expression).numerator
        for relation in self._relations:
            numerator = self._reduced(numerator, relation)
        return numerator

    def _quotient(self, expression: sp.Expr) -> Quotient:
        known = self._quotients.get(expression)
        if known is None:
            known = self._quotients[expression] = self._convert(expression)
        return known

    def _convert(self, expression: sp.Expr) -> Quotient:
        match expression:
            case sp.Rational():
                return self._whole(self._ring(sp.QQ(expression.p, expression.q)))
            case sp.Add():
                return self._sum([self._quotient(term) for term in expression.args])
            case sp.Mul():
                return self._product([self._quotient(factor) for factor in expression.args])
            case _:
                base, exponent = _root_and_exponent(expression)
                power = self._power(self._quotient(base), abs(exponent))
                return power if exponent > 0 else self._inverse(power)

    def _whole(self, polynomial: PolyElement) -> Quotient:
        return Quotient(polynomial, {})

    def _sum(self, terms: list[Quotient]) -> Quotient:
        common: dict[PolyElement, int] = {}
        for term in terms:
            for factor, exponent in term.denominators.items():
                common[factor] = max(common.get(factor, 0), exponent)
        return Quotient(sum((self._widened(term, common) for term in terms), self._ring.zero), common)

    def _widened(self, term: Quotient, common: Mapping[PolyElement, int]) -> PolyElement:
        """Return the numerator of a term over the common denominators."""
        numerator = term.numerator
        for factor, exponent in common.items():
            for _ in range(exponent - term.denominators.get(factor, 0)):
                numerator = self._times(numerator, factor)
        return numerator

    def _product(self, factors: list[Quotient]) -> Quotient:
        numerator, denominators = self._ring.one, {}
        for factor in factors:
            numerator = self._times(numerator, factor.numerator)
            for denominator, exponent in factor.denominators.items():
                denominators[denominator] = denominators.get(denominator, 0) + exponent
        return Quotient(numerator, denominators)

    def _power(self, base: Quotient, exponent: int) -> Quotient:
        self._left -= exponent
        if self._left < 0:
            raise EffortLimitExceeded
        return self._product([base] * exponent)

    def _inverse(self, quotient: Quotient) -> Quotient:
        if not quotient.numerator:
            raise ZeroDivisionError("a denominator is identically zero")
        content, primitive = quotient.numerator.primitive()
        if primitive.LC < 0:
            content, primitive = -content, -primitive
        numerator = self._widened(self._whole(self._ring(1 / content)), quotient.denominators)
        return Quotient(numerator, dict(self._factors(primitive)))

    def _factors(self, polynomial: PolyElement) -> Iterator[tuple[PolyElement, int]]:
        """Split a polynomial into the generators that divide it and the rest."""
        common = tuple(map(min, zip(*polynomial.monoms(), strict=True)))
        rest = polynomial.quo_term((common, sp.QQ.one))
        for generator, exponent in zip(self._ring.gens, common, strict=True):
            if exponent:
                yield generator, exponent
        if rest != 1:
            yield rest, 1

    def _times(self, left: PolyElement, right: PolyElement) -> PolyElement:
        self._left -= len(left) * len(right)
        if self._left < 0:
            raise EffortLimitExceeded
        return left * right

    def _reduced(self, polynomial: PolyElement, relation: RootRelation) -> PolyElement:
        """Return the numerator of a polynomial with generator^degree replaced throughout."""
        position = self._position[relation.generator]
        by_exponent: dict[int, dict] = {}
        for monomial, coefficient in polynomial.items():
            exponent, remainder = divmod(monomial[position], relation.degree)
            lowered = (*monomial[:position], remainder, *monomial[position + 1 :])
            by_exponent.setdefault(exponent, {})[lowered] = coefficient
        if not any(by_exponent):
            return polynomial
        value = self._quotient(relation.value)
        return self._sum(
            [
                self._product([self._whole(self._ring(part)), self._power(value, exponent)])
                for exponent, part in by_exponent.items()
            ]
        ).numerator


def _generators(expression: sp.Expr) -> Iterator[sp.Expr]:
    """Return the generators of an expression, those of a relation first."""
    match expression:
        case sp.Rational():
            return
        case sp.Add() | sp.Mul():
            for part in expression.args:
                yield from _generators(part)
        case _:
            base, _exponent = _root_and_exponent(expression)
            if base != expression:
                yield from _generators(base)
                return
            for relation in _relations_of(expression):
                yield from _generators(relation.value)
            yield expression


def _root_and_exponent(expression: sp.Expr) -> tuple[sp.Expr, int]:
    """Write an expression as base^integer, b^(p/q) as the p-th power of b^(1/q)."""
    match expression:
        case sp.Pow(args=(base, sp.Integer() as exponent)):
            return base, int(exponent)
        case sp.Pow(args=(base, sp.Rational() as exponent)):
            return sp.Pow(base, sp.Rational(1, exponent.q), evaluate=False), int(exponent.p)
        case sp.exp(args=(argument,)):
            numerator, exponential = argument.as_coeff_Mul(rational=True)
            return sp.exp(exponential / numerator.q), int(numerator.p)
        case _:
            return expression, 1


def _relations_of(generator: sp.Expr) -> list[RootRelation]:
    match generator:
        case sp.sin(args=(x,)):
            return [RootRelation(generator, 2, 1 - sp.cos(x) ** 2)]
        case sp.cosh(args=(x,)):
            return [RootRelation(generator, 2, 1 + sp.sinh(x) ** 2)]
        case sp.Abs(args=(x,)):
            return [RootRelation(generator, 2, x**2)]
        case sp.Pow(args=(base, sp.Rational() as exponent)) if exponent.p == 1:
            return [RootRelation(generator, int(exponent.q), base)]
        case _:
            return []


def _in_basic_functions(expression: sp.Expr) -> sp.Expr:
    """Take sums and multiples out of arguments, and rewrite tangents and floats.

    Tangents become quotients, floats rationals.
    """
    exact = expression.xreplace({number: sp.Rational(number) for number in expression.atoms(sp.Float)})
    return exact.replace(lambda part: isinstance(part, ADDITION_THEOREMS), _basic_function)


def _basic_function(part: sp.Expr) -> sp.Expr:
    """Write a function in terms of functions of shorter arguments.

    A large multiple, which would need too many of them, stays.
    """
    argument = sp.expand(part.args[0]) if part.args[0].count_ops() <= LONGEST_ARGUMENT else part.args[0]
    multiples = [term.as_coeff_Mul(rational=True)[0] for term in sp.Add.make_args(argument)]
    if len(multiples) > MOST_TERMS or any(abs(multiple.p) > LARGEST_MULTIPLE for multiple in multiples):
        return part
    match part:
        case sp.exp():
            return sp.expand_power_exp(sp.exp(argument))
        case sp.tan():
            return sp.expand_trig(sp.sin(argument)) / sp.expand_trig(sp.cos(argument))
        case sp.tanh():
            return sp.expand_trig(sp.sinh(argument)) / sp.expand_trig(sp.cosh(argument))
        case _:
            return sp.expand_trig(part.func(argument))
