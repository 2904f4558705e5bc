"""Derivatives of motions, against closed forms and differences."""

import json
from math import cosh, sinh, sqrt

import numpy as np
import pytest
import sympy as sp
from refusing import failing
from scipy.integrate import quad, solve_ivp
from scipy.special import beta

import holonom
from holonom.failures import ErrorKind, HolonomError

SPRING = """
system : holonomic_system(coordinates = [x], parameters = [m, k], kinetic_energy = m*dot(x)^2/2,
  potential_energy = k*x^2/2)$
scene : holonomic_scene(system, parameter_values = [m = 2, k = 8], initial_state = [x = 3, dot(x) = 1],
  time_span = [0, 5])$
"""
BEAD = """
system : holonomic_system(coordinates = [r, phi], controls = [u], parameters = [m, w],
  kinetic_energy = m*(dot(r)^2 + r^2*dot(phi)^2)/2, constraints = [phi - u])$
scene : holonomic_scene(system, control_law = [u = w*t], parameter_values = [m = 3, w = 2],
  initial_state = [r = 1, dot(r) = 0], time_span = [0, 1])$
"""
CIRCLE = """
system : holonomic_system(coordinates = [x, y], parameters = [g, l], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  potential_energy = g*y, constraints = [x^2 + y^2 - l^2])$
scene : holonomic_scene(system, parameter_values = [g = 981/100, l = 1], {start}, time_span = [0, 3])$
"""
ANGLE = """
system : holonomic_system(coordinates = [phi], parameters = [g, l], kinetic_energy = l^2*dot(phi)^2/2,
  potential_energy = -g*l*cos(phi))$
scene : holonomic_scene(system, parameter_values = [g = 981/100, l = 1], initial_state = [phi = asin(3/5),
  dot(phi) = 0], time_span = [0, 3])$
"""
FALL = """
system : holonomic_system(coordinates = [y], parameters = [g, h], kinetic_energy = dot(y)^2/2,
  potential_energy = g*y)$
scene : holonomic_scene(system, parameter_values = [g = 10, h = 5], initial_state = [y = h, dot(y) = 0],
  time_span = [0, 5], until = [y])$
"""
SLIDE = """
system : holonomic_system(coordinates = [x], parameters = [mu, g, v], kinetic_energy = dot(x)^2/2,
  forces = [friction = [-mu*g*signum(dot(x))]])$
scene : holonomic_scene(system, parameter_values = [mu = 1/4, g = 10, v = 3], initial_state = [x = 0, dot(x) = v],
  time_span = [0, 2])$
"""
PUSH = """
system : holonomic_system(coordinates = [x], controls = [F], parameters = [m, P, T],
  kinetic_energy = m*dot(x)^2/2, forces = [push = [F]])$
scene : holonomic_scene(system, control_law = [F = if t < T then P else 0],
  parameter_values = [m = 2, P = 6, T = 1], initial_state = [x = 0, dot(x) = 0], time_span = [0, 3])$
"""
SHARED = """
system : holonomic_system(coordinates = [x], controls = [F], parameters = [m, T], kinetic_energy = m*dot(x)^2/2,
  forces = [push = [F]])$
scene : holonomic_scene(system, control_law = [F = if t < T then 6*t + 2 else 3*t],
  parameter_values = [m = 1, T = 1], initial_state = [x = 0, dot(x) = 0], time_span = [0, 2])$
"""
SLING = """
beam : planar_body(20, 30, [xb, yb], th)$  stone : particle(2, [x, y])$
system : holonomic_system(parameters = [s],
  assembly(beam, stone, revolute_joint(marker(beam, [-1, 0]), [0, 1]), distance_joint(stone, marker(beam, [3/2, 0]), s),
    uniform_gravity(10, beam, stone)))$
scene : holonomic_scene(system, parameter_values = [s = 2], initial_state = [th = -asin(2/5), dot(th) = 0, x = 3/10,
  dot(x) = 0], initial_guess = [xb = 9/10, yb = 6/10, y = 1/5], time_span = [0, 1])$
"""
THROWN = """
a : particle(1, [x1, y1])$  b : particle(3, [x2, y2])$
rod : distance_joint(a, b, 4)$
system : holonomic_system(parameters = [c], assembly(a, b, rod))$
scene : holonomic_scene(system, parameter_values = [c = 1], time_span = [0, 3], released = [rod = t - c],
  initial_state = [x1 = 3, y1 = 0, x2 = -1, y2 = 0, dot(x1) = 1, dot(y1) = 6, dot(x2) = 1, dot(y2) = -2])$
"""
WEIGHED = """
system : holonomic_system(coordinates = [r, phi], controls = [u], parameters = [m, w],
  kinetic_energy = m*(dot(r)^2 + r^2*dot(phi)^2)/2, constraints = [phi - u])$
scene : holonomic_scene(system, control_law = [u = w*t], parameter_values = [m = 3, w = 2],
  initial_state = [r = 1, dot(r) = 0], time_span = [0, 1],
  observe = [ratio = ddot(r)/r, moment = lambda1/m, work = m*dot(r)^2/2], until = [lambda1 - 20, lambda1 + 20])$
"""
HALTED = """
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [a, w, T],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2, constraints = [(x - u)^2 + y^2 - 1])$
scene : holonomic_scene(system, control_law = [u = if t < T then a*t else a*T],
  parameter_values = [a = 2, w = 3, T = 1], time_span = [0, 3],
  initial_state = [x = 3/5, y = -4/5, dot(x) = a + 4*w/5, dot(y) = 3*w/5])$
"""
KICKED = """
system : holonomic_system(coordinates = [x, y, X, Y], controls = [u], parameters = [a, m, M, T, e],
  kinetic_energy = m*((dot(x) + y*dot(u)/3)^2 + dot(y)^2)/2 + M*(dot(X)^2 + dot(Y)^2)/2,
  potential_energy = 10*(m*y + M*Y), constraints = [(x - u)^2 + y^2 - 1, (X - x)^2 + (Y - y)^2 - 1])$
scene : holonomic_scene(system, control_law = [u = if t < T then a*t + t^2/2 else a*T + T^2/2 - (t - T)/5],
  parameter_values = [a = 2, m = 1, M = 3/2, T = 1, e = 0], time_span = [0, 2],
  initial_state = [x = 3/5 + e, dot(x) = 1, X = 6/5, dot(X) = 1/2], initial_guess = [y = -4/5, Y = -8/5])$
"""
APART = """
system : holonomic_system(coordinates = [x, y, z], parameters = [e],
  kinetic_energy = (dot(x)^2 + dot(y)^2 + dot(z)^2)/2,
  potential_energy = 50^2*x^2/2 - 9^2*z^2/2 - 10^12*e*y)$
scene : holonomic_scene(system, parameter_values = [e = 0], time_span = [0, 4],
  initial_state = [x = 1, dot(x) = 0, y = 0, dot(y) = 0, z = 0, dot(z) = 0])$
"""
DOUBLY_GIVEN = """
system : holonomic_system(coordinates = [x, a, b], parameters = [m, r], potential_energy = 3*(x - 1)^2/2,
  kinetic_energy = m*dot(x)^2/2 + (dot(a)^2 + dot(b)^2)/2, constraints = [x - r*a, r*a + b])$
scene : holonomic_scene(system, parameter_values = [m = 1, r = 1/2], time_span = [0, 1],
  initial_state = [x = 0, b = 0, dot(x) = 0], initial_guess = [a = 0])$
"""
REDUNDANT = """
system : holonomic_system(coordinates = [x, y, a], parameters = [m], kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2
    + dot(a)^2/4, potential_energy = 10*m*y, constraints = [x^2 + y^2 - 1, x - cos(a), y - sin(a)])$
scene : holonomic_scene(system, parameter_values = [m = 1], initial_state = [a = 1/2, dot(a) = 0],
  initial_guess = [x = 9/10, y = 1/2, dot(x) = 0, dot(y) = 0], time_span = [0, 1])$
"""


