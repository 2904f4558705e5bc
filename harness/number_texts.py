"""Numbers that documents hold as texts, as mpmath's."""

import sys
from collections.abc import Iterable

import mpmath

SPARE_DIGITS = 11  # of a number longer than Python reads, beyond those that mpmath keeps


def number(text: str) -> mpmath.mpf:
    """Return the value of p/q or of decimal digits, rounded to the digits that mpmath works with."""
    numerator, _, denominator = text.partition("/")
    return _decimal(numerator) / _decimal(denominator or "1")


def numbers(texts: Iterable[str]) -> list[mpmath.mpf]:
    """Return the values of several."""
    return [number(text) for text in texts]


def _decimal(text: str) -> mpmath.mpf:
    """Of an integer longer than Python reads, the first digits, which are more than mpmath keeps."""
    kept = mpmath.mp.dps + SPARE_DIGITS
    if len(text) <= sys.int_info.default_max_str_digits or not text.lstrip("-").isdigit():
        return mpmath.mpf(text)
    return mpmath.mpf(text[:kept]) * mpmath.mpf(10) ** (len(text) - kept)
