"""What is particular to the Taylor engine: blocks, rolling back, the choice of code."""

import numpy as np
import pytest
from problems import problem

from holonom.program.precision import read_precision
from holonom.simulation.constraints.program_projection import ProgramProjection
from holonom.simulation.engines.code import Code, better_code, pays
from holonom.simulation.engines.taylor import TaylorEngine
from holonom.simulation.matrices import MotionMatrices
from holonom.simulation.request import Stabilization


def test_code_is_better_where_a_run_earns_it():
    """What is compiled first is compiled quickly; better code pays for long runs, and in hardware numbers only."""
    assert TaylorEngine(problem("pendulum.mac")).code is Code.QUICK
    assert TaylorEngine(problem("pendulum.mac"), compact=True).code is Code.COMPACT
    assert TaylorEngine(problem("pendulum.mac"), compact=False).code is Code.UNROLLED
    long = TaylorEngine(problem("pendulum.mac", "swing_scene"))
    long.advance(20000.0)
    assert long.code is not Code.QUICK
    assert not pays(Code.COMPACT, 20, 1e-3)
    assert pays(Code.COMPACT, 20, 10.0)
    assert not pays(Code.UNROLLED, 500, 10.0)
    assert better_code(Code.QUICK, read_precision("quadruple")) is None


@pytest.mark.parametrize("compact", [None, True, False])
def test_the_code_does_not_change_the_motion(compact):
    motion = TaylorEngine(problem("car_axis.mac"), compact=compact)
    motion.advance(1.0)
    other = TaylorEngine(problem("car_axis.mac"), drift=Stabilization.NONE, compact=True)
    other.advance(1.0)
    assert motion.state == pytest.approx(other.state, abs=1e-11)


@pytest.mark.parametrize("precision", ["double", "extended", "quadruple", "50"])
def test_projection_is_quadratic_in_what_is_amiss(precision):
    """Truth: Newton's method squares an error of 1e-6 to one below 1e-11, and repeated, to rounding."""
    numbers = read_precision(precision)
    motion = problem("pendulum.mac", "swing_scene", 50)
    state = np.array([numbers.number(motion.start[name]) for name in motion.state])
    state[1] += numbers.number("1e-6")
    keeper, start = ProgramProjection(motion, numbers, MotionMatrices(motion)), numbers.number("0")
    keeper.project(start, state)
    assert 1e-15 < abs(float(state[0] ** 2 + state[1] ** 2 - numbers.number("1"))) < 1e-11
    for _ in range(3):
        keeper.project(start, state)
    assert abs(float(state[0] ** 2 + state[1] ** 2 - numbers.number("1"))) < 10.0 ** (1 - numbers.sure_digits)
