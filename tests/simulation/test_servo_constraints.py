"""Controls in forces that hold outputs to a path, against inverse dynamics, flatness and conservation laws."""

import json
import re
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from refusing import failing, refused
from scipy.special import j0

import holonom
from holonom.failures import ErrorKind, HolonomError

EXAMPLES = Path(__file__).parents[2] / "examples"
ENGINES = {"taylor": 1e-12, "runge-kutta": 1e-10, "robust": 1e-8}

ARM = """
system : holonomic_system(
  coordinates = [a, b], controls = [tau1, tau2], parameters = [m, l, g],
  kinetic_energy = m*l^2*(2*dot(a)^2 + dot(b)^2 + 2*dot(a)*dot(b)*cos(a - b))/2,
  potential_energy = m*g*l*(2*sin(a) + sin(b)), forces = [motors = [tau1 - tau2, tau2]])$
circle : holonomic_scene(system,
  servo_constraints = [l*cos(a) + l*cos(b) = {across}, l*sin(a) + l*sin(b) = sin(t)/4],
  parameter_values = [m = 2, l = 1, g = 981/100], initial_state = [],
  initial_guess = [a = -1, b = 1, dot(a) = 0, dot(b) = 0], time_span = [0, 3],
  observe = [trajectory, residuals, energy])$
"""
ROD = """
system : holonomic_system(
  coordinates = [x, p, q], controls = [F], parameters = [g], kinetic_energy = dot(x)^2 + (dot(p)^2 + dot(q)^2)/2,
  potential_energy = g*q, forces = [drive = [F, 0, 0]], constraints = [(p - x)^2 + q^2 - 1])$
shaken : holonomic_scene(system, servo_constraints = [x - sin(2*t)/5], parameter_values = [g = 981/100],
  initial_state = [x = 0, p = 3/5, q = -4/5, dot(p) = 2/5], time_span = [0, 2])$
"""


def inverse_dynamics():
    """The torques of the arm from its angles as functions of the time, by differentiating the elbow's two angles."""
    t = sp.Symbol("t")
    m, length, g = 2, 1, sp.Rational(981, 100)
    x, y = 1 + sp.cos(t) / 4, sp.sin(t) / 4
    distance = sp.sqrt(x**2 + y**2)
    opening, direction = sp.acos(distance / 2), sp.atan2(y, x)
    a, b = direction - opening, direction + opening  # of the solution with a < b
    da, db = sp.diff(a, t), sp.diff(b, t)
    dda, ddb = sp.diff(a, t, 2), sp.diff(b, t, 2)
    at_a = m * length**2 * (2 * dda + ddb * sp.cos(a - b) + db**2 * sp.sin(a - b)) + 2 * m * g * length * sp.cos(a)
    at_b = m * length**2 * (ddb + dda * sp.cos(a - b) - da**2 * sp.sin(a - b)) + m * g * length * sp.cos(b)
    return sp.lambdify(t, [a, b, at_a + at_b, at_b], "numpy")


@pytest.mark.parametrize("engine", ENGINES)
def test_a_two_link_arm_whose_tip_follows_a_circle_needs_the_torques_of_inverse_dynamics(engine, c_compiler):
    motion = holonom.system(ARM.format(across="1 + cos(t)/4")).simulate(samples=7, engine=engine)
    truth = np.array(inverse_dynamics()(motion.times))
    found = np.array([motion[name] for name in ("a", "b", "tau1", "tau2")])
    assert found == pytest.approx(truth, rel=ENGINES[engine], abs=ENGINES[engine])
    assert motion.report.trusted
    assert motion.report.multipliers == {}
    assert max(motion["residual.acceleration"]) < 100 * ENGINES[engine]


T = sp.Symbol("t")
CRANE = """
hook : [x + l*sin(phi), -l*cos(phi)]$
system : holonomic_system(coordinates = [x, l, phi], controls = [F, W], parameters = [M, m, g],
  kinetic_energy = M*dot(x)^2/2 + m*((dot(x) + dot(l)*sin(phi) + l*cos(phi)*dot(phi))^2
    + (dot(l)*cos(phi) - l*sin(phi)*dot(phi))^2)/2,
  potential_energy = [gravity = -m*g*l*cos(phi)], forces = [drives = [F, W, 0]])$
carried : holonomic_scene(system, servo_constraints = [{path}], parameter_values = [M = 2, m = 1, g = 981/100],
  initial_state = [], initial_guess = [x = 0, l = 2, phi = {phi}, dot(x) = 0, dot(l) = 0, dot(phi) = 0],
  time_span = [0, 1])$
"""


def flat_crane(across, below):
    """Of M = 2 and m = 1: the rope points along the load's acceleration less gravity."""
    pull = sp.diff(across, T, 2), sp.Rational(981, 100) - sp.diff(below, T, 2)
    phi = -sp.atan(pull[0] / pull[1])
    tension = sp.sqrt(pull[0] ** 2 + pull[1] ** 2)
    trolley = across - below * sp.tan(phi)
    return [trolley, phi, 2 * sp.diff(trolley, T, 2) - tension * sp.sin(phi), -tension]


