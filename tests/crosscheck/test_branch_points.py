"""Arguments of functions that branch: which count, and on which sides of zero they can be."""

import random

import pytest
import sympy as sp

from holonom.crosscheck.branches import RANGE, Branch, branches_of

X, Y = sp.symbols("x y", real=True)
Z = sp.Symbol("z")


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        (sp.Abs(X - 1) + sp.sign(Y), {Branch(X - 1), Branch(Y)}),
        (sp.log(X - 1), {Branch(X - 1, bounds_domain=True)}),
        (sp.sqrt(X + Y) + X ** sp.Rational(1, 3), {Branch(X + Y, bounds_domain=True), Branch(X, bounds_domain=True)}),
        (sp.exp(X), {Branch(X, is_growing=True)}),
        (X**3 + 1 / X + sp.sqrt(2) + sp.log(3), set()),
    ],
)
def test_branches_are_arguments_with_variables_of_functions_that_change(expression, expected):
    assert set(branches_of([expression])) == expected


@pytest.mark.parametrize("functions", [(sp.Abs, sp.log), (sp.exp, sp.log), (sp.exp, sp.Abs), (sp.Abs, sp.exp)])
def test_an_argument_counts_once_as_what_restricts_it_most(functions):
    found = branches_of([function(X) for function in functions])
    assert [each.argument for each in found] == [X]
    assert found[0].bounds_domain is (sp.log in functions)
    assert found[0].has_sides is not found[0].is_growing
    assert found[0].has_sides


def test_an_argument_and_its_negative_are_one():
    assert [each.argument for each in branches_of([sp.Abs(X - Y), sp.Abs(X - Y) + sp.sqrt(1 + X**2)])] == [
        X**2 + 1,
        X - Y,
    ]
    assert len(branches_of([sp.sqrt(X - Y), sp.log(Y - X)])) == 1


@pytest.mark.parametrize(
    ("argument", "sides"),
    [
        (X, []),
        (X**2 + 1, [-1]),
        (-(X**2), [1]),
        (2 + sp.sin(X), [-1]),
        (sp.cos(Y) - 3, [1]),
        (sp.sin(X) + sp.Rational(1, 2), []),
        (1 + sp.tanh(X), [-1]),
        (-1 / X**2, [1]),
        (1 / X**2 - sp.sin(Y), []),
        (sp.sin(Z) + 2, []),  # of a complex argument the sine is unbounded
        (sp.sqrt(X) ** 2 + 1, []),
        (1 + sp.log(X) ** 2, [-1]),
        (sp.Abs(X) - X, [-1]),
        (sp.Abs(X - 2 * Y) - X + 2 * Y, [-1]),
        (X * (1 + sp.sign(X)) / 2 + (1 - sp.sign(X)) / 4, [-1]),
        (-sp.Abs(X) - sp.Abs(Y) + Y, [1]),
        ((1 - sp.sign(X - 1)) * (1 + X) * (1 + sp.sign(X)) + sp.sign(X - 1) + 1, [-1]),
        (sp.Abs(X) - 2 * X, []),
        (sp.Abs(X) - 1, []),
        (sp.Abs(sp.sin(X)) - sp.sin(X), []),
    ],
)
def test_a_side_is_empty_only_where_it_is_known(argument, sides):
    branch = Branch(argument)
    assert [side for side in (-1, 1) if branch.is_empty(side)] == sides


def test_points_are_drawn_near_zero_and_of_growing_functions_in_a_range():
    draw = random.Random(1)
    assert {Branch(X).target(draw) for _ in range(9)} == {0}
    found = [Branch(X, is_growing=True).target(draw) for _ in range(200)]
    assert -RANGE <= min(found) < -RANGE / 2
    assert RANGE / 2 < max(found) <= RANGE
