"""Motions through regular states at which a fixed order of pivots could fail, against motions of one coordinate."""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve

import holonom

CLOSURE = "cos(q1) + 2*cos(q2) - 2*cos(q3) - 2, sin(q1) + 2*sin(q2) - 2*sin(q3)"
TURNED = "sin(q1) + 2*sin(q2) - 2*sin(q3), cos(q1) + 2*cos(q2) - 2*cos(q3) - 2"
LINKS = "(dot(q1)^2 + dot(q1)^2 + 4*dot(q2)^2 + 4*dot(q1)*dot(q2)*cos(q1 - q2))/2"
FOUR_BAR = """
system : holonomic_system(coordinates = [q1, q2, q3], parameters = [g], kinetic_energy = {energy},
  potential_energy = g*(2*sin(q1) + 2*sin(q2)), constraints = [{constraints}])$
turn : holonomic_scene(system, parameter_values = [g = 10], initial_state = [q1 = 1, dot(q1) = -4],
  initial_guess = [q2 = 1/2, q3 = 2, dot(q2) = 0, dot(q3) = 0], time_span = [0, 3])$
"""
LOST = """
system : holonomic_system(coordinates = [x, y, z], kinetic_energy = ((dot(x) + dot(y))^2 + dot(z)^2)/2,
  constraints = [x^2 + z^2 - 1, y - sin(x)])$
round : holonomic_scene(system, initial_state = [x = -3/5, z = 4/5, dot(x) = 4/5], time_span = [0, 5])$
"""
SEESAW = """
system : holonomic_system(coordinates = [x, y, z], kinetic_energy = ((dot(x) + dot(y))^2 + dot(z)^2)/2,
  forces = [1, 2, 3], constraints = [x^2/2 - y^2/2 + z, x - y - sin(z)])$
start : holonomic_scene(system, initial_guess = [x = 1/2, y = 1/2, z = 0, dot(x) = 0, dot(y) = 0, dot(z) = 0])$
"""


def closed(q1, near):
    """The angles of coupler and rocker; q3 has no mass."""
    return fsolve(
        lambda q: [
            np.cos(q1) + 2 * np.cos(q[0]) - 2 * np.cos(q[1]) - 2,
            np.sin(q1) + 2 * np.sin(q[0]) - 2 * np.sin(q[1]),
        ],
        near,
        xtol=1e-13,
    )


@cache
def crank():
    """q1 at t = 3: it turns on, and its rate follows from the energy."""
    near = [0.5, 2.0]

    def terms(q1):
        q2, q3 = near[:] = closed(q1, near)
        slope = np.sin(q1 - q3) / (2 * np.sin(q3 - q2))
        mass = 2 + 4 * slope**2 + 4 * slope * np.cos(q1 - q2)
        return mass, 20 * (np.sin(q1) + np.sin(q2))

    mass, potential = terms(1.0)
    energy = mass * 8 + potential

    def rate(t, q1):
        mass, potential = terms(q1[0])
        return [-np.sqrt(2 * (energy - potential) / mass)]

    return solve_ivp(rate, (0, 3), [1.0], rtol=1e-11, atol=1e-11).y[0, -1]


@pytest.mark.long
@pytest.mark.parametrize("options", [{}, {"solve": "orthogonal"}, {"engine": "robust"}])
@pytest.mark.parametrize("constraints", [CLOSURE, TURNED], ids=["closure", "turned"])
def test_four_bar_with_a_massless_angle_turns_through_every_position(constraints, options):
    motion = holonom.system(FOUR_BAR.format(energy=LINKS, constraints=constraints)).simulate(samples=2, **options)
    assert motion["q1"][-1] == pytest.approx(crank(), abs=1e-7)
    assert motion.report.trusted


@pytest.mark.parametrize("constraints", [CLOSURE, TURNED], ids=["closure", "turned"])
def test_right_hand_side_of_a_four_bar_has_values_in_every_position(constraints):
    """Where q1 = 0, sin(q3) = 0 or cos(q3) = 0 a pivot of fewer constraints vanishes."""
    rhs = holonom.system(FOUR_BAR.format(energy=LINKS, constraints=constraints)).rhs()
    near = [0.5, 2.0]
    for q1 in [*np.linspace(1, -2 * np.pi + 1, 400), 0.0]:
        q2, q3 = near = closed(q1, near if q1 else [0.5, 2.0])
        slopes = np.array([1, np.sin(q1 - q3) / (2 * np.sin(q3 - q2)), np.sin(q1 - q2) / (2 * np.sin(q3 - q2))])
        accelerations = rhs(0.0, np.concatenate([[q1, q2, q3], -4 * slopes]))[3:]
        assert np.isfinite(accelerations).all()
        assert np.max(np.abs(accelerations)) < 1e4


def test_sweep_follows_a_four_bar_in_batches():
    rows = holonom.sweep(
        holonom.system(FOUR_BAR.format(energy=LINKS, constraints=TURNED)), values={"g": [10, 10]}, keep=["q1"]
    ).to_pandas()
    assert rows["q1"].to_numpy() == pytest.approx([crank()] * 2, abs=1e-7)
    assert list(rows["status"]) == ["ok", "ok"]


@pytest.mark.parametrize("options", [{}, {"solve": "orthogonal"}, {"engine": "robust"}])
def test_vanishing_pivot_of_a_singular_mass_matrix_hands_over(options):
    """x = sin(p), z = cos(p): p' w(p) is constant."""

    def speed(p):
        return np.hypot((1 + np.cos(np.sin(p))) * np.cos(p), np.sin(p))

    start = np.arcsin(-0.6)
    truth = solve_ivp(lambda t, p: speed(start) / speed(p), (0, 5), [start], rtol=1e-12, atol=1e-12).y[0, -1]
    motion = holonom.system(LOST).simulate(samples=2, **options)
    assert motion["x"][-1] == pytest.approx(np.sin(truth), abs=1e-9)
    assert motion.report.trusted


@pytest.mark.parametrize("solve", ["direct", "orthogonal"])
@pytest.mark.parametrize("x", [0.0, 0.5])
def test_program_has_values_where_one_of_two_constraints_replaces_the_mass(solve, x):
    """At y = -x the first constraint holds nothing of x - y, which has no mass; these were NaN."""
    seesaw = holonom.system(SEESAW)
    v = np.array([0.1, 0.2, 0.3])
    mass, jacobian = np.array([[1, 1, 0], [1, 1, 0], [0, 0, 1]]), np.array([[x, x, 1], [1, -1, -1]])
    bordered = np.block([[mass, -jacobian.T], [jacobian, np.zeros((2, 2))]])
    truth = np.linalg.solve(bordered, [1, 2, 3, v[1] ** 2 - v[0] ** 2, 0])
    assert seesaw.program(solve=solve).compile()([0, x, -x, 0, *v]) == pytest.approx(truth, rel=1e-12)


HEAVY = LOST.replace("(dot(x) + dot(y))^2", "dot(x)^2 + y^2*dot(y)^2")


@pytest.mark.parametrize(("scene", "words"), [(SEESAW, "determine the motion"), (HEAVY, "positive definite")])
def test_exported_program_states_its_range(scene, words, tmp_path):
    described = holonom.system(scene)
    program = described.program()
    program.to_c(tmp_path / "library", name="motion")
    assert words in " ".join((tmp_path / "library" / "motion.h").read_text().split())
    assert words in program.to_python()