def values(formulas, times):
    return np.array([np.broadcast_to(row, len(times)) for row in sp.lambdify(T, formulas)(times)])


@pytest.mark.long
@pytest.mark.parametrize("engine", ENGINES)
def test_a_crane_whose_load_follows_a_line_is_flat(engine, c_compiler):
    """The rope points along the load's acceleration less gravity, which gives angle, tension and both forces."""
    motion = holonom.load(EXAMPLES / "overhead_crane.mac").simulate(samples=6, engine=engine)
    truth = values(flat_crane((1 - sp.cos(T)) / 2, 2 - T / 5), motion.times)
    found = np.array([motion[name] for name in ("x", "phi", "F", "W")])
    assert sorted(motion.report.relative_degrees) == [2, 4]
    assert found == pytest.approx(truth, rel=ENGINES[engine], abs=ENGINES[engine])


PATHS = {
    "from rest, under a rope that hangs straight": ("hook[1] = t^5, hook[2] = -2", 0, T**5, 2 + 0 * T),
    "the outputs in the other order": (
        "hook[2] = t/5 - 2, hook[1] = (1 - cos(t))/2",
        0,
        (1 - sp.cos(T)) / 2,
        2 - T / 5,
    ),
    "along a parabola, an output in terms of the other": (
        "hook[1] = t^2*(3 - 2*t), hook[2] = hook[1]^2/8 - 3",
        -0.5,
        T**2 * (3 - 2 * T),
        3 - (T**2 * (3 - 2 * T)) ** 2 / 8,
    ),
}


@pytest.mark.parametrize("path", PATHS)
def test_a_crane_was_refused(path):
    """From rest, for one output that is not moved there; along a parabola, for velocities that the outputs fix."""
    outputs, phi, across, below = PATHS[path]
    motion = holonom.system(CRANE.format(path=outputs, phi=phi)).simulate(samples=5)
    found = np.array([motion[name] for name in ("x", "phi", "F", "W")])
    assert found == pytest.approx(values(flat_crane(across, below), motion.times), rel=1e-11, abs=1e-11)
    assert motion.report.trusted
    assert [segment.engine for segment in motion.report.segments] == ["taylor"]


@pytest.mark.long
def test_a_rope_that_would_have_to_push_ends_the_motion_in_one_sentence():
    """It lies level where the path falls as a stone does, X'^2 + X X'' = -g/2; that was LinAlgError."""
    path = "hook[1] = t^2*(3 - 2*t), hook[2] = hook[1]^2 - 3"
    across = T**2 * (3 - 2 * T)
    falls = float(sp.nsolve(2 * sp.diff(across, T) ** 2 + 2 * across * sp.diff(across, T, 2) + 9.81, T, 0.9))
    scene = holonom.system(CRANE.format(path=path, phi=-0.5).replace("l = 2", "l = 3"))
    with pytest.raises(HolonomError) as ended:
        scene.simulate(samples=2, engine="taylor")
    assert float(re.search(r"t = ([\d.]+\d)", str(ended.value))[1]) == pytest.approx(falls, abs=1e-3)


@pytest.mark.long
def test_a_crane_in_space_needs_two_outputs_more():
    """Rope and load in a plane at any angle to the rails: x and y share what the plane's trolley does."""
    scene = holonom.system("""
hook : [x + l*sin(a), y + l*cos(a)*sin(b), -l*cos(a)*cos(b)]$
system : holonomic_system(coordinates = [x, y, l, a, b], controls = [Fx, Fy, W], parameters = [M, m, g],
  kinetic_energy = M*(dot(x)^2 + dot(y)^2)/2 + m*sum('diff(hook[k], t)^2, k, 1, 3)/2,
  potential_energy = [gravity = m*g*hook[3]], forces = [drives = [Fx, Fy, W, 0, 0]])$
carried : holonomic_scene(system, servo_constraints = [hook[1] = 3*t^4/5, hook[2] = 4*t^4/5, hook[3] = t/5 - 2],
  parameter_values = [M = 2, m = 1, g = 981/100], initial_state = [], initial_guess = [x = 0, y = 0, l = 2, a = 0,
  b = 0, dot(x) = 0, dot(y) = 0, dot(l) = 0, dot(a) = 0, dot(b) = 0], time_span = [0, 1])$""")
    motion = scene.simulate(samples=5)
    trolley, _, force, pull = values(flat_crane(T**4, 2 - T / 5), motion.times)
    assert sorted(motion.report.relative_degrees) == [2, 4, 4]
    for share, name, along in (0.6, "x", "Fx"), (0.8, "y", "Fy"):
        assert motion[name] == pytest.approx(share * trolley, rel=1e-11, abs=1e-11)
        assert motion[along] == pytest.approx(share * force, rel=1e-11, abs=1e-11)
    assert motion["W"] == pytest.approx(pull, rel=1e-11)


