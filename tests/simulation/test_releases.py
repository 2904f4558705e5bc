"""Joints that are released: constraints end, the state continues, and what follows has a closed form."""

import json
from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import holonom
from holonom.crosscheck.motion_program import ScenePrograms, verify_programs
from holonom.crosscheck.report import Verdict
from holonom.failures import HolonomError
from holonom.figures.drawing import animation, film_of
from holonom.program.motion_problem import problem_document, read_problem
from holonom.program.request import Request, Solve
from holonom.sandbox import Limits
from holonom.simulation.hybrid_motion import EventOutcome
from holonom.simulation.request import FINAL_STATE_ALONE, SimulationRequest
from holonom.simulation.result import Simulation
from holonom.simulation.simulate import simulate

# Released from rest where the thread is horizontal: at the depth d the tension is 3 m g d/l.
CUT = """
load("holonom.mac")$
bob : particle(m, [x, y])$
thread : distance_joint(bob, [0, 0], l)$
system : holonomic_system(parameters = [m, g, l], assembly(bob, thread, uniform_gravity(g, bob)))$
run : holonomic_scene(system, parameter_values = [m = 2, g = 10, l = 1], time_span = [0, 2],
  initial_state = [x = 1, y = 0, dot(y) = 0], {ends},
  observe = [trajectory, multipliers, energy, tension = -l*lambda1])$
"""

# Two masses on a rod turn about their mass centre, which moves, at the rate 2.
THROWN = """
load("holonom.mac")$
a : particle(1, [x1, y1])$  b : particle(3, [x2, y2])$
rod : distance_joint(a, b, 4)$
system : holonomic_system(parameters = [c], assembly(a, b, rod))$
run : holonomic_scene(system, parameter_values = [c = 1], time_span = [0, 3], released = [rod = t - c],
  initial_state = [x1 = 3, y1 = 0, x2 = -1, y2 = 0, dot(x1) = 1, dot(y1) = 6, dot(x2) = 1, dot(y2) = -2])$
"""

# A chain of two threads; the lower one is cut at c, the upper one where the upper bob has reached the height h.
CHAIN = """
load("holonom.mac")$
a : particle(1, [x1, y1])$  b : particle(1, [x2, y2])$
upper : distance_joint(a, [0, 0], 1)$  lower : distance_joint(a, b, 1)$
system : holonomic_system(parameters = [c, h, g], assembly(a, b, upper, lower, uniform_gravity(g, a, b)))$
run : holonomic_scene(system, parameter_values = [c = 1/10, h = -1/2, g = 10], time_span = [0, 1],
  released = [lower = t - c, upper = y1 - h],
  initial_state = [x1 = 1, y1 = 0, x2 = 2, y2 = 0, dot(y1) = 0, dot(y2) = 0])$
"""

# Two bobs at rest below their centres; the fall of the one whose thread is cut at 1 pulls the other to the right.
PULLED = """
load("holonom.mac")$
a : particle(1, [x1, y1])$  b : particle(1, [x2, y2])$
upper : distance_joint(a, [0, 0], 1)$  lower : distance_joint(b, [5, 0], 1)$
system : holonomic_system(parameters = [g], assembly(a, b, upper, lower, uniform_gravity(g, a, b),
  applied_force([-(y1 + 1), 0], b)))$
run : holonomic_scene(system, parameter_values = [g = 10], time_span = [0, 3],
  released = [upper = t - 1, lower = (x2 - 5)*(51/10 - x2)],
  initial_state = [x1 = 0, y1 = -1, x2 = 5, y2 = -1, dot(x1) = 0, dot(x2) = 0])$
"""

# A body welded to an arm that turns at the rate 2, let go when the arm has turned by a right angle.
WELDED = """
load("holonom.mac")$
arm : rigid_body(1, [1, 1, 1], [x1, y1, z1], [a0, a1, a2, a3])$
load_ : rigid_body(1, [1, 2, 3], [x, y, z], [e0, e1, e2, e3])$
A : marker(arm, [0, 0, 0], [0, 0, 1])$  Q : marker(ground, [0, 0, 0], [0, 0, 1])$
weld : generic_joint(marker(load_, [0, 0, 0], [0, 0, 1]), marker(arm, [1, 0, 0], [0, 0, 1]), [1, 2, 3], [1, 2, 3])$
system : holonomic_system(assembly(arm, load_, revolute_joint(A, Q), prescribed_angle(A, Q, theta), weld))$
run : holonomic_scene(system, time_span = [0, 2], released = [weld = theta - %pi/2],
  initial_state = [x1 = 0, y1 = 0, z1 = 0, a0 = 1, a1 = 0, a2 = 0, a3 = 0, theta = 0, dot(theta) = 2,
    x = 1, y = 0, z = 0, e0 = 1, e1 = 0, e2 = 0, e3 = 0])$
"""


