"""Controls in forces that hold outputs to a course, against inverse dynamics, flatness and conservation laws."""

import json
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

import holonom
from holonom.failures import HolonomError

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
def test_a_two_link_arm_whose_tip_follows_a_circle_needs_the_torques_of_inverse_dynamics(engine, gsl):
    motion = holonom.system(ARM.format(across="1 + cos(t)/4")).simulate(samples=7, engine=engine)
    truth = np.array(inverse_dynamics()(motion.instants))
    found = np.array([motion[name] for name in ("a", "b", "tau1", "tau2")])
    assert found == pytest.approx(truth, rel=ENGINES[engine], abs=ENGINES[engine])
    assert motion.report.trusted
    assert motion.report.multipliers == {}
    assert max(motion["residual.acceleration"]) < 100 * ENGINES[engine]


@pytest.mark.parametrize("engine", ENGINES)
def test_a_crane_whose_load_follows_a_line_is_flat(engine, gsl):
    """The rope points along the load's acceleration less gravity, which gives angle, tension and both forces."""
    motion = holonom.load(EXAMPLES / "overhead_crane.mac").simulate(samples=6, engine=engine)
    t = sp.Symbol("t")
    across, below = (1 - sp.cos(t)) / 2, 2 - t / 5
    pull = sp.diff(across, t, 2), sp.Rational(981, 100) - sp.diff(below, t, 2)
    phi = -sp.atan(pull[0] / pull[1])
    tension = sp.sqrt(pull[0] ** 2 + pull[1] ** 2)
    trolley = across - below * sp.tan(phi)
    force = 2 * sp.diff(trolley, t, 2) - tension * sp.sin(phi)
    truth = np.array(
        [np.broadcast_to(row, 6) for row in sp.lambdify(t, [trolley, phi, force, -tension])(motion.instants)]
    )
    found = np.array([motion[name] for name in ("x", "phi", "F", "W")])
    assert sorted(motion.report.relative_degrees) == [2, 4]
    assert found == pytest.approx(truth, rel=ENGINES[engine], abs=ENGINES[engine])


def test_a_reaction_stays_where_a_constraint_is_the_systems_own():
    """A pendulum on a shaken trolley: the trolley is where it should be, the rod pulls, and the drive does the work."""
    scene = holonom.system(ROD)
    motion = scene.simulate(samples=9)
    assert motion["x"] == pytest.approx(np.sin(2 * motion.instants) / 5, abs=1e-13)
    assert list(motion.report.multipliers) == ["lambda1"]
    # of the trolley, 2 ddot(x) = F + lambda df/dx
    pull = motion["lambda1"] * -2 * (motion["p"] - motion["x"])
    assert motion["F"] == pytest.approx(-2 * 4 * np.sin(2 * motion.instants) / 5 - pull, rel=1e-11, abs=1e-11)
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


REFUSED = {
    "one output too few": (
        ARM.replace(", l*sin(a) + l*sin(b) = sin(t)/4", ""),
        "prescribe 1 outputs, and 2 controls have no control_law (tau1, tau2); these numbers must be equal",
    ),
    "an output with a velocity": (ARM.replace("sin(t)/4]", "dot(a)]"), "contains 'dot(a)'; an output is made of"),
    "a control that is squared": (
        ARM.replace("tau1 - tau2", "tau1^2 - tau2"),
        "the forces must be linear in the controls",
    ),
    "a control in the constraints": (
        ROD.replace("+ q^2 - 1]", "+ q^2 - 1 - F]"),
        "may stand in forces alone; give the others a control_law",
    ),
    "the same output twice": (
        ARM.replace("l*sin(a) + l*sin(b) = sin(t)/4", "2*l*cos(a) + 2*l*cos(b) = 3"),
        "servo_constraints cannot be kept: no control reaches them",
    ),
    "a relative degree of three": (
        """
        system : holonomic_system(coordinates = [x, y], controls = [F], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
          forces = [push = [F, dot(x)]])$
        odd : holonomic_scene(system, servo_constraints = [y - t^4], initial_state = [x = 0])$""",
        "have the relative degree 3",
    ),
    "a start where the controls push nowhere": (
        """
        system : holonomic_system(coordinates = [x], controls = [F], kinetic_energy = dot(x)^2/2, forces = [x*F])$
        start : holonomic_scene(system, servo_constraints = [x - t], initial_state = [], time_span = [0, 1])$""",
        "at the initial state the controls F move the outputs in only 0 of 1 directions",
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_no_control_can_do_is_refused_in_one_sentence(what):
    text, said = REFUSED[what]
    with pytest.raises(HolonomError) as refused:
        holonom.system(text.format(across="1 + cos(t)/4")).simulate(samples=2)
    assert said in str(refused.value)


def test_a_course_by_a_long_table_is_refused_before_the_work():
    """All polynomials of the table stand in the equations, and the motion meets each in equations of its own."""
    points = ", ".join(f"[{k}/100, {k % 7}]" for k in range(501))
    scene = holonom.system(ROD.replace("sin(2*t)/5", f"table([{points}])"))
    with pytest.raises(HolonomError, match="a table in servo_constraints may have 500 points, .* this one has 501"):
        scene.simulate()


WINCH = """
system : holonomic_system(coordinates = [x, y, z], controls = [u, w], forces = [motor = [u, u, 0]],
  kinetic_energy = (dot(x)^2 + dot(y)^2 + dot(z)^2)/2, constraints = [z - w])$
driven : holonomic_scene(system, control_law = [w = {law}], servo_constraints = [x - {course}],
  initial_state = [y = 0, dot(y) = 0], time_span = [0, 2])$
"""


@pytest.mark.parametrize("law", ["1 + abs(t - 1)/4", "table([[0, 5/4], [1, 1], [2, 5/4]])"])
def test_a_law_in_parts_beside_servo_constraints_was_an_error_of_lisp(law):
    """In closed form: u moves x and y alike, and the law moves z alone, whose reaction takes the impulse of a kink."""
    motion = holonom.system(WINCH.format(law=law, course="sin(t)")).simulate(samples=5)
    t = np.array(motion.instants, dtype=float)
    assert motion["x"] == pytest.approx(np.sin(t), abs=1e-14)
    assert motion["y"] == pytest.approx(np.sin(t) - t, abs=1e-14)
    assert motion["z"][::2] == pytest.approx([5 / 4, 1, 5 / 4], abs=1e-14)
    assert motion.report.trusted


@pytest.mark.parametrize("course", ["abs(t - 1)/4", "z"])
def test_an_impulse_along_the_course_took_the_place_of_one_of_the_controls(course):
    """It left y at rest, which u moves as it moves x."""
    with pytest.raises(
        HolonomError, match="beyond t = 1, where servo-constraints would take an impulse of the controls"
    ):
        holonom.system(WINCH.format(law="1 + abs(t - 1)/4", course=course)).simulate(samples=2)


def test_what_takes_the_controls_as_given_is_refused():
    with pytest.raises(HolonomError, match="a scene with servo_constraints"):
        holonom.system(ROD).effects()
