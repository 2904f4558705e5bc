"""Steps that miss a force of the state are repeated; truths by SciPy with short steps."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import holonom

SMOOTH_FRICTION = """
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [3/2*sin(t) - tanh({k}*dot(x))])$
scene : holonomic_scene(system, initial_state = [x = 0, dot(x) = 0], time_span = [0, 10])$
"""
SOFT_WALL = """
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [1000*exp(-200*x) - 1])$
scene : holonomic_scene(system, initial_state = [x = 1, dot(x) = 0], time_span = [0, 20])$
"""


@pytest.mark.parametrize("engine", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("k", [100, 10_000])
def test_friction_that_is_smoothed(k, engine):
    def slope(t, state):
        return state[1], 1.5 * np.sin(t) - np.tanh(k * state[1])

    found = holonom.system(SMOOTH_FRICTION.format(k=k)).simulate(engine=engine, samples=2).report
    truth = solve_ivp(slope, (0, 10), (0, 0), method="LSODA", rtol=1e-10, atol=1e-13, max_step=1 / k**0.5).y[:, -1]
    assert found.trusted
    assert [found.coordinates["x"], found.velocities["dot(x)"]] == pytest.approx(truth, rel=1e-7)


BOUNCE = """
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [-tanh({k}*x)])$
scene : holonomic_scene(system, initial_state = [x = 1, dot(x) = 0], time_span = [0, 20])$
"""


@pytest.mark.parametrize("k", [10**6, 10**7, 10**8])
def test_a_step_that_ended_just_behind_a_place_did_not_show_its_force(k):
    """Truth: without the layer, from x = 1 the place is (1 - s^2/2) by turns, s the time to the last turn."""
    found = holonom.system(BOUNCE.format(k=k)).simulate(samples=2).report
    turns, rest = divmod(20 / 8**0.5 + 0.5, 1.0)
    expected = (1 - (8**0.5 * (rest - 0.5)) ** 2 / 2) * (-1) ** turns
    assert found.coordinates["x"] == pytest.approx(expected, abs=20 / k)


@pytest.mark.parametrize("end", [10, 100])
def test_the_end_of_a_span_with_a_shortened_step_ahead_was_an_internal_error(end):
    scene = holonom.system("""
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2,
  forces = [-x - 3/10*tanh(20*dot(x)) + max(0, min(x, 1/2))^(3/2) - erf(20*x)/20 + 2*sin(3*t)])$
scene : holonomic_scene(system, initial_state = [x = 5, dot(x) = 0])$""")
    assert scene.simulate(until=end, samples=2).report.trusted


def test_a_soft_wall_and_the_gravity_that_leads_to_it():
    def slope(t, state):
        return state[1], 1000 * np.exp(-200 * state[0]) - 1

    found = holonom.system(SOFT_WALL).simulate(samples=2).report
    truth = solve_ivp(slope, (0, 20), (1, 0), method="DOP853", rtol=1e-12, atol=1e-14, max_step=0.02).y[:, -1]
    assert found.trusted
    assert [found.coordinates["x"], found.velocities["dot(x)"]] == pytest.approx(truth, rel=1e-8)


def test_more_digits_of_a_soft_wall_are_right():
    scene = holonom.system("""
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, potential_energy = x^2/2,
  forces = [exp(-1000*(x - 1/2))])$
scene : holonomic_scene(system, initial_state = [x = 1, dot(x) = 0], time_span = [0, 2])$""")
    extended, quadruple = (scene.simulate(precision=each, samples=2).report for each in ("extended", "quadruple"))
    assert abs(float(quadruple.energy_error)) < 1e-31
    error = float(quadruple.coordinates["x"] - type(quadruple.coordinates["x"])(str(extended.coordinates["x"])))
    assert abs(error) < 1e-17