def released(motion: Simulation) -> list[tuple[float, str]]:
    assert {each.outcome for each in motion.report.switchings} == {EventOutcome.JOINT_RELEASED}
    return [(each.t, each.function) for each in motion.report.switchings]


def test_a_cut_thread_vanishes_from_the_film():
    """Each thread at its time; the bobs stay."""
    motion = holonom.system(CHAIN).simulate(samples=21)
    (lower, _), (upper, _) = released(motion)
    numbers, times = motion.drawing.numbers(motion["t"], motion.coordinates), motion["t"]
    last = [
        (shape, times[np.isfinite(rows).all(axis=1)][-1])
        for shape, rows in zip(motion.drawing.shapes, numbers, strict=False)
    ]
    assert [t for shape, t in last if shape == "segment"] == [times[times <= cut][-1] for cut in (upper, lower)]
    assert {t for shape, t in last if shape == "point"} == {1.0}
    assert animation(film_of(motion, motion.drawing)).count('attributeName="visibility"') == 2


def test_a_condition_that_is_zero_until_another_joint_is_released_was_never_examined():
    motion = holonom.system(PULLED).simulate(samples=3)
    (_, lower), at = released(motion), holonom.system(PULLED).simulate
    assert at(until=lower[0], samples=2)["x2"][-1] == pytest.approx(5.1, rel=1e-13)


@pytest.mark.parametrize(("condition", "left"), [("t", ("t",)), ("y - 1", ("y-1",)), ("t - 1/2", ())])
def test_conditions_that_do_not_cross_zero_are_reported(condition, left):
    """The time is zero at first, and does not cross zero after that."""
    motion = holonom.system(CUT.replace("{ends}", f"released = [thread = {condition}]")).simulate()
    assert motion.report.unreleased == left
    assert len(motion.report.switchings) == 1 - len(left)


def test_cut_thread_lets_the_bob_fly_on_a_parabola():
    motion = holonom.system(CUT.replace("{ends}", "released = [thread = t - 1/2]")).simulate(samples=9)
    assert released(motion) == [(0.5, "t-1/2")]
    since = motion["t"][2:] - 0.5
    at = {name: motion[name][2] for name in ("x", "y", "dot(x)", "dot(y)")}
    np.testing.assert_allclose(motion["x"][2:], at["x"] + at["dot(x)"] * since, atol=1e-12)
    np.testing.assert_allclose(motion["y"][2:], at["y"] + at["dot(y)"] * since - 5 * since**2, atol=1e-12)
    np.testing.assert_allclose(motion["x"][:3] ** 2 + motion["y"][:3] ** 2, 1, atol=1e-13)
    assert (motion["lambda1"][1:3] < 0).all()
    assert not motion["lambda1"][3:].any()
    np.testing.assert_allclose(motion["energy"], 0, atol=1e-12)


def test_thread_breaks_at_its_largest_tension():
    """3 m g d/l = 30 at d = 1/2; the mean of vx is that there, sqrt(10)/2, from then on."""
    motion = holonom.system(CUT.replace("{ends}", "released = [thread = tension - 30]")).simulate(samples=9)
    ((t, _),) = released(motion)
    np.testing.assert_allclose(motion["dot(x)"][motion["t"] > t], -np.sqrt(10) / 2, rtol=1e-11)
    assert not motion["tension"][motion["t"] > t].any()


def test_contact_ends_where_it_no_longer_presses():
    """A bead leaves a dome of radius 1 at the height h = (2 + v^2/g)/3, with the speed sqrt(g h) along the dome."""
    motion = holonom.system("""
bead : particle(m, [x, y])$
dome : distance_joint(bead, [0, 0], 1)$
system : holonomic_system(parameters = [m, g], assembly(bead, dome, gravity = uniform_gravity(g, bead)))$
slide : holonomic_scene(system, parameter_values = [m = 1, g = 10], initial_state = [x = 0, dot(x) = 1],
  initial_guess = [y = 1, dot(y) = 0], released = [dome = lambda1], until = [y], time_span = [0, 5])$
""").simulate()
    (release,), h = motion.report.switchings, 0.7
    assert release.function == "lambda1"
    assert motion.report.velocities["dot(x)"] == pytest.approx(np.sqrt(10 * h) * h, rel=1e-11)
    assert motion.report.velocities["dot(y)"] == pytest.approx(-np.sqrt(10 * h * (1 - h**2) + 20 * h), rel=1e-11)


