"""Looks at the steps of single motions."""

import numpy as np
import pytest

import holonom
from holonom.simulation.engines.engine import Step
from holonom.sweeps.single import _Look


def taken(quantity, start, end):
    """Middles, half lengths and coefficients of the parts of one step."""
    look = _Look(lambda mode, times, states: quantity(times)[None], 1, 0, [end], end - start)
    look.take(Step(start, end, lambda times: np.zeros((2, len(times)))))
    return look._taken


@pytest.mark.parametrize("rate", [1e3, 1e9])
def test_parts_were_cut_though_the_time_was_rounded(rate):
    """A step of three radians at t = 1: at 1e9 rad/s rounding of the time is 1e-7, and 4096 parts no better."""
    assert len(taken(lambda times: np.sin(rate * (times - 1)), 1.0, 1 + 3 / rate)) <= 16


def test_parts_of_a_step_are_as_short_as_a_quantity_needs():
    """Truth: the polynomials are the quantity, to 1e-9."""
    parts = taken(lambda times: np.tanh(100 * (times - 1.2)), 1.0, 2.0)
    assert sum(2 * half for _, half, _ in parts) == pytest.approx(1.0)
    for middle, half, (coefficients,) in parts:
        x = np.linspace(-1, 1, 9)
        assert np.polyval(coefficients[::-1], x) == pytest.approx(np.tanh(100 * (middle + half * x - 1.2)), abs=1e-9)


BOUNCING = """
system : holonomic_system(coordinates = [x, y], parameters = [c], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  potential_energy = 5000*y^2, forces = [if x > 0 then -c else -c - 10^8*x, 0])$
drops : holonomic_scene(system, parameter_values = [c = 1], time_span = [0, 3],
  initial_state = [x = 1, y = 1, dot(x) = 0, dot(y) = 0], observe = [trajectory, s = sqrt(x + 1/100)])$
"""


def test_an_output_without_a_value_beyond_the_next_switching_has_its_zeros():
    """A fall onto a stiff ground, with short steps of the other coordinate; their block falls through the ground."""
    found = holonom.sweep(holonom.system(BOUNCING), values={"c": [1, 2]}, keep=["zero(s - 1/4)"]).to_pandas()
    truth = np.sqrt(2 * (1 - (1 / 16 - 1 / 100)) / found["c"])
    assert list(found["zero(s-1/4)"]) == pytest.approx(list(truth), rel=1e-11)
