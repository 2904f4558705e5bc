"""Zeros of functions along a motion, among rounding errors."""

import numpy as np

from holonom.program.precision import read_precision
from holonom.simulation.engines.engine import Block, Step
from holonom.simulation.zeros import SignedFunctions


class OneFunction(SignedFunctions):
    def __init__(self, function, span):
        super().__init__(read_precision("double"), span)
        self._rows, self._function = [("f", -1, 1)], function

    def values(self, times, states):
        return self._function(times)[None]


def first_crossing(dip):
    """The first one of a function that was one before it falls to a parabola of size 1e-12."""
    functions = OneFunction(lambda t: np.where(t < 1, 1.0, 1e-12 * (t - 1.53) ** 2 - dip), 1000.0)

    def states(times):
        return np.zeros((2, len(times)))

    block = Block([0.0, 1.0, 2.0], states)
    steps = [Step(start, start + 1, states, block=block) for start in (0.0, 1.0)]
    return next((found for step in steps if (found := functions.first_crossing(step, {}))), None)


def test_a_dip_within_the_rounding_of_what_a_function_was_is_no_zero():
    assert first_crossing(1e-16) is None
    assert first_crossing(1e-12).t < 2
