"""Controls in constraints that hold outputs to a path: closed forms, Newton and Euler, planted motions."""

import random
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from refusing import refused
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import holonom
from holonom.failures import ErrorKind, HolonomError

EXAMPLES = Path(__file__).parents[2] / "examples"
ENGINES = {"taylor": 1e-13, "runge-kutta": 1e-10, "robust": 1e-8}
T = sp.Symbol("t")

BOB = """
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [m, g],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, potential_energy = [gravity = m*g*y], constraints = [x^2 + y^2 - u^2])$
led : holonomic_scene(system, servo_constraints = [y = {path}], parameter_values = [m = 2, g = 10],
  initial_state = [x = 1, dot(x) = {speed}], initial_guess = [y = -2, dot(y) = 0, u = 2, dot(u) = 0],
  time_span = [0, 2], observe = [trajectory, controls, multipliers, pull = -2*lambda1*u, energy, residuals])$
"""


@pytest.mark.parametrize("engine", ENGINES)
def test_level_bob_swings_as_a_harmonic_oscillator(engine, c_compiler):
    """Only the upright part of the pull holds the weight: ddot(x) = -(g/h) x and lambda = -m g/(2 h)."""
    motion = holonom.system(BOB.format(path="-2", speed=0)).simulate(samples=9, engine=engine)
    x = sp.cos(sp.sqrt(5) * T)
    u = sp.sqrt(x**2 + 4)
    truth = values([x, u, sp.diff(u, T), sp.diff(u, T, 2), -5 + 0 * T, 10 * u], motion.times)
    found = [motion[name] for name in ("x", "u", "dot(u)", "ddot(u)", "lambda1", "pull")]
    assert np.array(found) == pytest.approx(truth, rel=ENGINES[engine], abs=ENGINES[engine])
    assert motion.report.relative_degrees == (2,)
    assert motion.report.trusted


@pytest.mark.parametrize("mass", [10**9, 10**-9])
def test_rates_of_the_winch_keep_their_digits_with_any_load(mass):
    """The second rate is the difference of the drive and the reaction, which a unit mass made one of large numbers."""
    motion = holonom.system(BOB.format(path="-2", speed=0).replace("m = 2", f"m = {mass:.1e}")).simulate(samples=5)
    u = sp.sqrt(sp.cos(sp.sqrt(5) * T) ** 2 + 4)
    truth = values([u, sp.diff(u, T, 2), -5 * mass / 2 + 0 * T], motion.times)
    assert np.array([motion[name] for name in ("u", "ddot(u)", "lambda1")]) == pytest.approx(
        truth, rel=1e-13, abs=1e-13
    )


@pytest.mark.long
def test_path_of_a_thrown_bob_makes_the_motion_free():
    scene = holonom.system(BOB.format(path="-2 - 5*t^2", speed=3))
    motion = scene.simulate(samples=5)
    assert motion["x"] == pytest.approx(1 + 3 * motion.times, rel=1e-14)
    assert motion["lambda1"] == pytest.approx(0, abs=1e-14)
    found = scene.free().motion
    assert (found.verdict, found.order) == ("undecided", 40)  # all coefficients vanish, and nothing is proved


def values(formulas, times):
    return np.array([np.broadcast_to(row, len(times)) for row in sp.lambdify(T, formulas)(np.asarray(times))])


def test_winch_pays_out_what_the_heaving_crane_takes():
    """The load stays level; its sideways motion is Hill's equation, of which u and the pull follow."""
    motion = holonom.load(EXAMPLES / "level_load.mac", scene="heave_scene").simulate(samples=17)
    below = motion["w"] + 2
    assert motion["u"] == pytest.approx(np.hypot(motion["x"], below), rel=1e-14)
    assert motion["pull"] * below / motion["u"] == pytest.approx(9.81, rel=1e-13)
    hill = solve_ivp(lambda t, y: [y[1], -9.81 * y[0] / (2 + np.sin(t) / 2)], (0, 8), [0.2, 0], rtol=1e-12, atol=1e-13)
    assert [motion["x"][-1], motion["dot(x)"][-1]] == pytest.approx(hill.y[:, -1], abs=1e-10)


# ---- a Stewart platform ----