QUADROTOR = """
system : holonomic_system(coordinates = [x, z, th], controls = [F, tau], parameters = [m, J, g],
  kinetic_energy = (m*(dot(x)^2 + dot(z)^2) + J*dot(th)^2)/2, potential_energy = [gravity = m*g*z],
  forces = [rotors = [-F*sin(th), F*cos(th), tau]])$
flown : holonomic_scene(system, servo_constraints = [{outputs}], parameter_values = [m = 1, J = 1/10, g = 981/100],
  initial_state = [], initial_guess = [x = 0, z = 1/2, th = 0, dot(x) = 1, dot(z) = 0, dot(th) = 0],
  time_span = [0, 4])$
"""
IN_TURN = [("x", "x = sin(t)"), ("z", "z = cos(2*t)/2")]
NATURAL = (
    QUADROTOR.replace("[x, z, th]", "[x, z, c, s]")
    .replace("dot(th)^2", "(dot(c)^2 + dot(s)^2)")
    .replace("[-F*sin(th), F*cos(th), tau]", "[-F*s, F*c, -tau*s, tau*c]")
    .replace("tau*c]])", "tau*c]], constraints = [c^2 + s^2 - 1])")
    .replace("th = 0, ", "c = 1, s = 0, ", 1)
    .replace("dot(th) = 0", "dot(c) = 0, dot(s) = 0")
)


@pytest.mark.parametrize(
    "scene",
    [
        pytest.param(text.format(outputs=", ".join(said for _, said in order)), id=f"{name} {order[0][0]} first")
        for name, text in (("angle", QUADROTOR), ("natural coordinates", NATURAL))
        for order in (IN_TURN, IN_TURN[::-1])
    ],
)
def test_a_quadrotor_in_the_plane_is_flat_in_whatever_order_its_outputs_are_named(scene):
    """Thrust points along the acceleration less gravity; one order was refused, for a start that contradicts."""
    motion = holonom.system(scene).simulate(samples=9)
    x, z = sp.sin(T), sp.cos(2 * T) / 2
    pull = sp.diff(x, T, 2), sp.diff(z, T, 2) + sp.Rational(981, 100)
    th = -sp.atan(pull[0] / pull[1])
    truth = values([sp.sqrt(pull[0] ** 2 + pull[1] ** 2), sp.diff(th, T, 2) / 10], motion.times)
    assert np.array([motion["F"], motion["tau"]]) == pytest.approx(truth, rel=1e-11, abs=1e-11)


TURNING = """
system : holonomic_system(coordinates = [x, y{more}], controls = [u1, u2{sought}],
  kinetic_energy = (dot(x)^2 + dot(y)^2{energy})/2, forces = [thrust = [{forces}]])$
flown : holonomic_scene(system, servo_constraints = [x = sin(t), y = cos(t){path}], initial_state = [],
  time_span = [0, 2])$
"""


@pytest.mark.parametrize("engine", ENGINES)
def test_a_pivot_that_vanishes_on_the_way_made_the_controls_no_numbers(engine, c_compiler):
    """M = [[1 - t, -t], [t, 1 - t]] is regular throughout, and its first entry zero at t = 1."""
    text = TURNING.format(more="", sought="", energy="", path="", forces="u1*(1 - t) - u2*t, u1*t + u2*(1 - t)")
    motion = holonom.system(text).simulate(samples=5, engine=engine)
    t = motion.times
    truth = [np.linalg.solve([[1 - at, -at], [at, 1 - at]], [-np.sin(at), -np.cos(at)]) for at in t]
    found = np.array([motion["u1"], motion["u2"]]).T
    assert found == pytest.approx(np.array(truth), rel=ENGINES[engine])


def test_rows_of_any_size_and_outputs_that_one_control_moves_alone():
    """Of three outputs the third belongs to u3, and what it does to x is known when the others are sought."""
    text = TURNING.format(
        more=", z",
        sought=", u3",
        energy=" + dot(z)^2",
        path=", z = t^3",
        forces="u1*(1 - t) - u2*t + u3, 10^9*(u1*t + u2*(1 - t)), u3*(2 + t)",
    )
    motion = holonom.system(text).simulate(samples=5)
    t = np.asarray(motion.times)
    third = 6 * t / (2 + t)
    right = np.array([-np.sin(t) - third, -np.cos(t) / 1e9])
    truth = [np.linalg.solve([[1 - at, -at], [at, 1 - at]], both) for at, both in zip(t, right.T, strict=True)]
    assert motion["u3"] == pytest.approx(third, rel=1e-14)
    found = np.array([motion["u1"], motion["u2"]]).T
    assert found == pytest.approx(np.array(truth), rel=1e-13, abs=1e-13)


MASSES = """
system : holonomic_system(coordinates = [x, y], controls = [u{more}], parameters = [m, n, k],
  kinetic_energy = (m*dot(x)^2 + n*dot(y)^2)/2, potential_energy = [spring = k*(x - y)^2/2],
  forces = [drive = [u, 0]{forces}]{entries})$
led : holonomic_scene(system, servo_constraints = [{path}], parameter_values = [m = 2, n = 3, k = 5],
  {law}initial_state = [], time_span = [0, 2])$
"""


