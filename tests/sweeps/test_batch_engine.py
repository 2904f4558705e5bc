"""The steps of motions that are integrated together."""

import numpy as np
import pytest

from holonom.sweeps.batch_engine import SHRUNK, _steps_taken


@pytest.mark.parametrize(("share", "is_steady"), [(1, True), (0.9 * SHRUNK, True), (1.1 * SHRUNK, False)])
def test_steps_that_shrink_suddenly_are_not_steady(share, is_steady):
    calm, shrinking = (None, 0.1, 0.2, 5), (None, 0.2 / share, 0.1, 7)  # the shortest, the longest, their number
    batches = [[[calm, calm], [calm, shrinking]], [[calm]]]  # two elements in two blocks of steps, one in one
    steady, shortest, taken = _steps_taken(batches)
    assert list(steady) == [True, is_steady, True]
    assert list(shortest) == [0.1, min(0.1, 0.2 / share), 0.1]
    assert np.array_equal(taken, [10, 12, 5])