def circle(start: str) -> holonom.Scene:
    return holonom.system(CIRCLE.format(start=start))


GIVEN = circle("initial_state = [x = 3*l/5, y = -4*l/5, dot(x) = 0, dot(y) = 0]")
GUESSED = circle("initial_state = [x = 3/5, dot(x) = 0], initial_guess = [y = -1]")


def test_the_oscillator_of_the_textbook():
    """x = x0 cos(w t) + v0/w sin(w t), w^2 = k/m."""
    motion = holonom.system(SPRING).simulate(samples=21, sensitivities=["k", "m", "x", "dot(x)"])
    t, w, x0, v0 = motion["t"], 2.0, 3.0, 1.0
    by_w = -x0 * t * np.sin(w * t) + v0 * (t * np.cos(w * t) / w - np.sin(w * t) / w**2)
    for name, expected in {
        "d(x, x)": np.cos(w * t),
        "d(x, dot(x))": np.sin(w * t) / w,
        "d(x, k)": by_w / (2 * w * 2),
        "d(x, m)": -by_w * w / (2 * 2),
        "d(dot(x), x)": -w * np.sin(w * t),
    }.items():
        assert motion[name] == pytest.approx(expected, abs=1e-12), name
    assert motion.report.sensitivities["d(x, k)"] == motion["d(x, k)"][-1]


