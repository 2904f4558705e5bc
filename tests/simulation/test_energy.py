"""Residuals, condition and energy balance, against closed forms."""

from fractions import Fraction

import numpy as np
import pytest
from problems import problem

import holonom
from holonom.program.motion_problem import motion_problem
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.simulation.energy import EnergyBalance
from holonom.simulation.engines.engine import Task
from holonom.simulation.engines.robust import RobustEngine
from holonom.simulation.matrices import Matrices, MotionMatrices
from holonom.simulation.nominal import Nominal
from holonom.simulation.request import SimulationRequest
from holonom.simulation.residuals import condition, residuals
from holonom.simulation.simulate import simulate


def balance_of(motion: RobustEngine, asked) -> EnergyBalance:
    return EnergyBalance(asked, lambda times, states: motion.solutions(times, states).multipliers)


def simulated(asked, until: float):
    """Energy gained and work done along a motion."""
    motion = RobustEngine(Task.of(asked, tol=1e-12))
    balance = balance_of(motion, asked)
    start = balance.energy(np.array([motion.time]), motion.state[:, None])[0]
    starts, ends, between = [], [], []
    for piece in motion.integrate(until):
        inside = balance.times_between([piece.start], [piece.end])
        starts, ends = [*starts, piece.start], [*ends, piece.end]
        between += [(inside, piece.states(inside))] if len(inside) else []
    work = sum(balance.works(np.array(starts), np.array(ends), between)[0])
    return balance.energy(np.array([motion.time]), motion.state[:, None])[0] - start, work, balance


def test_a_table_that_rises_does_the_work_of_the_weight(particle_scene):
    gained, work, balance = simulated(motion_problem(particle_scene, Request(), Limits()), 1.5)
    assert not balance.conservative
    assert work == pytest.approx(2 * 9.81 * 1.5, rel=1e-13)  # m g u, the table rising by u = t
    assert gained == pytest.approx(work, rel=1e-13)


@pytest.mark.parametrize(
    ("name", "scene", "until"),
    [
        ("paper/paper", "free_motion_scene", 3.0),
        ("paper/paper", "initial_motion_scene", 3.0),
        ("pendulum", "lengthening_scene", 2.0),
        ("chain", None, 1.0),
        ("bead", "driven_scene", 2.0),
        ("whirling_bob", None, 1.0),
    ],
)
def test_energy_gained_is_work_done(name, scene, until):
    gained, work, balance = simulated(problem(f"{name}.mac", scene), until)
    assert not balance.conservative
    assert abs(gained) > 1e-3
    assert abs(gained - work) <= 1e-9 * max(1.0, abs(gained))


@pytest.mark.parametrize(("precision", "digits"), [("extended", 17), ("quadruple", 31), ("50", 55)])
def test_work_is_integrated_in_the_digits_of_the_motion(precision, digits, write_scene):
    """With nodes and weights in double precision the energy was missed by 1e-14 in any."""
    scene = write_scene("""load("holonom.mac")$
      system : holonomic_system(coordinates = [x], controls = [u], kinetic_energy = dot(x)^2/2,
        potential_energy = x^2/2, forces = [push = [u - dot(x)/10]])$
      run : holonomic_scene(system, control_law = [u = cos(3*t)], initial_state = [x = 1, dot(x) = 0],
        time_span = [0, 5])$""")
    report = holonom.load(scene).simulate(precision=precision).report
    assert abs(report.energy_error) < 10.0**-digits


def test_work_of_a_control_was_integrated_by_the_points_of_a_step_as_long_as_the_state_is_smooth():
    """The bob stays upright, its support is shaken ten times a second: energy and work are those of the support."""
    report = simulate(problem("shaken_pendulum.mac", "upright_scene"), SimulationRequest(samples=7)).report
    assert report.steps == 1
    assert report.trusted


