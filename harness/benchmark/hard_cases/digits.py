"""How many decimal digits a computation keeps of the truth."""

from collections.abc import Iterable

import mpmath
from mpmath import mp, mpf

MOST = 16.0  # digits of a double
TRUTH_DIGITS = 40  # that a truth is computed with

certified = mp.workdps(TRUTH_DIGITS)
"""Decorates what computes a truth; as a context, what its constants are made in."""


def digits_kept(computed: Iterable[float], truth: Iterable[mpf], scale: float | mpf | None = None) -> float:
    """Decimal digits that numbers keep of the truth, the worst of them counting.

    Parameters
    ----------
    scale : number, optional
        What an error is relative to; without it, the largest of the true numbers.

    Returns
    -------
    float
        From 0, also where a number is infinite or none, to 16.
    """
    pairs = [(mpf(float(value)), exact) for value, exact in zip(computed, truth, strict=True)]
    if not all(mpmath.isfinite(value) for value, _ in pairs):
        return 0.0
    return digits_of_error(max(abs(value - exact) for value, exact in pairs), scale or max(abs(x) for _, x in pairs))


def digits_of_error(error: float | mpf, scale: float | mpf) -> float:
    """Decimal digits that an error leaves of a number of that scale, from 0 to 16."""
    if not mpmath.isfinite(error):
        return 0.0
    return float(min(MOST, max(0.0, -mpmath.log10(error / scale)))) if error else MOST
