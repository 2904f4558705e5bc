"""Reactions of joints and forces of loads, against the equations of Newton and Euler of each body."""

import io

import numpy as np
import pytest
from rich.console import Console

import holonom
from holonom.display.motion import show_simulation

ROD = """
rod : {body}$
top : marker(rod, {place})$
hinge : revolute_joint(top, [0, 0])$
system : holonomic_system(parameters = [m, l, g], assembly(rod, hinge, gravity = uniform_gravity(g, rod)))$
swing : holonomic_scene(system, parameter_values = [m = 2, l = 3, g = 10], time_span = [0, 1],
  initial_state = {start}, observe = [trajectory, multipliers, R = reaction(hinge), {own}])$
"""


def test_pivot_of_a_rod_carries_weight_and_inertia():
    """A rod of mass 2 and length 3 under g = 10: its angle has the second rate -3 g cos(phi)/(2 l) = -5 cos(phi)."""
    motion = holonom.system(
        ROD.format(
            body="planar_body(m, m*l^2/12, [x, y], phi)",
            place="[-l/2, 0]",
            start="[phi = 0, dot(phi) = 1, x = 3/2, y = 0]",
            own="B = reaction(hinge, rod, rod), tip = [position(end), velocity(end), acceleration(end)][3]",
        ).replace("hinge :", "end : marker(rod, [l/2, 0])$ hinge :")
    ).simulate(samples=11)
    phi, w = motion["phi"], motion["dot(phi)"]
    across, along = -7.5 * np.cos(phi), -1.5 * w**2  # acceleration of the centre
    a = np.array([along * np.cos(phi) - across * np.sin(phi), along * np.sin(phi) + across * np.cos(phi)])
    force = 2 * (a + np.array([[0], [10]]))
    assert np.array([motion["R[1]"], motion["R[2]"]]) == pytest.approx(force, abs=1e-12)
    assert motion["R[3]"] == pytest.approx(np.zeros(11), abs=1e-12)
    own = [2 * along + 20 * np.sin(phi), 2 * across + 20 * np.cos(phi)]
    assert np.array([motion["B[1]"], motion["B[2]"]]) == pytest.approx(np.array(own), abs=1e-12)
    assert np.array([motion["tip[1]"], motion["tip[2]"]]) == pytest.approx(2 * a, abs=1e-12)


def test_pivot_of_a_thin_rod_by_its_ends_carries_the_same():
    """The same rod by the places of its ends: its constraint is its own, the hinge's are the reaction."""
    motion = holonom.system(
        ROD.format(
            body="uniform_rod(m, l, [x1, y1], [x2, y2])",
            place="[0]",
            start="[x1 = 0, y1 = 0, x2 = 3, y2 = 0, dot(x1) = 0, dot(y1) = 0, dot(x2) = 0, dot(y2) = 3]",
            own="c = acceleration(marker(rod, [l/2]))",
        )
    ).simulate(samples=11)
    assert motion["R[1]"] == pytest.approx(2 * motion["c[1]"], abs=1e-12)
    assert motion["R[2]"] == pytest.approx(2 * motion["c[2]"] + 20, abs=1e-12)
    assert motion["R[3]"] == pytest.approx(np.zeros(11), abs=1e-12)