FEET = np.array([[0.96, 0.25], [-0.25, 0.96], [-0.7, 0.7], [-0.7, -0.7], [-0.25, -0.96], [0.96, -0.25]])
JOINTS = np.array([[1 / 3, 1 / 3], [0.125, 0.48], [-0.48, 0.125], [-0.48, -0.125], [0.125, -0.48], [1 / 3, -1 / 3]])


def platform(times):
    """Lengths and pushes of the legs, shape (6, k) each, by inverse kinematics, and by Newton and Euler."""
    place = [sp.sin(T) / 5, (1 - sp.cos(T)) / 5, 1 + sp.sin(2 * T) / 10]
    turn = [sp.sin(T) / 10, (1 - sp.cos(T)) / 20, sp.sin(2 * T) / 10]
    path = [*place, sp.sqrt(1 - sum(e**2 for e in turn)), *turn]
    lengths, pushes = [], []
    for q, v, a in zip(*(values([sp.diff(f, T, k) for f in path], times).T for k in range(3)), strict=True):
        e0, e1, e2, e3 = q[3:]
        cross = np.array([[0, -e3, e2], [e3, 0, -e1], [-e2, e1, 0]])
        rotation = np.eye(3) + 2 * e0 * cross + 2 * cross @ cross
        rates = np.array([[-e1, e0, e3, -e2], [-e2, -e3, e0, e1], [-e3, e2, -e1, e0]])
        turning, spin_up = 2 * rates @ v[3:], 2 * rates @ a[3:]  # angular velocity and its rate, in the platform's axes
        joints = np.column_stack([JOINTS, np.zeros(6)])
        legs = q[:3] + joints @ rotation.T - np.column_stack([FEET, np.zeros(6)])
        length = np.linalg.norm(legs, axis=1)
        along = legs / length[:, None]
        inertia = np.array([1.0, 1.0, 2.0])
        force = 10 * (a[:3] + [0, 0, 9.81])
        moment = inertia * spin_up + np.cross(turning, inertia * turning)
        matrix = np.vstack([along.T, np.cross(joints, along @ rotation).T])
        lengths.append(length)
        pushes.append(np.linalg.solve(matrix, [*force, *moment]))
    return np.array(lengths).T, np.array(pushes).T


@pytest.mark.long
def test_stewart_platform_has_the_lengths_and_pushes_of_its_legs():
    motion = holonom.load(EXAMPLES / "stewart_platform.mac").simulate(samples=7)
    lengths, pushes = platform(motion.times)
    assert np.array([motion[f"u{i}"] for i in range(1, 7)]) == pytest.approx(lengths, rel=1e-13)
    assert np.array([motion[f"push{i}"] for i in range(1, 7)]) == pytest.approx(pushes, rel=1e-11)
    assert motion.report.trusted


# ---- controls of several kinds ----

MIXED = """
system : holonomic_system(coordinates = [r, phi, x, y, z], controls = [u1, u2, F, w], parameters = [m, g],
  kinetic_energy = m*(dot(r)^2 + r^2*dot(phi)^2 + dot(x)^2 + dot(y)^2 + dot(z)^2)/2,
  potential_energy = [gravity = -m*g*r*cos(phi) + m*g*y, spring = m*(z - x)^2/2], forces = [drive = [0, 0, 0, 0, F]],
  constraints = [r - u1, x^2 + (y - w)^2 - u2^2])$
go : holonomic_scene(system, prescribed_reactions = [lambda1 = -S], servo_constraints = [y = -2 + t/10, z = sin(t)],
  control_law = [w = t^2/10], parameter_values = [m = 2, g = 10, S = 20],
  initial_state = [r = 1, dot(r) = 0, phi = 0, dot(phi) = 1, x = 1/2, dot(x) = 0, u1 = 1, dot(u1) = 0],
  initial_guess = [y = -2, u2 = 2, z = 0, dot(z) = 1, dot(y) = 0, dot(u2) = 0], time_span = [0, 1],
  observe = [trajectory, controls, multipliers, energy, residuals])$
"""


