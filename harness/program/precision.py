"""Floating-point precisions of heyoka: double, extended, quadruple or more digits."""

import math
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from ..failures import ErrorKind, HolonomError
from ..language import translatable
from .heyoka_function import import_heyoka

GUARD_DIGITS = 10  # given and computed with beyond the digits asked for
MOST_DIGITS = 5000  # what heyoka compiles in about a second; twice as many take four times as long
EXPONENTS_OF_REAL = 2**61  # of MPFR's numbers
LEAST_BITS = 64  # what heyoka makes of an integer, whatever it computes with


@dataclass(frozen=True)
class Precision:
    """Floating-point numbers of one size."""

    name: str  # ``double``, ``extended``, ``quadruple`` or ``heyoka(D)``
    digits: int  # decimal digits that a number is written with
    sure_digits: int  # correct decimal digits of a rounded number
    highest_order: int  # of an expansion: its tolerance, exp(-2*order), is one of the numbers
    number: Callable[[str], Any]  # from decimal digits to a number
    text: Callable[[Any], str]  # from a number to decimal digits
    options: Mapping[str, Any]  # options of heyoka's integrators for the numbers

    @property
    def rounding(self) -> Any:
        """The distance of one to the next larger number."""
        one, two = self.number("1"), self.number("2")
        distance = one
        while one + distance / two != one:
            distance = distance / two
        return distance

    def numbers(self, values: Sequence[float]) -> Any:
        """Return floats as numbers of this precision.

        Parameters
        ----------
        values : sequence of float, shape (k,)
            The floats.

        Returns
        -------
        ndarray, shape (k,)
        """
        return np.array([self.number(repr(float(value))) for value in values])

    def ratio(self, value: Fraction) -> Any:
        """Return the number nearest to a rational one.

        Parameters
        ----------
        value : Fraction
            The rational number.

        Returns
        -------
        float, longdouble, real128 or real
            A number of this precision.
        """
        return self.number(str(value.numerator)) / self.number(str(value.denominator))


def read_precision(text: str) -> Precision:
    """Return the numbers that an option asks for.

    Parameters
    ----------
    text : str
        ``double``, ``extended``, ``quadruple``, or a number of decimal digits.

    Returns
    -------
    Precision

    Raises
    ------
    HolonomError
        heyoka is not installed, or it or this machine has no such numbers.
    """
    if text in HARDWARE:
        return HARDWARE[text]()
    if not text.isdecimal() or len(text) > len(str(MOST_DIGITS)) or not 1 <= int(text) <= MOST_DIGITS:
        raise HolonomError(
            ErrorKind.NOT_A_PRECISION,
            detail=translatable(
                "expected double, extended, quadruple, or from 1 to %(most)s digits, not %(text)s",
                text=text,
                most=MOST_DIGITS,
            ),
            option="--precision",
        )
    return _of_digits(int(text))


def _double() -> Precision:
    return _binary("double", 53, 1074, float, _scientific(17), {"fp_type": float})


def _extended() -> Precision:
    if np.finfo(np.longdouble).nmant != 63:
        raise HolonomError(
            ErrorKind.NOT_A_PRECISION, detail=translatable("extended precision is not available on this machine")
        )
    return _binary("extended", 64, 16445, np.longdouble, _scientific(21), {"fp_type": np.longdouble})


def _quadruple() -> Precision:
    real128 = import_heyoka().real128
    return _binary("quadruple", 113, 16494, real128, str, {"fp_type": real128})


def _of_digits(digits: int) -> Precision:
    import mpmath

    heyoka = import_heyoka()
    bits = max(LEAST_BITS, _bits(digits + GUARD_DIGITS))
    sys.set_int_max_str_digits(max(sys.get_int_max_str_digits(), 2 * (digits + GUARD_DIGITS)))

    def number(text: str) -> Any:
        return heyoka.real(text, bits)

    def rounded(x: Any) -> str:
        with mpmath.workprec(bits):
            return mpmath.nstr(mpmath.mpf(str(x)), digits, strip_zeros=False)

    options = {"fp_type": heyoka.real, "prec": bits}
    return Precision(f"heyoka({digits})", digits, digits, _highest_order(EXPONENTS_OF_REAL), number, rounded, options)


HARDWARE = {"double": _double, "extended": _extended, "quadruple": _quadruple}


def _binary(
    name: str,
    bits: int,
    exponents: int,
    number: Callable[[str], Any],
    text: Callable[[Any], str],
    options: Mapping[str, Any],
) -> Precision:
    """Binary floating-point numbers with a significand of that many bits."""
    digits, sure_digits = math.ceil(bits * math.log10(2)) + 1, math.floor((bits - 1) * math.log10(2))
    return Precision(name, digits, sure_digits, _highest_order(exponents), number, text, options)


def _highest_order(exponents: int) -> int:
    return int(exponents * math.log(2) / 2)


def _bits(digits: int) -> int:
    return math.ceil(digits * math.log2(10))


def _scientific(digits: int) -> Callable[[Any], str]:
    return lambda x: np.format_float_scientific(x, precision=digits - 1, unique=False)