def masses(path, more="", forces="", entries="", law=""):
    return holonom.system(MASSES.format(path=path, more=more, forces=forces, entries=entries, law=law))


def test_two_masses_and_a_spring_have_the_known_feedforward():
    motion = masses("y = sin(t)").simulate(samples=5)
    y = np.sin(motion.times)
    assert motion["u"] == pytest.approx(2 * 3 / 5 * y - (2 + 3) * y, abs=1e-14)
    assert motion.report.relative_degrees == (4,)


def test_friction_whose_sign_changes_the_force_holds_two_masses_together():
    """F = -sin(t) - 2 s, so that s = 3/4 keeps x' = y'; the part of F in this was left out."""
    motion = holonom.system("""
system : holonomic_system(coordinates = [x, y], controls = [F], kinetic_energy = (dot(x)^2 + dot(y)^2)/2, forces =
  [drive = [F, F], friction = [3 - 2*signum(dot(x) - dot(y)), 2*signum(dot(x) - dot(y))]])$
led : holonomic_scene(system, servo_constraints = [y = sin(t)], initial_state = [x = 0, dot(x) = 2], time_span = [0, 2],
  observe = [trajectory, controls])$""").simulate(samples=9)
    t, late = motion.times, motion.times > 1
    assert (motion["dot(x)"] - motion["dot(y)"])[late] == pytest.approx(0, abs=1e-14)
    assert motion["F"] == pytest.approx(-np.sin(t) - np.where(late, 3 / 2, 2), rel=1e-13)


@pytest.mark.parametrize("samples", [3, 4])
def test_servo_constraint_ends_where_no_equation_gives_its_control(samples):
    """ddot(x) = x u with x = sin(t - 1) is u = -1, and any number where x is zero."""
    scene = holonom.system("""
system : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  forces = [x*u, u])$
led : holonomic_scene(system, servo_constraints = [x = sin(t - 1)], initial_state = [y = 0, dot(y) = 0],
  time_span = [0, 2])$""")
    with pytest.raises(HolonomError) as refused:
        scene.simulate(samples=samples)
    assert refused.value.kind is ErrorKind.NO_WAY_ON
    assert float(refused.value.detail.split(",")[0]) == pytest.approx(1, abs=1e-8)


def test_an_arm_stretched_out_was_a_reaction_that_cannot_act():
    """At t = 1 its tip is as far as it reaches, and no multiplier is the arm's own."""
    stretching = ARM.replace("sin(t)/4", "0").format(across="1 + t")
    with failing(ErrorKind.NO_WAY_ON):
        holonom.system(stretching).simulate(samples=2)


SATELLITE = """
de : [dot(e0), dot(e1), dot(e2), dot(e3)]$
system : holonomic_system(coordinates = [e0, e1, e2, e3], controls = [t1, t2, t3], parameters = [J1, J2, J3],
  kinetic_energy = 2*(J1*([-e1, e0, e3, -e2] . de)^2 + J2*([-e2, -e3, e0, e1] . de)^2 + J3*([-e3, e2, -e1, e0] . de)^2),
  forces = [wheels = 2*(t1*[-e1, e0, e3, -e2] + t2*[-e2, -e3, e0, e1] + t3*[-e3, e2, -e1, e0])],
  constraints = [e0^2 + e1^2 + e2^2 + e3^2 - 1])$
turned : holonomic_scene(system, servo_constraints = [e1 = 0, e2 = 0, e3 = sin(t^3/6)],
  parameter_values = [J1 = 1, J2 = 2, J3 = 3], initial_state = [],
  initial_guess = [e0 = 1, e1 = 0, e2 = 0, e3 = 0, dot(e0) = 0, dot(e1) = 0, dot(e2) = 0, dot(e3) = 0],
  time_span = [0, 1])$
"""


@pytest.mark.parametrize("engine", ["taylor", "robust"])
def test_a_satellite_at_rest_was_a_singular_configuration_that_it_starts_from(engine):
    """About its third axis by t^3/3, so that t3 = 2 J3 t. The outputs cannot make up for the singular A at e0 = 1."""
    motion = holonom.system(SATELLITE).simulate(samples=5, engine=engine)
    t = np.asarray(motion.times)
    assert motion["t3"] == pytest.approx(6 * t, abs=ENGINES[engine])
    assert motion["e0"] == pytest.approx(np.cos(t**3 / 6), abs=ENGINES[engine])