SLIDER_CRANK = """
crank  : planar_body(2, 1/3, [x1, y1], a)$
rod    : planar_body(3, 1, [x2, y2], b)$
slider : planar_body(4, 1/2, [x3, y3], c)$
guide  : prismatic_joint(marker(slider, [0, 0], [1, 0]), marker(ground, [0, 1/10], [1, 0]))$
pivot  : revolute_joint(marker(crank, [-1/2, 0]), [0, 0])$
pin    : revolute_joint(marker(crank, [1/2, 0]), marker(rod, [-1, 0]))$
wrist  : revolute_joint(marker(rod, [1, 0]), marker(slider, [0, 1/5]))$
push   : spring(50, 1, marker(slider, [1/4, 0]), [4, 0])$
drag   : damper(2, marker(slider, [1/4, 0]), [4, 1])$
drive  : applied_torque(5, crank)$
system : holonomic_system(assembly(crank, rod, slider, guide, pivot, pin, wrist, push, drag, drive,
  gravity = uniform_gravity(10, crank, rod, slider)))$
turn   : holonomic_scene(system, initial_state = [a = 1, dot(a) = 2], time_span = [0, 1],
  initial_guess = [x1 = 1/4, y1 = 1/2, x2 = 5/4, y2 = 1/2, b = -3/10, x3 = 2, y3 = 1/10, c = 0],
  observe = [trajectory, multipliers, G = reaction(guide), P = reaction(pivot), Q = reaction(pin),
    R = reaction(pin, rod), W = reaction(wrist), S = force(push), D = force(drag), T = force(drive),
    A = [ddot(x1), ddot(y1), ddot(a)],
    B = [ddot(x2), ddot(y2), ddot(b)], C = [ddot(x3), ddot(y3), ddot(c)]])$
"""


@pytest.fixture(scope="module")
def slider_crank():
    return holonom.system(SLIDER_CRANK).simulate(samples=6)


def test_multipliers_belong_to_the_joints_that_wrote_their_constraints(slider_crank):
    joints = slider_crank.report.joints
    assert list(joints) == [f"lambda{k}" for k in range(1, 9)]
    assert list(joints.values()) == ["guide", "guide", "pivot", "pivot", "pin", "pin", "wrist", "wrist"]
    text = io.StringIO()
    show_simulation(Console(file=text, width=120), slider_crank)
    assert "lambda3 (pivot)" in text.getvalue()


def rows(motion, name, count):
    return np.array([motion[f"{name}[{k}]"] for k in range(1, count + 1)])


def test_each_body_of_a_slider_crank_obeys_newton_and_euler(slider_crank):
    def found(name):
        return rows(slider_crank, name, 3)

    def moment(arm, angle, wrench):
        c, s = np.cos(slider_crank[angle]), np.sin(slider_crank[angle])
        x, y = c * arm[0] - s * arm[1], s * arm[0] + c * arm[1]
        return wrench[2] + x * wrench[1] - y * wrench[0]

    guide, pivot, pin, on, wrist, push, drag, drive = (found(name) for name in ("G", "P", "Q", "R", "W", "S", "D", "T"))
    crank, rod, slider = (found(name) for name in "ABC")
    down = np.array([[0], [-10]])
    assert on == pytest.approx(-pin)
    assert 2 * crank[:2] == pytest.approx(pivot[:2] + pin[:2] + 2 * down)
    assert crank[2] / 3 == pytest.approx(moment([-0.5, 0], "a", pivot) + moment([0.5, 0], "a", pin) + 5)
    assert drive == pytest.approx(np.array([[0] * 6, [0] * 6, [5] * 6]))
    assert 3 * rod[:2] == pytest.approx(on[:2] + wrist[:2] + 3 * down)
    assert rod[2] == pytest.approx(moment([-1, 0], "b", on) + moment([1, 0], "b", wrist))
    assert 4 * slider[:2] == pytest.approx(-wrist[:2] + guide[:2] + push[:2] + drag[:2] + 4 * down)
    turning = moment([0, 0.2], "c", -wrist) + moment([0.25, 0], "c", push) + moment([0.25, 0], "c", drag)
    assert slider[2] / 2 == pytest.approx(turning + guide[2], abs=1e-10)
    assert guide[0] == pytest.approx(np.zeros(6), abs=1e-10)  # no friction


def test_springs_and_dampers_pull_along_their_line(slider_crank):
    at = np.array([slider_crank["x3"] + 0.25, slider_crank["y3"]])
    to_wall = np.array([[4], [0]]) - at
    length = np.hypot(*to_wall)
    assert rows(slider_crank, "S", 2) == pytest.approx(50 * (length - 1) * to_wall / length)
    away = np.array([[4], [1]]) - at
    speed = -slider_crank["dot(x3)"] * away[0] / np.hypot(*away)  # of the distance; the slider moves along x
    assert rows(slider_crank, "D", 2) == pytest.approx(2 * speed * away / np.hypot(*away))