def test_multipliers_of_the_bead_on_a_turning_wire():
    """r = cosh(w t), and the moment lambda1 = 2 m w r dot(r)."""
    motion = holonom.system(BEAD).simulate(samples=5, sensitivities="w,m")
    c, s = (np.array([f(2 * t) for t in motion["t"]]) for f in (cosh, sinh))
    t, w, m = motion["t"], 2.0, 3.0
    assert motion["d(r, w)"] == pytest.approx(t * s, abs=1e-12)
    assert motion["d(r, m)"] == pytest.approx(0 * t, abs=1e-12)
    sign = np.sign(motion["lambda1"][-1])
    by_w = 2 * m * (2 * w * c * s + w**2 * t * (c**2 + s**2))
    assert motion["d(lambda1, w)"] == pytest.approx(sign * by_w, rel=1e-12, abs=1e-11)
    assert motion["d(lambda1, m)"] == pytest.approx(sign * 2 * w**2 * c * s, rel=1e-12, abs=1e-11)


@pytest.mark.parametrize("scene", [GIVEN, GUESSED], ids=["given", "guessed"])
def test_an_initial_value_takes_the_others_along_the_manifold(scene):
    """The pendulum in x and y, and in its angle: dx0 = l cos(phi0) dphi0."""
    motion = scene.simulate(samples=7, sensitivities=["g", "x"])
    angle = holonom.system(ANGLE).simulate(samples=7, sensitivities=["g", "phi"])
    cos, sin = np.cos(angle["phi"]), np.sin(angle["phi"])
    assert motion["d(x, g)"] == pytest.approx(cos * angle["d(phi, g)"], abs=1e-11)
    assert motion["d(x, x)"] == pytest.approx(cos * angle["d(phi, phi)"] / 0.8, abs=1e-11)
    assert motion["d(y, x)"] == pytest.approx(sin * angle["d(phi, phi)"] / 0.8, abs=1e-11)


def test_a_parameter_of_the_start_moves_the_start():
    """Twice the length is the same motion in a time sqrt(2) times as long: l dx/dl = x - t dot(x)/2."""
    motion = GIVEN.simulate(samples=7, sensitivities="l")
    assert motion["d(x, l)"] == pytest.approx(motion["x"] - motion["t"] * motion["dot(x)"] / 2, abs=1e-11)


def test_an_event_moves_with_the_parameters():
    """A body falls from h in t = sqrt(2 h/g), and arrives with sqrt(2 g h)."""
    end = holonom.system(FALL).simulate(samples=3, sensitivities=["g", "h"]).report.sensitivities
    assert end["d(t, h)"] == pytest.approx(1 / sqrt(2 * 5 * 10), rel=1e-12)
    assert end["d(t, g)"] == pytest.approx(-1 / 2 * sqrt(2 * 5 / 10**3), rel=1e-12)
    assert end["d(dot(y), h)"] == pytest.approx(-sqrt(10 / (2 * 5)), rel=1e-12)
    assert end["d(y, g)"] == pytest.approx(0, abs=1e-12)


def test_friction_that_stops_a_body():
    """It stops after v/(mu g), having come v^2/(2 mu g) far."""
    motion = holonom.system(SLIDE).simulate(samples=5, sensitivities=["mu", "v"])
    assert motion["d(x, v)"][-1] == pytest.approx(3 / 2.5, rel=1e-12)
    assert motion["d(x, mu)"][-1] == pytest.approx(-(3**2) / (2 * 0.25**2 * 10), rel=1e-12)
    assert motion["d(dot(x), v)"][-1] == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("tol", [1e-4, 1e-8])
def test_coarse_tolerances(tol):
    """Friction stops the body at the same place, and the pendulum swings on."""
    slid = holonom.system(SLIDE).simulate(samples=3, sensitivities="v", tol=tol)
    assert slid["d(x, v)"][-1] == pytest.approx(3 / 2.5, rel=100 * tol)
    swung, fine = (GIVEN.simulate(samples=3, sensitivities="g", tol=each) for each in (tol, 1e-14))
    assert swung["d(x, g)"] == pytest.approx(fine["d(x, g)"], abs=1000 * tol)


def test_the_time_of_a_law_that_switches():
    """x = P T (t - T/2)/m after the push is over."""
    motion = holonom.system(PUSH).simulate(samples=4, sensitivities=["T", "P"])
    assert motion["d(x, T)"][-1] == pytest.approx(6 * (3 - 1) / 2, rel=1e-12)
    assert motion["d(x, P)"][-1] == pytest.approx(1 * (3 - 1 / 2) / 2, rel=1e-12)
    assert motion["d(dot(x), T)"][-1] == pytest.approx(6 / 2, rel=1e-12)


def test_the_time_of_a_release():
    """A mass turns about the mass centre at 2 rad/s and a distance of 3, and flies on when the rod is released."""
    motion = holonom.system(THROWN).simulate(samples=4, sensitivities="c")
    expected = [0 if t <= 1 else -12 * np.cos(2) * (t - 1) for t in motion["t"]]
    assert motion["d(x1, c)"] == pytest.approx(expected, abs=1e-11)