def test_redundant_constraints_under_a_relative_degree_of_four():
    """x and y together, 2 ddot(x) = F - (x - z) and ddot(z) = x - z: z = sin(2 t) takes F = 20 sin(2 t)."""
    motion = holonom.system("""
system : holonomic_system(coordinates = [x, y, z], controls = [F], potential_energy = [spring = (x - z)^2/2],
  kinetic_energy = (dot(x)^2 + dot(y)^2 + dot(z)^2)/2, forces = [drive = [F, 0, 0]], constraints = [x - y, 2*x - 2*y])$
led : holonomic_scene(system, servo_constraints = [z = sin(2*t)], initial_state = [], time_span = [0, 1])$""").simulate(
        samples=5
    )
    assert motion["F"] == pytest.approx(20 * np.sin(2 * motion.times), abs=1e-13)


def test_a_path_by_if_was_refused_for_a_function_that_no_program_has():
    """At rest, then y = (t - 1)^5: four rates are continuous, and so are all controls but one kink."""
    motion = masses("y = if t < 1 then 0 else (t - 1)^5").simulate(samples=9)
    s = np.maximum(np.asarray(motion.times) - 1, 0)
    assert motion["u"] == pytest.approx(6 / 5 * 120 * s + 5 * 20 * s**3, abs=1e-12)
    assert motion["x"] == pytest.approx(s**5 + 3 / 5 * 20 * s**3, abs=1e-13)


def test_a_special_function_in_forces_beside_a_path_was_refused():
    """Truth: the control is -sin(t) less Bessel's function."""
    motion = holonom.system("""
system : holonomic_system(coordinates = [x], controls = [F], kinetic_energy = dot(x)^2/2,
  forces = [F + bessel_j(0, t)])$
drive : holonomic_scene(system, servo_constraints = [x = sin(t)], initial_state = [],
  initial_guess = [x = 0, dot(x) = 1], time_span = [0, 5], observe = [trajectory, controls])$""").simulate(samples=11)
    assert motion["F"] == pytest.approx(-np.sin(motion.times) - j0(motion.times), abs=1e-14)


def test_a_path_that_asks_for_third_rates_of_a_law_was_followed_without_them():
    """Relative degree 4, and w has two rates: dot(x) was given without the third, and the energy was lost."""
    with refused("servo_rates_of_controls"):
        masses("y = w", ", w", entries=", drawing = [point([w, 0])]", law="control_law = [w = sin(2*t)], ").simulate(
            samples=2
        )


def test_a_reaction_stays_where_a_constraint_is_the_systems_own():
    """A pendulum on a shaken trolley: the trolley is where it should be, the rod pulls, and the drive does the work."""
    scene = holonom.system(ROD)
    motion = scene.simulate(samples=9)
    assert motion["x"] == pytest.approx(np.sin(2 * motion.times) / 5, abs=1e-13)
    assert list(motion.report.multipliers) == ["lambda1"]
    # of the trolley, 2 ddot(x) = F + lambda df/dx
    pull = motion["lambda1"] * -2 * (motion["p"] - motion["x"])
    assert motion["F"] == pytest.approx(-2 * 4 * np.sin(2 * motion.times) / 5 - pull, rel=1e-11, abs=1e-11)
    assert motion.report.trusted


def test_the_programs_and_the_series_hold_the_controls():
    scene = holonom.system(ARM.format(across="1 + cos(t)/4"))
    program = scene.program()
    assert not {"tau1", "dot(tau1)", "ddot(tau2)"} & set(program.inputs)
    a, b, tau1, tau2 = inverse_dynamics()(1e-9)
    rates = (np.array(inverse_dynamics()(1e-6)) - np.array(inverse_dynamics()(-1e-6)))[:2] / 2e-6
    given = {"t": 0.0, "a": a, "b": b, "dot(a)": rates[0], "dot(b)": rates[1]}
    found = dict(zip(program.outputs, program.lambdify()([given[name] for name in program.inputs]), strict=True))
    assert [found["tau1"], found["tau2"]] == pytest.approx([tau1, tau2], rel=1e-6)
    series = scene.series(order=6, digits=20).coordinates
    at = 1 / 16
    assert sum(float(c) * at**k for k, c in enumerate(series["a"])) == pytest.approx(
        inverse_dynamics()(at)[0], rel=1e-9
    )


def test_the_document_has_the_controls(tmp_path):
    from holonom.simulation.output import simulation_document

    document = simulation_document(holonom.system(ROD).simulate(samples=3))
    assert set(json.loads(json.dumps(document))["controls"]) == {"F"}
    assert "F" in document["samples"]


