"""Coulomb friction with the normal force, against closed forms and Newton-Euler equations solved for each sign."""

from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from refusing import failing
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

import holonom
from holonom.failures import ErrorKind, HolonomError

INCLINE = """
system : holonomic_system(coordinates = [x, y], parameters = [m, g, alpha, mu],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, potential_energy = [gravity = m*g*(y*cos(alpha) - x*sin(alpha))],
  forces = [friction = [-mu*abs(lambda1)*signum(dot(x)), 0]], constraints = [y])$
scene : holonomic_scene(system, parameter_values = [m = 2, g = 981/100, alpha = 1/4, mu = 1/2],
  initial_state = [x = 0, dot(x) = VELOCITY], time_span = [0, 2])$
"""


def of_text(text):
    return holonom.system(f'load("holonom.mac")$ {text}')


@pytest.mark.parametrize(("mu", "v"), [(0.5, 2), (0.25, 0), (0.26, 0), (0.2, -1)])
def test_a_block_on_an_incline_slides_and_stops_and_stays_where_friction_holds_it(mu, v):
    motion = of_text(INCLINE.replace("VELOCITY", str(v))).simulate(until=2, samples=2, mu=str(mu))
    g, alpha, t, x = 9.81, 0.25, 2.0, 0.0
    if v:
        rate = g * (np.sin(alpha) - np.sign(v) * mu * np.cos(alpha))
        stop = -v / rate if rate * v < 0 else np.inf
        passed = min(stop, t)
        x, v, t = v * passed + rate * passed**2 / 2, v + rate * passed if stop > t else 0, t - passed
    if v == 0 and np.tan(alpha) > mu:
        x += g * (np.sin(alpha) - mu * np.cos(alpha)) * t**2 / 2
    assert motion["x"][-1] == pytest.approx(x, abs=1e-12)
    assert motion["lambda1"] == pytest.approx(2 * g * np.cos(alpha))


@pytest.mark.parametrize("normal", ["abs(lambda1)", "10"])
def test_friction_that_falls_with_the_speed_stops_a_block_where_its_work_says(normal):
    """Truth: v dv/dx = -F(v); a drive below F(0) does not move it again."""
    speed = of_text(f"""
system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2, constraints = [y],
  forces = [-(1/5 + 3/10*exp(-2*abs(dot(x))))*{normal}*signum(dot(x)) + 1/4*hstep(t - 9), -10])$
scene : holonomic_scene(system, initial_state = [x = 0, dot(x) = 3], time_span = [0, 100])$""")
    way, _ = quad(lambda v: v / ((0.2 + 0.3 * np.exp(-2 * v)) * 10), 0, 3, epsabs=0, epsrel=1e-13)
    motion = speed.simulate(samples=11)
    assert motion["x"][1:] == pytest.approx(way, rel=1e-10)
    assert np.abs(motion["dot(x)"][1:]).max() < 1e-12


def test_friction_with_a_reaction_in_more_digits_was_an_internal_error():
    incline = of_text(INCLINE.replace("VELOCITY", "2"))
    many, double = (incline.simulate(until="1/5", samples=2, precision=each) for each in ("30", "double"))
    assert float(str(many["x"][-1])) == pytest.approx(double["x"][-1], rel=1e-13)


BLOCK = """
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [mu],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2, potential_energy = [gravity = 10*y], forces = [FORCE, 0],
  constraints = [y - u])$
scene : holonomic_scene(system, control_law = [u = LAW], parameter_values = [mu = 3/10], initial_state = [x = 0,
  dot(x) = 2], time_span = [0, END])$
"""


def block(force, end=0.5, law="0"):
    return of_text(BLOCK.replace("FORCE", force).replace("LAW", law).replace("END", str(end)))


@pytest.mark.parametrize(
    ("force", "velocity"),
    [
        ("-mu*lambda1", 0.5),
        ("-mu*lambda1*dot(x)", 2 * np.exp(-1.5)),
        ("-mu*lambda1*sin(t)", 2 - 3 * (1 - np.cos(0.5))),
        ("-mu*lambda1*tanh(20*(3 + dot(x)))", 0.5),
        ("-(if t < 1/4 then 0 else mu)*lambda1", 1.25),
    ],
)
def test_multipliers_in_forces_without_a_sign_were_an_internal_error(force, velocity):
    motion = block(force).simulate(samples=2)
    assert motion["dot(x)"][-1] == pytest.approx(velocity, abs=1e-12)


