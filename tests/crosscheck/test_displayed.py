"""The form in which an expression is displayed: sums, products with one sign, fractions, roots."""

from fractions import Fraction

import pytest

from holonom.crosscheck.displayed import displayed

MINUS_X = ["Multiply", -1, "x"]


@pytest.mark.parametrize(
    ("tree", "expected"),
    [
        (["Multiply", MINUS_X, "y"], ("-", displayed(["Multiply", "x", "y"]))),
        (["Multiply", MINUS_X, ["Multiply", -1, "y"]], displayed(["Multiply", "x", "y"])),
        (["Multiply", -2, MINUS_X], displayed(["Multiply", 2, "x"])),
        (["Multiply", ["Rational", 1, 2], "x"], ("/", "x", Fraction(2))),
    ],
)
def test_a_product_has_one_sign_before_it(tree, expected):
    assert displayed(tree) == expected