def test_the_impulse_of_a_support_that_halts():
    """Without gravity the pendulum turns at w, and at w + a cos(phi(T)) after its support halts at T."""
    motion = holonom.system(HALTED).simulate(samples=6, sensitivities=["a", "w", "T"])
    t, a, w, T = motion["t"], 2.0, 3.0, 1.0
    at_halt, since = np.arcsin(3 / 5) + w * T, np.maximum(t - T, 0)
    after = w + a * np.cos(at_halt)
    phi = np.where(t < T, at_halt + w * (t - T), at_halt + after * since)
    expected = {
        "a": np.cos(at_halt) * since,
        "w": np.minimum(t, T) + (1 - a * np.sin(at_halt) * T) * since,
        "T": np.where(t < T, 0, w - after - a * np.sin(at_halt) * w * since),
    }
    for name, change in expected.items():
        assert motion[f"d(y, {name})"] == pytest.approx(np.sin(phi) * change, abs=1e-12), name


@pytest.mark.parametrize(
    ("name", "value"),
    [("a", 2), *(pytest.param(*each, marks=pytest.mark.long) for each in [("m", 1), ("M", 1.5), ("T", 1), ("e", 0)])],
)
def test_differences_of_a_motion_with_an_impulse(name, value):
    """The energy contains the velocity of the support, so momenta jump with it."""
    scene, step = holonom.system(KICKED), 1e-5
    found, ahead, behind = (
        scene.simulate(samples=4, sensitivities=[name], **{name: value + h}) for h in (0, step, -step)
    )
    for quantity in (*found.coordinates, *found.velocities):
        difference = (ahead[quantity] - behind[quantity]) / (2 * step)
        assert found[f"d({quantity}, {name})"] == pytest.approx(difference, abs=1e-6), quantity


def test_outputs_of_a_scene_of_its_own():
    """ddot(r)/r = w^2, lambda1/m = w^2 sinh(2 w t) up to its sign; the end is where m w^2 sinh(2 w t) is 20."""
    motion = holonom.system(WEIGHED).simulate(samples=5, sensitivities="w,m")
    t, w, m, end = motion["t"], 2.0, 3.0, motion.report.sensitivities
    assert motion["d(ratio, w)"] == pytest.approx(2 * w + 0 * t, rel=1e-12)
    assert motion["d(ratio, m)"] == pytest.approx(0 * t, abs=1e-12)
    moment = 2 * w * np.sinh(2 * w * t) + 2 * t * w**2 * np.cosh(2 * w * t)
    assert np.abs(motion["d(moment, w)"]) == pytest.approx(moment, rel=1e-12, abs=1e-12)
    rate = 2 * w * m * w**2 * cosh(2 * w * t[-1])
    assert end["d(t, m)"] == pytest.approx(-20 / m / rate, rel=1e-11)
    assert end["d(moment, m)"] == pytest.approx(-np.sign(motion["moment"][-1]) * 20 / m**2, rel=1e-11)
    work = w**2 * sinh(w * t[-1]) ** 2 / 2 + end["d(t, m)"] * m * w**3 * sinh(w * t[-1]) * cosh(w * t[-1])
    assert end["d(work, m)"] == pytest.approx(work, rel=1e-11)


def test_the_time_of_a_law_with_numbers():
    """The velocity is 3 T^2 + 2 T + 3/2 (t^2 - T^2) after it."""
    motion = holonom.system(SHARED).simulate(samples=3, sensitivities="T")
    assert motion["d(dot(x), T)"][-1] == pytest.approx(3 + 2, rel=1e-12)


def test_a_sweep_keeps_derivatives():
    """x = x0 cos(w t) + v0/w sin(w t) at t = 5."""
    swept = holonom.sweep(
        holonom.system(SPRING), values={"k": [2, 8]}, keep=["x", "d(x, k)", "d(x, x)", "d(dot(x), dot(x))"]
    ).to_pandas()
    w = np.sqrt(np.array([2, 8]) / 2)
    by_w = -3 * 5 * np.sin(5 * w) + 5 * np.cos(5 * w) / w - np.sin(5 * w) / w**2
    assert swept["d(x,k)"].to_numpy() == pytest.approx(by_w / (4 * w), rel=1e-10)
    assert swept["d(x,x)"].to_numpy() == pytest.approx(np.cos(5 * w), rel=1e-10)
    assert swept["d(dot(x),dot(x))"].to_numpy() == pytest.approx(np.cos(5 * w), rel=1e-10)
    for asked in ("d(x, m)", "d(q, k)", "d(x + 1, k)"):
        with pytest.raises(HolonomError) as refused:
            holonom.sweep(holonom.system(SPRING), values={"k": [2]}, keep=[asked])
        assert refused.value.kind is ErrorKind.NOT_AN_OUTPUT