IN_SPACE = """
E     : [e0, e1, e2, e3]$
V     : [[ax, ay, az], [bx, by, bz], [cx, cy, cz]]$
upper : rigid_body(2, [1/3, 1/2, 3/5], [x, y, z], E)$
lower : natural_body(3, [1, 4/5, 7/10], [p, q, r], V)$
hinge : revolute_joint(marker(upper, [0, 0, 1/2], [1, 0, 0]), marker(ground, [0, 0, 0], [1, 0, 0]))$
cross : universal_joint(marker(lower, [0, 1/3, 1], [0, 1, 0]), marker(upper, [1/5, 0, -1/2], [1, 0, 0]))$
tow   : spring(20, 1/2, marker(lower, [0, 0, -1]), [2, 1, -1])$
system : holonomic_system(assembly(upper, lower, hinge, cross, tow, gravity = uniform_gravity(10, upper, lower)))$
fall  : holonomic_scene(system, time_span = [0, 1/2],
  initial_state = [x = 0, y = 0, z = -1/2, e0 = 1, e1 = 0, e2 = 0, e3 = 0,
    p = 1/5, q = -1/3, r = -2, ax = 1, ay = 0, az = 0, bx = 0, by = 1, bz = 0, cx = 0, cy = 0, cz = 1, dot(e1) = 1/2,
    dot(az) = -1/2, dot(bz) = 3/2],
  observe = [trajectory, H = reaction(hinge), K = reaction(cross, upper), L = reaction(cross),
    own = reaction(cross, lower, lower), S = force(tow), A = acceleration(upper), B = acceleration(lower),
    e = map(ddot, E), v = map(ddot, flatten(V)),
    arms = append(position(marker(upper, [0, 0, 1/2])), position(marker(upper, [1/5, 0, -1/2])),
      position(marker(lower, [0, 1/3, 1])), position(marker(lower, [0, 0, -1])))])$
"""


def skew_part(matrices):
    return np.array([matrices[:, 2, 1], matrices[:, 0, 2], matrices[:, 1, 0]])


def moments_of(turned, rate, second, inertia):
    """Rate of the angular momentum about the mass centre, of R, dR/dt, d2R/dt2, shape (k, 3, 3)."""
    w = skew_part(rate @ turned.transpose(0, 2, 1))
    alpha = skew_part(second @ turned.transpose(0, 2, 1) + rate @ rate.transpose(0, 2, 1))
    tensor = turned @ np.diag(inertia) @ turned.transpose(0, 2, 1)
    momentum = np.einsum("kij,jk->ik", tensor, w)
    return np.einsum("kij,jk->ik", tensor, alpha) + np.cross(w, momentum, axis=0)


def products(e, f):
    """The terms of the rotation matrix as bilinear forms, shape (k, 3, 3)."""
    (a, b, c, d), (p, q, r, s) = e, f
    found = [
        [a * p + b * q - c * r - d * s, 2 * (b * r - a * s), 2 * (b * s + a * r)],
        [2 * (b * r + a * s), a * p - b * q + c * r - d * s, 2 * (c * s - a * q)],
        [2 * (b * s - a * r), 2 * (c * s + a * q), a * p - b * q - c * r + d * s],
    ]
    return np.array(found).transpose(2, 0, 1)


def symmetric(e, f):
    return (products(e, f) + products(f, e)) / 2


