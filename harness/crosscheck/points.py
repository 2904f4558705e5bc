"""Draw random rational points, and evaluate SymPy's functions by mpmath."""

from __future__ import annotations

import random
from collections.abc import Iterable

import sympy as sp
from mpmath import mp

from ..elliptic import JacobiCn, JacobiDn, JacobiSn
from ..mathjson import CLASSES

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
