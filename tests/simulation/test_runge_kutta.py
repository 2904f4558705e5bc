"""What is particular to the Runge-Kutta engine: compiled steps, states between them, the constraints kept in C."""

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from problems import problem

from harness.confined import Limits
from harness.failures import Failure, HolonomError
from harness.motion.problem import motion_problem
from harness.motion.request import Request
from harness.simulation import prince_dormand
from harness.simulation.program_motion import ProgramObstacle
from harness.simulation.request import Drift, Engine, SimulationRequest
from harness.simulation.runge_kutta import RungeKuttaMotion
from harness.simulation.simulate import simulate
from harness.simulation.taylor import TaylorMotion

THROWN = """
load("holonom.mac")$
body : holonomic_system(coordinates = [x, z], kinetic_energy = (dot(x)^2 + dot(z)^2)/2, potential_energy = 10*z,
  constraints = [])$
flight : holonomic_scene(body, initial_state = [x = 0, z = 0, dot(x) = 1, dot(z) = 5], time_span = [0, 1])$
"""
BURST = """
load("holonom.mac")$
body : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [growth = [6*x^2]], constraints = [])$
burst : holonomic_scene(body, initial_state = [x = 1, dot(x) = 2], time_span = [0, 2])$
"""

pytestmark = pytest.mark.usefixtures("gsl")


def test_a_parabola_is_followed_to_rounding(write_scene):
    """Truth: a method of order 8 is exact for polynomials of degree 2, and the first step reaches the end."""
    motion = RungeKuttaMotion(motion_problem(write_scene(THROWN), Request(), Limits()), 1e-6)
    motion.advance(1.0)
    assert motion.state == pytest.approx([1, 0, 1, -5], abs=1e-13)


def test_the_error_follows_the_tolerance():
    """Truth: the pendulum of the Taylor engine at rounding; six powers of ten in the tolerance are six in the error."""
    true = TaylorMotion(problem("pendulum.mac"))
    true.advance(10.0)
    errors = []
    for tol in (1e-4, 1e-7, 1e-10):
        motion = RungeKuttaMotion(problem("pendulum.mac"), tol)
        motion.advance(10.0)
        errors.append(np.abs(motion.state - true.state).max())
    assert errors[2] < 1e-9
    assert 1e2 < errors[0] / errors[1] < 1e5
    assert 1e2 < errors[1] / errors[2] < 1e5


def test_projection_keeps_the_constraints_that_a_coarse_tolerance_loses():
    def missed(drift):
        motion = RungeKuttaMotion(problem("pendulum.mac", "swing_scene"), 1e-5, drift)
        motion.advance(50.0)
        (x, y), (vx, vy) = motion.state[:2], motion.state[2:]
        return max(abs(x**2 + y**2 - 1), abs(x * vx + y * vy))

    assert missed(Drift.PROJECTION) < 1e-14
    assert missed(Drift.NONE) > 1e-6


def test_it_goes_on_from_where_it_is():
    at_once, in_parts = (RungeKuttaMotion(problem("chain.mac")) for _ in range(2))
    at_once.advance(2.0)
    for instant in np.linspace(0.1, 2, 20):
        in_parts.advance(instant)
    assert in_parts.time == 2.0
    assert in_parts.state == pytest.approx(at_once.state, abs=1e-10)


def test_a_run_repeated_from_the_start_is_the_same_bit_by_bit():
    motion = RungeKuttaMotion(problem("chain.mac"), 1e-9)
    begin, start = motion.time, motion.state.copy()
    motion.advance(2.0)
    first = motion.state.copy()
    motion.restart(begin, start)
    motion.advance(2.0)
    assert (motion.state == first).all()


def test_pieces_join_and_hold_the_states_between():
    motion, other = (RungeKuttaMotion(problem("pendulum.mac"), 1e-11) for _ in range(2))
    pieces = list(motion.pieces(100.0))
    assert len(pieces) == motion.steps > 3 * 128
    assert [pieces[0].start, pieces[-1].end] == [0, 100]
    for before, after in pairwise(pieces):
        assert before.end == after.start
        ends = before.states(np.array([before.end])), after.states(np.array([after.start]))
        assert ends[0] == pytest.approx(ends[1], abs=1e-9)
    middle = pieces[len(pieces) // 2]
    instants = np.linspace(middle.start, middle.end, 4)
    other.advance(instants[2])
    assert middle.states(instants)[:, 2] == pytest.approx(other.state, abs=1e-8)
    other.advance(100.0)
    assert motion.state == pytest.approx(other.state, abs=1e-7)


def test_an_obstacle_leaves_the_last_good_state():
    """Before a singular configuration of the linkage, where the rods' angle is a right one: the tips are at y = 0."""
    motion = RungeKuttaMotion(problem("linkage.mac"))
    with pytest.raises(ProgramObstacle, match="nears a singular one"):
        motion.advance(10.0)
    x, y = motion.state[:2]
    assert x**2 + y**2 == pytest.approx(1, abs=1e-14)
    assert 0 < y < 0.5


def test_a_motion_that_ends_in_finite_time_is_followed_to_there(write_scene):
    """Truth: ddot(x) = 6 x^2 has the motion x = 1/(1 - t)^2, which ends at t = 1."""
    motion = RungeKuttaMotion(motion_problem(write_scene(BURST), Request(), Limits()))
    with pytest.raises(HolonomError, match=r"beyond t = 0\.999.*, where"):
        motion.advance(2.0)
    assert np.isfinite(motion.state).all()
    assert motion.state[0] * (1 - motion.time) ** 2 == pytest.approx(1, rel=1e-3)


def test_the_work_of_a_control_is_balanced():
    """Truth: energy; the car axis' road does work on it all the time."""
    request = SimulationRequest(1e-11, engine=Engine.RUNGE_KUTTA, samples=0)
    report = simulate(problem("car_axis.mac"), request).report
    assert abs(report.energy_error) < 1e-11
    assert report.engine == "runge-kutta"
    assert report.code == ""


@pytest.mark.parametrize(
    ("request_", "said"),
    [
        (SimulationRequest(1e-15), "holds tolerances from 1e-14 to 1, not 1e-15"),
        (SimulationRequest(precision="quadruple"), "computes in double precision, not quadruple"),
        (SimulationRequest(drift=Drift.GGL), "no cure of drift named ggl"),
    ],
)
def test_what_it_lacks_is_refused(request_, said):
    wanted = SimulationRequest(
        request_.tol, request_.precision, Engine.RUNGE_KUTTA, request_.drift, until=Fraction(1), samples=0
    )
    with pytest.raises(HolonomError, match=said):
        simulate(problem("pendulum.mac"), wanted)


def test_a_missing_library_is_named(monkeypatch):
    monkeypatch.setattr(prince_dormand.shutil, "which", lambda _: None)
    with pytest.raises(HolonomError, match="needs the GNU Scientific Library.*libgsl-dev") as refusal:
        RungeKuttaMotion(problem("pendulum.mac"))
    assert refusal.value.failure is Failure.GSL_MISSING
