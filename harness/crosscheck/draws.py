"""Draw random points of many sizes and both signs, within the domain.

Points near branches and on both sides of them are among these. A point is exact, a rational number for each symbol,
so that it is the same in any precision.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations

import sympy as sp
from mpmath import mp

from ..language import translatable
from .branches import Branch, Branches
from .evaluation import Number, Steps
from .points import random_point

Point = Mapping[sp.Symbol, sp.Rational]

MANTISSA = 10**12
"""Denominator of drawn numbers, too large to foresee them."""

LARGEST_POWER = 6
"""Sizes are drawn from 10^-6 to 10^6, each power of ten as likely as the others."""

LOOKING_DIGITS = 30
"""Digits in which the side of a branch is looked at."""

REPAIRS = 24
"""Symbols drawn anew for a point outside the domain."""

SECANTS = 40
"""Steps of the secant method towards a value of an argument."""

PER_BRANCH, MOST_LOOKS = 24, 400
"""Points looked at for each branch, and for all."""

TRIPLES, PAIRS = 8, 40
"""Most branches of which all combinations of three sides are drawn, and of two."""


class Draws:
    """Random points for some names, determined by the seed."""

    def __init__(self, names: Sequence[str], branches: Branches, seed: str) -> None:
        self.names, self.branches, self.seed = names, branches, seed
        self._sides = Steps([branch.argument for branch in branches])
        self._wanted = [i for i, branch in enumerate(branches) if branch.bounds_domain]
        self._reached: set[tuple[tuple[int, int], ...]] = set()

    def point(self, attempt: int) -> Point:
        """Return the point of this attempt, moved into the domain if a simple step can.

        Parameters
        ----------
        attempt : int
            Number of the attempt, from 0. It decides about sizes and signs.

        Returns
        -------
        Point
            Rational number of each symbol.
        """
        draw = random.Random(f"{self.seed} {attempt}")
        point = self._drawn(attempt, draw)
        outside = self._outside(point) if self._wanted else []
        for _ in range(REPAIRS if outside else 0):
            symbols = self._symbols_of(outside[0])
            if not symbols:
                break
            moved = {**point, (symbol := draw.choice(symbols)): _number(draw)}
            if attempt % 2 == 0:
                moved[symbol] = abs(moved[symbol]) if draw.random() < 0.5 else moved[symbol]
            left = self._outside(moved)
            if len(left) <= len(outside):
                point, outside = moved, left
            if not outside:
                break
        self._note(point)
        return point

    def at_branches(self) -> Iterator[Point]:
        """Yield points on sides of branches that no point reached before.

        Combinations of sides count, too.

        Yields
        ------
        Point
            Rational number of each symbol.
        """
        looks = min(PER_BRANCH * len(self.branches), MOST_LOOKS) if self.names else 0
        for attempt in range(looks):
            draw = random.Random(f"{self.seed} branch {attempt}")
            branch = self.branches[attempt % len(self.branches)]
            point = self._drawn(attempt // len(self.branches), draw)
            point = self._brought_to(branch, point, draw)
            if point and (self._note(point) or branch.is_growing):
                yield point

    def sides_not_reached(self) -> list[str]:
        """Return the sides of branches that no point reached.

        Sides that are known to be empty do not count.

        Returns
        -------
        list of str
            Conditions such as ``x - 1 is negative``.
        """
        missing = []
        for i, branch in enumerate(self.branches):
            for side in (1, -1):
                if branch.has_sides and ((i, side),) not in self._reached and not branch.is_empty(side):
                    what = (
                        translatable("%(expression)s is positive")
                        if side > 0
                        else translatable("%(expression)s is negative")
                    )
                    missing.append(translatable(what, expression=str(branch.argument)))
        return missing if self.names else []

    def _drawn(self, attempt: int, draw: random.Random) -> dict[sp.Symbol, sp.Rational]:
        """Draw a point.

        Every second attempt has values of many sizes. Of the others, every second has positive values only.
        """
        if attempt % 2:
            return random_point(self.names, attempt // 2, self.seed)
        return {sp.Symbol(name, real=True): _number(draw) for name in self.names}

    def _symbols_of(self, branch: int) -> list[sp.Symbol]:
        return sorted((x for x in self.branches[branch].argument.free_symbols if x.name in self.names), key=str)

    def _looked_at(self, point: Point) -> list[mp.mpf | None]:
        with mp.workdps(LOOKING_DIGITS):
            found = self._sides.at({x: mp.mpf(number.p) / number.q for x, number in point.items()})
        return [*map(_real, found)]

    def _outside(self, point: Point) -> list[int]:
        found = self._looked_at(point)
        return [i for i in self._wanted if found[i] is None or found[i] < 0]

    def _note(self, point: Point) -> bool:
        """Return True if the point is the first on a side or combination of sides."""
        sides = [
            (i, 1 if value > 0 else -1)
            for i, value in enumerate(self._looked_at(point))
            if value and self.branches[i].has_sides
        ]
        most = 3 if len(self.branches) <= TRIPLES else 2 if len(self.branches) <= PAIRS else 1
        found = {each for count in range(1, most + 1) for each in combinations(sides, count)}
        new = found - self._reached
        self._reached |= new
        return bool(new)

    def _brought_to(self, branch: Branch, point: Point, draw: random.Random) -> Point | None:
        """Move one symbol onto the zero of a function, and a small step off it."""
        symbols = sorted((x for x in branch.argument.free_symbols if x in point), key=str)
        if not symbols:
            return None
        symbol = draw.choice(symbols)
        with mp.workdps(LOOKING_DIGITS):
            target = sp.Rational(str(branch.target(draw)))
            found = _solved(Steps([branch.argument - target]), symbol, point)
            if found is None:
                return point
            if branch.has_sides:
                found += (1 + abs(found)) * mp.mpf(10) ** (-LARGEST_POWER * draw.random()) * draw.choice((-1, 1))
            return {**point, symbol: _exact(found)}


def _number(draw: random.Random) -> sp.Rational:
    power = draw.randrange(-LARGEST_POWER, LARGEST_POWER)
    return (
        draw.choice((-1, 1)) * sp.Rational(draw.randrange(MANTISSA, 10 * MANTISSA), MANTISSA) * sp.Integer(10) ** power
    )


def _exact(number: mp.mpf) -> sp.Rational:
    sign, mantissa, exponent, _ = number._mpf_
    whole = sp.Integer(-int(mantissa) if sign else int(mantissa))
    return whole * sp.Integer(2) ** exponent


def _real(number: Number | None) -> mp.mpf | None:
    return None if number is None or mp.im(number) else mp.re(number)


def _solved(residual: Steps, symbol: sp.Symbol, point: Point) -> mp.mpf | None:
    """Return the zero of the residual as a function of the symbol.

    The secant method is used, or None if it does not converge.
    """
    values = {x: mp.mpf(number.p) / number.q for x, number in point.items()}

    def at(number: mp.mpf) -> mp.mpf | None:
        return _real(residual.at({**values, symbol: number})[0])

    before, now = values[symbol], values[symbol] * mp.mpf("1.01")
    left = at(before)
    for _ in range(SECANTS):
        right = at(now)
        if left is None or right is None or right == left:
            return now if right == 0 else None
        before, now, left = now, now - right * (now - before) / (right - left), right
        if abs(now - before) <= mp.mpf(10) ** -(LOOKING_DIGITS // 2) * abs(now):
            return now
    return None
