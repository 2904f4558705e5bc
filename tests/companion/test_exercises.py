"""Answers of the book's exercises that no run of a chapter shows: each is computed again from its description."""

import math

import numpy as np
import pytest
from sympy import Matrix, Symbol, exp, simplify, sympify

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


def test_the_reaction_of_chapter_10_vanishes_at_the_start_only():
    motion = plane(v1="41/42").simulate(until=1, samples=2)  # dot(S) = 41/42 - 1/3 = 9/14
    assert motion["lambda1"][0] == pytest.approx(0, abs=1e-14)
    assert abs(motion["lambda1"][-1]) > 0.1
    series = plane(v1="41/42").series(order=2)
    assert float(sympify(series.multipliers["lambda1"][1])) * 1.18 == pytest.approx(-10.48, abs=5e-3)


def test_every_motion_of_chapter_10_is_free_with_a_negative_kappa():
    found = plane("[-(q1 + q2)/4, dot(q1) + dot(q2), 0]", "u0*exp(-t/2)").free().motion
    assert (found.verdict, found.states) == ("free", "all states")


def test_power_of_chapter_10_at_the_start():
    multiplier = plane().simulate(until=1, samples=2)["lambda1"][0]
    assert [multiplier, 3 * multiplier] == pytest.approx([-100 / 177, -100 / 59], abs=1e-12)


def test_parallel_gradients_of_chapter_11_lose_digits():
    alpha = 1e-3
    jacobian = np.array([[1, 0], [math.cos(alpha), math.sin(alpha)]])
    assert np.linalg.cond(jacobian @ jacobian.T) == pytest.approx(4e6, rel=1e-3)
    assert np.linalg.cond(jacobian) == pytest.approx(2000, rel=1e-3)
    assert [math.log10(4e6), math.log10(2000)] == pytest.approx([6.6, 3.3], abs=0.01)


def test_two_rods_of_chapter_11_have_a_singular_matrix_at_zero():
    found = holonom.system("""
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [l, g],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2, potential_energy = [gravity = g*y],
  constraints = [(x^2 + y^2 - l^2)/2, ((x - u)^2 + y^2 - l^2 - u^2)/2])$
""").equations["lagrange_equations"][0]
    names = [Symbol(f"lambda{k}", real=True) for k in (1, 2)]
    x, y, u, length = (Symbol(name, real=True) for name in ("x", "y", "u", "l"))
    columns = Matrix([[each.right.expand().coeff(name) for name in names] for each in found.relations])
    determinant = (columns.T * columns).det().subs({x: 0, y: -length})
    assert simplify(determinant - u**2 * length**2) == 0


def test_steps_of_the_stiff_spring_of_chapter_11():
    def growth(step: float) -> float:
        z = 1j * step
        return abs(1 + z + z**2 / 2 + z**3 / 6 + z**4 / 24)

    assert growth(1e4 / 3536) <= 1 < growth(1e4 / 3535)


def test_digits_of_chapter_11():
    assert 1 - math.cos(1e-8) == 0
    assert 2 * math.sin(1e-8 / 2) ** 2 == pytest.approx(5e-17, rel=1e-15)
    assert math.log(1e14) / 2 == pytest.approx(16.1, abs=0.05)
    assert 1e-2 * math.exp(-2 * 2 * math.log(1e14) / 2) == pytest.approx(1e-30, rel=1e-12)


def test_costs_of_digits_of_chapter_12():
    assert [round(10 ** (10 / p)) for p in (4, 5, 8)] == [316, 100, 18]
    assert [math.ceil(digits * math.log(10) / 2) for digits in (16, 32)] == [19, 37]


def test_drift_of_chapter_12_with_and_without_stabilization():
    times = np.linspace(0, 1, 100_001)
    assert max(1e-8 * times * np.exp(-10 * times)) == pytest.approx(3.7e-10, abs=5e-12)
    t = Symbol("t")
    stabilized = t * exp(-10 * t)
    assert simplify(stabilized.diff(t, 2) + 20 * stabilized.diff(t) + 100 * stabilized) == 0


def test_projected_velocity_of_chapter_12():
    mass, jacobian, velocity = np.diag([1, 4]), np.array([[0.6, -0.8]]), np.array([1, 1])
    bordered = np.block([[mass, jacobian.T], [jacobian, np.zeros((1, 1))]])
    found = np.linalg.solve(bordered, [*(mass @ velocity), 0])[:2]
    assert found == pytest.approx([16 / 13, 12 / 13])


def test_best_step_of_chapter_12():
    steps = np.linspace(1e-4, 1e-3, 100_001)
    errors = steps**4 + 1e-16 / steps
    assert [steps[errors.argmin()], errors.min()] == pytest.approx([4.8e-4, 2.6e-13], rel=0.01)


def test_angular_acceleration_of_chapter_4_at_the_start():
    series = holonom.load("examples/whirling_bob.mac", scene="drawn_in_scene").series(order=2)
    assert 2 * float(sympify(series.coordinates["phi"][2])) == pytest.approx(1 / 5, abs=1e-14)