def test_reaction_force_and_length_are_found_together():
    """A string of prescribed tension, a winch that leads a load, and a force that leads a mass on a spring."""
    scene = holonom.system(MIXED)
    motion = scene.simulate(samples=5)
    t = motion.times
    assert motion["lambda1"] == pytest.approx(-20, rel=1e-14)
    assert motion["u1"] == pytest.approx(motion["r"], rel=1e-14)
    assert motion["lambda2"] == pytest.approx(20 / (2 * (motion["y"] - motion["w"])), rel=1e-12)
    assert motion["u2"] == pytest.approx(np.hypot(motion["x"], motion["y"] - motion["w"]), rel=1e-13)
    assert motion["F"] == pytest.approx(-2 * np.sin(t) + 2 * (np.sin(t) - motion["x"]), abs=1e-12)
    assert {"F", "w", "ddot(u2)"} == set(motion.report.controls)
    alone = BOB.replace("x^2 + y^2 - u^2", "y - u").format(path="-2", speed=0)  # another system, for its free fall
    assert holonom.system(alone).simulate(samples=2)["x"] == pytest.approx([1, 1], rel=1e-14)
    assert motion.report.trusted


def test_load_on_a_spring_takes_a_path_of_relative_degree_four():
    """h = u, and m ddot(x) = k (h - x - 1) - m g: the winch must know two rates more of the path."""
    motion = holonom.system("""
system : holonomic_system(coordinates = [h, x], controls = [u], parameters = [m, k, g],
  kinetic_energy = m*dot(x)^2/2 + dot(h)^2/2, potential_energy = [gravity = g*(m*x + h), spring = k*(h - x - 1)^2/2],
  constraints = [h - u])$
led : holonomic_scene(system, servo_constraints = [x = sin(t)], parameter_values = [m = 2, k = 50, g = 10],
  initial_state = [], initial_guess = [x = 0, u = 1, h = 1, dot(h) = 0, dot(x) = 0, dot(u) = 0], time_span = [0, 2],
  observe = [trajectory, controls, multipliers])$""").simulate(samples=5)
    x = sp.sin(T)
    h = x + 1 + (2 * sp.diff(x, T, 2) + 20) / 50
    push = sp.diff(h, T, 2) + 10 + 50 * (h - x - 1)
    truth = values([h, sp.diff(h, T, 2), push], motion.times)
    assert np.array([motion[name] for name in ("u", "ddot(u)", "lambda1")]) == pytest.approx(truth, rel=1e-12)
    assert motion.report.relative_degrees == (4,)


# ---- where the controls have no values ----

SLIDE = """
system : holonomic_system(coordinates = [x], controls = [u], kinetic_energy = dot(x)^2/2,
  constraints = [x - {position}])$
led : holonomic_scene(system, servo_constraints = [x = {path}], initial_state = [{start}],
  initial_guess = [{guess}], time_span = [0, 3])$
"""
GUESS = "x = 1/2, u = 1/2, dot(x) = 0, dot(u) = 0"


@pytest.mark.long
@pytest.mark.parametrize("engine", ["auto", "robust"])
@pytest.mark.parametrize(("path", "end"), [("cos(t - 1)", 1), ("1/2 + t/4", 2)])
def test_motion_ends_at_a_dead_centre_with_its_time(path, end, engine):
    """x = sin(u): at u = pi/2 the control does not move x, even if the path passes there smoothly."""
    scene = holonom.system(SLIDE.format(position="sin(u)", path=path, start="", guess=GUESS))
    with pytest.raises(HolonomError) as ended:
        scene.simulate(samples=3, engine=engine)
    assert ended.value.kind is ErrorKind.NO_WAY_ON
    assert float(ended.value.detail.split(",")[0]) == pytest.approx(end, abs=1e-6)


@pytest.mark.parametrize("friction", [3, 30])
def test_friction_acts_on_the_level_load(friction):
    """Its sign changes the drive of the winch, too. From x = 1 the pull -10 x may be less than the friction."""
    text = BOB.format(path="-2", speed=1).replace(
        " constraints", f" forces = [-{friction}*signum(dot(x)), 0], constraints"
    )
    motion = holonom.system(text).simulate(samples=9)
    assert motion["lambda1"] == pytest.approx(-5, rel=1e-13)
    sticks = motion.times > 0.1
    if friction == 3:
        assert motion.report.switchings[0].outcome == "crossed"
    else:
        assert motion["dot(x)"][sticks] == pytest.approx(0, abs=1e-13)
        assert motion["dot(u)"][sticks] == pytest.approx(0, abs=1e-13)
        assert np.ptp(motion["x"][sticks]) < 1e-13