@pytest.mark.parametrize("size", ["max(0, -lambda1)", "-min(0, lambda1)", "(abs(lambda1) - lambda1)/2"])
@pytest.mark.parametrize(("side", "velocity"), [("y - u", 2), ("u - y", 0.5)])
def test_friction_of_one_sign_of_a_reaction_was_an_error(size, side, velocity):
    scene = of_text(BLOCK.replace("FORCE", f"-mu*{size}*signum(dot(x))").replace("LAW", "0").replace("END", "1/2")
                    .replace("y - u", side))  # fmt: skip
    assert scene.simulate(samples=2)["dot(x)"][-1] == pytest.approx(velocity)


@pytest.mark.parametrize("size", ["mu*abs(lambda1) + 1", "mu*x^2*abs(lambda1) + 1", "mu*lambda1 + 1"])
def test_a_coefficient_that_vanishes_was_a_divisor(size):
    """Of the other part of the friction, which was a paradox at t = 0."""
    found = block(f"-({size})*signum(dot(x))").simulate(samples=2, mu=0)
    assert found["dot(x)"][-1] == pytest.approx(1.5)
    assert block(f"-({size})*signum(dot(x))", end=4).simulate(samples=2)["dot(x)"][-1] == pytest.approx(0, abs=1e-12)


def test_no_friction_was_an_internal_error():
    scene = holonom.system(f'load("holonom.mac")$ {BLOCK}'.replace("mu = 3/10", "mu = 0").replace("LAW", "0")
                           .replace("FORCE", "-mu*abs(lambda1)*signum(dot(x)) + 1").replace("END", "2"))  # fmt: skip
    assert scene.simulate(samples=2)["dot(x)"][-1] == pytest.approx(4)
    assert not scene.check().disagreements


@pytest.mark.parametrize(
    "force",
    [
        "if dot(x) > 0 then -mu*lambda1 elseif dot(x) < 0 then mu*lambda1 else 0",
        "if dot(x) > 0 then -10*mu elseif dot(x) < 0 then 10*mu else 0",
        "-mu*lambda1*(exp(signum(dot(x))) - exp(-signum(dot(x))))/(2*sinh(1))",
        "-mu*lambda1*sin(%pi/2*signum(dot(x)))",
        "-mu*(1 + exp(-10000*abs(dot(x))))*lambda1*signum(dot(x))",
    ],
)
def test_friction_that_is_not_linear_in_a_sign_was_an_internal_error(force):
    """Only its values on both sides count (Filippov)."""
    motion = block(force, end=1).simulate(samples=2)
    assert [motion["x"][-1], motion["dot(x)"][-1]] == pytest.approx([2 / 3, 0], abs=1e-7)
    assert motion["lambda1"] == pytest.approx(10)


def test_friction_by_a_function_of_sign_and_place_is_refused_at_rest_alone():
    scene = block("-mu*lambda1*signum(dot(x))*exp(signum(dot(x))*x/10)", end=2)
    found = scene.simulate(until="1/2", samples=2)
    true = solve_ivp(lambda t, s: [s[1], -3 * np.exp(s[0] / 10)], (0, 0.5), [0, 2], rtol=1e-12, atol=1e-13).y[:, -1]
    assert [found["x"][-1], found["dot(x)"][-1]] == pytest.approx(true, abs=1e-10)
    with failing(ErrorKind.NO_WAY_ON):
        scene.simulate()


ROPE = """
system : holonomic_system(coordinates = [x, y], parameters = [m], kinetic_energy = (m*dot(x)^2 + dot(y)^2)/2,
  potential_energy = [gravity = -10*(m*x + y)], constraints = [-x - y],
  forces = [rope = [-lambda1*(exp(%pi/5*signum(dot(x))) - 1), 0]])$
scene : holonomic_scene(system, parameter_values = [m = 3], initial_state = [x = 0, dot(x) = 0], time_span = [0, 1])$
"""


@pytest.mark.parametrize(("m", "side"), [("3", 1), ("3/2", 0), ("1/2", -1)])
def test_a_rope_on_a_rough_pulley_slips_or_stays(m, side):
    """Its tensions differ by the factor exp(mu pi) at most (Euler)."""
    ratio, mass = np.exp(side * np.pi / 5), float(Fraction(m))
    acceleration = 10 * (mass - ratio) / (mass + ratio) if side else 0
    motion = of_text(ROPE).simulate(samples=2, m=m)
    assert motion["dot(x)"][-1] == pytest.approx(acceleration, abs=1e-12)