# The shaft's torque moves the height of the sleeve by the centrifugal force alone.
GOVERNOR = """
spindle : rigid_body(Ms, [Is, Is, Is], [xs, ys, zs], [p0, p1, p2, p3])$
left    : rigid_body(m, [I1, I1, I3], [xa, ya, za], [a0, a1, a2, a3])$
right   : rigid_body(m, [I1, I1, I3], [xb, yb, zb], [b0, b1, b2, b3])$
sleeve  : particle(mc, [0, 0, h])$
system : holonomic_system(
  parameters = [Ms, Is, m, I1, I3, mc, g, l],
  controls = [M],
  assembly(spindle, left, right, sleeve,
    bearing = revolute_joint(marker(spindle, [0,0,0], [0,0,1]), marker(ground, [0,0,0], [0,0,1])),
    hinge_a = revolute_joint(marker(left, [0,0,l], [0,1,0]), marker(spindle, [0,0,0], [0,1,0])),
    hinge_b = revolute_joint(marker(right, [0,0,l], [0,1,0]), marker(spindle, [0,0,0], [0,1,0])),
    rod_a = distance_joint(left, sleeve, l),
    rod_b = distance_joint(right, sleeve, l),
    drive = applied_torque([0,0,M], spindle),
    gravity = uniform_gravity(g, left, right, sleeve)))$
servo_scene : holonomic_scene(system,
  parameter_values = [Ms = 1, Is = 1/10, m = 1, I1 = 1/10, I3 = 1/100, mc = 1, g = 10, l = 1],
  servo_constraints = [h = -6/5 + t^4],
  initial_state = [xs = 0, ys = 0, zs = 0, p0 = 1, p1 = 0, p2 = 0, p3 = 0, dot(p3) = 3/2, dot(h) = 0],
  initial_guess = [xa = -4/5, za = -3/5, ya = 0, xb = 4/5, yb = 0, zb = -3/5, h = -6/5,
     a0 = 0.89, a1 = 0, a2 = 0.45, a3 = 0, b0 = 0.89, b1 = 0, b2 = -0.45, b3 = 0],
  time_span = [0, 1])$
"""

