"""The times at which the matrix of sought controls loses rank, of one column and two rows."""

import numpy as np
import pytest

from holonom.program.precision import read_precision
from holonom.simulation.control_matrix import ControlMatrix
from holonom.simulation.engines.engine import Step
from holonom.simulation.zeros import SignedFunctions


class OneControl(ControlMatrix):
    def __init__(self, *rows):
        SignedFunctions.__init__(self, read_precision("double"), 3.0)
        self._shape, self._scale, self._of_time = (len(rows), 1), 1.0, rows

    def _matrices(self, times, states):
        return np.stack([row(times) for row in self._of_time], axis=1)[..., None] / self._scale


@pytest.mark.parametrize(
    ("rows", "lost"),
    [
        ((lambda t: 1 - t, lambda t: 4 + t), None),
        ((lambda t: 1 - t, lambda t: 2 - 2 * t), 1.0),
        ((lambda t: (1 - t) * (2 - t), lambda t: (4 - t) * (2 - t)), 2.0),
        ((lambda t: (1 - t) ** 2, lambda t: (1 - t) ** 2 * t), 1.0),
        ((lambda t: (1.5 - t) ** 2, lambda t: -((1.5 - t) ** 2)), 1.5),
        ((lambda t: (1 - t) ** 2 * (2 - t), lambda t: (2 - t) * t), 2.0),
        ((lambda t: (1 - t) ** 2 + 1e-6, lambda t: (1 - t) ** 2), None),
        ((lambda t: (1 - t) * t, lambda t: 2 * (1 - t) * t), 0.0),
        ((lambda t: 1 / (1 - t), lambda t: 1 / (4 + t)), None),
    ],
)
def test_rank_is_lost_when_all_rows_vanish_and_not_when_one_does(rows, lost):
    found = OneControl(*rows).lost(Step(0.0, 3.0, lambda times: np.zeros((2, len(times)))))
    assert found == (None if lost is None else pytest.approx(lost, rel=1e-8))


def test_the_rank_is_compared_with_that_nearby_alone():
    """The second row was large long ago."""
    late = OneControl(lambda t: 101 - t, lambda t: np.exp(80 - t))
    assert late.lost(Step(100.0, 103.0, lambda times: np.zeros((2, len(times))))) is None
