"""Control laws as the cross-check computes them."""

from math import factorial

import pytest
from mpmath import mp
from scipy.interpolate import CubicSpline

from holonom.crosscheck.irregular_point import IrregularPoint
from holonom.crosscheck.law import Spline
from holonom.description import Table

TIMES, HEIGHTS = (0, 1, 3, 4), (2, -1, 5, 0)


@pytest.mark.parametrize(("ends", "condition"), [(None, "natural"), ((1, -2), ((1, 1), (1, -2)))])
def test_a_table_is_scipys_cubic_spline(ends, condition):
    found = Spline(Table(points=tuple(zip(TIMES, HEIGHTS, strict=True)), ends=ends))
    expected = CubicSpline(TIMES, HEIGHTS, bc_type=condition)
    for time in (0, 0.5, 1, 2.25, 3.75):
        polynomial = [float(expected(time, k)) / factorial(k) for k in range(4)]
        assert list(map(float, found.at(mp.mpf(time)))) == pytest.approx(polynomial)


@pytest.mark.parametrize("time", [-1, 4, 5])
def test_a_table_has_no_value_outside(time):
    with pytest.raises(IrregularPoint):
        Spline(Table(points=((0, 2), (4, 1)), ends=None)).at(mp.mpf(time))