def test_bodies_in_space_obey_newton_and_euler():
    """Euler parameters and natural coordinates, a hinge, a universal joint and a spring."""
    motion = holonom.system(IN_SPACE).simulate(samples=5)
    hinge, below, above, own, tow = (rows(motion, name, 6) for name in ("H", "K", "L", "own", "S"))
    down = np.array([[0], [0], [-10]])
    assert 2 * rows(motion, "A", 3) == pytest.approx(hinge[:3] + below[:3] + 2 * down, abs=1e-9)
    assert 3 * rows(motion, "B", 3) == pytest.approx(above[:3] + tow[:3] + 3 * down, abs=1e-9)
    assert below == pytest.approx(-above, abs=1e-9)
    upper, lower = (np.array([motion[name] for name in names]) for names in ("xyz", "pqr"))
    arms = rows(motion, "arms", 12).reshape(4, 3, -1)

    e, de = (np.array([motion[mark.format(k)] for k in range(4)]) for mark in ("e{}", "dot(e{})"))
    dde = rows(motion, "e", 4)
    turned = symmetric(e, e), 2 * symmetric(e, de), 2 * (symmetric(de, de) + symmetric(e, dde))
    exerted = hinge[3:] + np.cross(arms[0] - upper, hinge[:3], axis=0)
    exerted = exerted + below[3:] + np.cross(arms[1] - upper, below[:3], axis=0)
    assert moments_of(*turned, [1 / 3, 1 / 2, 3 / 5]) == pytest.approx(exerted, abs=1e-8)

    names = [f"{vector}{axis}" for vector in "abc" for axis in "xyz"]
    v, dv = (np.array([motion[mark.format(name)] for name in names]) for mark in ("{}", "dot({})"))
    turned = [each.reshape(3, 3, -1).transpose(2, 1, 0) for each in (v, dv, rows(motion, "v", 9))]
    exerted = above[3:] + np.cross(arms[2] - lower, above[:3], axis=0)
    exerted = exerted + tow[3:] + np.cross(arms[3] - lower, tow[:3], axis=0)
    assert moments_of(*turned, [1, 4 / 5, 7 / 10]) == pytest.approx(exerted, abs=1e-8)
    rotation = turned[0].transpose(0, 2, 1)
    for part in (slice(0, 3), slice(3, 6)):
        assert own[part] == pytest.approx(np.einsum("kij,jk->ik", rotation, above[part]), abs=1e-9)
    along_hinge = hinge[3]  # nothing turns the hinge about its axis, x
    assert along_hinge == pytest.approx(np.zeros(5), abs=1e-9)


DOOR = """
door : rigid_body(20, [5/3, 5/3, 5/3], [x, y, z], [e0, e1, e2, e3])$
low  : revolute_joint(marker(door, [-1/2, 0, -1], [0, 0, 1]), marker(ground, [0, 0, 0], [0, 0, 1]))$
high : {high}$
system : holonomic_system(assembly(door, low, {name} applied_torque([0, 0, 30], door), uniform_gravity(10, door)))$
rest : holonomic_scene(system, time_span = [0, 1], initial_state = [x = 1/2, y = 0, z = 1, e0 = 1, e1 = 0, e2 = 0,
    e3 = 0, dot(e3) = 0], observe = [trajectory, R = reaction(low), {own}])$
"""


def test_hinge_of_a_door_carries_its_weight():
    """At rest, of width 1 and mass 20; 30/(5/3 + 20/4) = 4.5 turns it, and accelerates its centre by 2.25."""
    motion = holonom.system(DOOR.format(high="0", name="", own="a = acceleration(door)")).simulate(samples=2)
    assert rows(motion, "a", 3)[:, 0] == pytest.approx([0, 2.25, 0], abs=1e-12)
    assert rows(motion, "R", 6)[:, 0] == pytest.approx([0, 45, 200, -45, -100, 0], abs=1e-10)
    assert motion.report.undetermined == ()


def test_two_hinges_share_a_door_in_a_way_that_is_not_unique():
    """Their sum is unique, and that neither turns the door about its axis or the ball about any."""
    high = "spherical_joint(marker(door, [-1/2, 0, 1]), [0, 0, 2])"
    own = "S = reaction(high), force = [R[1] + S[1], R[2] + S[2], R[3] + S[3]]"
    motion = holonom.system(DOOR.format(high=high, name="high,", own=own)).simulate(samples=2)
    assert rows(motion, "force", 3)[:, 0] == pytest.approx([0, 45, 200], abs=1e-10)
    assert motion.report.undetermined == ("R[1]", "R[2]", "R[3]", "R[4]", "R[5]", "S[1]", "S[2]", "S[3]")
    text = io.StringIO()
    show_simulation(Console(file=text, width=200), motion)
    assert "Outputs that are not unique: R[1], R[2], R[3], R[4], R[5], S[1], S[2], S[3]." in text.getvalue()


