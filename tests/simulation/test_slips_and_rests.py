"""Friction of the speed, and of corners that touch down: truth by slips and rests one after the other."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import holonom

BLOCK = """
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2,
  forces = [5*sin(t) - 4*x - ({law})*signum(dot(x))])$
scene : holonomic_scene(system, initial_state = [x = 0, dot(x) = 0], time_span = [0, 10])$
"""
LAWS = {
    "2 + exp(-10*abs(dot(x)))": lambda v: 2 + np.exp(-10 * abs(v)),
    "2 + abs(dot(x))": lambda v: 2 + abs(v),
    "3 - abs(dot(x))/(1 + abs(dot(x)))": lambda v: 3 - abs(v) / (1 + abs(v)),
}


def slipped_and_rested(friction, end):
    """The place at the end, and the times at which the block begins to slip and to rest."""

    def push(t, x):
        return 5 * np.sin(t) - 4 * x

    def stops(t, state, side):
        return state[1]

    stops.terminal = True
    t, x, times = 0.0, 0.0, []
    while t < end:
        later = np.linspace(t, end, 100_001)
        slips = np.flatnonzero(abs(push(later, x)) > friction(0) * (1 + 1e-12))
        if not len(slips):
            break
        if slips[0] > 1:
            t = brentq(lambda at, x=x: abs(push(at, x)) - friction(0), *later[slips[0] - 1 : slips[0] + 1])
            times.append(t)
        elif times:
            times.pop()
        side = np.sign(push(later[slips[0]], x))
        stops.direction = -side
        way = solve_ivp(
            lambda t, state, side: (state[1], push(t, state[0]) - friction(state[1]) * side),
            (t, end), (x, side*1e-14), args=(side,), events=stops,
            method="DOP853", rtol=1e-11, atol=1e-13, max_step=0.01,
        )  # fmt: skip
        t, x = way.t[-1], way.y[0, -1]
        times += [t] if t < end else []
    return x, times


@pytest.mark.parametrize("law", LAWS)
def test_friction_of_the_speed(law):
    """It was refused as that of several multipliers."""
    found = holonom.system(BLOCK.format(law=law)).simulate(samples=2).report
    place, times = slipped_and_rested(LAWS[law], 10.0)
    assert found.coordinates["x"] == pytest.approx(place, abs=1e-8)
    resting = [each.t for each in found.switchings if each.outcome != "crossed"]
    assert resting == pytest.approx(times, abs=1e-6)


TWO_CORNERS = """
n : [sin(1/10), cos(1/10)]$
along : [cos(1/10), -sin(1/10)]$
box : planar_body(33/20, 1/20, [x, y], phi)$
first_corner : marker(box, [-3/20, 7/20])$
second_corner : marker(box, [3/10, -1/20])$
contact(p) := applied_force(
  200*max(0, -(position(p) . n))^(3/2)*(n - 3/4*signum(velocity(p) . along)*along), p)$
system : holonomic_system(assembly(box, uniform_gravity(981/100, box), contact(first_corner), contact(second_corner)))$
fall : holonomic_scene(system, time_span = [0, 9/10],
  initial_state = [x = -1/4, y = 29/20, phi = -51/20, dot(x) = -1/10, dot(y) = -1, dot(phi) = -47/20])$
"""


@pytest.mark.parametrize("engine", ["taylor", "runge-kutta", "robust"])
def test_a_corner_that_sticks_while_another_touches_down(engine):
    """Rounding had put the other corner's depth below zero, where its root has no value."""
    scene = holonom.system(TWO_CORNERS)
    found, other = scene.simulate(engine=engine, samples=2).report, scene.simulate(max_step=0.01, samples=2).report
    assert found.coordinates == pytest.approx(other.coordinates, abs=1e-8)
    assert [each.outcome for each in found.switchings] == [each.outcome for each in other.switchings]
    assert [each.t for each in found.switchings] == pytest.approx([each.t for each in other.switchings], abs=1e-8)
