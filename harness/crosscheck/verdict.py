"""Compare two expressions at points, and then by proof.

A point is evaluated in two precisions. A difference that shrinks with the precision is a rounding error of zero. No
tolerance is needed, and terms of any size count. A difference common to both is real if it exceeds the bound on the
rounding errors at the point (`rounding`). If it does not, the point decides nothing.

A comparison may need the solution of linear equations. At a point they are solved numerically. In a proof a
certificate replaces the solution: the record's own closed form, which is substituted into the equations. If all
residuals vanish identically, it is the solution, because the equations are regular at the points and have no other.

Without a proof, points are drawn on both sides of each branch (`branches`), and points at which functions such as exp
have values independent of their arguments (`independent_functions`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum, auto
from typing import NamedTuple

import sympy as sp
from mpmath import mp

from ..language import translatable
from .branches import Branches, branches_of
from .digits import BOUNDING_DIGITS, CONFIRMING_DIGITS, DIGITS, POINTS, WORKING_DIGITS
from .draws import Draws, Point
from .evaluation import Number, Steps, Values
from .independent_functions import with_independent_functions
from .linear import LinearEquations
from .normal_form import is_identically_zero
from .report import CheckResult, Verdict
from .rounding import Bounded, NoValue, Result, bounded, rational

SHOWN = 12
"""Digits of two values that differ; more if these are equal."""

SHRUNK = 2 * DIGITS
"""Orders of magnitude by which a rounding of zero shrinks at least, of the 140 that the digits differ by."""

SAME_DIGITS = 10
"""Digits that a number has in common in both precisions if it is one."""

INDEPENDENT_POINTS = 4
"""Points with independent functions at which two expressions are compared."""

ATTEMPTS = 25
"""Draws for each point before the search for a regular one is given up."""


MOST_AGAIN = 8
"""Numbers of digits tried in place of the first where a rounding of zero is zero."""

Sides = tuple[list[Number | None], list[Number | None]]
"""Values of all derived expressions, and of what they are compared with."""


HOPELESS = 60
"""Draws after which no regular point is looked for where there was none."""


class Pair(NamedTuple):
    """A quantity in the record, and its value by the independent evaluation."""

    quantity: str
    derived: sp.Expr
    independent: sp.Expr


@dataclass(frozen=True)
class Comparison:
    """Pairs that must be identically equal."""

    pairs: tuple[Pair, ...]
    # symbols with a meaning, such as u under a control law; each may use the ones before it
    given: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    # equations whose unknowns occur in the pairs; each may use the solutions before it
    solves: tuple[LinearEquations, ...] = ()
    # derived closed forms of all these unknowns; None if there are none
    certificate: Mapping[sp.Symbol, sp.Expr] | None = None
    # symbols with numbers that may be rounded in the last of 50 digits, such as initial values found by Newton's method
    rounded: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    # described terms; where one has no real value, as asech(x) at x < 0, its derivatives are not compared
    domain: tuple[sp.Expr, ...] = ()


class Found(Enum):
    """The result for a pair at a point."""

    EQUAL = auto()
    DIFFERENT = auto()
    UNDERIVED = auto()  # only the independent evaluation has a value
    UNSTABLE = auto()  # the derived value is lost in rounding
    NOTHING = auto()  # the independent evaluation has no value, or the digits decide nothing


DIFFERENCES = (Found.DIFFERENT, Found.UNDERIVED)


def verify(comparison: Comparison, seed: str) -> CheckResult:
    """Return the verdict on a comparison.

    Parameters
    ----------
    comparison : Comparison
    seed : str
        Seed of the random points. The same seed makes the same points.

    Returns
    -------
    CheckResult
    """
    if not comparison.pairs:
        return CheckResult(Verdict.NOTHING, None, None)
    numbers = _pairs_of_numbers(comparison) if comparison.rounded else ()
    others = tuple(pair for pair in comparison.pairs if pair not in numbers)
    found = [_verify_rounded(replace(comparison, pairs=numbers))] if numbers else []
    return _weakest([*found, _Verification(replace(comparison, pairs=others), seed).result()] if others else found)


def verify_all(comparisons: Sequence[Comparison], seed: str) -> CheckResult:
    """Return the verdict on several comparisons.

    Parameters
    ----------
    comparisons : sequence of Comparison
        The comparisons.
    seed : str
        Seed of the random points.

    Returns
    -------
    CheckResult
        The weakest verdict of all.
    """
    return _weakest([verify(comparison, f"{seed} {i}") for i, comparison in enumerate(comparisons)])


def _weakest(found: Sequence[CheckResult]) -> CheckResult:
    order = (
        Verdict.DISAGREES,
        Verdict.UNDECIDED,
        Verdict.SAMPLED,
        Verdict.AGREES,
        Verdict.PROVED,
        Verdict.NOTHING,
    )
    return min(found, key=lambda each: order.index(each.verdict))


class _Verification:
    """One comparison, with the number of points at which each pair agreed."""

    def __init__(self, comparison: Comparison, seed: str) -> None:
        self.comparison = comparison
        self.evaluation = Evaluation(comparison)
        self.branches = branches_of(_definitions_put_in(comparison))
        self.draws = Draws(_free_names(comparison), self.branches, seed)
        self.points = POINTS if self.draws.names else 1
        self.equal = [0] * len(comparison.pairs)
        self.lost = [""] * len(comparison.pairs)

    def result(self) -> CheckResult:
        attempts = range(ATTEMPTS * self.points)
        if detail := self._difference(map(self.draws.point, attempts), enough=True):
            return CheckResult(Verdict.DISAGREES, DIGITS, self.points, detail)
        fewest = min(self.equal)
        if fewest < self.points:
            return self._too_few(fewest)
        if _is_proved(self.comparison):
            return CheckResult(Verdict.PROVED, DIGITS, self.points)
        if detail := self._difference(self.draws.at_branches()):
            return CheckResult(Verdict.DISAGREES, DIGITS, self.points, detail)
        if sides := self.draws.sides_not_reached():
            return CheckResult(
                Verdict.UNDECIDED, None, fewest, translatable("no point was found where %(side)s", side=sides[0])
            )
        verdict = Verdict.AGREES if self._agrees_independently() else Verdict.SAMPLED
        return CheckResult(verdict, DIGITS, min(self.equal))

    def _difference(self, points: Iterable[Point], enough: bool = False) -> str:
        """Return the first difference, empty if there is none.

        The search stops when each pair has enough points.
        """
        for drawn, point in enumerate(points):
            for i, (found, left, right) in enumerate(self.evaluation.findings(point)):
                if found is Found.EQUAL:
                    self.equal[i] += 1
                elif found in DIFFERENCES and self._is_in_domain(i, point):
                    return self._describe(i, found, left, right, point)
                elif found is Found.UNSTABLE:
                    self.lost[i] = self._describe(i, found, left, right, point)
            if enough and (min(self.equal) >= self.points or (drawn > HOPELESS and not max(self.equal))):
                break
        return ""

    def _is_in_domain(self, i: int, point: Point) -> bool:
        """Return False if a described term of a pair has no real value at a point."""
        pair = self.comparison.pairs[i]
        known = pair.independent.free_symbols | pair.derived.free_symbols
        terms = [term for term in self.comparison.domain if term.free_symbols <= known]
        return all(each is not None and _is_real(each, each) for each in self.evaluation.values_of(terms, point))

    def _describe(self, i: int, found: Found, left: Number | None, right: Number, point: Point) -> str:
        if found is Found.DIFFERENT:
            derived, known = _distinguished(mp.re(left), mp.re(right))
        else:
            derived, known = translatable("no real value"), mp.nstr(mp.re(right), SHOWN)
        difference = translatable(
            "%(quantity)s: the record gives %(derived)s, the independent evaluation %(known)s",
            quantity=self.comparison.pairs[i].quantity,
            derived=derived,
            known=known,
        )
        where = ", ".join(f"{symbol.name} = {number}" for symbol, number in point.items())
        return translatable("%(difference)s at %(where)s", difference=difference, where=where) if where else difference

    def _too_few(self, fewest: int) -> CheckResult:
        equal, _ = self._independently_equal() if any(self.lost) else (self.equal, False)
        for lost, *agreeing in zip(self.lost, self.equal, equal, strict=True):
            if lost and not any(agreeing):
                return CheckResult(Verdict.DISAGREES, DIGITS, ATTEMPTS * self.points, lost)
        reason = (
            translatable("only %(points)s regular points were found among those drawn at random", points=fewest)
            if fewest
            else translatable("no regular point was found among those drawn at random")
        )
        return CheckResult(Verdict.UNDECIDED, None, fewest or None, reason)

    def _agrees_independently(self) -> bool:
        equal, differs = self._independently_equal()
        return not differs and min(equal) >= INDEPENDENT_POINTS

    def _independently_equal(self) -> tuple[list[int], bool]:
        """Compare the pairs with functions independent of their arguments.

        The functions are exp, sin and the like. The result is the number of points at which each pair agrees, and True
        if one differs.
        """
        comparison = with_independent_functions(self.comparison)
        evaluation = Evaluation(comparison)
        draws = Draws(_free_names(comparison), Branches(()), f"{self.draws.seed} independent")
        equal = [0] * len(comparison.pairs)
        for attempt in range(ATTEMPTS * INDEPENDENT_POINTS):
            for i, (found, _, _) in enumerate(evaluation.findings(draws.point(attempt), complex_too=True)):
                equal[i] += found is Found.EQUAL
                if found is Found.DIFFERENT:
                    return equal, True
            if min(equal) >= INDEPENDENT_POINTS:
                break
        return equal, False


class Evaluation:
    """The pairs of a comparison, evaluated at points in two precisions."""

    def __init__(self, comparison: Comparison) -> None:
        self._given = [(symbol, Steps([meaning])) for symbol, meaning in comparison.given.items()]
        self._solves = comparison.solves
        self._left = Steps([pair.derived for pair in comparison.pairs])
        self._right = Steps([pair.independent for pair in comparison.pairs])

    def findings(self, point: Point, complex_too: bool = False) -> Iterator[tuple[Found, Number | None, Number | None]]:
        """Yield the result for each pair at a point, and the values of both sides.

        Parameters
        ----------
        point : Point
            Number of each symbol.
        complex_too : bool
            If True, complex values are compared, too.

        Yields
        ------
        result : Found
            Result for a pair.
        left : mpf, mpc or None
            Value of the derived expression.
        right : mpf, mpc or None
            Value by the independent evaluation.
        """
        fine = self._values(point, CONFIRMING_DIGITS)
        coarse = self._values(point, WORKING_DIGITS)
        for digits in range(WORKING_DIGITS + 1, WORKING_DIGITS + MOST_AGAIN):
            lucky = [i for i, each in enumerate(zip(*coarse, *fine, strict=True)) if _is_luck(*each)]
            if not lucky:
                break
            again = self._values(point, digits)
            for i in lucky:
                coarse[0][i], coarse[1][i] = again[0][i], again[1][i]
        with mp.workdps(CONFIRMING_DIGITS):
            found = [
                _finding((left, left_again), (right, right_again), complex_too)
                for left, right, left_again, right_again in zip(*coarse, *fine, strict=True)
            ]
        yield from zip(self._confirmed(found, point, complex_too), *fine, strict=True)

    def values_of(self, expressions: Sequence[sp.Expr], point: Point) -> Sequence[Number | None]:
        """Return the values of other expressions at a point, or None if one has no value.

        Parameters
        ----------
        expressions : sequence of Expr
            Expressions in the symbols of the comparison.
        point : Point
            Number of each symbol.

        Returns
        -------
        sequence of Number or None
            One for each expression.
        """
        with mp.workdps(CONFIRMING_DIGITS):
            return Steps(expressions).at(self._known(point))

    def _values(self, point: Point, digits: int) -> Sides:
        with mp.workdps(digits):
            values = self._known(point)
            return self._left.at(values), self._right.at(values)

    def _confirmed(self, found: Sequence[Found], point: Point, complex_too: bool) -> list[Found]:
        """Return the results without the differences that may be rounding errors."""
        differing = {i for i, each in enumerate(found) if each in DIFFERENCES}
        confirmed = list(found)
        for digits in BOUNDING_DIGITS:
            if not differing:
                break
            with mp.workdps(digits):
                sides = list(zip(*self._bounded(point), strict=True))
                for i in differing:
                    confirmed[i] = _bounded_finding(*sides[i], complex_too)
            differing = {i for i in differing if confirmed[i] not in DIFFERENCES}
        return confirmed

    def _bounded(self, point: Point) -> tuple[list[Result], list[Result]]:
        values: dict[sp.Symbol, Result] = {x: rational(number) for x, number in point.items()}
        for symbol, meaning in self._given:
            values[symbol] = bounded(meaning, values)[0]
        for equations in self._solves:
            values |= equations.bounded_solution(values)
        return bounded(self._left, values), bounded(self._right, values)

    def _known(self, point: Point) -> dict[sp.Symbol, Number | None]:
        values: dict[sp.Symbol, Number | None] = {x: mp.mpf(number.p) / number.q for x, number in point.items()}
        for symbol, meaning in self._given:
            values[symbol] = meaning.at(values)[0]
        for equations in self._solves:
            values |= equations.solution(values)
        return values


def _finding(left: Sequence[Number | None], right: Sequence[Number | None], complex_too: bool) -> Found:
    if None in right or not (_is_stable(*right) and (complex_too or _is_real(*right))):
        return Found.NOTHING
    if None in left:
        return Found.UNDERIVED if left[0] is left[1] else Found.UNSTABLE
    coarse, fine = (derived - known for derived, known in zip(left, right, strict=True))
    if not coarse or _vanishes(coarse, fine):  # zero in each of the fewer numbers of digits
        return Found.EQUAL
    if not _is_same(coarse, fine):
        return Found.UNSTABLE if abs(fine) > abs(coarse) else Found.NOTHING  # what shrinks may be a root of rounding
    return Found.DIFFERENT if complex_too or _is_real(*left) else Found.UNDERIVED


def _bounded_finding(left: Result, right: Result, complex_too: bool) -> Found:
    """Return a difference only if it exceeds the bounds on the rounding errors."""
    if isinstance(right, NoValue) or not (complex_too or _may_be_real(right)):
        return Found.NOTHING
    match left:
        case NoValue.TOO_LARGE:
            return Found.NOTHING
        case NoValue.LOST:
            return Found.UNSTABLE
        case NoValue.UNDEFINED:
            return Found.UNDERIVED
    if not (complex_too or _may_be_real(left)):
        return Found.UNDERIVED
    is_real = abs(left.value - right.value) > left.error + right.error
    return Found.DIFFERENT if is_real else Found.NOTHING


def _may_be_real(number: Bounded) -> bool:
    return abs(mp.im(number.value)) <= number.error


def _is_luck(left: Number | None, right: Number | None, left_again: Number | None, right_again: Number | None) -> bool:
    """Return True if a rounding error is exactly zero in the fewer digits.

    It cannot be seen to shrink then.
    """
    return left is not None and left == right and left_again != right_again


def _vanishes(coarse: Number, fine: Number) -> bool:
    """Return True if a number shrinks with the precision, like a rounding error."""
    return not fine or abs(fine) <= mp.mpf(10) ** -SHRUNK * abs(coarse)


def _is_same(coarse: Number, fine: Number) -> bool:
    return abs(fine - coarse) <= mp.mpf(10) ** -SAME_DIGITS * abs(fine)


def _is_stable(coarse: Number, fine: Number) -> bool:
    return not coarse or _is_same(coarse, fine) or _vanishes(coarse, fine)


def _is_real(coarse: Number, fine: Number) -> bool:
    return _vanishes(mp.im(coarse), mp.im(fine)) or abs(mp.im(fine)) <= mp.mpf(10) ** -SHRUNK * abs(fine)


def _verify_rounded(comparison: Comparison) -> CheckResult:
    """Return the verdict on pairs at one point whose numbers may be rounded.

    A difference d is explained if a change of the numbers in the 50th digit makes it: |d| <= 10^-50 times the sum of
    |x dd/dx| over the rounded numbers x.
    """
    values = _rounded_values(comparison)
    exact = _resolved({x: meaning for x, meaning in comparison.given.items() if x not in comparison.rounded})
    for pair in comparison.pairs:
        difference = (pair.derived - pair.independent).xreplace(exact)
        changing = [x for x in comparison.rounded if x in difference.free_symbols]
        terms = [*sp.Add.make_args(pair.derived), *sp.Add.make_args(pair.independent)]
        slopes = [x * difference.diff(x) for x in changing]
        steps = Steps([difference, pair.derived, pair.independent, *terms, *slopes])
        with mp.workdps(CONFIRMING_DIGITS):
            found, left, right, *more = steps.at(values)
            sizes, changes = more[: len(terms)], more[len(terms) :]
            if found is None or left is None or right is None or mp.im(found):
                detail = translatable("%(quantity)s has no real value at the initial time", quantity=pair.quantity)
                return CheckResult(Verdict.DISAGREES, DIGITS, 1, detail)
            explained = mp.mpf(10) ** -DIGITS * mp.fsum(abs(change) for change in changes if change is not None)
            largest = max(abs(each) for each in (left, right, *sizes) if each is not None)
            noise = mp.mpf(10) ** (DIGITS - CONFIRMING_DIGITS) * largest + _error(difference, values)
            if abs(found) > explained + noise:
                detail = translatable(
                    "%(quantity)s: the record gives %(derived)s, where %(known)s belongs",
                    quantity=pair.quantity,
                    derived=mp.nstr(left, 12),
                    known=mp.nstr(right, 12),
                )
                return CheckResult(Verdict.DISAGREES, DIGITS, 1, detail)
    return CheckResult(Verdict.AGREES, DIGITS, 1)


def _error(expression: sp.Expr, values: Values) -> mp.mpf:
    """Return a bound on the rounding error of an expression, zero if none is known."""
    known = {x: Bounded(value, abs(value) * mp.ldexp(1, -mp.prec)) for x, value in values.items() if value is not None}
    found = bounded(Steps([expression]), known)[0]
    return found.error if isinstance(found, Bounded) else mp.zero


def _pairs_of_numbers(comparison: Comparison) -> tuple[Pair, ...]:
    """Return the pairs that contain no free symbol."""
    known = _numbers(comparison).keys()
    return tuple(
        pair for pair in comparison.pairs if pair.derived.free_symbols | pair.independent.free_symbols <= known
    )


def _numbers(comparison: Comparison) -> dict[sp.Symbol, sp.Expr]:
    """Return the meanings that contain no free symbol, in order of use."""
    found: dict[sp.Symbol, sp.Expr] = {}
    for symbol, meaning in {**comparison.rounded, **comparison.given}.items():
        if meaning.free_symbols <= found.keys():
            found[symbol] = meaning
    return found


def _rounded_values(comparison: Comparison) -> Values:
    values: dict[sp.Symbol, Number | None] = {}
    with mp.workdps(CONFIRMING_DIGITS):
        for symbol, meaning in _numbers(comparison).items():
            values[symbol] = Steps([meaning]).at(values)[0]
    return values


def confirmed(difference: Callable[[], str]) -> str:
    """Return a difference that is confirmed in more digits, or an empty text.

    Differences made by rounding do not count.

    Parameters
    ----------
    difference : callable
        Function that finds a difference in the working precision, or an empty text.

    Returns
    -------
    str
        Message.
    """
    if not difference():
        return ""
    with mp.workdps(CONFIRMING_DIGITS):
        return difference()


def _distinguished(left: Number, right: Number) -> tuple[str, str]:
    """Return two numbers with enough digits to distinguish them."""
    with mp.workdps(CONFIRMING_DIGITS):
        for digits in range(SHOWN, CONFIRMING_DIGITS):
            texts = mp.nstr(left, digits), mp.nstr(right, digits)
            if texts[0] != texts[1]:
                break
    return texts


def _free_names(comparison: Comparison) -> list[str]:
    """Return names of the symbols that need a value at a point."""
    solved = {symbol for equations in comparison.solves for symbol in equations.unknowns}
    free = set().union(*(e.free_symbols for e in _expressions(comparison)))
    return sorted(symbol.name for symbol in free - solved - comparison.given.keys() if isinstance(symbol, sp.Symbol))


def _expressions(comparison: Comparison) -> Iterator[sp.Expr]:
    for pair in comparison.pairs:
        yield from (pair.derived, pair.independent)
    yield from comparison.given.values()
    for equations in comparison.solves:
        yield from equations.residuals


def _definitions_put_in(comparison: Comparison) -> list[sp.Expr]:
    definitions = _resolved(comparison.given)
    return [expression.xreplace(definitions) for expression in _expressions(comparison)]


def _is_proved(comparison: Comparison) -> bool:
    if comparison.solves and comparison.certificate is None:
        return False
    definitions = _resolved({**comparison.given, **(comparison.certificate or {})})
    zeros = [pair.derived - pair.independent for pair in comparison.pairs]
    zeros += [residual for equations in comparison.solves for residual in equations.residuals]
    return is_identically_zero(zero.xreplace(definitions) for zero in zeros)


def _resolved(definitions: Mapping[sp.Symbol, sp.Expr]) -> dict[sp.Symbol, sp.Expr]:
    """Return definitions in terms of undefined symbols, in order of use."""
    found: dict[sp.Symbol, sp.Expr] = {}
    for symbol, meaning in definitions.items():
        found[symbol] = meaning.xreplace(found)
    return found
