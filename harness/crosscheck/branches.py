"""Branch points of expressions, and arguments at which they change quickly.

Branch points are zeros of the arguments of abs, sign, roots and logarithms. Two expressions may be equal on one side
of a branch and differ on the other. A function such as exp or tanh may differ from zero, or from one, only in a
narrow range of its argument. Points are drawn there as well.
"""

from __future__ import annotations

import random
from collections.abc import Iterable
from dataclasses import dataclass

import sympy as sp
from mpmath import mp

from ..expression.functions import Behaviour
from ..expression.mathjson import CLASSES

CHANGING = tuple(function for each, function in CLASSES.items() if each.behaviour is Behaviour.CHANGING)
"""Functions that change in a range of their argument alone."""

RANGE = 2
"""Of their argument, around zero."""

MOST_SIGNS = 3
"""Signs in an argument whose cases are looked at."""


@dataclass(frozen=True)
class Branch:
    """The argument of a function that branches, or changes quickly, at its zero."""

    argument: sp.Expr
    bounds_domain: bool = False  # True if there is no real value at negative arguments
    is_growing: bool = False  # whether it is that of a function such as exp, which changes but has no sides

    @property
    def has_sides(self) -> bool:
        """True if both sides of zero are different."""
        return not self.is_growing

    def is_empty(self, side: int) -> bool:
        """Return True if the argument is known never to be on this side of zero.

        Parameters
        ----------
        side : int
            1 for positive arguments, -1 for negative ones.

        Returns
        -------
        bool
        """
        return _is_never(side, self.argument)

    def target(self, draw: random.Random) -> mp.mpf:
        """Return a value of the argument near which points are drawn.

        Parameters
        ----------
        draw : Random
            Source of random numbers.

        Returns
        -------
        mpf
            Zero, or a number from -`RANGE` to `RANGE` if the function has no sides.
        """
        return mp.mpf(draw.uniform(-RANGE, RANGE)) if self.is_growing else mp.zero


def _is_never(side: int, argument: sp.Expr) -> bool:
    """Return True if an argument is on a side of zero for none of its signs."""
    functions = {part.args[0] for part in argument.atoms(sp.Abs, sp.sign)}
    few = sorted(functions, key=sp.default_sort_key) if len(functions) <= MOST_SIGNS else []
    by_signs = [cases for g in few if (cases := _cases_by_sign(argument, g))]
    if by_signs:
        return any(all(_is_never(side, case) for case in cases) for cases in by_signs)
    argument = argument.replace(lambda part: part.is_real is None and _branch(part) is not None, _real)
    argument = argument.replace(_is_inverse_square, lambda part: sp.Dummy(positive=True))
    bounds = argument.replace(_is_bounded, lambda part: sp.AccumBounds(-1, 1))
    if isinstance(bounds, sp.AccumBounds):
        return bool(bounds.max <= 0 if side > 0 else bounds.min >= 0)
    return bool(argument.is_nonpositive if side > 0 else argument.is_nonnegative)


def _cases_by_sign(argument: sp.Expr, g: sp.Expr) -> list[sp.Expr]:
    """Return an argument with g = s P for each sign s, none if g is not linear."""
    cases: list[sp.Expr] = []
    x, slope = next(((x, d) for x in sorted(g.free_symbols, key=str) if (d := g.diff(x)).is_number), (None, None))
    if x is not None:
        for sign in (1, -1, 0):
            size = sp.Dummy(positive=True)
            with_sign = argument.xreplace({sp.Abs(g): sign * g, sp.sign(g): sp.Integer(sign)})
            cases.append(with_sign.subs(x, (sign * size - g + slope * x).expand() / slope).expand())
    return cases


def _is_bounded(part: sp.Expr) -> bool:
    """Return True for a function of a real argument with values from -1 to 1."""
    return isinstance(part, sp.sin | sp.cos | sp.tanh) and bool(part.args[0].is_real)


def _is_inverse_square(part: sp.Expr) -> bool:
    """Return True for a negative even power of a real number.

    It is positive if it has a value.
    """
    return bool(part.is_Pow and part.exp.is_even and part.exp.is_negative and part.base.is_real)


Branches = tuple[Branch, ...]


def branches_of(expressions: Iterable[sp.Expr]) -> Branches:
    """Return all branches of some expressions, each once.

    Parameters
    ----------
    expressions : iterable of Expr
        Expressions to examine.

    Returns
    -------
    Branches
        Branches in a fixed order.
    """
    parts = set().union(*(expression.atoms(sp.Function, sp.Pow) for expression in expressions))
    found: dict[sp.Expr, Branch] = {}
    for part in sorted(parts, key=sp.default_sort_key):
        branch = _branch(part)
        if branch is None or not branch.argument.free_symbols or -branch.argument in found:
            continue
        known = found.get(branch.argument)
        if known is None or known.is_growing or branch.bounds_domain:
            found[branch.argument] = branch
    return tuple(found.values())


def _real(part: sp.Expr) -> sp.Expr:
    """Replace a root or logarithm by a real one: only its real values count."""
    return sp.Dummy(real=True)


def _branch(part: sp.Expr) -> Branch | None:
    match part:
        case sp.Abs() | sp.sign():
            return Branch(part.args[0])
        case sp.log():
            return Branch(part.args[0], bounds_domain=True)
        case sp.Pow(args=(base, exponent)) if not exponent.is_Integer:
            return Branch(base, bounds_domain=True)
        case sp.Function() if isinstance(part, CHANGING):
            return Branch(part.args[0], is_growing=True)
        case _:
            return None