def test_motion_ends_in_free_flight_where_until_says():
    ends = "released = [thread = y + 1/2], until = [y + 3]"
    motion = holonom.system(CUT.replace("{ends}", ends)).simulate(samples=5)
    ((t, _),) = released(motion)
    fall = Fraction(5, 2)  # y = -1/2 - v (T - t) - 5 (T - t)^2, v = sqrt(10) cos(pi/6)
    v = np.sqrt(7.5)
    assert float(motion.report.t) - t == pytest.approx((np.sqrt(v**2 + 20 * float(fall)) - v) / 10, abs=1e-11)


@pytest.mark.parametrize("engine", ["taylor", "runge-kutta", "robust"])
def test_two_bodies_fly_apart_along_straight_lines(engine):
    motion = holonom.system(THROWN).simulate(samples=4, engine=engine, c=2)
    t, turn = np.array([2.0, 3.0]), 4.0
    np.testing.assert_allclose(motion["x1"][2:], t + 3 * np.cos(turn) - 6 * np.sin(turn) * (t - 2), atol=1e-9)
    np.testing.assert_allclose(motion["y1"][2:], 3 * np.sin(turn) + 6 * np.cos(turn) * (t - 2), atol=1e-9)
    np.testing.assert_allclose(motion["x1"] + 3 * motion["x2"], 4 * motion["t"], atol=1e-9)


def test_welded_body_flies_off_along_the_tangent_and_keeps_its_spin():
    motion = holonom.system(WELDED).simulate(samples=5)
    ((t, _),) = released(motion)
    assert t == pytest.approx(np.pi / 4, abs=1e-12)
    flying = motion["t"] > t
    np.testing.assert_allclose(motion["x"][flying], -2 * (motion["t"][flying] - np.pi / 4), atol=1e-11)
    np.testing.assert_allclose(motion["y"][flying], 1, atol=1e-11)
    np.testing.assert_allclose(motion["e3"], np.sin(motion["t"]), atol=1e-11)
    np.testing.assert_allclose(motion["theta"], 2 * motion["t"], atol=1e-11)


def test_releases_keep_the_digits_of_a_longer_precision():
    motion = holonom.system(THROWN).simulate(samples=4, precision="quadruple")
    ends = motion["y1"][-1] + 3 * motion["y2"][-1]
    assert abs(float(ends)) < 1e-28


@pytest.mark.parametrize(("h", "first"), [("-1/1000", "y1-h"), ("-1/2", "t-c")])
def test_joints_are_released_in_the_order_of_their_events(h, first):
    motion = holonom.system(CHAIN.replace("h = -1/2", f"h = {h}")).simulate(samples=11)
    order = released(motion)
    assert order[0][1] == first
    assert len(order) == 2
    last = motion["t"] > order[1][0]
    for name in ("x1", "x2"):
        rates = motion[f"dot({name})"][last]
        np.testing.assert_allclose(rates, rates[0], rtol=1e-12, atol=1e-12)
    rates = motion["dot(y2)"] + 10 * motion["t"]
    np.testing.assert_allclose(rates[last], rates[-1], rtol=1e-12, atol=1e-12)
    assert not motion["lambda1"][last].any()
    assert not motion["lambda2"][last].any()


def test_who_follows_one_analytic_motion_refuses_released_joints():
    scene = holonom.system(THROWN)
    asked = (scene.rhs, scene.dae, scene.equilibria, scene.free, lambda: scene.linearize(at=2))
    sweep = holonom.sweep
    for ask in (*asked, lambda: scene.program().inputs, lambda: sweep(scene, grid={"c": (1, 2, 2)}, keep=["final"])):
        with pytest.raises(HolonomError) as stopped:
            ask()
        assert "t-c" in stopped.value.reason


def test_check_verifies_the_motion_after_each_release():
    report = holonom.system(CHAIN).check()
    after = [verdict for verdict in report.verdicts if "; after " in verdict.name]
    assert {verdict.verdict for verdict in after} == {Verdict.AGREES}
    assert sum("direct solve; after" in verdict.name for verdict in after) == 4  # of two joints in both orders


