"""Convert numbers that documents hold as texts to mpmath's."""

import sys
from collections.abc import Iterable

import mpmath

SPARE_DIGITS = 11  # of a number longer than Python reads, beyond those that mpmath keeps


def number(text: str) -> mpmath.mpf:
    """Return the value of a text in mpmath's working precision.

    Parameters
    ----------
    text : str
        p/q or decimal digits.

    Returns
    -------
    mpf
    """
    numerator, _, denominator = text.partition("/")
    return _decimal(numerator) / _decimal(denominator or "1")


def numbers(texts: Iterable[str]) -> list[mpmath.mpf]:
    """Return the values of several texts.

    Parameters
    ----------
    texts : iterable of str
        Each is p/q or decimal digits.

    Returns
    -------
    list of mpf
    """
    return [number(text) for text in texts]


def _decimal(text: str) -> mpmath.mpf:
    """Return the leading digits of an integer that is too long for Python to read.

    These are more than mpmath keeps.
    """
    digits = mpmath.mp.dps + SPARE_DIGITS
    if len(text) <= sys.int_info.default_max_str_digits or not text.lstrip("-").isdigit():
        return mpmath.mpf(text)
    return mpmath.mpf(text[:digits]) * mpmath.mpf(10) ** (len(text) - digits)