def test_rounding_errors_of_a_power_were_resolved_in_a_thousand_parts_a_step(monkeypatch):
    """At the start no reaction does work: 4000 powers of 1e-16 were computed for the first two steps."""
    computed, power = [], EnergyBalance._power
    monkeypatch.setattr(EnergyBalance, "_power", lambda *given: computed.append(1) or power(*given))
    wanted = SimulationRequest(engine="robust", samples=0, until=Fraction(1, 4))
    report = simulate(problem("hard/swing.mac", "opening_scene"), wanted).report
    assert len(computed) <= 20 * report.steps
    assert report.trusted


def test_where_nothing_does_work_the_energy_stays():
    gained, work, balance = simulated(problem("linkage.mac"), 2.0)
    assert balance.conservative
    assert work == 0
    assert abs(gained) <= 1e-10


@pytest.mark.parametrize("relation", ["y - 2*x", "dot(x) - 3*x", "dot(y) - 4*x", "2*dot(x) - 3*y", "dot(x) - x - y"])
def test_the_states_that_show_power_were_multiples_of_one_another(relation):
    scene = holonom.system(f"""system : holonomic_system(coordinates = [x, y],
        kinetic_energy = (dot(x)^2 + dot(y)^2)/2, potential_energy = x^2/2, forces = [push = [0, {relation}]])$
      run : holonomic_scene(system, initial_state = [x = 1, y = 0, dot(x) = 0, dot(y) = 0], time_span = [0, 1])$""")
    report = scene.simulate(samples=2).report
    assert report.trusted
    assert abs(report.energy_error) < 1e-13


def test_damping_takes_its_power():
    paper = problem("paper/paper.mac", "free_motion_scene")
    balance = balance_of(RobustEngine(Task.of(paper)), paper)
    state = np.array([1.0, 2.0, 0.9, 0.5, -1 / 3, 0.95])
    # conservative forces are in Q here, too: Q.v = -(q1 + q2) v1 - 2 (v1 + v2) v2, and no reaction along a free motion
    expected = -3 * 0.5 - 2 * (0.5 - 1 / 3) * (-1 / 3)
    assert balance._power(np.array([0.0]), state[:, None])[0] == pytest.approx(expected, rel=1e-12)


def test_a_residual_is_the_distance_from_the_constraint():
    pendulum = problem("pendulum.mac", "swing_scene")
    matrices = MotionMatrices(pendulum)
    state = np.array([float(pendulum.start[name]) for name in pendulum.state])
    n = len(pendulum.coordinates)
    outwards = state[:n] / np.linalg.norm(state[:n])
    state[:n] += 1e-7 * outwards
    state[n:] += 1e-5 * outwards
    left = residuals(matrices(0.0, state), state, np.zeros(n), Nominal(1.0, np.ones(2 * n)))
    assert left["position"] == pytest.approx(1e-7, rel=1e-6)
    assert left["velocity"] == pytest.approx(1e-5, rel=1e-6)


def test_a_steep_constraint_weighs_no_more_than_a_flat_one():
    def at(factor: float) -> Matrices:
        row, left = np.array([[3.0, 4.0]]), np.array([1e-6])
        return Matrices(np.eye(2), np.zeros(2), factor * row, factor * left, factor * left, factor * left, True)

    sizes = Nominal(1.0, np.ones(4))
    found = [residuals(at(factor), np.ones(4), np.ones(2), sizes) for factor in (1.0, 1e200, 1e-200)]
    assert found[0]["position"] == pytest.approx(2e-7)
    assert all(other[name] == pytest.approx(found[0][name]) for other in found for name in found[0])


@pytest.mark.parametrize("angle", [1.0, 1e-3, 1e-6])
def test_condition_of_two_constraints_at_an_angle(angle):
    jacobian = np.array([[1.0, 0.0], [1e5 * np.cos(angle), 1e5 * np.sin(angle)]])
    zeros = np.zeros(2)
    at = Matrices(np.eye(2), zeros, jacobian, zeros, zeros, zeros, True)
    assert condition(at) == pytest.approx(1 / np.tan(angle / 2) ** 2, rel=1e-8)


def test_condition_of_dependent_constraints_has_no_bound():
    zeros = np.zeros(2)
    at = Matrices(np.eye(2), zeros, np.array([[1.0, 2.0], [2.0, 4.0]]), zeros, zeros, zeros, True)
    assert condition(at) > 1e30