@pytest.mark.parametrize("law", ["if t < 1/4 then 0 else t - 1/4", "abs(t - 1/4)"])
def test_an_impulse_of_a_reaction_left_out_its_friction(law):
    with failing(ErrorKind.NO_WAY_ON):
        block("-mu*abs(lambda1)*signum(dot(x))", law=law).simulate()
    assert block("-2*mu*signum(dot(x))", law=law).simulate(samples=2)["dot(x)"][-1] == pytest.approx(1.7)


BELT = """
system : holonomic_system(coordinates = [x, z], kinetic_energy = (dot(x)^2 + 2*dot(z)^2)/2,
  forces = [-2*x - (1 + exp(-3*abs(dot(x) - dot(z))))*signum(dot(x) - dot(z)),
    (1 + exp(-3*abs(dot(x) - dot(z))))*signum(dot(x) - dot(z)) + 4*sin(t)
      - (1 + 2*exp(-4*abs(dot(z))))*signum(dot(z)) - abs(dot(z))*dot(z)/10])$
scene : holonomic_scene(system, initial_state = [x = 2, z = 0, dot(x) = 0, dot(z) = 0], time_span = [0, 20])$
"""


def test_two_contacts_with_friction_that_falls_with_the_speed():
    """Truth: signs smoothed ever more, extrapolated."""

    def slope(t, state, k):
        x, z, v, w = state
        upper = (1 + np.exp(-3 * abs(v - w))) * np.tanh(k * (v - w))
        lower = (1 + 2 * np.exp(-4 * abs(w))) * np.tanh(k * w) + abs(w) * w / 10
        return v, w, -2 * x - upper, (upper + 4 * np.sin(t) - lower) / 2

    rough, fine = (
        solve_ivp(slope, (0, 20), (2, 0, 0, 0), method="LSODA", rtol=1e-10, atol=1e-12, args=(k,)).y[:, -1]
        for k in (1e5, 2e5)
    )
    motion = of_text(BELT).simulate(samples=2)
    found = [motion[name][-1] for name in ("x", "z", "dot(x)", "dot(z)")]
    assert found == pytest.approx(2 * fine - rough, abs=3e-5)


def test_a_bead_on_a_rough_hoop_has_the_speed_of_the_closed_form():
    hoop = of_text("""
system : holonomic_system(coordinates = [x, y], parameters = [m, g, r, mu],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, potential_energy = [gravity = m*g*y],
  forces = [friction = -mu*2*abs(lambda1)*signum(x*dot(y) - y*dot(x))*[-y, x]], constraints = [x^2 + y^2 - r^2])$
scene : holonomic_scene(system, parameter_values = [m = 3, g = 10, r = 2, mu = 1/5],
  initial_state = [x = 0, y = -2, dot(x) = 20], time_span = [0, 1])$
""")
    motion = hoop.simulate(until=0.6, samples=10)
    phi = np.unwrap(np.arctan2(motion["x"], -motion["y"]))
    g, r, mu = 10, 2, 0.2
    a, b = -6 * mu * r * g / (1 + 4 * mu**2), 2 * r * g * (1 - 2 * mu**2) / (1 + 4 * mu**2)
    square = (20**2 - b) * np.exp(-2 * mu * phi) + a * np.sin(phi) + b * np.cos(phi)
    assert phi[-1] > np.pi
    assert motion["dot(x)"] ** 2 + motion["dot(y)"] ** 2 == pytest.approx(square, rel=1e-11)


ROD = """
system : holonomic_system(coordinates = [x, y, phi], parameters = [m, g, l, mu],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2 + m*l^2/6*dot(phi)^2, potential_energy = [gravity = m*g*y],
  forces = [friction = -mu*abs(lambda1)*signum(dot(x) + l*sin(phi)*dot(phi))*[1, 0, l*sin(phi)]],
  constraints = [y - l*sin(phi)])$
scene : holonomic_scene(system, parameter_values = [m = 1, g = 10, l = 1, mu = MU],
  initial_state = [x = 0, phi = PHI, dot(x) = 30, dot(phi) = -1], time_span = [0, 1])$
"""


