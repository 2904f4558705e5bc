"""Two expressions compared: at random points first, then, where they agree, by proof.

A comparison may need the solution of linear equations. At a point they are solved, by numbers.
In a proof a certificate takes the solution's place: the record's own closed form, which is put
back into the equations. Where all residuals vanish identically it is the solution, for the
equations are regular at the points and so have no other.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import NamedTuple

import sympy as sp
from mpmath import mp

from .linear import LinearEquations
from .normal_form import is_identically_zero
from .points import IrregularPoint, Valuation, random_point
from .report import Verdict

DIGITS = 50
"""Digits to which two values must agree, relative to the larger of them and of one."""

WORKING_DIGITS = DIGITS + 20
"""Digits carried, so that cancellation and a linear solve leave the stated ones untouched."""

CONFIRMING_DIGITS = 3 * WORKING_DIGITS
"""Digits in which a difference must be found again: of terms that cancel 10^40 is left as a rounding of 10^-30."""

DIGITS_OF_FLOATS = 9
"""Digits to which values agree that come from floating-point data in the scene."""

POINTS = 8
"""Random points at which two expressions are compared."""

ATTEMPTS = 25
"""Draws for each point before the search for a regular one is given up."""


Point = Mapping[sp.Symbol, sp.Rational]


class Pair(NamedTuple):
    """What the record claims of a quantity, and what the independent evaluation makes of it."""

    quantity: str
    claimed: sp.Expr
    independent: sp.Expr


@dataclass(frozen=True)
class Comparison:
    """Pairs that have to be equal identically."""

    pairs: tuple[Pair, ...]
    # symbols with a meaning, such as u under a control law; each may use the ones before it
    given: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    # equations whose unknowns occur in the pairs; each may use the solutions before it
    solves: tuple[LinearEquations, ...] = ()
    # claimed closed forms of all these unknowns; None where there are none
    certificate: Mapping[sp.Symbol, sp.Expr] | None = None


class Judgement(NamedTuple):
    """A verdict, the digits and points that support it, and the difference found."""

    verdict: Verdict
    digits: int | None
    points: int | None
    detail: str = ""


def judge(comparison: Comparison, seed: str) -> Judgement:
    """Verdict on a comparison; the same seed makes the same random points."""
    if not comparison.pairs:
        return Judgement(Verdict.NOTHING, None, None)
    names = _free_names(comparison)
    points = POINTS if names else 1
    digits = _digits(comparison)
    compared, valueless = 0, ""
    candidates = (random_point(names, attempt, seed) for attempt in range(ATTEMPTS * points))
    with mp.workdps(WORKING_DIGITS):
        while compared < points and (point := next(candidates, None)) is not None:
            try:
                detail = confirmed(partial(_difference, comparison, point, digits))
            except ClaimWithoutValue as found:
                valueless = valueless or str(found)
                continue
            except (IrregularPoint, ZeroDivisionError):
                continue
            if detail:
                return Judgement(Verdict.DISAGREES, digits, points, detail)
            compared += 1
    if compared == 0 and valueless:
        return Judgement(Verdict.DISAGREES, digits, ATTEMPTS * points, valueless)
    if compared < points:
        return Judgement(Verdict.UNDECIDED, None, compared or None, _too_few(compared))
    proved = _is_proved(comparison)
    return Judgement(Verdict.PROVED if proved else Verdict.AGREES, digits, points)


def confirmed(difference: Callable[[], str]) -> str:
    """Tell a difference that is found in more digits too; empty where there is none, or rounding made it."""
    if not difference():
        return ""
    with mp.workdps(CONFIRMING_DIGITS):
        return difference()


def _too_few(compared: int) -> str:
    found = f"only {compared} regular points were" if compared else "no regular point was"
    return f"{found} found among {ATTEMPTS * POINTS} drawn at random"


class ClaimWithoutValue(IrregularPoint):
    """At a point where the independent evaluation has a value the record's expression has none."""


def _difference(comparison: Comparison, point: Point, digits: int) -> str:
    """Tell the first difference at a point; empty where there is none."""
    value = Valuation(point)
    for symbol, meaning in comparison.given.items():
        value.define(symbol, value(meaning))
    for equations in comparison.solves:
        for symbol, number in equations.solution(value).items():
            value.define(symbol, number)
    for quantity, claimed, independent in comparison.pairs:
        right = value(independent)
        try:
            left = value(claimed)
        except (IrregularPoint, ZeroDivisionError):
            raise ClaimWithoutValue(
                f"{quantity}: the record gives no real value at any point tried, "
                f"the independent evaluation {mp.nstr(right, 12)}{_where(point)}"
            ) from None
        if abs(left - right) > mp.mpf(10) ** -digits * max(1, abs(left), abs(right)):
            return (
                f"{quantity}: the record gives {mp.nstr(left, 12)}, "
                f"the independent evaluation {mp.nstr(right, 12)}{_where(point)}"
            )
    return ""


def _where(point: Point) -> str:
    if not point:
        return ""
    return " at " + ", ".join(f"{symbol.name} = {number}" for symbol, number in point.items())


def _free_names(comparison: Comparison) -> list[str]:
    """Names of the symbols that need a value at a point."""
    solved = {symbol for equations in comparison.solves for symbol in equations.unknowns}
    free = set().union(*(e.free_symbols for e in _expressions(comparison)))
    return sorted(symbol.name for symbol in free - solved - comparison.given.keys())


def _digits(comparison: Comparison) -> int:
    floating = any(expression.has(sp.Float) for expression in _expressions(comparison))
    return DIGITS_OF_FLOATS if floating else DIGITS


def _expressions(comparison: Comparison) -> Iterator[sp.Expr]:
    for pair in comparison.pairs:
        yield from (pair.claimed, pair.independent)
    yield from comparison.given.values()
    for equations in comparison.solves:
        yield from equations.residuals


def _is_proved(comparison: Comparison) -> bool:
    if comparison.solves and comparison.certificate is None:
        return False
    definitions = {**comparison.given, **(comparison.certificate or {})}
    zeros = [pair.claimed - pair.independent for pair in comparison.pairs]
    zeros += [residual for equations in comparison.solves for residual in equations.residuals]
    return is_identically_zero(_substituted(zero, definitions) for zero in zeros)


def _substituted(expression: sp.Expr, definitions: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    """Put in every definition, the last first, as later ones use earlier."""
    for symbol, meaning in reversed(definitions.items()):
        expression = expression.xreplace({symbol: meaning})
    return expression
