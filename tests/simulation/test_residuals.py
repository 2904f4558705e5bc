"""Residuals of the constraints, as shares of the motion's sizes."""

import numpy as np
import pytest

from holonom.simulation.residuals import scaled_residual


@pytest.mark.parametrize("length", [1e-10, 1.0, 1e9])
@pytest.mark.parametrize(("at", "largest"), [(1.0, 1.0), (3.0, 2.4)])
def test_a_residual_is_the_distance_from_the_circle_in_units_of_its_size(length, at, largest):
    """Truth: a point at 1 + 1e-7 of the radius, which is as far away; beyond the size, of the coordinate."""
    radius = at * length
    q = radius * (1 + 1e-7) * np.array([0.6, -0.8])
    residual, jacobian = np.array([q @ q - radius**2]), 2 * q[None]
    found = scaled_residual(residual, jacobian, q, np.full(2, length))
    assert found == pytest.approx(at * 1e-7 / largest, rel=1e-6)