REFUSED = {
    "one output too few": (
        ARM.replace(", l*sin(a) + l*sin(b) = sin(t)/4", ""),
        "wrong_number_of_outputs",
    ),
    "an output with a velocity": (ARM.replace("sin(t)/4]", "dot(a)]"), "unknown_name_in_output"),
    "a control that is squared": (
        ARM.replace("tau1 - tau2", "tau1^2 - tau2"),
        "servo_control_not_linear",
    ),
    "a control in the potential energy": (ROD.replace("g*q,", "g*q + F*p,"), "servo_control_in_energy"),
    "the same output twice": (
        ARM.replace("l*sin(a) + l*sin(b) = sin(t)/4", "2*l*cos(a) + 2*l*cos(b) = 3"),
        "servo_condition_on_time",
    ),
    "outputs that fix what a constraint fixes": (
        ROD.replace("x - sin(2*t)/5", "(p - x)^2 + q^2 = 1"),
        "servo_undetermined",
    ),
    "what holds on the constraints alone": (
        ROD.replace("x - sin(2*t)/5", "sqrt((p - x)^2 + q^2) = 1"),
        "servo_undetermined",
    ),
    "the same output twice, in agreement": (
        ARM.replace("l*sin(a) + l*sin(b) = sin(t)/4", "2*l*cos(a) + 2*l*cos(b) = 2*({across})"),
        "servo_undetermined",
    ),
    "a damper on the way, whose relative degree of four was called three": (
        """
        system : holonomic_system(coordinates = [x, y, z], controls = [F],
          kinetic_energy = (dot(x)^2 + dot(y)^2 + dot(z)^2)/2, forces = [push = [F, 0, 0],
          damping = [dot(y) - dot(x), dot(x) - 2*dot(y) + dot(z), dot(y) - dot(z)]])$
        odd : holonomic_scene(system, servo_constraints = [z - t^4], initial_state = [x = 0])$""",
        "servo_of_velocities",
    ),
    "a control in no force that is called for": (
        ROD.replace("servo_constraints = ", "effects = [], servo_constraints = "),
        "servo_control_without_force",
    ),
    "a relative degree of three": (
        """
        system : holonomic_system(coordinates = [x, y], controls = [F], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
          forces = [push = [F, dot(x)]])$
        odd : holonomic_scene(system, servo_constraints = [y - t^4], initial_state = [x = 0])$""",
        "servo_of_velocities",
    ),
    "a governor of rigid bodies, whose condition took minutes": (GOVERNOR, "servo_of_velocities"),
    "a start where the controls push nowhere": (
        """
        system : holonomic_system(coordinates = [x], controls = [F], kinetic_energy = dot(x)^2/2, forces = [x*F])$
        start : holonomic_scene(system, servo_constraints = [x - t], initial_state = [], time_span = [0, 1])$""",
        "servo_rank_at_start",
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_no_control_can_do_is_refused(what):
    text, refusal = REFUSED[what]
    with refused(refusal):
        holonom.system(text.format(across="1 + cos(t)/4")).simulate(samples=2)


def test_a_path_by_a_long_table_is_refused_before_the_work():
    """All polynomials of the table stand in the equations, and the motion meets each in equations of its own."""
    points = ", ".join(f"[{k}/100, {k % 7}]" for k in range(501))
    scene = holonom.system(ROD.replace("sin(2*t)/5", f"table([{points}])"))
    with refused("long_servo_table"):
        scene.simulate()


WINCH = """
system : holonomic_system(coordinates = [x, y, z], controls = [u, w], forces = [motor = [u, u, 0]],
  kinetic_energy = (dot(x)^2 + dot(y)^2 + dot(z)^2)/2, constraints = [z - w])$
driven : holonomic_scene(system, control_law = [w = {law}], servo_constraints = [x - {path}],
  initial_state = [y = 0, dot(y) = 0], time_span = [0, 2])$
"""


@pytest.mark.parametrize("law", ["1 + abs(t - 1)/4", "table([[0, 5/4], [1, 1], [2, 5/4]])"])
def test_a_law_in_parts_beside_servo_constraints_was_an_error_of_lisp(law):
    """In closed form: u moves x and y alike, and the law moves z alone, whose reaction takes the impulse of a kink."""
    motion = holonom.system(WINCH.format(law=law, path="sin(t)")).simulate(samples=5)
    t = np.array(motion.times, dtype=float)
    assert motion["x"] == pytest.approx(np.sin(t), abs=1e-14)
    assert motion["y"] == pytest.approx(np.sin(t) - t, abs=1e-14)
    assert motion["z"][::2] == pytest.approx([5 / 4, 1, 5 / 4], abs=1e-14)
    assert motion.report.trusted


@pytest.mark.parametrize("path", ["abs(t - 1)/4", "z"])
def test_an_impulse_along_the_path_took_the_place_of_one_of_the_controls(path):
    """It left y at rest, which u moves as it moves x."""
    with failing(ErrorKind.NO_WAY_ON, "t = 1"):
        holonom.system(WINCH.format(law="1 + abs(t - 1)/4", path=path)).simulate(samples=2)


def test_what_takes_the_controls_as_given_is_refused():
    with refused("servo_not_possible"):
        holonom.system(ROD).effects()


SINGULAR = """
system : holonomic_system(coordinates = [x, y], controls = [F], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  potential_energy = {energy}, forces = [{forces}])$
driven : holonomic_scene(system, servo_constraints = [x - t^2], initial_state = [],
  initial_guess = [x = 0, dot(x) = 0, y = -1, dot(y) = 1], time_span = [0, {end}])$
"""
TWO_CONTROLS = """
system : holonomic_system(coordinates = [x, y], controls = [F, G], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  forces = [F + G, F + t*G])$
driven : holonomic_scene(system, servo_constraints = [x - t^2, y - t^3],
  initial_state = [x = 0, dot(x) = 0, y = 0, dot(y) = 0], time_span = [0, 2])$
"""
ZEROS = {
    "F*(t - 1), 0": 1,
    "F*(t - sqrt(2)), 0": 2**0.5,
    "F*y^2, 0": 1,  # y = t - 1
    "F*sin(y), 0": 1,
    "F*cos(x), 0": (np.pi / 2) ** 0.5,
    "F*(t - 1)^4, 0": 1,
    "F*abs(t - 1), 0": 1,
    "F*(t - 1/3)*(t - 2/3), 0": 1 / 3,
}


def end_of(text, **options):
    """The time that a refused simulation names."""
    with pytest.raises(HolonomError) as refused:
        holonom.system(text).simulate(**options)
    assert refused.value.kind is ErrorKind.NO_WAY_ON
    return float(refused.value.detail.split(",")[0])


@pytest.mark.parametrize("forces", ZEROS)
def test_servo_constraint_ends_where_its_control_is_infinite(forces):
    """x'' = 2 = F m(t, y): F = 2/m has no value where m vanishes."""
    text = SINGULAR.format(forces=forces, energy=0, end=2)
    assert end_of(text) == pytest.approx(ZEROS[forces], abs=1e-8)


@pytest.mark.parametrize(
    "options", [{"engine": "robust"}, {"precision": "quadruple"}, {"samples": 2}, {"max_step": 0.3}]
)
def test_servo_constraint_ends_at_a_singular_control_under_every_option(options):
    assert end_of(SINGULAR.format(forces="F*(t - 1), 0", energy=0, end=2), **options) == pytest.approx(1, abs=1e-8)


def test_servo_constraint_ends_at_a_singular_control_on_runge_kutta(c_compiler):
    assert end_of(SINGULAR.format(forces="F*y, 0", energy=0, end=2), engine="runge-kutta") == pytest.approx(1, abs=1e-8)


def test_two_servo_constraints_end_where_the_determinant_of_their_controls_vanishes():
    """F + G = 2, F + t G = 6 t: G = (6 t - 2)/(t - 1)."""
    assert end_of(TWO_CONTROLS) == pytest.approx(1, abs=1e-8)


def test_servo_constraint_of_relative_degree_four_ends_at_a_singular_control():
    """A spring of unit stiffness: y = x + x'', y'' = 2 = F (t - 1) - (y - x)."""
    text = SINGULAR.format(forces="0, F*(t - 1)^2", energy="(x - y)^2/2", end=2)
    assert end_of(text) == pytest.approx(1, abs=1e-8)


@pytest.mark.parametrize(
    ("forces", "end", "control"),
    [
        ("F*(t - 1), 0", 0.9, -20),
        ("F*((t - 1)^2 + 1/10^6), 0", 2, 2 / (1 + 1e-6)),  # a narrow peak of 2 10^6
        ("F*exp(-20*t), 0", 2, 2 * np.exp(40)),
        ("F/(t - 1), 0", 2, 2),
    ],
)
def test_servo_constraint_passes_a_control_that_stays_finite(forces, end, control):
    motion = holonom.system(SINGULAR.format(forces=forces, energy=0, end=end)).simulate(samples=2)
    assert motion["x"][-1] == pytest.approx(end**2, rel=1e-12)
    assert motion["F"][-1] == pytest.approx(control, rel=1e-9)


def test_sweep_breaks_off_where_the_control_is_infinite(tmp_path):
    """F (t - p): of p = 1 and p = 3 the first is singular inside the span."""
    text = SINGULAR.format(forces="F*(t - p), 0", energy=0, end=2)
    text = text.replace("controls = [F],", "controls = [F], parameters = [p],").replace(
        "time_span", "parameter_values = [p = 3], time_span"
    )
    rows = holonom.sweep(holonom.system(text), values={"p": [1, 3]}, keep=["x"]).to_pandas()
    assert list(rows["status"]) == ["broken off", "ok"]


def test_servo_constraints_in_quadruple_precision_give_the_torques_of_inverse_dynamics():
    motion = holonom.system(ARM.format(across="1 + cos(t)/4")).simulate(samples=3, precision="quadruple")
    truth = np.array(inverse_dynamics()(motion.times.astype(float)))
    found = [[float(number) for number in motion[name]] for name in ("a", "b", "tau1", "tau2")]
    assert np.array(found) == pytest.approx(truth, rel=1e-13, abs=1e-13)
    assert motion.report.trusted


CRANE_IN_UNITS = """m_ : {mass}$ l_ : {length}$ t_ : {time}$
system : holonomic_system(coordinates = [x, l, phi], controls = [F, W], parameters = [M, m, g],
  kinetic_energy = M*dot(x)^2/2 + m*((dot(x) + dot(l)*sin(phi) + l*cos(phi)*dot(phi))^2
    + (dot(l)*cos(phi) - l*sin(phi)*dot(phi))^2)/2,
  potential_energy = [gravity = -m*g*l*cos(phi)], forces = [drives = [F, W, 0]])$
s : holonomic_scene(system, parameter_values = [M = 3*m_, m = m_, g = 10*l_/t_^2],
  servo_constraints = [x + l*sin(phi) = l_*sin(t/t_)/5, l*cos(phi) = l_*(2 + t^2/t_^2/50)], initial_state = [],
  initial_guess = [x = 0, l = 2*l_, phi = 0, dot(x) = 0, dot(l) = 0, dot(phi) = 0], time_span = [0, 2*t_])$
"""


@pytest.mark.parametrize(
    "units",
    [
        (Fraction(1, 10**27), Fraction(1, 10**10), Fraction(1, 10**13)),
        pytest.param((10**30, 10**9, 10**7), marks=pytest.mark.long),
    ],
)
def test_forces_of_a_crane_are_the_same_in_other_units(units):
    """F does not move the load where the rope hangs straight, at the start: its weight in the least squares was one."""

    def moved(mass, length, time):
        motion = holonom.system(CRANE_IN_UNITS.format(mass=mass, length=length, time=time)).simulate(samples=5)
        assert motion.report.trusted
        assert [segment.engine for segment in motion.report.segments] == ["taylor"]
        force = float(mass * length / Fraction(time) ** 2)
        return np.array([motion["F"] / force, motion["W"] / force, motion["x"] / float(length), motion["phi"]])

    assert moved(*units) == pytest.approx(moved(1, 1, 1), rel=1e-10, abs=1e-10)


WAITING = """system : holonomic_system(coordinates = [x], controls = [F], kinetic_energy = dot(x)^2/2,
  forces = [F - signum(dot(x))])$
waiting : holonomic_scene(system, servo_constraints = [x = %s], initial_state = [], time_span = [0, 2])$"""


@pytest.mark.parametrize(("to", "force"), [(-1, -7), (1, 7)])
def test_a_path_that_waits_and_goes_backwards_changed_the_sign_of_friction_again_and_again(to, force):
    scene = holonom.system(WAITING % f"{to}*max(0, t - 1)^3")
    report = scene.simulate(samples=3).report
    assert report.controls["F"] == pytest.approx(force)
    assert report.undetermined == ("F",)  # any force up to that of friction lets the mass wait


@pytest.mark.parametrize("path", ["-t^3", "t^3", "t^2"])
def test_a_path_that_starts_at_rest_leaves_no_force_open(path):
    assert holonom.system(WAITING % path).simulate(samples=3).report.undetermined == ()


def test_a_path_that_comes_to_rest_leaves_the_force_open():
    assert holonom.system(WAITING % "-max(0, 1 - t)^3").simulate(samples=3).report.undetermined == ("F",)