def singular_angle(mu, low, high):
    """Where 1 + 3 cos(phi)^2 = 3 mu sin(phi) cos(phi), the boundary of Painleve's paradoxes."""
    return brentq(lambda phi: 1 + 3 * np.cos(phi) ** 2 - 3 * mu * np.sin(phi) * np.cos(phi), low, high)


def test_a_sliding_rod_is_followed_up_to_the_paradoxes_of_painleve_and_not_into_them():
    mu = 2
    first, last = singular_angle(mu, 0.5, 1.0), singular_angle(mu, 1.2, 1.57)
    for phi, there in ((first - 0.01, True), (first + 0.01, False), (last - 0.01, False), (last + 0.01, True)):
        scene = of_text(ROD.replace("MU", str(mu)).replace("PHI", repr(phi)))
        if there:
            assert np.isfinite(scene.simulate(until=0.001, samples=2)["lambda1"]).all()
        else:
            with failing(ErrorKind.NO_WAY_ON, "t = 0", "Painleve"):
                scene.simulate(until=0.001, samples=2)
    with failing(ErrorKind.NO_WAY_ON, "Painleve"):
        of_text(ROD.replace("MU", str(mu)).replace("PHI", repr(last + 0.01))).simulate(until=1)


def test_a_start_within_the_paradoxes_is_refused():
    with failing(ErrorKind.NO_WAY_ON, "t = 0", "Painleve"):
        of_text(ROD.replace("MU", "2").replace("PHI", "1")).simulate(until=0.001, samples=2)


def test_a_rod_that_jams_names_the_paradox():
    """Steps became too short, with no word of the multiplier that grows without bound."""
    scene = of_text(ROD.replace("MU", "2").replace("PHI", "6/10").replace("dot(phi) = -1", "dot(phi) = 8"))
    with failing(ErrorKind.NO_WAY_ON, "Painleve"):
        scene.simulate(until=1)


def test_an_end_that_friction_does_not_cause_names_no_paradox():
    """Truth: z'' = 6 z^2 from 1 with the speed 2 is 1/(1 - t)^2; the block beside it slides as on any incline."""
    text = (
        INCLINE.replace("[x, y]", "[x, y, z]").replace("0]],", "0, 6*z^2]],").replace("dot(y)^2", "dot(y)^2 + dot(z)^2")
    )
    scene = of_text(text.replace("m = 2", "m = 1").replace("dot(x) = VELOCITY", "dot(x) = 9, z = 1, dot(z) = 2"))
    with failing(ErrorKind.NO_WAY_ON) as ended:
        scene.simulate(until=2)
    assert float(ended.value.detail.split(",")[0]) == pytest.approx(1, abs=1e-3)
    assert "Painleve" not in ended.value.detail


def test_a_rod_with_less_friction_than_four_thirds_has_no_paradox():
    scene = of_text(ROD.replace("MU", "13/10").replace("PHI", "13/10"))
    assert scene.simulate(until=1, samples=2)["phi"][-1] < 1.3


CRANK = """
system : holonomic_system(coordinates = [a, b, x, y], parameters = [mu],
  kinetic_energy = dot(a)^2/4 + dot(x)^2/2 + dot(y)^2/2 + dot(b)^2*4*4/5/24
    + 4/5*((-dot(a)*sin(a) - dot(b)*sin(b))^2 + (dot(a)*cos(a) + dot(b)*cos(b))^2)/2,
  forces = [drive = [1, 0, 0, 0], friction = [0, 0, -mu*abs(lambda3)*signum(dot(x)), 0]],
  constraints = [x - cos(a) - 2*cos(b), y - sin(a) - 2*sin(b), y])$
scene : holonomic_scene(system, parameter_values = [mu = 3/10],
  initial_state = [a = 1/2, dot(a) = 2], initial_guess = [b = -1/4, x = 2, y = 0, dot(b) = 0, dot(x) = 0, dot(y) = 0],
  time_span = [0, 2])$
"""


