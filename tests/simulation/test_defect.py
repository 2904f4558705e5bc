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


def test_a_soft_wall_and_the_gravity_that_leads_to_it():
    def slope(t, state):
        return state[1], 1000 * np.exp(-200 * state[0]) - 1

    found = holonom.system(SOFT_WALL).simulate(samples=2).report
    truth = solve_ivp(slope, (0, 20), (1, 0), method="DOP853", rtol=1e-12, atol=1e-14, max_step=0.02).y[:, -1]
    assert found.trusted
    assert [found.coordinates["x"], found.velocities["dot(x)"]] == pytest.approx(truth, rel=1e-8)