def test_start_at_a_dead_centre_is_refused():
    scene = holonom.system(
        SLIDE.format(position="u^3", path="t^3", start="x = 0, u = 0, dot(u) = 0", guess="dot(x) = 0")
    )
    with refused("servo_rank_at_start"):
        scene.simulate(samples=2)


@pytest.mark.parametrize(("path", "x"), [("-1 - t^2", "0"), ("-3/5 - t", "4/5")])
def test_start_at_a_double_root_of_the_control_is_refused(path, x):
    """x^2 + y^2 = 1 + u^2: Newton's method finds u = 0 to half the digits."""
    text = BOB.replace("- u^2", "- u^2 - 1").replace("x = 1", f"x = {x}").format(path=path, speed=0)
    with refused("servo_rank_at_start"):
        holonom.system(text).simulate(samples=2)


REFUSED = {
    "a path of relative degree three": (
        BOB.replace("forces", "").replace(
            "constraints = [x^2 + y^2 - u^2]", "forces = [0, dot(x)], constraints = [x - u]"
        ),
        "servo_of_velocities",
    ),
    "an output that the control does not reach": (
        BOB.replace("x^2 + y^2 - u^2", "x - u"),
        "servo_condition_on_time",
    ),
    "a rate of the control in the kinetic energy": (
        BOB.replace("(dot(x)^2 +", "((dot(x) + dot(u))^2 +"),
        "servo_rate_in_energy",
    ),
    "two controls for one output": (
        BOB.replace("controls = [u]", "controls = [u, w]").replace("- u^2", "- u^2 - w"),
        "wrong_number_of_outputs",
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_no_control_can_follow_is_refused(what):
    text, refusal = REFUSED[what]
    with refused(refusal):
        holonom.system(text.format(path="t^3", speed=0)).simulate(samples=2)


@pytest.mark.parametrize(
    ("asked", "kind"),
    [
        (lambda scene: scene.dae(), ErrorKind.NO_LAW),
        (lambda scene: scene.equilibria(), ErrorKind.NO_LAW),
        (lambda scene: scene.effects(), ErrorKind.REFUSED),
    ],
)
def test_what_takes_the_controls_as_given_is_refused(asked, kind):
    with pytest.raises(HolonomError) as refused:
        asked(holonom.system(BOB.format(path="-2", speed=0)))
    assert refused.value.kind is kind


def test_sweep_keeps_the_second_rate_of_the_control():
    rows = holonom.sweep(
        holonom.system(BOB.format(path="-2", speed=0)), values={"g": [10, 20]}, keep=["ddot(u)", "max(abs(lambda1))"]
    ).to_pandas()
    assert list(rows["max(abs(lambda1))"]) == pytest.approx([5, 10], rel=1e-12)
    x = sp.cos(sp.sqrt(5) * T)
    assert rows["ddot(u)"][0] == pytest.approx(float(sp.diff(sp.sqrt(x**2 + 4), T, 2).subs(T, 2)), rel=1e-10)


# ---- planted motions ----


def planted(seed):
    """A random system of three coordinates, two constraints and two controls, with a motion chosen before."""
    draw = random.Random(seed)
    q, u, lam = sp.symbols("x y z"), sp.symbols("u w"), sp.symbols("lambda1 lambda2")
    v = sp.symbols("vx vy vz")

    def number(size=2):
        return sp.Rational(draw.randint(1, 4 * size), 4) * draw.choice([-1, 1])

    def path():
        return number() + number() * T + number(1) * sp.sin(T)

    motion = dict(zip((*q, *u), [path() for _ in range(5)], strict=True))
    pushes = dict(zip(lam, [path() for _ in range(2)], strict=True))
    a, b, c = (abs(number()) for _ in range(3))
    kinetic = ((3 + a * q[1] ** 2) * v[0] ** 2 + 4 * v[1] ** 2 + (3 + b * sp.cos(q[0])) * v[2] ** 2) / 2 + c * v[0] * v[
        1
    ]
    potential = number() * q[0] * q[1] + number() * q[2] ** 2 + number() * q[0] * u[0]

    def random_constraint():
        inner = sum(
            (number() * s for s in (*q, *u)), number() * q[0] * u[1] + number() * sp.sin(q[1]) + number() * u[0] * T
        )
        return inner - inner.subs(motion)

    constraints, outputs = (
        [random_constraint(), random_constraint()],
        [q[0] * q[1] + number() * q[2], number() * q[0] - q[2]],
    )
    outputs = [s - s.subs(motion) for s in outputs]
    rates = {rate: sp.diff(motion[each], T) for rate, each in zip(v, q, strict=True)}
    along = {**motion, **rates}
    forces = []
    for s, rate in zip(q, v, strict=True):
        momentum = sp.diff(kinetic, rate).subs(rates).subs(motion)
        rest = sp.diff(kinetic - potential, s).subs(along)
        reaction = sum(pushes[each] * sp.diff(f, s).subs(motion) for each, f in zip(lam, constraints, strict=True))
        forces.append(sp.diff(momentum, T) - rest - reaction)

    def written(expression):
        text = str(expression).replace("**", "^")
        for rate, each in zip(v, q, strict=True):
            text = text.replace(str(rate), f"dot({each})")
        return text

    def listed(expressions):
        return "[" + ", ".join(map(written, expressions)) + "]"

    at = {**{str(s): motion[s] for s in (*q, *u)}, **{f"dot({s})": sp.diff(motion[s], T) for s in (*q, *u)}}
    state = ", ".join(f"{name} = {written(path.subs(T, 0))}" for name, path in at.items())
    text = f"""
system : holonomic_system(coordinates = [x, y, z], controls = [u, w], kinetic_energy = {written(kinetic)},
  potential_energy = {written(potential)}, forces = [planted = {listed(forces)}], constraints = {listed(constraints)})$
led : holonomic_scene(system, servo_constraints = {listed(outputs)}, initial_state = [{state}], time_span = [0, 1/4],
  observe = [trajectory, controls, multipliers, energy, residuals])$"""
    return (
        text,
        [motion[each] for each in (*q, *u)],
        [sp.diff(motion[each], T, 2) for each in u],
        list(pushes.values()),
        sp.lambdify(T, bordered(kinetic, constraints, outputs, v, q, u).subs(motion)),
    )


def bordered(kinetic, constraints, outputs, v, q, u):
    """The matrix [A -J^T 0; J 0 U; Y 0 0]."""
    mass, zero = sp.hessian(kinetic, v), sp.zeros(2, 2)
    jacobian, slopes, moved = (sp.Matrix(f).jacobian(x) for f, x in ((constraints, q), (constraints, u), (outputs, q)))
    blocks = [[mass, -jacobian.T, sp.zeros(3, 2)], [jacobian, zero, slopes], [moved, zero, zero]]
    return sp.Matrix(sp.BlockMatrix(blocks))


@pytest.mark.parametrize(
    "seed", [0, 20, *(pytest.param(seed, marks=pytest.mark.long) for seed in range(30) if seed not in (0, 20))]
)
def test_planted_motion_comes_back(seed):
    """Or it ends where the matrix of the accelerations, the multipliers and the controls becomes singular."""
    text, paths, seconds, pushes, matrix = planted(seed)
    scene = holonom.system(text)
    determinants = [np.linalg.det(matrix(t)) for t in np.linspace(0, 1 / 4, 26)]
    if min(determinants) * max(determinants) < 0:
        with pytest.raises(HolonomError) as ended:
            scene.simulate(samples=4)
        end = brentq(lambda t: np.linalg.det(matrix(t)), 0, 1 / 4, xtol=1e-14)
        assert float(ended.value.detail.split(",")[0]) == pytest.approx(end, abs=1e-6)
        return
    motion = scene.simulate(samples=4)
    truth = values([*paths, *seconds, *pushes], motion.times)
    found = [motion[name] for name in ("x", "y", "z", "u", "w", "ddot(u)", "ddot(w)", "lambda1", "lambda2")]
    assert np.array(found) == pytest.approx(truth, rel=1e-8, abs=1e-8)
    assert motion.report.trusted