def test_outputs_are_unique_once_a_redundant_joint_is_released():
    high = "spherical_joint(marker(door, [-1/2, 0, 1]), [0, 0, 2])"
    text = DOOR.format(high=high, name="high,", own="S = reaction(high)").replace(
        "observe =", "released = [high = t - 1/2], observe ="
    )
    motion = holonom.system(text).simulate(samples=5)
    assert motion.report.undetermined == ()
    assert rows(motion, "S", 6)[:, -1] == pytest.approx(np.zeros(6), abs=1e-12)
    assert rows(motion, "R", 3)[2, -1] == pytest.approx(200)


SHARED = """
bob   : planar_body(1, 1, [x, y], phi)$
pivot : revolute_joint(bob, [0, 0])$
rail  : point_on_line(bob, marker(ground, [0, 0], [1, 0]))$
system : holonomic_system(assembly(bob, pivot, rail, uniform_gravity(10, bob), applied_force([3, 0], bob)))$
run : holonomic_scene(system, initial_state = [x = 0, y = 0, phi = 0, dot(phi) = 1], time_span = [0, 1], {released}
  observe = [trajectory, multipliers, P = reaction(pivot), R = reaction(rail), S = P[2] + R[2]])$
"""


def test_joints_that_share_a_constraint_share_its_force():
    motion = holonom.system(SHARED.format(released="")).simulate(samples=2)
    assert motion["S"] == pytest.approx([10, 10])  # and not the weight for each
    assert motion.report.undetermined == ("P[2]", "R[2]")
    assert list(motion.report.joints.values()) == ["pivot", "pivot", "rail"]


def test_shared_constraint_stays_when_one_of_its_joints_is_released():
    """The rail holds the bob, which 3 moves along it for 1/2."""
    motion = holonom.system(SHARED.format(released="released = [pivot = t - 1/2],")).simulate(samples=3)
    assert motion["y"] == pytest.approx([0, 0, 0])
    assert motion["x"] == pytest.approx([0, 0, 3 / 8])
    assert motion["R[2]"][-1] == pytest.approx(10)


def test_gear_turns_rotors_by_its_moments():
    """The torque T turns J1 and, geared by r1/r2 = 2/3, J2: in one coordinate (J1 + 4/9 J2) a = T."""
    scene = holonom.system("""
first : rotor(J1, a)$
second : rotor(J2, b)$
teeth : gear(2, first, 3, second)$
system : holonomic_system(parameters = [J1, J2, T], assembly(first, second, teeth, applied_torque(T, first)))$
run : holonomic_scene(system, parameter_values = [J1 = 1, J2 = 9, T = 10], initial_state = [a = 0, dot(a) = 0],
  initial_guess = [b = 0, dot(b) = 0], time_span = [0, 1],
  observe = [trajectory, A = reaction(teeth), B = reaction(teeth, second)])$
""")
    motion = scene.simulate(samples=3)
    assert motion["a"] == pytest.approx([0, 0.25, 1])
    assert motion["A[1]"] == pytest.approx([-8] * 3)
    assert motion["B[1]"] == pytest.approx([-12] * 3)


def test_rack_on_the_centre_of_its_own_wheel_is_the_friction_of_rolling():
    """A disc of m = 2 and I = 1 with r = 1 is pulled by 3: (m + I/r^2) a = 3, and the ground brakes it by I a."""
    scene = holonom.system("""
disc  : planar_body(2, 1, [x, y], phi)$
grip  : rack(disc, marker(ground, [0, 1], [1, 0]), -1, disc)$
system : holonomic_system(assembly(disc, point_on_line(disc, marker(ground, [0, 1], [1, 0])), grip,
  applied_force([3, 0], disc)))$
roll : holonomic_scene(system, initial_state = [x = 0, y = 1, phi = 0, dot(phi) = 0], time_span = [0, 1],
  observe = [trajectory, G = reaction(grip)])$
""")
    motion = scene.simulate(samples=2)
    assert motion["x"] == pytest.approx([0, 1 / 2])
    assert rows(motion, "G", 3)[:, -1] == pytest.approx([-1, 0, -1])
