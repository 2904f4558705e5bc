"""Mechanisms of joints and loads, against their motions and reactions in minimal coordinates."""

import numpy as np

import holonom
from holonom.simulation.result import Simulation

GEARED = """
load("holonom.mac")$
motor : rotor(I1, phi)$  wheel : rotor(I2, psi)$  rod : particle(m, [x, 0])$
system : holonomic_system(parameters = [I1, I2, m, M],
  assembly(motor, wheel, gear(1, motor, 3, wheel), rod, rack(rod, marker(ground, [0, 0], [1, 0]), 2, wheel),
    generalized_force(M, phi)))$
run : holonomic_scene(system, parameter_values = [I1 = 2, I2 = 9, m = 1, M = 5], time_span = [0, 1],
  initial_state = [phi = 0, dot(phi) = 0])$
"""

BEAD = """
load("holonom.mac")$
bead : particle(m, [x, y])$
system : holonomic_system(parameters = [m, g],
  assembly(bead, point_on_curve(bead, [s, s^2], s), uniform_gravity(g, bead)))$
run : holonomic_scene(system, parameter_values = [m = 2, g = 10], time_span = [0, 1],
  initial_state = [s = 1, dot(s) = 0])$
"""

ON_A_SHAFT = """
load("holonom.mac")$
body : rigid_body(m, [1, 2, J], [x, y, z], [e0, e1, e2, e3])$
sleeve : marker(body, [0, 0, 0], [0, 0, 1])$  shaft : marker(ground, [0, 0, 0], [0, 0, 1])$
system : holonomic_system(parameters = [m, g, J, k],
  assembly(body, cylindrical_joint(sleeve, shaft), prescribed_angle(sleeve, shaft, theta),
    uniform_gravity(g, body), torsional_spring(k, 0, theta, ground)))$
run : holonomic_scene(system, parameter_values = [m = 2, g = 10, J = 3, k = 12], time_span = [0, 1],
  initial_state = [z = 0, dot(z) = 0, theta = 1, dot(theta) = 0, e1 = 0, e2 = 0],
  initial_guess = [x = 0, y = 0, e0 = 7/8, e3 = 1/2, dot(x) = 0, dot(y) = 0,
    dot(e0) = 0, dot(e1) = 0, dot(e2) = 0, dot(e3) = 0])$
"""

MOTOR = """
load("holonom.mac")$
body : rigid_body(m, [1, 2, J], [x, y, z], [e0, e1, e2, e3])$
P : marker(body, [1, 0, 0], [0, 0, 1])$  Q : marker(ground, [0, 0, 0], [0, 0, 1])$
system : holonomic_system(controls = [u], parameters = [m, J],
  assembly(prescribed_angle(P, Q, u), revolute_joint(P, Q), body))$
run : holonomic_scene(system, control_law = [u = t^2], parameter_values = [m = 2, J = 3], time_span = [0, 1],
  initial_state = [x = -1, y = 0, z = 0, e0 = 1, e1 = 0, e2 = 0, e3 = 0])$
"""


PLANETARY = """
load("holonom.mac")$
arm : rotor(4, phi)$  planet : planar_body(3, 1/2, [x, y], psi)$
system : holonomic_system(parameters = [M], assembly(arm, planet, gear(2, ground, 1, planet, arm),
  revolute_joint(planet, marker(arm, [3, 0])), applied_torque(M, arm)))$
run : holonomic_scene(system, parameter_values = [M = 71/10], time_span = [0, 1],
  initial_state = [phi = 0, dot(phi) = 0, psi = 0])$
"""

SCREW = """
load("holonom.mac")$
nut : rigid_body(2, [1, 1, 3], [x, y, z], [e0, e1, e2, e3])$
P : marker(nut, [0, 0, 0], [0, 0, 1])$  Q : marker(ground, [0, 0, 0], [0, 0, 1])$
system : holonomic_system(parameters = [g], assembly(nut, cylindrical_joint(P, Q), prescribed_angle(P, Q, theta),
  rack(P, Q, 1/2, theta), uniform_gravity(g, nut)))$
run : holonomic_scene(system, parameter_values = [g = 10], time_span = [0, 1],
  initial_state = [x = 0, y = 0, z = 0, e0 = 1, e1 = 0, e2 = 0, e3 = 0, theta = 0, dot(theta) = 0])$
"""


def simulated(text: str) -> Simulation:
    return holonom.system(text).simulate(samples=5, tol=1e-13)


def test_gears_and_rack_accelerate_as_one_inertia_and_carry_the_load():
    motion = simulated(GEARED)
    inertia = 2 + 9 / 9 + 1 * (2 / 3) ** 2  # seen from the motor
    np.testing.assert_allclose(motion["phi"], 5 / inertia * motion["t"] ** 2 / 2, atol=1e-12)
    np.testing.assert_allclose(motion["x"], -2 / 3 * motion["phi"], atol=1e-12)
    np.testing.assert_allclose(motion["lambda1"], 2 * 5 / inertia - 5, atol=1e-11)


def test_bead_on_a_curve_moves_and_presses_as_in_one_coordinate():
    motion = simulated(BEAD)
    x, v = motion["x"], motion["dot(x)"]
    np.testing.assert_allclose((1 + 4 * x**2) * v**2 + 20 * x**2, 20, rtol=1e-11)  # the energy
    np.testing.assert_allclose(motion["lambda1"], 2 * -2 * x * (10 + 2 * v**2) / (1 + 4 * x**2), atol=1e-10)
    np.testing.assert_allclose(2 * x * motion["lambda2"] + motion["lambda1"], 0, atol=1e-10)  # no force along it


def test_sleeve_on_a_shaft_swings_by_its_measured_angle_and_falls():
    motion = simulated(ON_A_SHAFT)
    np.testing.assert_allclose(motion["theta"], np.cos(2 * motion["t"]), atol=1e-11)
    np.testing.assert_allclose(motion["z"], -5 * motion["t"] ** 2, atol=1e-11)
    np.testing.assert_allclose(motion["e3"], np.sin(motion["theta"] / 2), atol=1e-11)


def test_motor_turns_by_the_path_and_its_moment_is_the_multiplier():
    motion = simulated(MOTOR)
    np.testing.assert_allclose(motion["e0"], np.cos(motion["t"] ** 2 / 2), atol=1e-12)
    np.testing.assert_allclose(np.abs(motion["lambda1"]), (3 + 2 * 1) * 2, atol=1e-10)


def test_planet_wheel_rolls_round_the_fixed_sun():
    """With R + r = 3 and psi = 3 phi the inertia is 4 + 3*9 + 9/2 = 35.5; the teeth carry 1/2 psi''."""
    motion = simulated(PLANETARY)
    np.testing.assert_allclose(motion["phi"], 0.1 * motion["t"] ** 2, atol=1e-13)
    np.testing.assert_allclose(motion["psi"], 0.3 * motion["t"] ** 2, atol=1e-13)
    np.testing.assert_allclose(motion["lambda1"], 0.3, atol=1e-12)


def test_nut_on_a_screw_falls_as_its_spin_lets_it():
    """theta'' = -m g p/(m p^2 + J) = -20/7 with the pitch p = 1/2."""
    motion = simulated(SCREW)
    np.testing.assert_allclose(motion["theta"], -10 / 7 * motion["t"] ** 2, atol=1e-12)
    np.testing.assert_allclose(motion["z"], -5 / 7 * motion["t"] ** 2, atol=1e-12)
