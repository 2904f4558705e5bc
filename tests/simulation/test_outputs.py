"""Outputs of a scene's own, against the mechanics of a pendulum and of a body on a sliding wedge."""

import numpy as np
import pytest
from refusing import failing

import holonom
from holonom.failures import ErrorKind, HolonomError

PENDULUM = """
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [m, g],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, potential_energy = [gravity = m*g*y], constraints = [x^2 + y^2 - u^2])$
swing : holonomic_scene(system, control_law = [u = {law}], parameter_values = [m = 3/2, g = 981/100],
  initial_state = [x = 3/5, y = -4/5, dot(x) = 0], time_span = [0, 2]{until},
  observe = [trajectory, energy, {outputs}])$
"""
PULL = "pull = -2*lambda1*u, a = [ddot(x), 'diff(y, t, 2)], kinetic = energy - m*g*y"
ENGINES = {"taylor": 1e-13, "runge-kutta": 1e-11, "robust": 1e-9}


def pendulum(outputs: str = PULL, law: str = "1", until: str = "") -> holonom.Scene:
    return holonom.system(PENDULUM.format(outputs=outputs, law=law, until=until))


@pytest.mark.parametrize("engine", ENGINES)
def test_tension_of_a_pendulum_is_weight_and_centripetal_force(engine, c_compiler):
    motion = pendulum().simulate(samples=21, engine=engine)
    speed2 = motion["dot(x)"] ** 2 + motion["dot(y)"] ** 2
    tension = 1.5 * (speed2 - 9.81 * motion["y"])
    assert motion["pull"] == pytest.approx(tension, rel=ENGINES[engine])
    assert motion["a[1]"] == pytest.approx(-tension * motion["x"] / 1.5, rel=ENGINES[engine], abs=1e-8)
    assert motion["a[2]"] == pytest.approx(-tension * motion["y"] / 1.5 - 9.81, rel=ENGINES[engine], abs=1e-8)
    assert motion["kinetic"] == pytest.approx(0.75 * speed2, abs=1e-9)


def test_outputs_of_controls_have_the_rates_of_the_law():
    motion = pendulum("rates = [u, dot(u), ddot(u)]", law="1 + t^2/10").simulate(samples=5)
    t = motion.times
    assert np.array([motion[f"rates[{k}]"] for k in (1, 2, 3)]) == pytest.approx(
        np.array([1 + t**2 / 10, t / 5, np.full(5, 0.2)])
    )


def test_outputs_come_after_the_state_in_keys_frames_and_files(tmp_path):
    motion = pendulum().simulate(samples=3)
    own = ("pull", "a[1]", "a[2]", "kinetic")
    assert tuple(motion) == motion.keys() == ("t", "x", "y", "dot(x)", "dot(y)", *own, "energy", "energy_error")
    assert tuple(motion.report.outputs) == own
    assert motion.report.outputs["pull"] == motion["pull"][-1]
    assert list(motion.to_pandas()["pull"]) == list(motion["pull"])


def test_outputs_have_the_digits_of_the_motion():
    found = pendulum().simulate(samples=2, precision=40)
    x, v, y, w = (found[name][-1] for name in ("x", "dot(x)", "y", "dot(y)"))
    assert abs(float(found["pull"][-1] - (v**2 + w**2) * 3 / 2 + 981 * y * 3 / 200)) < 1e-36
    assert float(x**2 + y**2) == pytest.approx(1)


def test_a_motion_ends_at_the_zero_of_an_output():
    report = pendulum("lift = y + 4/5 + t/10", until=", until = [lift = -1/10]").simulate(samples=2).report
    assert 0 < report.t < 1
    assert report.coordinates["y"] == pytest.approx(-0.9 - report.t / 10, rel=1e-13)


def test_an_output_without_a_value_is_refused_with_its_time():
    with failing(ErrorKind.NO_WAY_ON, "t = 1", "root"):
        pendulum("root = sqrt(1/2 - t)").simulate(samples=5)


@pytest.mark.parametrize(
    ("outputs", "refusal"),
    [
        ("tip = lambda2*x", "unknown_name_in_observe"),
        ("tip = dddot(x)", "unknown_name_in_observe"),
        ("x = 2*y", "unusable_output_name"),
        ("t = 2*y", "unusable_output_name"),
        ("energy = 2*y", "unusable_output_name"),
        ("tip = x, tip = y", "given_twice"),
        ("tip = []", "wrong_output"),
        ("tip = asin(2)", "not_a_real_expression"),
    ],
)
def test_outputs_that_are_not_known_are_refused(outputs, refusal):
    with pytest.raises(HolonomError) as refused:
        pendulum(outputs).description()
    assert refused.value.refusal == refusal


def test_an_output_may_change_its_sign_without_switching_the_motion():
    motion = pendulum("far = max(x, 1/5), side = signum(x)").simulate(samples=21)
    assert motion["far"] == pytest.approx(np.maximum(motion["x"], 0.2))
    assert list(motion["side"]) == list(np.sign(motion["x"]))
    assert not motion.report.switchings


STUCK = """
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [dry = [-signum(dot(x))]])$
braked : holonomic_scene(system, initial_state = [x = 0, dot(x) = 1], time_span = [0, 2],
  observe = [trajectory, force = ddot(x)])$
"""


def test_outputs_follow_a_motion_through_its_switchings():
    motion = holonom.system(STUCK).simulate(samples=4)  # it stops at t = 1
    assert motion["force"] == pytest.approx([-1, -1, 0, 0], abs=1e-12)


CART = """
system : holonomic_system(coordinates = [x, y], controls = [F], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  forces = [drive = [F, 0]], constraints = [y - x])$
led : holonomic_scene(system, servo_constraints = [x = sin(t)], initial_state = [], time_span = [0, 2],
  observe = [trajectory, push = F - lambda1])$
"""


def test_outputs_hold_controls_that_servo_constraints_find():
    motion = holonom.system(CART).simulate(samples=5)
    assert motion["push"] == pytest.approx(-np.sin(motion.times))  # of the driven half: its acceleration


SHAKEN = """
bob : particle(m, [x + shaking*u, y])$
system : holonomic_system(controls = [u], parameters = [m], switches = [shaking],
  assembly(bob, coordinates = [x]), constraints = [x^2 + y^2 - 1])$
turn : holonomic_scene(system, effects = {effects}, control_law = [u = t^2], parameter_values = [m = 1],
  initial_state = [x = 1, y = 0, dot(y) = 1], time_span = [0, 1],
  observe = [trajectory, apart = position(bob)[1] - x, rate = velocity(bob)[1] - dot(x)])$
"""


@pytest.mark.parametrize(("effects", "shaking"), [("[shaking]", 1), ("[]", 0)])
def test_outputs_have_the_switches_that_the_scene_chooses(effects, shaking):
    motion = holonom.system(SHAKEN.format(effects=effects)).simulate(samples=3)
    assert motion["apart"] == pytest.approx(shaking * motion.times**2)
    assert motion["rate"] == pytest.approx(2 * shaking * motion.times)
