"""What is particular to the NumPy form: shapes."""

import numpy as np
import pytest
from programs import PENDULUM

from holonom.program.numpy_function import BLOCK, NumpyFunction


def test_inputs_are_broadcast_to_the_shape_of_the_points():
    x, y = np.linspace(-1, 1, 6).reshape(2, 3), np.full((2, 1), -2.0)
    accelerations = NumpyFunction(PENDULUM)([0.0, x, y, 0.0, 0.0, 9.81])
    assert accelerations.shape == (3, 2, 3)
    assert accelerations[2] == pytest.approx(9.81 * y / (x**2 + y**2))


def test_one_point_has_no_axis():
    assert NumpyFunction(PENDULUM)([0.0, 0.0, -1.0, 0.0, 0.0, 9.81]) == pytest.approx([0, 0, -9.81])


def test_blocks_join():
    x = np.linspace(1, 2, 2 * BLOCK + 1)
    multipliers = NumpyFunction(PENDULUM)([0.0, x, 0.0, 0.0, 1.0, 0.0])[2]
    assert multipliers == pytest.approx(-1 / x**2)


def test_no_points_give_no_values():
    assert NumpyFunction(PENDULUM)([np.empty(0), 0.0, -1.0, 0.0, 0.0, 9.81]).shape == (3, 0)


@pytest.mark.parametrize("count", [5, 7])
def test_more_or_fewer_inputs_are_refused(count):
    with pytest.raises(ValueError, match="needed"):
        NumpyFunction(PENDULUM)([1.0] * count)
