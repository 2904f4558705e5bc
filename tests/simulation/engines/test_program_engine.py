"""What the engines that take the motion program have in common: continuing, pieces, obstructions and ends."""

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from problems import problem
from refusing import failing

import holonom
from holonom.failures import ErrorKind
from holonom.program.motion_problem import motion_problem
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.simulation.engines.engine import Task, advance
from holonom.simulation.engines.program_engine import DECAYS_IN_A_RUN, FIRST_BLOCK, Obstruction
from holonom.simulation.engines.runge_kutta import RungeKuttaEngine
from holonom.simulation.engines.taylor import FINE_BLOCK, TaylorEngine
from holonom.simulation.hard_cases import Difficulty
from holonom.simulation.request import EngineName, SimulationRequest
from holonom.simulation.simulate import simulate

CLOSE = {TaylorEngine: 1e-12, RungeKuttaEngine: 1e-9}  # what two ways to a state may differ by
BURST = """
load("holonom.mac")$
body : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [growth = [6*x^2]], constraints = [])$
burst : holonomic_scene(body, initial_state = [x = 1, dot(x) = 2], time_span = [0, 2])$
"""


@pytest.fixture(params=[TaylorEngine, RungeKuttaEngine])
def engine(request):
    if request.param is RungeKuttaEngine:
        request.getfixturevalue("c_compiler")
    return request.param


def test_it_goes_on_from_where_it_is(engine):
    at_once, in_parts = (engine(Task.of(problem("chain.mac"))) for _ in range(2))
    advance(at_once, 2.0)
    for time in np.linspace(0.1, 2, 20):
        advance(in_parts, time)
    assert in_parts.time == 2.0
    assert in_parts.state == pytest.approx(at_once.state, abs=10 * CLOSE[engine])


def test_a_run_repeated_from_the_start_is_the_same_bit_by_bit(engine):
    motion = engine(Task.of(problem("chain.mac"), tol=1e-9))
    begin, start = motion.time, motion.state.copy()
    advance(motion, 2.0)
    first = motion.state.copy()
    motion.restart(begin, start)
    advance(motion, 2.0)
    assert (motion.state == first).all()


def test_pieces_join_and_hold_the_states_between(engine):
    motion, other = (engine(Task.of(problem("pendulum.mac"))) for _ in range(2))
    pieces = list(motion.integrate(100.0))
    assert len(pieces) == motion.steps > 2 * FIRST_BLOCK
    assert [pieces[0].start, pieces[-1].end] == [0, 100]
    for before, after in pairwise(pieces):
        assert before.end == after.start
        ends = before.states(np.array([before.end])), after.states(np.array([after.start]))
        assert ends[0] == pytest.approx(ends[1], abs=CLOSE[engine])
    middle = pieces[len(pieces) // 2]
    times = np.linspace(middle.start, middle.end, 4)
    advance(other, times[2])
    assert middle.states(times)[:, 2] == pytest.approx(other.state, abs=10 * CLOSE[engine])


def test_an_obstruction_leaves_the_last_good_state(engine):
    """Before a singular configuration of the linkage, where the rods' angle is a right one: the tips are at y = 0."""
    motion = engine(Task.of(problem("linkage.mac")))
    pieces = []
    with pytest.raises(Obstruction) as stopped:
        pieces.extend(motion.integrate(10.0))
    assert stopped.value.case is Difficulty.SINGULAR_CONFIGURATION
    assert pieces[-1].end == motion.time
    assert np.isfinite(motion.state).all()
    x, y = motion.state[:2]
    assert x**2 + y**2 == pytest.approx(1, abs=1e-14)
    assert 0 < y < 0.5


def test_a_motion_that_ends_in_finite_time_is_followed_to_there(engine, write_scene):
    """Truth: ddot(x) = 6 x^2 has the motion x = 1/(1 - t)^2, which ends at t = 1."""
    motion = engine(Task.of(motion_problem(write_scene(BURST), Request(), Limits())))
    with failing(ErrorKind.NO_WAY_ON):
        advance(motion, 2.0)
    assert motion.state[0] * (1 - motion.time) ** 2 == pytest.approx(1, rel=1e-3)


def test_behind_an_obstruction_the_way_to_the_next_one_was_gone_twice(monkeypatch):
    """A block of steps to the next dead centre shrank until it failed, and was taken back at each of them."""
    taken_back, go_back = [], TaylorEngine._go_back

    def counted(engine, time, state):
        if time < engine.time:
            taken_back.append(time)
        go_back(engine, time, state)

    monkeypatch.setattr(TaylorEngine, "_go_back", counted)
    report = simulate(problem("linkage.mac"), SimulationRequest(until=Fraction(5))).report
    assert sum(segment.engine is EngineName.ROBUST for segment in report.segments) > 3
    assert len(taken_back) == 1


def test_the_first_block_of_a_long_program_is_short():
    """Its steps are taken twice where it ends before a singular configuration."""
    short, long = (TaylorEngine(Task.of(problem("linkage.mac", N=bars))) for bars in ("1", "8"))
    assert long._first_block < short._first_block == FINE_BLOCK


@pytest.mark.parametrize("engine", ["taylor", pytest.param("runge-kutta", marks=pytest.mark.usefixtures("c_compiler"))])
def test_numbers_whose_squares_overflow_are_finite(engine):
    motion = holonom.system("""
system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2, constraints = [x - y])$
motion : holonomic_scene(system, initial_state = [x = 10^160, dot(x) = 10^158], time_span = [0, 10])$""")
    assert motion.simulate(samples=2, engine=engine)["y"][-1] == pytest.approx(1.1e160, rel=1e-12)


def test_stabilization_decays_as_often_in_every_span(write_scene):
    late = """
load("holonom.mac")$
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2)$
motion : holonomic_scene(system, initial_state = [x = 0, dot(x) = 1], time_span = [6, 10])$
"""
    motion = motion_problem(write_scene(late), Request(), Limits())
    engine = TaylorEngine(Task.of(motion)._replace(end=10.0))
    assert engine.decay == pytest.approx(DECAYS_IN_A_RUN / 4)