@pytest.mark.parametrize(
    ("example", "name", "value", "until"),
    [
        ("andrews", "c0", 4530.0, "1/100"),
        ("crane", "M", 200.0, "1/2"),
        ("heavy_top", "I1", 0.0005, "1/2"),
        ("hoist", "g", 9.81, "1/2"),
        ("overhead_crane", "g", 9.81, "1/2"),
        ("whirling_bob", "l0", 1.0, "1/2"),
    ],
)
def test_differences_of_an_example(example, name, value, until):
    """In overhead_crane servo-constraints find the controls, hoist has a table, heavy_top one constraint too many."""
    scene, step = holonom.load(f"examples/{example}.mac"), 1e-4 * value
    found, ahead, behind = (
        scene.simulate(samples=4, until=until, sensitivities=[name], **{name: value + h}) for h in (0, step, -step)
    )
    for quantity in (*found.coordinates, *found.multipliers):
        difference = (ahead[quantity] - behind[quantity]) / (2 * step)
        size = max(np.max(np.abs(found[quantity])) / value, 1e-6)
        assert found[f"d({quantity}, {name})"] == pytest.approx(difference, rel=1e-6, abs=1e-6 * size), quantity


@pytest.mark.parametrize(
    ("scene", "options"),
    [
        (holonom.system(SPRING), {"sensitivities": "q"}),
        (holonom.system(SPRING), {"sensitivities": "k", "precision": "extended"}),
        (holonom.system(SPRING), {"sensitivities": "k", "stabilization": "ggl"}),
    ],
    ids=["no parameter", "other numbers", "other equations"],
)
def test_refusals(scene, options):
    with pytest.raises(HolonomError) as refused:
        scene.simulate(**options)
    assert refused.value.kind is ErrorKind.NO_SENSITIVITY


@pytest.mark.parametrize("stiffness", ["10^400", "10^(-400)"])
def test_a_parameter_beyond_a_double_ended_in_an_internal_error(stiffness):
    scene = holonom.system(SPRING.replace("k = 8", f"k = {stiffness}"))
    with failing(ErrorKind.SETTING_TOO_LARGE):
        scene.simulate(until=1, sensitivities="k")


def test_no_numbers_are_refused():
    """The pivots of the program vanish in the linkage's dead centres."""
    with pytest.raises(HolonomError) as refused:
        holonom.load("examples/linkage.mac").simulate(sensitivities="g")
    assert refused.value.kind is ErrorKind.NO_SENSITIVITY


def test_a_start_moves_in_one_joint_alone():
    """The length of a sling moves the stone, and the beam by nothing but rounding errors."""
    scene = holonom.system(SLING)
    found = scene.simulate(until="1/100", samples=2, sensitivities=["s"])
    below = sqrt(2**2 - (0.3 - 2.5 * sqrt(1 - 0.4**2)) ** 2)
    for name, expected in {"x": 0, "y": 2 / below, "xb": 0, "yb": 0, "dot(y)": 0}.items():
        assert found[f"d({name}, s)"][0] == pytest.approx(expected, abs=1e-12)


def test_a_start_near_a_guess_that_fits_follows():
    """With l the point nearest to (0, -1) moves along the string."""
    motion = circle("initial_state = [], initial_guess = [x = 0, y = -1, dot(x) = 0, dot(y) = 0]").simulate(
        samples=3, sensitivities=["l", "g"]
    )
    assert motion["d(y, l)"] == pytest.approx([-1, -1, -1], rel=1e-12)
    assert motion["d(x, g)"] == pytest.approx([0, 0, 0], abs=1e-12)


@pytest.mark.parametrize(
    "start",
    [
        "initial_state = [x = 3/5, y = -4/5, dot(x) = 0]",
        "initial_state = [dot(x) = 0], initial_guess = [x = 1, y = -1]",
    ],
    ids=["given", "nearest of many"],
)
def test_a_start_that_does_not_follow_is_refused(start):
    with pytest.raises(HolonomError) as refused:
        circle(start).simulate(sensitivities="l")
    assert refused.value.kind is ErrorKind.NO_INITIAL_STATE


def test_on_the_command_line(tmp_path, holonom_here):
    file, samples = tmp_path / "scene.mac", tmp_path / "samples.csv"
    file.write_text(f'load("holonom.mac")$ {SPRING}', encoding="utf-8")
    run = holonom_here("simulate", file, "--sensitivity", "k,x", "--samples", "5", "-o", samples, "--json", "-")
    assert run.returncode == 0
    document = json.loads(run.stdout)
    assert list(document["sensitivities"]) == ["d(x, k)", "d(x, x)", "d(dot(x), k)", "d(dot(x), x)"]
    assert (
        samples.read_text(encoding="utf-8")
        .splitlines()[0]
        .endswith('"d(x, k)","d(x, x)","d(dot(x), k)","d(dot(x), x)"')
    )