def crank_acceleration(a, rate, mu):
    """Newton-Euler: crank of length 1 and inertia 1/2, rod of length 2 and mass 4/5, slider of mass 1; and the guide.

    Unknown are the accelerations of a and b, the forces on the rod at its ends and the guide's force.
    """
    b = -np.arcsin(np.sin(a) / 2)
    turn = -rate * np.cos(a) / (2 * np.cos(b))
    (ca, sa), (cb, sb), m = (np.cos(a), np.sin(a)), (np.cos(b), np.sin(b)), 0.8
    sliding = np.sign(-rate * sa - 2 * turn * sb)
    found = []
    for side in (1, -1):
        # columns: a'', b'', Px, Py at the crank, Qx, Qy at the slider, N
        rows = [
            [0.5, 0, -sa, ca, 0, 0, 0],
            [-m * sa, -m * sb, -1, 0, -1, 0, 0],
            [m * ca, m * cb, 0, -1, 0, -1, 0],
            [0, m * 4 / 12, -sb, cb, sb, -cb, 0],
            [-sa, -2 * sb, 0, 0, 1, 0, mu * sliding * side],
            [ca, 2 * cb, 0, 0, 0, 0, 0],
            [0, 0, 0, 0, 0, 1, -1],
        ]
        right = [
            1,
            m * (rate**2 * ca + turn**2 * cb),
            m * (rate**2 * sa + turn**2 * sb),
            0,
            rate**2 * ca + 2 * turn**2 * cb,
            rate**2 * sa + 2 * turn**2 * sb,
            0,
        ]
        solution = np.linalg.solve(rows, right)
        if side * solution[6] >= 0:
            found.append((solution[0], solution[6]))
    assert len(found) == 1
    return found[0]


def test_a_slider_crank_moves_as_the_equations_of_newton_and_euler_say():
    motion = of_text(CRANK).simulate(until=2, samples=5)
    truth = solve_ivp(
        lambda t, state: [state[1], crank_acceleration(*state, 0.3)[0]],
        (0, 2),
        (0.5, 2),
        t_eval=np.linspace(0, 2, 5),
        rtol=1e-9,
        atol=1e-10,
        max_step=0.02,
    ).y
    assert motion["a"] == pytest.approx(truth[0], rel=1e-6)
    guides = [crank_acceleration(a, v, 0.3)[1] for a, v in zip(motion["a"], motion["dot(a)"], strict=True)]
    assert np.abs(motion["lambda3"]) == pytest.approx(np.abs(guides), rel=1e-9)
    assert any(switching.function == "lambda3" for switching in motion.report.switchings)


def planted(seed):
    """Numbers of a system of 4 coordinates, with friction in two of them that two multipliers bound.

    Both move, both rest, or the second one alone moves.
    """
    draw = np.random.default_rng(seed)
    root, J, F = draw.normal(size=(4, 4)), draw.normal(size=(2, 4)), draw.normal(size=4)
    A, mu = root @ root.T + np.eye(4), draw.uniform(0.2, 4, 2)
    v = draw.normal(size=4) * [[1, 1, 1, 1], [0, 0, 1, 1], [0, 1, 1, 1]][seed % 3]
    A, J, F, mu, v = (np.round(each * 1024) / 1024 for each in (A, J, F, mu, v))
    v[2:] = np.linalg.solve(J[:, 2:], -J[:, :2] @ v[:2])
    return A, J, F, mu, v


def solved(A, J, F, mu, v):
    """The solutions (a, lambda, friction) of all modes that agree, and the signs of the determinants of all modes.

    Unknown are the accelerations, the multipliers and the friction of both contacts, each equation written out.
    """
    found, signs = [], set()
    contacts = [(1, -1, 0) if speed == 0 else (np.sign(speed),) for speed in v[:2]]
    for *mode, s1, s2 in product(*contacts, (1, -1), (1, -1)):
        matrix, sides = np.zeros((8, 8)), np.array([s1, s2])
        matrix[:4], matrix[4:6, :4] = np.hstack([A, -J.T, -np.eye(4)[:, :2]]), J
        for k, s in enumerate(mode):
            matrix[6 + k, k] = -1 if s == 0 else 0
            matrix[6 + k, [4 + k, 6 + k]] = [mu[k] * s * sides[k], 1] if s else [0, 0]
        signs.add(np.sign(np.linalg.det(matrix)))
        x = np.linalg.solve(matrix, [*F, 0, 0, 0, 0])
        leaves = all(s == 0 or v[k] or s * x[k] >= 0 for k, s in enumerate(mode))
        if leaves and (sides * x[4:6] >= 0).all() and (np.abs(x[6:]) <= mu * np.abs(x[4:6]) + 1e-12).all():
            found.append(x)
    return found, signs


def exact(x):
    return f"({round(x * 1024)}/1024)"


