"""Random points are in the domain of the functions where simple steps lead there."""

import pytest
import sympy as sp

from holonom.crosscheck.branches import branches_of
from holonom.crosscheck.draws import Draws

X, Y = sp.symbols("x y", real=True)


@pytest.mark.parametrize("bound", [X - 3, -X - 3, X - Y, X + Y - 2])
def test_nine_points_of_ten_are_in_the_domain_of_a_root(bound):
    """Of those that are drawn once a half or less are in it."""
    draws = Draws(["x", "y"], branches_of([sp.sqrt(bound)]), "a seed")
    points = [draws.point(attempt) for attempt in range(60)]
    assert sum(bool(bound.subs(point) >= 0) for point in points) >= 54


def test_points_are_drawn_on_a_side_that_few_numbers_are_on():
    draws = Draws(["x"], branches_of([sp.Abs(X - 10**12)]), "a seed")
    for attempt in range(8):
        draws.point(attempt)
    assert draws.sides_not_reached() == [f"{X - 10**12} is positive"]
    assert any(point[X] > 10**12 for point in draws.at_branches())
    assert draws.sides_not_reached() == []