def test_large_derivatives_do_not_coarsen_the_motion():
    """The push e moves the second body by 5e11 after a second. The first one swings as without it."""
    scene = holonom.system(APART)
    plain, found = scene.simulate(samples=5), scene.simulate(samples=5, sensitivities=["e", "x", "z"])
    t = plain["t"]
    for motion in (plain, found):
        assert motion["x"] == pytest.approx(np.cos(50 * t), abs=1e-12)
    assert found["d(y, e)"] == pytest.approx(1e12 * t**2 / 2, rel=1e-14)
    assert found["d(x, x)"] == pytest.approx(np.cos(50 * t), abs=1e-12)
    assert found["d(z, z)"] == pytest.approx(np.cosh(9 * t), rel=1e-12)


def test_an_initial_value_more_than_is_needed_was_refused():
    """x = 1 - cos(w t), w^2 = 3/(m + 1/r^2 + 1)."""
    motion = holonom.system(DOUBLY_GIVEN).simulate(samples=11, sensitivities=["m", "r"])
    t, w, inertia = motion["t"], sqrt(1 / 2), 6.0
    by_inertia = -t * np.sin(w * t) * w / (2 * inertia)
    assert motion["d(x, m)"] == pytest.approx(by_inertia, abs=1e-13)
    assert motion["d(x, r)"] == pytest.approx(by_inertia * -2 / 0.5**3, abs=1e-12)


IN_UNITS = """m_ : {mass}$ l_ : {length}$ t_ : {time}$
system : holonomic_system(coordinates = [x, y, phi], parameters = [l, g, k],
  kinetic_energy = m_*(dot(x)^2 + dot(y)^2 + l_^2*dot(phi)^2)/2,
  potential_energy = [gravity = m_*g*y, spring = k*phi^2*(2 + x/l_)/2], constraints = [x^2 + y^2 - l^2, phi - x/l])$
s : holonomic_scene(system, parameter_values = [l = l_, g = 10*l_/t_^2, k = m_*l_^2/t_^2],
  initial_state = [x = 3*l/5, dot(x) = 0], initial_guess = [y = -l, phi = 1, dot(y) = 0, dot(phi) = 0],
  time_span = [0, 2*t_])$
"""


