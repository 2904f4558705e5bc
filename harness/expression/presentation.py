"""Bring SymPy expressions into the written form, with differences and fractions.

They replace factors -1 and powers -1. The result is a tree in MathJSON's shape, its terms and factors in reading
order.
"""

from collections.abc import Sequence

import sympy
from sympy import Add, Expr, Float, Indexed, Integer, Mul, Number, Pow, Rational, S, Symbol

from ..failures import ErrorKind, HolonomError
from .mathjson import CONSTANT_NAMES, HEADS
from .notation import scene_text
from .trees import Tree, integer_tree

TIME = Symbol("t", real=True)
READING_ORDER = (Number, sympy.NumberSymbol, Symbol, Indexed, sympy.Function, Pow, Add)  # of factors


def presented(expression: Expr) -> Tree:
    """Return the tree of an expression in reading order.

    Heads are those of MathJSON, among them Negate, Divide, Sqrt and Exp.

    Parameters
    ----------
    expression : Expr
        Expression in the symbols of a derivation record.

    Returns
    -------
    Tree
        Tree in MathJSON's shape.

    Raises
    ------
    HolonomError
        A part of the expression is none that a derivation record can hold.
    """
    if isinstance(expression, Add):
        return ["Add", *map(presented, _positive_first(sorted(expression.as_ordered_terms(), key=_power_of_time)))]
    sign, tree = _signed(expression)
    return ["Negate", tree] if sign < 0 else tree


def formula_text(expression: Expr) -> str:
    """Return an expression in reading order, in the notation of scene files.

    Parameters
    ----------
    expression : Expr
        As for `presented`.

    Returns
    -------
    str
        One line.
    """
    return scene_text(presented(expression))


def _power_of_time(term: Expr) -> tuple[bool, Expr]:
    """Return the key that sorts the terms of a power series by powers of the time."""
    powers = (power for base, power in term.as_powers_dict().items() if (base - TIME).is_number and power.is_Number)
    return not term.is_Number, next(powers, S.Zero)


def _positive_first(terms: list[Expr]) -> list[Expr]:
    first = next((term for term in terms if _signed(term)[0] > 0), terms[0])
    return [first, *(term for term in terms if term is not first)]


def _signed(expression: Expr) -> tuple[int, Tree]:
    """Return the sign of a term, and the term without it."""
    match expression:
        case Float():
            return (-1 if expression < 0 else 1), {"num": sympy.sstr(abs(expression), full_prec=False)}
        case Integer():
            return (-1 if expression < 0 else 1), integer_tree(abs(int(expression)))
        case Rational() | Mul() | Pow(exp=Rational(is_negative=True)):
            return _signed_quotient(*sympy.fraction(expression, exact=True))
        case _:
            return 1, _unsigned(expression)


def _signed_quotient(numerator: Expr, denominator: Expr) -> tuple[int, Tree]:
    """Return a quotient, with a sum of the numerator after the fraction.

    This applies only if there are other factors for the fraction.
    """
    (up, factors), (down, divisors) = _factors(numerator), _factors(denominator)
    number = up / down
    sums = [factor for factor in factors if isinstance(factor, Add)]
    others = [factor for factor in factors if not isinstance(factor, Add)]
    plain, divisor = [*_unless_one(abs(number.p)), *others], [*_unless_one(number.q), *divisors]
    if not divisor or not plain:
        return int(sympy.sign(number)), _quotient([*plain, *sums], divisor)
    parts = [_quotient(plain, divisor), *map(presented, sums)]
    return int(sympy.sign(number)), ["Multiply", *parts] if sums else parts[0]


def _factors(product: Expr) -> tuple[Rational, list[Expr]]:
    """Return the rational coefficient and the other factors.

    Common factors of sums go into the coefficient.
    """
    coefficient, rest = product.as_coeff_Mul(rational=True)
    parts = [_primitive(factor) for factor in rest.as_ordered_factors() if factor != 1]
    return coefficient * Mul(*(content for content, _ in parts)), sorted(
        (factor for _, factor in parts), key=_reading_order
    )


def _primitive(factor: Expr) -> tuple[Rational, Expr]:
    if isinstance(factor, Float) and factor < 0:
        return S.NegativeOne, -factor
    if not isinstance(factor, Add):
        return S.One, factor
    content, primitive = factor.primitive()
    negative = all(_signed(term)[0] < 0 for term in primitive.args)
    return (-content, -primitive) if negative else (content, primitive)


def _unless_one(number: int) -> list[Expr]:
    return [] if number == 1 else [Integer(number)]


def _quotient(factors: Sequence[Expr], divisors: Sequence[Expr]) -> Tree:
    return ["Divide", _product(factors), _product(divisors)] if divisors else _product(factors)


def _product(factors: Sequence[Expr]) -> Tree:
    trees = list(map(presented, factors))
    return ["Multiply", *trees] if len(trees) > 1 else next(iter(trees), 1)


def _reading_order(factor: Expr) -> tuple[int, int, bool]:
    """Order numbers, symbols, symbols under dots, the time, functions, sums."""
    base = factor.base if isinstance(factor, Pow) else factor
    kind = next(place for place, kind in enumerate((*READING_ORDER, Expr)) if isinstance(base, kind))
    dots = base.name.partition("ot(")[0].count("d") if isinstance(base, Symbol) and "ot(" in base.name else 0
    return kind, base == TIME, dots


def _unsigned(expression: Expr) -> Tree:
    match expression:
        case Symbol():
            return expression.name
        case Indexed():
            return ["Subscript", expression.base.label.name, *map(presented, expression.indices)]
        case _ if expression in CONSTANT_NAMES:
            return CONSTANT_NAMES[expression]
        case Pow(exp=S.Half):
            return ["Sqrt", presented(expression.base)]
        case _ if expression.func in HEADS:
            return [HEADS[expression.func], *map(presented, expression.args)]
        case _:
            raise HolonomError(ErrorKind.NOT_AN_EXPRESSION, detail=str(expression))
