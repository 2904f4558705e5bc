"""The functions whose signs decide the form of an expression."""

import pytest

from holonom.crosscheck.switches import switching_functions

A, B = ["Subtract", "t", 1], ["Subtract", "x", "t"]


@pytest.mark.parametrize(
    ("tree", "found"),
    [
        (["Which", ["Greater", "t", 1], "x", "True", 0], [A]),
        (["Which", ["And", ["Less", "t", 1], ["Not", ["GreaterEqual", "x", "t"]]], 1, "True", 2], [A, B]),
        (["Max", "t", 1], [A]),
        (["Add", ["Sign", "x"], ["Multiply", 2, ["Abs", ["Sign", "t"]]]], ["x", ["Sign", "t"], "t"]),
        (["Sin", "t"], []),
    ],
)
def test_functions_of_conditions_extremes_and_signs_are_found(tree, found):
    assert list(switching_functions(tree)) == found
