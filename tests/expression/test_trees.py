"""Trees that are shown."""

import pytest
from sympy import Integer, Rational, Symbol

from holonom.expression.mathjson import from_sympy, to_sympy
from holonom.expression.presentation import formula_text, presented
from holonom.expression.trees import with_decimals

LONG = Rational(-(10**60) - 1, 3 * 10**60)


def test_long_fractions_are_shown_as_decimals():
    decimal = {"num": "-0.333333333333"}
    assert with_decimals(["Add", "x", from_sympy(LONG)]) == ["Add", "x", decimal]
    assert with_decimals(presented(LONG)) == ["Negate", {"num": "0.333333333333"}]
    for readable in (from_sympy(Rational(1, 3)), presented(10**40 * Symbol("x", real=True) / 3), 10**40):
        assert with_decimals(readable) == readable


@pytest.mark.parametrize("size", [2**53 - 1, 2**53, 2**53 + 1, 398600441800000**3])
def test_integers_of_any_size_are_shown(size):
    x = Symbol("x", real=True)
    for shown in (Integer(size), -Integer(size), Rational(size, 10), Rational(3, size), size * x, x**size / size):
        assert to_sympy(presented(shown)) == shown
    assert formula_text(-size * x) == f"-{size}*x"