@pytest.mark.parametrize("seed", range(12))
def test_random_systems_accelerate_as_the_one_mode_that_agrees_or_are_refused(seed):
    A, J, F, mu, v = planted(seed)
    rates = [f"dot(q{s})" for s in range(1, 5)]
    energy = " + ".join(f"{exact(A[i, k])}*{rates[i]}*{rates[k]}/2" for i, k in product(range(4), repeat=2))
    friction = [f"-{exact(mu[k])}*abs(lambda{k + 1})*signum({rates[k]})" for k in range(2)]
    constraints = ", ".join(" + ".join(f"{exact(x)}*q{s}" for s, x in enumerate(row, 1)) for row in J)
    scene = of_text(
        f"""
system : holonomic_system(coordinates = [q1, q2, q3, q4], kinetic_energy = {energy},
  forces = [push = [{", ".join(map(exact, F))}], friction = [{", ".join(friction)}, 0, 0]],
  constraints = [{constraints}])$
scene : holonomic_scene(system, observe = [trajectory, multipliers, a1 = ddot(q1)],
  initial_state = [q1 = 0, q2 = 0, dot(q1) = {exact(v[0])}, dot(q2) = {exact(v[1])}])$
""".replace("diff(dot(q1), t)", "ddot(q1)")
    )
    found, signs = solved(A, J, F, mu, v)
    motion, kind = None, None
    try:
        motion = scene.simulate(until=1e-3, samples=2)
    except HolonomError as error:
        kind = error.kind
    if motion is None:
        assert kind is ErrorKind.NO_WAY_ON
        assert len(signs) > 1 or len(found) != 1
        return
    assert len(found) == 1
    numbers = [motion["a1"][0], motion["lambda1"][0], motion["lambda2"][0]]
    assert numbers == pytest.approx(found[0][[0, 4, 5]], rel=1e-9, abs=1e-12)


def test_without_a_reaction_there_is_no_friction():
    scene = of_text("""
system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  forces = [friction = [-abs(lambda1)*signum(dot(x)), 0]], constraints = [y])$
scene : holonomic_scene(system, initial_state = [x = 0, dot(x) = 1], time_span = [0, 1])$
""")
    motion = scene.simulate(until=1, samples=2)
    assert motion["x"][-1] == pytest.approx(1, abs=1e-14)
    assert not motion.report.switchings


def test_joints_name_their_reactions_in_forces():
    scene = of_text("""
bob : particle(m, [x, y])$
rail : point_on_line(bob, marker(ground, [0, 0], [1, 0]))$
system : holonomic_system(parameters = [m, g, mu], assembly(bob, rail, gravity = uniform_gravity(g, bob)),
  forces = [friction = [-mu*abs(reaction(rail)[2])*signum(dot(x)), 0]])$
scene : holonomic_scene(system, parameter_values = [m = 2, g = 10, mu = 1/4], initial_state = [x = 0, dot(x) = 5])$
""")
    assert scene.simulate(until=1, samples=2)["x"][-1] == pytest.approx(5 - 2.5 / 2, rel=1e-12)


def test_a_scene_may_leave_out_all_friction():
    """Truth: it slides as on ice."""
    text = INCLINE.replace("VELOCITY", "1").replace(
        "scene : holonomic_scene(system,", "ice : holonomic_scene(system, effects = [gravity],"
    )
    motion = of_text(text).simulate(samples=2)
    assert motion["x"][-1] == pytest.approx(2 + 2 * 9.81 * np.sin(0.25), abs=1e-12)
    assert motion["lambda1"] == pytest.approx(2 * 9.81 * np.cos(0.25))


TWO_BLOCKS = """
system : holonomic_system(coordinates = [x, y, z, w], kinetic_energy = (dot(x)^2 + dot(y)^2 + dot(z)^2 + dot(w)^2)/2,
  potential_energy = [spring = (x - y)^2, weight = 10*z + 10*w], constraints = [z, w],
  forces = [push = [2*t, 0, -t, 0], floor = [-abs(lambda1)*signum(dot(x))/4, -abs(lambda2)*signum(dot(y))/8, 0, 0]])$
scene : holonomic_scene(system, initial_state = [x = 0, y = 0, z = 0, w = 0, dot(x) = 0, dot(y) = 0])$
"""


