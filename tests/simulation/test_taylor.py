"""What is particular to the Taylor engine: blocks, rolling back, the choice of code."""

from itertools import pairwise

import numpy as np
import pytest
from problems import problem

from harness.confined import Limits
from harness.failures import HolonomError
from harness.motion.precision import read_precision
from harness.motion.problem import motion_problem
from harness.motion.request import Request
from harness.simulation.code import Code, better_code, pays
from harness.simulation.constraint_keeper import ConstraintKeeper
from harness.simulation.program_motion import ProgramObstacle
from harness.simulation.request import Drift
from harness.simulation.taylor import TaylorMotion


def test_code_is_better_where_a_run_earns_it():
    """What is compiled first is compiled quickly; better code pays for long runs, and in hardware numbers only."""
    assert TaylorMotion(problem("pendulum.mac")).code is Code.QUICK
    assert TaylorMotion(problem("pendulum.mac"), compact=True).code is Code.COMPACT
    assert TaylorMotion(problem("pendulum.mac"), compact=False).code is Code.UNROLLED
    long = TaylorMotion(problem("pendulum.mac", "swing_scene"))
    long.advance(20000.0)
    assert long.code is not Code.QUICK
    assert not pays(Code.COMPACT, 20, 1e-3)
    assert pays(Code.COMPACT, 20, 10.0)
    assert not pays(Code.UNROLLED, 500, 10.0)
    assert better_code(Code.QUICK, read_precision("quadruple")) is None


@pytest.mark.parametrize("compact", [None, True, False])
def test_the_code_does_not_change_the_motion(compact):
    motion = TaylorMotion(problem("car_axis.mac"), compact=compact)
    motion.advance(1.0)
    other = TaylorMotion(problem("car_axis.mac"), drift=Drift.NONE, compact=True)
    other.advance(1.0)
    assert motion.state == pytest.approx(other.state, abs=1e-11)


def test_it_goes_on_from_where_it_is():
    at_once, in_parts = (TaylorMotion(problem("chain.mac")) for _ in range(2))
    at_once.advance(2.0)
    for instant in np.linspace(0.1, 2, 20):
        in_parts.advance(instant)
    assert in_parts.time == 2.0
    assert in_parts.state == pytest.approx(at_once.state, abs=1e-11)


def test_pieces_join_and_hold_the_states_between():
    motion, other = TaylorMotion(problem("pendulum.mac")), TaylorMotion(problem("pendulum.mac"))
    pieces = list(motion.pieces(10.0))
    assert len(pieces) == motion.steps
    assert [pieces[0].start, pieces[-1].end] == [0, 10]
    for before, after in pairwise(pieces):
        assert before.end == after.start
        ends = before.states(np.array([before.end])), after.states(np.array([after.start]))
        assert ends[0] == pytest.approx(ends[1], abs=1e-12)
    middle = pieces[len(pieces) // 2]
    instant = (middle.start + middle.end) / 2
    other.advance(instant)
    assert middle.states(np.array([instant]))[:, 0] == pytest.approx(other.state, abs=1e-12)


def test_an_obstacle_leaves_the_last_good_state():
    """Before a singular configuration of the linkage, where the rods' angle is a right one: the tips are at y = 0."""
    motion = TaylorMotion(problem("linkage.mac"))
    pieces = []
    with pytest.raises(ProgramObstacle):
        pieces.extend(motion.pieces(10.0))
    assert pieces[-1].end == motion.time
    assert np.isfinite(motion.state).all()
    x, y = motion.state[:2]
    assert x**2 + y**2 == pytest.approx(1, abs=1e-14)
    assert 0.05 < y < 0.5


def test_a_motion_that_ends_in_finite_time_is_followed_to_there(write_scene):
    """Truth: ddot(x) = 6 x^2 has the motion x = 1/(1 - t)^2, which ends at t = 1."""
    scene = write_scene("""
load("holonom.mac")$
body : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [growth = [6*x^2]], constraints = [])$
burst : holonomic_scene(body, initial_state = [x = 1, dot(x) = 2], time_span = [0, 2])$
""")
    motion = TaylorMotion(motion_problem(scene, Request(), Limits()))
    with pytest.raises(HolonomError, match=r"beyond t = 0\.99999.*, where steps become too short"):
        motion.advance(2.0)
    assert motion.state[0] * (1 - motion.time) ** 2 == pytest.approx(1, rel=1e-3)


@pytest.mark.parametrize("precision", ["double", "extended", "quadruple", "50"])
def test_projection_is_quadratic_in_what_is_amiss(precision):
    """Truth: Newton's method squares an error of 1e-6 to one below 1e-11, and repeated, to rounding."""
    numbers = read_precision(precision)
    motion = problem("pendulum.mac", "swing_scene", 50)
    state = np.array([numbers.number(motion.start[name]) for name in motion.state])
    state[1] += numbers.number("1e-6")
    keeper, start = ConstraintKeeper(motion, numbers), numbers.number("0")
    keeper.project(start, state)
    assert 1e-15 < abs(float(state[0] ** 2 + state[1] ** 2 - numbers.number("1"))) < 1e-11
    for _ in range(3):
        keeper.project(start, state)
    assert abs(float(state[0] ** 2 + state[1] ** 2 - numbers.number("1"))) < 10.0 ** (1 - numbers.sure_digits)
