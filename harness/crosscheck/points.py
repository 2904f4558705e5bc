"""Draw random rational points, and evaluate SymPy's functions by mpmath."""

from __future__ import annotations

import random
from collections.abc import Iterable

import sympy as sp
from mpmath import mp

from ..expression.mathjson import CLASSES

PARTS = 1_000_003
"""Coordinates of a random point are multiples of its inverse, up to two: small, rarely special, too many to foresee."""

FUNCTIONS = {function: each.of(mp) for each, function in CLASSES.items()}
FUNCTIONS |= {sp.DiracDelta: lambda x, order=0: None if mp.im(x) else mp.zero if x else mp.inf}
"""SymPy's functions by mpmath."""


def random_point(names: Iterable[str], attempt: int, seed: str) -> dict[sp.Symbol, sp.Rational]:
    """Draw a rational point for some names, determined by the seed and a number.

    Every second attempt is positive throughout, for the sake of logarithms and roots.

    Parameters
    ----------
    names : iterable of str
        Names of the symbols.
    attempt : int
        Number of the point.
    seed : str
        Seed of the random numbers.

    Returns
    -------
    dict of Symbol to Rational
        Rational numbers up to two, by symbol.
    """
    draw = random.Random(f"{seed} {attempt}")
    lowest = -2 * PARTS if attempt % 2 else 1
    return {sp.Symbol(name, real=True): sp.Rational(draw.randint(lowest, 2 * PARTS), PARTS) for name in sorted(names)}