def test_two_blocks_stick_until_their_forces_are_as_large_as_their_friction():
    """Both were refused as a paradox.

    Truth: the first one slides from 2 t = (10 + t)/4 on, x'' = 7/4 t - 5/2 - 2 x, the second one from 2 x = 10/8 on.
    """
    motion = of_text(TWO_BLOCKS).simulate(until=4, samples=2)
    first = 10 / 7

    def x(t):
        rate, w = 7 / 4, np.sqrt(2)
        return rate / 2 * (t - first - np.sin(w * (t - first)) / w)

    second = brentq(lambda t: 2 * x(t) - 10 / 8, first, 4)
    assert [each.t for each in motion.report.switchings] == pytest.approx([first, second], rel=1e-12)
    assert [each.outcome for each in motion.report.switchings] == ["released", "released"]


LADDER = """
system : holonomic_system(coordinates = [x, y, p], controls = [u], parameters = [mu],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2 + dot(p)^2/6,
  potential_energy = [weight = 10*y, climber = 40*(y - sin(p) + 2*u*sin(p))],
  forces = [floor = -mu*abs(lambda1)*signum(dot(x) + sin(p)*dot(p))*[1, 0, sin(p)],
            wall = -mu*abs(lambda2)*signum(dot(y) + cos(p)*dot(p))*[0, 1, cos(p)]],
  constraints = [y - sin(p), x + cos(p)])$
scene : holonomic_scene(system, control_law = [u = t/10], initial_state = [p = 8/10, dot(p) = 0], time_span = [0, 7])$
"""


@pytest.mark.parametrize("mu", ["1/3", "1/2"])
def test_a_ladder_stands_until_its_climber_is_too_high(mu):
    """It has one degree of freedom, and friction at both ends, which is not unique while it stands.

    Truth: the moments of a ladder that slips at both ends, and then the equations of Newton and Euler.
    """
    k, p0 = float(Fraction(mu)), 0.8
    floor = 50 / (1 + k**2)
    slips = 10 * (2 * k * floor * (np.tan(p0) + k) - 10) / 80
    motion = of_text(LADDER).simulate(until=slips + 0.4, samples=30, mu=mu)
    times = motion["t"]
    assert [each.t for each in motion.report.switchings][:2] == pytest.approx([slips, slips], rel=1e-9)
    assert motion["p"][times < slips] == pytest.approx(p0, abs=1e-13)
    assert motion.report.undetermined == ("lambda1", "lambda2")

    def moved(t, state):
        p, rate = state
        s, c = np.sin(p), np.cos(p)
        equations = [  # of x'', y'', p'', the floor's force and the wall's, by Newton and Euler
            [1, 0, 0, -k, 1],
            [0, 1, 0, -1, -k],
            [0, 0, 1 / 3, c - k * s, -s - k * c],
            [0, 1, -c, 0, 0],
            [1, 0, -s, 0, 0],
        ]
        right = [0, -50, -40 * (t / 5 - 1) * c, -s * rate**2, c * rate**2]
        return rate, np.linalg.solve(equations, right)[2]

    falls = times > slips
    truth = solve_ivp(moved, (slips, times[-1]), (p0, 0), t_eval=times[falls], rtol=1e-11, atol=1e-13).y
    assert motion["p"][falls] == pytest.approx(truth[0], rel=1e-8)


FEET = """
system : holonomic_system(coordinates = [x1, y1, x2, y2],
  kinetic_energy = (dot(x1)^2 + dot(y1)^2 + dot(x2)^2 + dot(y2)^2)/2, potential_energy = 10*y1 + 20*y2,
  constraints = [y1, y2, x2 - x1 - 1], forces = [pull = [t, 0, 0, 0],
    floor = -3*[abs(lambda1)*signum(dot(x1)), 0, abs(lambda2)*signum(dot(x2)), 0]/10])$
scene : holonomic_scene(system, initial_state = [x1 = 0, y1 = 0, y2 = 0, x2 = 1, dot(x1) = 0, dot(y1) = 0, dot(y2) = 0],
  observe = [trajectory, multipliers, rod = lambda3, weight = lambda1 + lambda2])$
"""


def test_feet_that_share_friction_have_unique_weights():
    """Truth: weights 10 and 20; the rod's force depends on the shares, until both slip at t = 3/10*(10 + 20)."""
    motion = of_text(FEET).simulate(until=10, samples=11)
    assert motion.report.undetermined == ("lambda3", "rod")
    assert motion["lambda1"] == pytest.approx(10)
    assert motion["weight"] == pytest.approx(30)
    assert [each.t for each in motion.report.switchings] == pytest.approx([9, 9], rel=1e-9)
    assert motion["x1"][-1] == pytest.approx(1 / 6 / 2, rel=1e-9)