def test_check_finds_constraints_that_do_not_end(write_scene):
    file = write_scene(THROWN)
    description = holonom.load(file).description
    answer = {solve: problem_document(file, Request(solve=solve), Limits()) for solve in Solve}
    wrong = {solve: json.loads(text) for solve, text in answer.items()}
    for document in wrong.values():
        document["released"][0]["after"] = document | {"released": []}
    programs = [ScenePrograms("run", {solve: read_problem(json.dumps(each)) for solve, each in wrong.items()})]
    found = verify_programs(description, programs, "seed")
    assert [each.found.verdict for each in found if "; after t-c = 0" in each.part] == [Verdict.DISAGREES]


def test_the_final_state_alone_was_given_with_the_constraint_that_had_ended():
    """Truth: it falls freely."""
    scene = holonom.system(CUT.format(ends="released = [thread = t - 1/10]"))
    alone = simulate(scene._derived.motion(Request()), SimulationRequest(samples=FINAL_STATE_ALONE)).report
    assert alone.multipliers == {"lambda1": 0}
    assert not alone.violations


def test_a_particle_leaves_a_rough_sphere():
    """Truth: Newton's second law with the normal force N, integrated to N = 0, then a parabola."""
    sphere = holonom.system("""
load("holonom.mac")$
system : holonomic_system(coordinates = [r, phi], parameters = [g, mu],
  kinetic_energy = (dot(r)^2 + r^2*dot(phi)^2)/2, potential_energy = g*r*cos(phi),
  forces = [friction = [0, -mu*abs(lambda1)*r*signum(dot(phi))]], constraints = [r - 1])$
run : holonomic_scene(system, parameter_values = [g = 10, mu = 1/5], released = [lambda1 = lambda1], time_span = [0, 1],
  initial_state = [r = 1, phi = 1/2, dot(phi) = 1])$
""")

    def normal_force(t, state):
        phi, omega = state
        return 10 * np.cos(phi) - omega**2

    def moved(t, state):
        phi, omega = state
        return omega, 10 * np.sin(phi) - normal_force(t, state) / 5

    normal_force.terminal = True
    truth = solve_ivp(moved, (0, 1), (0.5, 1), "DOP853", events=normal_force, rtol=1e-12, atol=1e-14)
    left, (phi, omega) = truth.t_events[0][0], truth.y_events[0][0]
    place, velocity = np.exp(1j * phi), 1j * omega * np.exp(1j * phi)  # upwards is the real axis
    place += velocity * (1 - left) - 5 * (1 - left) ** 2
    motion = sphere.simulate(samples=2)
    assert released(motion) == [(pytest.approx(left, rel=1e-10), "lambda1")]
    assert motion["r"][-1] * np.exp(1j * motion["phi"][-1]) == pytest.approx(place, rel=1e-10)
    after = [each for each in sphere.check().verdicts if "; after " in each.name]
    assert {each.verdict for each in after} == {Verdict.AGREES}


def test_a_block_that_is_lifted_from_another_leaves_it_its_friction_on_the_floor():
    """Truth: weights 10 - 5 t and 20 - 5 t until t = 2, then 0 and 10."""
    blocks = holonom.system("""
load("holonom.mac")$
system : holonomic_system(coordinates = [x1, y1, x2, y2],
  kinetic_energy = (dot(x1)^2 + dot(y1)^2 + dot(x2)^2 + dot(y2)^2)/2, potential_energy = 10*y1 + 10*y2,
  forces = [lift = [0, 0, 0, 5*t], floor = [-abs(lambda1)*signum(dot(x1))/10, 0, 0, 0],
    between = abs(lambda2)*signum(dot(x2) - dot(x1))/5*[1, 0, -1, 0]], constraints = [y1, y2 - y1])$
run : holonomic_scene(system, released = [lambda2 = lambda2], time_span = [0, 3],
  initial_state = [x1 = 0, y1 = 0, x2 = 0, y2 = 0, dot(x1) = 10, dot(y1) = 0, dot(x2) = 20, dot(y2) = 0])$
""")
    motion = blocks.simulate(samples=2)
    assert released(motion) == [(pytest.approx(2, rel=1e-12), "lambda2")]
    assert motion["lambda1"][-1] == pytest.approx(10)
    assert motion["x1"][-1] == pytest.approx(20 - 8 / 12 + 9 - 1 / 2, rel=1e-12)
    assert motion["x2"][-1] == pytest.approx(40 - 4 + 8 / 6 + 18, rel=1e-12)
    assert motion["y2"][-1] == pytest.approx(5 / 6, rel=1e-11)
