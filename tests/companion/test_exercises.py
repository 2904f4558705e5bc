"""Answers of the book's exercises that no run of a chapter shows: each is computed again from its description."""

import math

import numpy as np
import pytest
from sympy import Symbol, simplify, sympify

import holonom

PLANE = """
system : holonomic_system(
  coordinates = [q1, q2, q3], controls = [u],
  kinetic_energy = (dot(q1)^2 + dot(q2)^2 + dot(q3)^2)/2,
  forces = [given = {forces}],
  constraints = [q3 - u*(q1 + q2)])$
scene : holonomic_scene(system, control_law = [u = {law}], parameter_values = [{values}],
  initial_state = [q1 = {q1}, q2 = 2, dot(q1) = {v1}, dot(q2) = -1/3])$
"""
PAPER_FORCES = "[-q1 - q2, -2*(dot(q1) + dot(q2)), 0]"


def plane(forces=PAPER_FORCES, law="u0 + t", values="u0 = 3/10", q1="1", v1="1/2"):
    """The tilted plane with other forces, another law and another start."""
    return holonom.system(PLANE.format(forces=forces, law=law, values=values, q1=q1, v1=v1))


def multiplier(text):
    """The first multiplier of a system."""
    return holonom.system(text).equations["multipliers"][0].relations[0].right


@pytest.mark.parametrize(
    ("forces", "law", "values"),
    [
        ("[-4*(q1 + q2), -4*(dot(q1) + dot(q2)), 0]", "u0*exp(2*t)", "u0 = 3/10"),
        ("[-4*(q1 + q2), 4*(dot(q1) + dot(q2)), 0]", "u0*exp(-2*t)", "u0 = 3/10"),
        ("[0, 0, 2*(dot(q1) + dot(q2))]", "u0 + t", "u0 = 3/10"),
    ],
)
def test_every_motion_is_free_under_the_laws_of_chapter_6(forces, law, values):
    found = plane(forces, law, values).free().motion
    assert (found.verdict, found.states) == ("free", "all states")


def test_one_motion_of_chapter_7_is_free_and_others_are_not():
    law, values = "(u0 + v*t)*exp(t)", "u0 = 3/10, v = 1/5"
    decaying = plane(law=law, values=values, v1="-8/3").free().motion
    assert decaying.verdict == "free"
    assert decaying.states != "all states"
    assert plane(law=law, values=values).free().motion.verdict == "not free"


def test_two_bodies_on_one_floor_float_together():
    found = (
        holonom.system("""
system : holonomic_system(
  coordinates = [z1, z2], controls = [u], parameters = [m1, m2, g],
  kinetic_energy = (m1*dot(z1)^2 + m2*dot(z2)^2)/2, potential_energy = [gravity = g*(m1*z1 + m2*z2)],
  constraints = [z1 - u, z2 - u])$
scene : holonomic_scene(system, control_law = [u = h + w*t - g*t^2/2],
  parameter_values = [m1 = 1, m2 = 3, g = 981/100, h = 2, w = 5], initial_state = [])$
""")
        .free()
        .motion
    )
    assert (found.verdict, found.states) == ("free", "all states")


def test_initial_acceleration_and_jerk_of_chapter_4():
    series = plane().series(order=4).coordinates
    second, third, fourth = (
        [float(sympify(series[name][order])) for name in ("q1", "q2", "q3")] for order in (2, 3, 4)
    )
    assert [2 * second[2], 6 * third[2]] == pytest.approx([-0.564972, -5.845303], abs=1e-6)
    assert fourth == pytest.approx([0.151, -0.845, 1.535], abs=5e-4)


def test_velocities_of_chapter_5_tend_to_17_thirds():
    motion = plane(law="u0*exp(t)").simulate(until=30, samples=2)
    assert [motion["dot(q1)"][-1], motion["dot(q2)"][-1]] == pytest.approx([-17 / 3, 17 / 3], abs=1e-9)


@pytest.mark.parametrize(("t", "coefficient"), [(0, -0.5424), (2, 1.7229)])
def test_coefficient_of_chapter_3_at_fixed_times(t, coefficient):
    right_side = holonom.load("examples/paper/knob.mac", scene="exponential_scene", c=-1).rhs()
    u = 0.3 * math.exp(t)
    found = right_side(t, np.array([1.0, -1, 0, 1, 0, u]))  # S = 0 and dot(S) = 1
    assert -(found[3] + found[4]) == pytest.approx(coefficient, abs=1e-4)


@pytest.mark.parametrize(
    ("law", "values", "radius"),
    [("u0*exp(t)", "u0 = 3/10", 1.7896), ("u0*cos(omega*t)", "u0 = 3/10, omega = 3", 0.7457)],
)
def test_radii_of_chapter_9(law, values, radius):
    forces = "[-q1 - q2, -(dot(q1) + dot(q2)), 0]"
    assert float(plane(forces, law, values).series(order=60).radius.estimate) == pytest.approx(radius, abs=5e-4)


def test_a_scaled_constraint_scales_the_multiplier_of_chapter_1():
    found = multiplier("""
system : holonomic_system(coordinates = [z], controls = [u], parameters = [m, g, k],
  kinetic_energy = m*dot(z)^2/2, potential_energy = [gravity = m*g*z], constraints = [k*(z - u)])$
""")
    m, g, k, acceleration = (Symbol(name, real=True) for name in ("m", "g", "k", "ddot(u)"))
    assert simplify(found - m * (g + acceleration) / k) == 0


def test_masses_of_chapter_2_give_the_denominator():
    found = multiplier("""
system : holonomic_system(coordinates = [q1, q2, q3], controls = [u], parameters = [m1, m2, m3],
  kinetic_energy = (m1*dot(q1)^2 + m2*dot(q2)^2 + m3*dot(q3)^2)/2, constraints = [q3 - u*(q1 + q2)])$
""")
    u, m1, m2, m3 = (Symbol(name, real=True) for name in ("u", "m1", "m2", "m3"))
    acceleration = Symbol("ddot(u)", real=True)
    s = Symbol("q1", real=True) + Symbol("q2", real=True)
    rest = {Symbol("dot(u)", real=True): 0}
    assert simplify(found.subs(rest) * (u**2 / m1 + u**2 / m2 + 1 / m3) - acceleration * s) == 0