def test_a_motion_that_ends_while_a_contact_sticks_names_its_end():
    """It was an internal error. Truth: w = 1/(1 - t)."""
    scene = of_text("""
system : holonomic_system(coordinates = [x, y, w], kinetic_energy = (dot(x)^2 + dot(y)^2 + dot(w)^2)/2,
  potential_energy = 10*y - w^4/2, forces = [-abs(lambda1)*signum(dot(x))/4, 0, 0], constraints = [y])$
scene : holonomic_scene(system, initial_state = [x = 0, y = 0, w = 1, dot(x) = 0, dot(w) = 1])$
""")
    with failing(ErrorKind.NO_WAY_ON) as ended:
        scene.simulate(until=2, samples=2)
    assert float(ended.value.detail.split(",")[0]) == pytest.approx(1, abs=1e-6)
    assert "Painleve" not in ended.value.detail


def test_six_blocks_slide_on_each_other():
    """Truth: block i has friction -i/10 of the weights 10*(7 - i) from below, that of the next one from above."""
    blocks = range(1, 7)

    def each(term):
        return ", ".join(term(i) for i in blocks)

    def friction(i):
        slip = f"dot(x{i})" + (f" - dot(x{i - 1})" if i > 1 else "")
        direction = [int(place == i) - int(place == i - 1) for place in blocks]
        return f"f{i} = -{i}*abs(lambda{i})*signum({slip})*{[*direction, *[0] * 6]}/10"

    start = each("x{0} = 0, y{0} = 0, dot(x{0}) = 10*{0}, dot(y{0}) = 0".format)
    stack = of_text(f"""
system : holonomic_system(coordinates = [{each("x{}".format)}, {each("y{}".format)}],
  kinetic_energy = apply("+", map(lambda([v], v^2), [{each("dot(x{0}), dot(y{0})".format)}]))/2,
  potential_energy = 10*apply("+", [{each("y{}".format)}]), forces = [{each(friction)}],
  constraints = [y1, {", ".join(f"y{i} - y{i - 1}" for i in blocks[1:])}])$
scene : holonomic_scene(system, initial_state = [{start}],
  time_span = [0, 1/2])$
""")
    motion = stack.simulate(samples=2)
    forces = [i * (7 - i) for i in blocks] + [0]
    accelerations = np.diff(forces)
    for i, acceleration in zip(blocks, accelerations, strict=True):
        assert motion[f"x{i}"][-1] == pytest.approx(10 * i / 2 + acceleration / 8, rel=1e-13)


TIPPED_ROD = """
rod : planar_body({m}, {m}*{l}^2/10, [x, y], phi)$
tip : marker(rod, [0, -{l}/2])$
system : holonomic_system(assembly(rod, constraints = [position(tip)[2]], uniform_gravity(10*{l}/{t}^2, rod),
  applied_force([-1/5*abs(lambda1)*signum(velocity(tip)[1]), 0], tip),
  applied_torque(-{m}*{l}^2/{t}^2/5*signum(dot(phi)), rod)))$
fall : holonomic_scene(system, time_span = [0, 2*{t}], initial_state = [phi = 1/10, x = 0, dot(phi) = 0, dot(x) = 0],
  initial_guess = [y = {l}/2, dot(y) = 0])$
"""


@pytest.mark.parametrize(
    ("length", "mass", "time"), [("1", "1", "(10^-6)"), ("(10^9)", "(10^-12)", "(10^-6)"), ("1000", "1000", "(10^-9)")]
)
def test_moments_of_friction_in_other_units_were_a_paradox(length, mass, time):
    def fallen(**units):
        return holonom.system(TIPPED_ROD.format(**units)).simulate(samples=2).report.coordinates

    found, expected = fallen(l=length, m=mass, t=time), fallen(l="1", m="1", t="1")
    unit = {"1": 1.0, "1000": 1e3, "(10^9)": 1e9}[length]
    assert found["phi"] == pytest.approx(expected["phi"], rel=1e-12)
    assert [found[name] / unit for name in "xy"] == pytest.approx([expected[name] for name in "xy"], rel=1e-11)