@pytest.mark.parametrize("units", [("1/10^27", "1/10^10", "1/10^13"), ("10^30", "10^9", "10^7")])
def test_derivatives_in_other_units(units):
    """In units of atoms they were refused as not finite: they were integrated in seconds."""

    def moved(mass, length, time):
        text = IN_UNITS.format(mass=mass, length=length, time=time)
        found = holonom.system(text).simulate(samples=5, sensitivities=["l", "g", "k", "x"])
        length, time, mass = (float(sp.sympify(each.replace("^", "**"))) for each in (length, time, mass))
        unit_of = {"l": length, "g": length / time**2, "k": mass * length**2 / time**2, "x": length}
        angles = np.array([found[f"d(phi, {name})"] * unit for name, unit in unit_of.items()])
        return np.concatenate([angles, [found["d(x, l)"], found["d(dot(y), g)"] / time]])

    assert moved(*units) == pytest.approx(moved("1", "1", "1"), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("power", [-30, 30])
def test_derivatives_by_a_force_of_zero_beside_a_uniform_motion(power):
    """Truth: (1 - cos(t))/k. Where k is 10^30, the motion alone decided about steps, with errors of 10^7."""
    text = f"""system : holonomic_system(coordinates = [x, y], parameters = [k, F],
  kinetic_energy = 10^({power})*(dot(x)^2 + dot(y)^2)/2, potential_energy = k*y^2/2, forces = [0, F])$
s : holonomic_scene(system, parameter_values = [k = 10^({power}), F = 0],
  initial_state = [x = 1, y = 0, dot(x) = 1/10, dot(y) = 0], time_span = [0, 20])$"""
    found = holonom.system(text).simulate(samples=9, sensitivities=["F"])
    assert found["d(y, F)"] * 10.0**power == pytest.approx(1 - np.cos(found.times), abs=1e-12)


def test_values_of_an_earlier_motion_were_taken():
    scene = holonom.system(SPRING)
    scene.simulate(samples=2, m=9, k=3)
    fresh = holonom.system(SPRING).simulate(samples=2, m=3, sensitivities=["k"])
    again = scene.simulate(samples=2, m=3, sensitivities=["k"])
    assert [again[name].tolist() for name in ("x", "d(x, k)")] == [fresh[name].tolist() for name in ("x", "d(x, k)")]


def test_derivatives_were_wrong_where_the_constraints_that_are_solved_become_dependent():
    """At y = 0 the gradients of x^2 + y^2 - 1 and x - cos(a) are, and the motion is regular."""
    scene = holonom.system(REDUNDANT)
    step, before = 1e-3, {"until": 0.35, "samples": 2}
    beside = [scene.simulate(m=1 + k * step, **before)["a"][-1] for k in (-2, -1, 1, 2)]
    slope = np.dot(beside, [1, -8, 8, -1]) / (12 * step)
    assert scene.simulate(**before, sensitivities=["m"])["d(a, m)"][-1] == pytest.approx(slope, rel=1e-8)
    with pytest.raises(HolonomError) as caught:
        scene.simulate(sensitivities=["m"])
    assert caught.value.kind is ErrorKind.NO_SENSITIVITY


@pytest.mark.parametrize(
    "options",
    [{"precision": "quadruple"}, {"precision": 30}, {"engine": "runge-kutta"}, {"stabilization": "ggl"}],
    ids=lambda options: next(iter(options)),
)
def test_a_known_parameter_was_called_unknown(options):
    scene = holonom.system(BEAD)
    with pytest.raises(HolonomError) as caught:
        scene.simulate(sensitivities=["m"], **options)
    assert caught.value.kind is ErrorKind.NO_SENSITIVITY
    assert "unknown" not in caught.value.message()


def test_a_parameter_of_a_force_that_begins_later_was_called_unknown():
    """Truth: a contact with the force of Hertz takes a time in proportion to k^(-2/5)."""
    body = holonom.system("""system : holonomic_system(coordinates = [x], parameters = [k],
      kinetic_energy = dot(x)^2/2, forces = [contact = [-k*max(0, x - 1)^(3/2)]])$
    s : holonomic_scene(system, parameter_values = [k = 50], initial_state = [x = 0, dot(x) = 2], time_span = [0, 2])$
    """)
    took = (5 / 50) ** 0.4 * 0.4 * beta(0.4, 0.5)
    found = body.simulate(samples=2, sensitivities=["k"])
    assert found["x"][-1] == pytest.approx(1 - 2 * (1.5 - took), rel=1e-12)
    assert found["d(x, k)"][-1] == pytest.approx(-2 * 0.4 * took / 50, rel=1e-9)


def test_derivatives_that_are_zero_satisfy_the_constraints():
    """Truth: the angle is prescribed, so that the mass moves the control alone. Rounding errors are left of zero."""
    arm = holonom.system("""system : holonomic_system(coordinates = [a], controls = [F], parameters = [m, l, g],
      kinetic_energy = m*l^2*dot(a)^2/2, potential_energy = m*g*l*sin(a), forces = [F])$
    s : holonomic_scene(system, parameter_values = [m = 2, l = 7/10, g = 981/100],
      servo_constraints = [l*sin(a) - 3/10*sin(t)], initial_state = [a = 0], time_span = [0, 1])$""")
    found = arm.simulate(samples=2, sensitivities=["m", "l"])
    assert np.max(np.abs(found["d(a, m)"])) < 1e-12
    assert found["d(a, l)"][-1] == pytest.approx(-np.tan(found["a"][-1]) / 0.7)


def test_derivatives_end_at_a_flat_position():
    """The message told the start of the block. Truth: the time at which the rods of `linkage.mac` lie flat."""
    rate = 2 * 9.81 * 6 / 5
    flat, _ = quad(lambda phi: 1 / np.sqrt(1 + rate * (1 - np.cos(phi))), 0, np.pi / 2)
    with pytest.raises(HolonomError) as caught:
        holonom.load("examples/linkage.mac").simulate(sensitivities=["m"], samples=2)
    assert caught.value.kind is ErrorKind.NO_SENSITIVITY
    assert float(caught.value.detail.split()[-1]) == pytest.approx(flat, rel=1e-3)


RUBBED = """
system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2 + {k}*dot(x)*dot(y))/2,
  potential_energy = y - x, forces = [{x}, {y}])$
scene : holonomic_scene(system, initial_state = [x = 0, y = 0, dot(x) = 0, dot(y) = 0], time_span = [0, 1])$
"""


@pytest.mark.parametrize("k", ["0", "1/2"])
@pytest.mark.parametrize(("x", "y"), [("-3/2*signum(dot(x))", "0"), ("-3/2*signum(dot(x))", "-2*signum(dot(y))")])
def test_derivatives_by_the_velocity_of_what_sticks_were_those_of_a_body_that_slides_on(k, x, y):
    """Pushed by eps, it stops within a multiple of eps, which is the error of the difference quotients."""
    text, eps = RUBBED.format(k=k, x=x, y=y), 1e-5
    pushed = text.replace("dot(x) = 0,", "dot(x) = 1/100000,")
    ends = [holonom.system(each).simulate(tol=1e-14).report for each in (text, pushed)]
    found = holonom.system(text).simulate(sensitivities=["dot(x)"]).report.sensitivities
    for name in ("x", "y"):
        quotient = (ends[1].coordinates[name] - ends[0].coordinates[name]) / eps
        assert found[f"d({name}, dot(x))"] == pytest.approx(quotient, abs=10 * eps)
    assert found["d(x, dot(x))"] == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize(
    ("force", "by", "known"),
    [
        ("-signum(dot(x))/4", "dot(x)", False),  # d(dot(x), dot(x)) is 1 or 3/5
        ("-signum(x)", "x", False),
        ("-signum(dot(x))/4", "x", True),
        ("-dot(x)*abs(dot(x))", "dot(x)", True),
    ],
)
def test_derivatives_that_depend_on_the_side_were_those_of_one_side(force, by, known):
    scene = holonom.system(RUBBED.format(k=0, x=force, y=0))
    if known:
        assert 0 < scene.simulate(sensitivities=[by]).report.sensitivities[f"d(x, {by})"] <= 1
        return
    with pytest.raises(HolonomError) as error:
        scene.simulate(sensitivities=[by])
    assert error.value.kind is ErrorKind.NO_SENSITIVITY


@pytest.mark.parametrize("start", [0, 0.1])
@pytest.mark.parametrize("edge", [0, 0.01])
def test_a_contact_of_hertz_had_no_derivatives_where_it_begins(start, edge):
    """By SciPy; the Taylor polynomial of x^(3/2) has no finite coefficients at the edge."""
    scene = holonom.system(f"""system : holonomic_system(coordinates = [x], parameters = [k],
      kinetic_energy = dot(x)^2/2, forces = [-k*x + 30*max(0, {edge} - x)^(3/2)])$
      falling : holonomic_scene(system, parameter_values = [k = 3], initial_state = [x = 1/7, dot(x) = -3/7],
        time_span = [{start}, 1])$""")

    def end(k):
        def rates(_, y):
            return [y[1], -k * y[0] + 30 * max(0, edge - y[0]) ** 1.5]

        return solve_ivp(rates, (start, 1), [1 / 7, -3 / 7], rtol=1e-11, atol=1e-13, max_step=1e-2).y[:, -1]

    motion = scene.simulate(samples=2, sensitivities=["k"])
    expected = (end(3.001) - end(2.999)) / 0.002
    assert [motion["d(x, k)"][-1], motion["d(dot(x), k)"][-1]] == pytest.approx(expected, rel=1e-5)


# ---- pulses of the time ---------------------------------------------------------------------------------------------

STIFFER_FOR_A_WHILE = """system : holonomic_system(coordinates = [x], controls = [u], kinetic_energy = dot(x)^2/2,
  potential_energy = u*x^2/2, forces = [damping = [-dot(x)/5 - max(0, x - {edge})]])$
s : holonomic_scene(system, control_law = [u = 1/10 + 100*exp(-(200*t - 275/4)^2)], nominal = [x = 1],
  initial_state = [x = {x}, dot(x) = 0], time_span = [0, 1])$"""


@pytest.mark.parametrize(("x", "edge"), [(0, 5), (1, 5), (1, "9/10")])
def test_derivatives_passed_a_pulse_that_steps_of_the_motion_end_before(x, edge):
    """Below the edge the motion is linear: as x = 1 moves, so do deviations. They missed the pulse by 0.75."""
    truth = holonom.system(STIFFER_FOR_A_WHILE.format(x=1, edge=5)).simulate(samples=5)
    found = holonom.system(STIFFER_FOR_A_WHILE.format(x=x, edge=edge)).simulate(samples=5, sensitivities=["x"])
    if edge == 5:
        assert found["d(x, x)"] == pytest.approx(truth["x"], abs=1e-12)
        return
    step = 1e-4
    moved = [
        holonom.system(STIFFER_FOR_A_WHILE.format(x=f"1 + {k}/10^4", edge=edge)).simulate(samples=5)["x"]
        for k in (-2, -1, 1, 2)
    ]
    slopes = (moved[0] - 8 * moved[1] + 8 * moved[2] - moved[3]) / (12 * step)
    assert found["d(x, x)"] == pytest.approx(slopes, abs=1e-9)


@pytest.mark.parametrize("size", [0, 1])
def test_a_pulse_of_size_zero_has_a_derivative(size):
    """A kick of 100 exp(-(2000 t - 687)^2) begins a motion at constant speed. Its derivative was 0 if its size was."""
    text = f"""system : holonomic_system(coordinates = [x], parameters = [p], kinetic_energy = dot(x)^2/2,
      forces = [kick = [100*p*exp(-(2000*t - 687)^2)]])$
    s : holonomic_scene(system, parameter_values = [p = {size}], initial_state = [x = 0, dot(x) = 0], nominal = [x = 1],
      time_span = [0, 1])$"""
    found = holonom.system(text).simulate(samples=2, sensitivities=["p"])
    speed = 100 * np.sqrt(np.pi) / 2000
    assert [found["d(dot(x), p)"][-1], found["d(x, p)"][-1]] == pytest.approx([speed, speed * (1 - 0.3435)], rel=1e-9)
