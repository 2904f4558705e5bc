"""Numbers that heyoka computes with: written with as many digits as it takes, and no more promised than they keep."""

from fractions import Fraction

import mpmath
import pytest
from refusing import failing

from holonom.failures import ErrorKind
from holonom.program.precision import MOST_DIGITS, read_precision


@pytest.mark.parametrize("name", ["double", "quadruple"])
def test_text_names_one_number(name):
    numbers = read_precision(name)
    third = numbers.ratio(Fraction(1, 3))
    assert numbers.number(numbers.text(third)) == third


@pytest.mark.parametrize(("name", "digits"), [("double", 15), ("quadruple", 33), ("50", 50)])
def test_sure_digits_are_right(name, digits):
    numbers = read_precision(name)
    assert numbers.sure_digits == digits
    with mpmath.workdps(digits + 20):
        error = abs(mpmath.mpf(numbers.text(numbers.ratio(Fraction(2, 3)))) * 3 / 2 - 1)
        assert error < mpmath.mpf(10) ** (1 - digits)


@pytest.mark.parametrize("text", ["", "0", "-3", "half", "1.5", str(MOST_DIGITS + 1), "9" * 5000])
def test_what_is_no_precision_is_refused(text):
    with failing(ErrorKind.NOT_A_PRECISION):
        read_precision(text)
