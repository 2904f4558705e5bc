"""Curves of a motion: those of unlike size have axes of their own, and no legend lies on them."""

import numpy as np
import pytest

from holonom.figures.curves import Panel, draw_curves
from holonom.figures.motion import _draw, of_like_size
from holonom.figures.style import figure_style, new_figure

TIMES = np.linspace(0, 1, 5)


def test_curves_of_unlike_size_have_axes_of_their_own():
    curves = {"angle": 0.01 * TIMES, "way": 40 * TIMES, "height": 7 * TIMES, "still": 0 * TIMES}
    assert [list(part) for part in of_like_size(curves)] == [["way", "height"], ["angle", "still"]]


@pytest.mark.parametrize("unit", [1e-12, 1.0, 1e12])
def test_units_do_not_change_the_axes(unit):
    curves = {"way": unit * TIMES, "turn": 1e-3 * unit * TIMES, "rounding": 1e-16 * unit * TIMES}
    assert [list(part) for part in of_like_size(curves)] == [["way"], ["turn", "rounding"]]


@pytest.mark.parametrize("value", [-6.25e-12, 9.81, 3e12])
def test_a_curve_that_is_constant_but_for_rounding_is_drawn_as_a_constant(value):
    with figure_style():
        axes = new_figure(4, 3).subplots()
        _draw(axes, TIMES, {"lambda1": value * (1 + 1e-14 * np.sin(9 * TIMES))}, {})
    low, high = axes.get_ylim()
    assert high - low > 0.05 * abs(value)
    assert low < value < high


def test_curves_of_like_size_share_their_axes():
    assert [list(part) for part in of_like_size({"a": TIMES, "b": 9 * TIMES})] == [["a", "b"]]


def test_a_multiplier_that_is_rounding_noise_is_drawn():
    assert [list(part) for part in of_like_size({"lambda1": 1e-17 * TIMES})] == [["lambda1"]]


def test_the_legend_is_above_the_panel():
    """In SVG y grows downwards: the label of the curve stands above the uppermost tick."""
    svg = draw_curves([Panel("height", {"the only curve": (TIMES, TIMES)})], "time")
    label = svg.index("the only curve")
    place = float(svg[:label].rpartition('y="')[2].partition('"')[0])
    ticks = [float(part.partition('"')[0]) for part in svg[:label].split('y="')[1:-1]]
    assert all(place < tick for tick in ticks)
