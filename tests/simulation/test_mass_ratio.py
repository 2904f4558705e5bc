"""The difficulties of a motion, by its matrices."""

import numpy as np
import pytest

from holonom.simulation.hard_cases import _mass_ratio
from holonom.simulation.matrices import Matrices


@pytest.mark.parametrize(
    ("masses", "gradients", "ratio"),
    [
        ([4, 1], [], 4),
        ([4, 1, 0], [], 4),  # of the directions that carry mass
        ([4, 1, 0], [[0, 0, 1]], 4),
        ([4, 1, 0], [[1, 0, 0]], 1),
    ],
)
def test_the_mass_ratio_is_that_of_the_free_directions_if_the_mass_matrix_is_singular(masses, gradients, ratio):
    jacobian = np.reshape(gradients, (-1, len(masses))).astype(float)
    rows = np.zeros(len(jacobian))
    at = Matrices(np.diag(masses).astype(float), np.zeros(len(masses)), jacobian, rows, rows, rows, finite=True)
    assert _mass_ratio(at, np.ones(len(masses))) == pytest.approx(ratio)
