"""Trees that are shown."""

from sympy import Rational, Symbol

from holonom.expression.mathjson import from_sympy
from holonom.expression.presentation import presented
from holonom.expression.trees import with_decimals

LONG = Rational(-(10**60) - 1, 3 * 10**60)


def test_long_fractions_are_shown_as_decimals():
    decimal = {"num": "-0.333333333333"}
    assert with_decimals(["Add", "x", from_sympy(LONG)]) == ["Add", "x", decimal]
    assert with_decimals(presented(LONG)) == ["Negate", {"num": "0.333333333333"}]
    for readable in (from_sympy(Rational(1, 3)), presented(10**40 * Symbol("x", real=True) / 3), 10**40):
        assert with_decimals(readable) == readable
