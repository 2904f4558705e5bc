"""Linearisation against closed forms, SymPy's Linearizer, and small deviations of motions that are followed."""

import json
from fractions import Fraction

import numpy as np
import pytest
from problems import problem
from refusing import failing
from sympy.physics.mechanics import LagrangesMethod, Point, ReferenceFrame, dynamicsymbols

import holonom
from holonom.crosscheck.report import Verdict
from holonom.crosscheck.results import verify_result
from holonom.failures import ErrorKind, HolonomError
from holonom.formats import Publication, published, require
from holonom.program.numpy_function import NumpyFunction
from holonom.stability.linearization import Linearization, state_at

# ---- textbook cases, at rest -----------------------------------------------------------------------------------------

DOUBLE_PENDULUM = """system : holonomic_system(coordinates = [x1, y1, x2, y2], parameters = [g],
  kinetic_energy = (dot(x1)^2 + dot(y1)^2 + dot(x2)^2 + dot(y2)^2)/2, potential_energy = [gravity = g*(y1 + y2)],
  constraints = [x1^2 + y1^2 - 1, (x2 - x1)^2 + (y2 - y1)^2 - 1])$
rest : holonomic_scene(system, parameter_values = [g = 10], time_span = [0, 1], initial_state =
  [x1 = 0, y1 = -1, x2 = 0, y2 = -2, dot(x1) = 0, dot(y1) = 0, dot(x2) = 0, dot(y2) = 0])$
"""
HOOP = """system : holonomic_system(coordinates = [r, z], parameters = [Omega],
  kinetic_energy = (dot(r)^2 + dot(z)^2 + r^2*Omega^2)/2, potential_energy = [gravity = 10*z],
  constraints = [r^2 + z^2 - 1])$
rest : holonomic_scene(system, parameter_values = [Omega = 5], time_span = [0, 1], initial_guess = [z = -1],
  initial_state = [r = {r}, dot(r) = 0, dot(z) = 0])$
"""
FOUCAULT = """system : holonomic_system(coordinates = [x, y, z], parameters = [w],
  kinetic_energy = ((dot(x) - w*y)^2 + (dot(y) + w*x)^2 + dot(z)^2)/2,
  potential_energy = [gravity = 10*z], constraints = [x^2 + y^2 + z^2 - 4])$
rest : holonomic_scene(system, parameter_values = [w = 3], time_span = [0, 1], initial_state =
  [x = 0, y = 0, z = -2, dot(x) = 0, dot(y) = 0, dot(z) = 0])$
"""


def imaginary(frequencies):
    return sorted(w * sign for w in frequencies for sign in (1, -1))


@pytest.mark.parametrize(
    ("text", "frequencies"),
    [
        (DOUBLE_PENDULUM, [np.sqrt(10 * (2 + np.sqrt(2))), np.sqrt(10 * (2 - np.sqrt(2)))]),
        # the bead leaves the lowest point for cos(phi) = g/(R Omega^2), where it swings with Omega*sin(phi)
        (HOOP.format(r="sqrt(1 - 4/25)"), [5 * np.sqrt(1 - 0.16)]),
        (FOUCAULT, [3 + np.sqrt(5), 3 - np.sqrt(5)]),
    ],
    ids=["double pendulum", "bead on a turning hoop", "Foucault"],
)
def test_textbook_frequencies(text, frequencies):
    found = holonom.system(text).linearize()
    assert found.at_rest
    assert np.abs(found.eigenvalues.real).max() < 1e-7
    assert sorted(found.eigenvalues.imag) == pytest.approx(imaginary(frequencies), rel=1e-10)


def test_a_bead_at_the_lowest_point_of_a_fast_hoop_leaves_it():
    found = holonom.system(HOOP.format(r=0)).linearize()
    assert sorted(found.eigenvalues.real) == pytest.approx([-np.sqrt(15), np.sqrt(15)], rel=1e-12)


@pytest.mark.parametrize(("k", "zeros"), [(0, 2), (3, 0)])
def test_a_double_zero_is_zero_to_its_rounding_errors(k, zeros):
    """A cart with a pendulum, on a spring or on none: its eigenvalues were 2e-8 and -2e-8, with damping."""
    found = holonom.system(
        """system : holonomic_system(coordinates = [s, x, y], parameters = [k], kinetic_energy =
          dot(s)^2 + (dot(x)^2 + dot(y)^2)/2, potential_energy = 981/100*y + k*s^2/2,
          constraints = [(x - s)^2 + y^2 - 1])$
        rest : holonomic_scene(system, initial_state = [s = 0, x = 0, y = -1, dot(s) = 0, dot(x) = 0, dot(y) = 0],
          time_span = [0, 1])$""",
        k=k,
    ).linearize(at=0)
    assert np.sum(np.abs(found.eigenvalues) <= found.eigenvalue_errors) == zeros
    assert np.max(found.eigenvalue_errors) < 1e-6
    squares = np.linalg.eigvals(np.linalg.solve([[3, 1], [1, 1]], [[k, 0], [0, 9.81]]))
    assert np.max(found.eigenvalues.imag) == pytest.approx(np.sqrt(np.max(squares)), abs=1e-12)


def test_modes_of_the_double_pendulum():
    found = holonom.system(DOUBLE_PENDULUM).linearize()
    shapes = {tuple(np.round(np.real(mode[[0, 2]] / mode[0]), 10)) for mode in found.modes.T}
    assert shapes == {(1.0, round(1 + np.sqrt(2), 10)), (1.0, round(1 - np.sqrt(2), 10))}


# ---- SymPy ---------------------------------------------------------------------------------------------------------

CART = """system : holonomic_system(coordinates = [s, x, y], controls = [F], parameters = [c],
  kinetic_energy = dot(s)^2 + (dot(x)^2 + dot(y)^2)/2, potential_energy = [gravity = 10*y],
  forces = [damping = [-c*dot(s), -dot(x)/3, 0], push = [F, 0, 0]], constraints = [(x - s)^2 + y^2 - 1])$
rest : holonomic_scene(system, parameter_values = [c = 1/2], control_law = [F = 0], time_span = [0, 1],
  initial_state = [s = 0, x = 0, y = {y}, dot(s) = 0, dot(x) = 0, dot(y) = 0])$
"""


def cart_by_sympy(y0):
    s, x, y, force = dynamicsymbols("s x y F")
    ds, dx, dy = dynamicsymbols("s x y", 1)
    frame, cart, bob = ReferenceFrame("N"), Point("cart"), Point("bob")
    cart.set_vel(frame, ds * frame.x)
    bob.set_vel(frame, dx * frame.x + dy * frame.y)
    forces = [(cart, (force - ds / 2) * frame.x), (bob, -dx / 3 * frame.x)]
    lagrangian = ds**2 + (dx**2 + dy**2) / 2 - 10 * y
    length = (x - s) ** 2 + y**2 - 1
    method = LagrangesMethod(lagrangian, [s, x, y], hol_coneqs=[length], forcelist=forces, frame=frame)
    method.form_lagranges_equations()
    linearizer = method.to_linearizer(q_ind=[s, x], qd_ind=[ds, dx], q_dep=[y], qd_dep=[dy])
    at = dict.fromkeys([s, x, ds, dx, dy, force, *dynamicsymbols("s x y", 2)], 0) | {y: y0, method.lam_vec[0]: -5 * y0}
    return [np.array(part, dtype=float) for part in linearizer.linearize(op_point=at, A_and_B=True)]


@pytest.mark.parametrize("y", [-1, 1])
def test_a_cart_with_a_pendulum_against_sympys_linearizer(y):
    found, (a, b) = holonom.system(CART.format(y=y)).linearize(), cart_by_sympy(y)
    assert np.sort_complex(found.eigenvalues) == pytest.approx(np.sort_complex(np.linalg.eigvals(a)), abs=1e-8)
    rate = 0.3 + 1.1j  # of which the transfer function from the force to s and x is the same
    one = found.C[:2] @ np.linalg.solve(rate * np.eye(4) - found.A, found.B["u"])
    other = np.linalg.solve(rate * np.eye(4) - a, b)[:2]
    assert one == pytest.approx(other, rel=1e-8)
    assert found.controllable_rank == 4
    assert found.observable_rank(["x"]) == 4
    assert found.observable_rank(["dot(x)"]) == 3


@pytest.mark.parametrize(
    ("mass", "drive", "coupling", "rank"), [("1", "1", "1", 4), ("1/10^4", "10^8", "1/10", None), ("1", "1", "0", 2)]
)
def test_rank_of_controllability_is_open_where_rounding_does_not_determine_it(mass, drive, coupling, rank):
    """Kalman's rank is 4 unless the coupling is zero; a fast mode that hardly moves the slow one left 2."""
    found = holonom.system(f"""
system : holonomic_system(coordinates = [x, y, z], controls = [u],
  kinetic_energy = {mass}*dot(x)^2/2 + dot(y)^2/2,
  potential_energy = {drive}*(x - z)^2/2 + {coupling}*(y - x)^2/2 + y^2/2, constraints = [z - u])$
rest : holonomic_scene(system, control_law = [u = 0],
  initial_state = [x = 0, y = 0, dot(x) = 0, dot(y) = 0])$""").linearize()
    assert found.controllable_rank == rank


# ---- motions that are followed ---------------------------------------------------------------------------------------

PARTS = {
    "pendulum": """system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [e],
  kinetic_energy = (1 + x^2)*(dot(x)^2 + dot(y)^2)/2, potential_energy = [gravity = 10*y],
  forces = [drag = [-dot(x)/5, u*dot(u)/7]], constraints = [x^2 + y^2 - u^2])$
scene : holonomic_scene(system, control_law = [u = 1 + t/4 + e*(1 + sin(3*t))], time_span = [0, 2],
  initial_state = [x = 3/5 + e/3, dot(x) = 1 - e], initial_guess = [y = -4/5, dot(y) = 0])$
""",
    "two bars": """system : holonomic_system(coordinates = [phi, x, y], controls = [u, w], parameters = [e],
  kinetic_energy = dot(phi)^2/3 + (dot(x)^2 + dot(y)^2) + dot(w)*dot(x)/5, potential_energy = [gravity = 5*y],
  forces = [push = [w, 0, 0]], constraints = [(x - cos(phi) - u)^2 + (y - sin(phi))^2 - 4])$
scene : holonomic_scene(system, control_law = [u = t^2/3 + e*cos(t), w = 1 + e*t], time_span = [0, 2],
  initial_state = [phi = 1/2 + e, x = 2, dot(phi) = -1, dot(x) = e/2], initial_guess = [y = 2, dot(y) = 0])$
""",
    "winch and force that keep a path": """system : holonomic_system(coordinates = [x, y, z], controls = [u, F, w],
  parameters = [e], kinetic_energy = (1 + z^2/4)*dot(x)^2 + dot(y)^2 + dot(z)^2/2,
  potential_energy = [gravity = 20*y, spring = (z - x)^2], forces = [drive = [F*z/5, F/7, F]],
  constraints = [x^2 + (y - w)^2 - u^2])$
scene : holonomic_scene(system, servo_constraints = [y = -2 + t/10, z = x/3 + sin(t)],
  control_law = [w = t^2/10 + e*cos(t)], time_span = [0, 2], initial_state = [x = 1/2 + e, dot(x) = e/3],
  initial_guess = [y = -2, u = 2, z = 0, dot(z) = 1, dot(y) = 0, dot(u) = 0],
  observe = [trajectory, controls, multipliers, pull = -2*u*lambda1 + F*dot(z)])$
""",
    "path of relative degree four": """system : holonomic_system(coordinates = [h, x, z], controls = [u, w],
  parameters = [e], kinetic_energy = dot(h)^2/2 + dot(x)^2 + dot(z)^2*(1 + z^2)/2,
  potential_energy = [gravity = 10*h + 20*x, spring = 25*(h - x - 1)^2 + 10*(z - x)^2], constraints = [h - u - w])$
scene : holonomic_scene(system, servo_constraints = [x = sin(t)], control_law = [w = t/5 + e*cos(t)],
  time_span = [0, 2], initial_state = [z = 1/5 + e, dot(z) = e/4],
  initial_guess = [x = 0, u = 1, h = 1, dot(h) = 0, dot(x) = 0, dot(u) = 0], observe = [trajectory, multipliers])$
""",
    "prescribed tension": """system : holonomic_system(coordinates = [x, y], controls = [u, w], parameters = [e],
  kinetic_energy = dot(x)^2 + dot(y)^2, potential_energy = [gravity = 20*y], constraints = [x^2 + (y - w)^2 - u^2])$
scene : holonomic_scene(system, prescribed_reactions = [lambda1 = -5 - t], control_law = [w = t^2/10 + e*cos(t)],
  time_span = [0, 2], initial_state = [x = 1/2 + e, y = -2, dot(x) = e/3, dot(y) = 1],
  initial_guess = [u = 2, dot(u) = 0])$
""",
    "table": """system : holonomic_system(coordinates = [x, y], controls = [u, w], parameters = [e],
  kinetic_energy = dot(x)^2 + dot(y)^2, potential_energy = [gravity = 20*y], constraints = [x^2 + (y - w)^2 - u^2])$
scene : holonomic_scene(system, control_law = [u = table([[0, 2], [1/2, 3/2], [1, 2], [3/2, 1], [2, 2]]), w = e*cos(t)],
  time_span = [0, 2], initial_state = [x = 1/2 + e, dot(x) = e/3], initial_guess = [y = -2, dot(y) = 0])$
""",
    "law in parts": """system : holonomic_system(coordinates = [x, y], controls = [u, w], parameters = [e],
  kinetic_energy = dot(x)^2 + dot(y)^2, potential_energy = [gravity = 20*y],
  forces = [dry = [-signum(dot(x) - w), 0]], constraints = [x^2 + (y - w)^2 - u^2])$
scene : holonomic_scene(system, control_law = [u = if t < 2/5 then 2 else 2 + (t - 2/5)^3, w = e*cos(t)],
  time_span = [0, 2], initial_state = [x = 1/2 + e, dot(x) = -1 + e/3], initial_guess = [y = -2, dot(y) = 0])$
""",
}


def cosine(t):
    return [[np.cos(t)], [-np.sin(t)], [-np.cos(t)]]


LAWS = {  # by e: of u, dot(u) and ddot(u), a row for each control
    "pendulum": lambda t: [[1 + np.sin(3 * t)], [3 * np.cos(3 * t)], [-9 * np.sin(3 * t)]],
    "two bars": lambda t: [[np.cos(t), t], [-np.sin(t), 1], [-np.cos(t), 0]],
    "winch and force that keep a path": cosine,
    "path of relative degree four": cosine,
    "prescribed tension": cosine,
    "table": lambda t: np.insert(cosine(t), 0, 0, axis=1),
    "law in parts": lambda t: np.insert(cosine(t), 0, 0, axis=1),
}
TIME, STEP, SMALL = 0.8, 2e-3, 1e-4
STENCIL = {-2: 1 / 12, -1: -2 / 3, 1: 2 / 3, 2: -1 / 12}  # of a first derivative


def deviations(scene, times, outputs):
    """Derivatives by e of outputs at times."""

    def numbers(time, e):
        motion = scene.simulate(until=time, samples=2, tol=1e-14, e=e)
        return np.array([motion[name][-1] for name in outputs])

    def derivative(time, h):
        return (numbers(time, h) - numbers(time, -h)) / (2 * h)

    return {k: (4 * derivative(t, SMALL) - derivative(t, 2 * SMALL)) / 3 for k, t in times.items()}


NEIGHBOURS = {
    "andrews.mac": (None, "1/100"),
    "car_axis.mac": (None, "3/10"),
    "heavy_top.mac": (None, "3/10"),
    "ring.mac": (None, None),
    "spherical_pendulum.mac": ("shaken_scene", "3/10"),
}


@pytest.mark.parametrize(
    "file", [pytest.param(file, marks=[pytest.mark.long] if file == "ring.mac" else []) for file in NEIGHBOURS]
)
def test_multipliers_of_neighbouring_states(file):
    """States next to one on the manifold have, to first order, the multipliers that the motion program finds there."""
    name, time = NEIGHBOURS[file]
    motion = problem(file, name)
    found = holonom.load(f"examples/{file}", scene=name).linearize(time)
    t, state = state_at(motion, time and Fraction(time))
    function, rows = NumpyFunction(motion.motion), slice(len(state), len(state) + len(motion.multipliers))
    places = [function.outputs.index(each) for each in found.outputs[rows]]
    deviation = np.random.default_rng(1).normal(size=len(found.A))
    moved = found.C[: len(state)] @ deviation
    step = 1e-5 * np.max(np.abs(state)) / np.max(np.abs(moved))
    beside = [0.0] * len(motion.multipliers)
    ahead, behind = (function([t, *(state + k * step * moved), *beside])[places] for k in (1, -1))
    assert found.C[rows] @ deviation == pytest.approx((ahead - behind) / (2 * step), rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("name", PARTS)
def test_small_deviations_of_a_motion_follow_the_linear_system(name):
    scene = holonom.system(PARTS[name])
    times = {k: TIME + k * STEP for k in (0, *STENCIL)}
    undisturbed = scene.with_settings(e=0)
    found = {k: undisturbed.linearize(t) for k, t in times.items()}
    here, n = found[0], len(found[0].coordinates)
    deviating = deviations(scene, times, here.outputs)

    def state(k):
        """Deviations in tangent coordinates whose basis moves as little as the metric allows: its turn is symmetric."""
        left, _, right = np.linalg.svd(here.basis.T @ here.mass @ found[k].basis)
        tangent = (found[k].basis @ (left @ right).T).T @ found[k].mass
        return np.concatenate([tangent @ deviating[k][:n], tangent @ deviating[k][n : 2 * n]])

    law = dict(zip(("u", "du", "ddu"), np.array(LAWS[name](TIME)), strict=True))
    outputs = here.C @ state(0) + sum(here.D[rate] @ law[rate] for rate in law)
    assert outputs == pytest.approx(deviating[0], rel=1e-7, abs=1e-7)
    rates = sum(weight * state(k) for k, weight in STENCIL.items()) / STEP
    assert here.A @ state(0) + sum(here.B[rate] @ law[rate] for rate in law) == pytest.approx(rates, rel=1e-6, abs=1e-6)


def test_one_output_is_given_by_its_name():
    linear = holonom.load("examples/pendulum.mac").linearize()
    assert linear.state_space("ddot", "dot(x)")[2].shape == (1, 4)
    assert linear.observable_rank("dot(x)") == linear.observable_rank(["dot(x)"])


def test_state_space_with_accelerations_as_inputs():
    found = holonom.system(PARTS["pendulum"]).with_settings(e=0).linearize(TIME)
    a, b, c, d = found.state_space("ddot", ["x", "lambda1"])
    assert [part.shape for part in (a, b, c, d)] == [(4, 4), (4, 1), (2, 4), (2, 1)]
    rate = 0.7 + 0.4j
    inner = np.linalg.solve(rate * np.eye(2) - found.A, sum(rate**k * each for k, each in enumerate(found.B.values())))
    whole = found.C @ inner + sum(rate**k * each for k, each in enumerate(found.D.values()))
    rows = [found.outputs.index(name) for name in ("x", "lambda1")]
    assert rate**2 * (c @ np.linalg.solve(rate * np.eye(4) - a, b) + d) == pytest.approx(whole[rows], rel=1e-12)
    with pytest.raises(ValueError, match="'ddot'"):
        found.state_space("u")


# ---- refusals --------------------------------------------------------------------------------------------------------

DEAD_CENTRE = """system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  constraints = [x*y])$
scene : holonomic_scene(system, initial_state = [x = {x}, y = 0, dot(x) = 1, dot(y) = 0], time_span = [0, 1])$
"""


def test_a_singular_configuration_is_refused():
    with pytest.raises(HolonomError) as refused:
        holonom.system(DEAD_CENTRE.format(x=0)).linearize()
    assert refused.value.kind is ErrorKind.NOT_LINEARIZED


@pytest.mark.parametrize(("force", "observed"), [("sqrt(x)", ""), ("-x", ", observe = [r = sqrt(x)]")])
def test_what_has_no_derivative_ended_in_an_internal_error(force, observed):
    text = f"""system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [{force}])$
        scene : holonomic_scene(system, initial_state = [x = 0, dot(x) = 1], time_span = [0, 1]{observed})$"""
    with pytest.raises(HolonomError) as refused:
        holonom.system(text).linearize()
    assert refused.value.kind is ErrorKind.NO_DERIVATIVES


@pytest.mark.parametrize(("x", "stiffness"), [(1, 0), (-4, 60)])
@pytest.mark.parametrize("contact", ["20*max(0, -x)^(3/2)", "if x < 0 then 20*(-x)^(3/2) else 0"])
def test_hertz_contact_is_linearised_on_both_sides(contact, x, stiffness):
    text = f"""system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [{contact}])$
        scene : holonomic_scene(system, initial_state = [x = {x}, dot(x) = 1], time_span = [0, 1])$"""
    assert holonom.system(text).linearize().A.ravel() == pytest.approx([0, 1, -stiffness, 0], abs=1e-12)


def test_a_time_before_the_motion_is_not_the_end_of_one():
    with failing(ErrorKind.NOT_REACHED, "-1", "0"):
        holonom.load("examples/pendulum.mac").linearize(at=-1)


def test_a_motion_that_ends_before_is_refused():
    ending = DOUBLE_PENDULUM.replace("x1 = 0, y1 = -1, x2 = 0", "x1 = 1, y1 = 0, x2 = 1").replace(
        "y2 = -2,", "y2 = -1,"
    )
    scene = holonom.system(ending.replace("time_span = [0, 1]", "time_span = [0, 1], until = [y1 + 1/2]"))
    assert scene.linearize("1/10").at == pytest.approx(0.1)
    with pytest.raises(HolonomError) as refused:
        scene.linearize(1)
    assert refused.value.kind is ErrorKind.NOT_REACHED


DRY = """system : holonomic_system(coordinates = [x], parameters = [c], kinetic_energy = dot(x)^2/2,
  potential_energy = [spring = 2*x^2], forces = [dry = [-c*signum(dot(x))*(1 + x^2)]])$
s : holonomic_scene(system, parameter_values = [c = 3], initial_state = [x = 1/2, dot(x) = {speed}],
  time_span = [0, 1])$"""


@pytest.mark.parametrize(("speed", "direction"), [(1, 1), (-1, -1)])
def test_a_motion_with_friction_is_linearised_between_switchings(speed, direction):
    found = holonom.system(DRY.format(speed=speed)).linearize()
    stiffness = 4 + 3 * direction  # the slope of 4 x + 3 d (1 + x^2) at 1/2
    assert found.A.ravel() == pytest.approx([0, 1, -stiffness, 0], abs=1e-12)


@pytest.mark.parametrize(("speed", "at"), [(0, None), (1, 1)])
def test_a_state_that_sticks_or_turns_is_refused(speed, at):
    """The friction 15/4 holds the spring's pull 2, from the start or once the mass has stopped."""
    with pytest.raises(HolonomError) as refused:
        holonom.system(DRY.format(speed=speed)).linearize(at=at)
    assert refused.value.kind is ErrorKind.NOT_ANALYTIC


# ---- changes with time -----------------------------------------------------------------------------------------------

DRIVEN = """system : holonomic_system(coordinates = [x], controls = [u], kinetic_energy = {mass}*dot(x)^2/2,
  potential_energy = {stiffness}*x^2/2)$
s : holonomic_scene(system, control_law = [u = {law}], initial_state = [x = 0, dot(x) = 0], time_span = [0, 1])$"""


@pytest.mark.parametrize(
    ("mass", "stiffness", "law", "resting"),
    [
        ("u^2", "4", "1 + t", False),
        ("u^2", "4", "cos(t)", False),
        ("1", "u", "1 + t", False),
        ("u*(1 + t)^2", "4", "1", False),
        ("u^2", "4", "1", True),
    ],
)
def test_a_mass_at_rest_with_coefficients_that_change_is_not_at_rest(mass, stiffness, law, resting):
    """With u = 1 + t, x'' = -2 x' - 4 x at first, but xi = u x has other eigenvalues, without a warning before."""
    scene = holonom.system(DRIVEN.format(mass=mass, stiffness=stiffness, law=law))
    found = scene.linearize()
    assert (found.at_rest, "xi" in found.as_text()) == (resting, not resting)
    document = json.loads(json.dumps(published(Publication.LINEARIZED, found.document())))
    assert verify_result(scene.description, document).verdict is Verdict.AGREES
    wrong = verify_result(scene.description, document | {"at_rest": not resting})
    assert wrong.verdict is Verdict.DISAGREES


# ---- the command -----------------------------------------------------------------------------------------------------


def test_the_command(holonom_here):
    answer = holonom_here("linearize", "examples/pendulum.mac", "--at", "1/2", "--json", "-")
    document = json.loads(answer.stdout)
    require(Publication.LINEARIZED, document, Linearization)
    assert (answer.returncode, document["at"], document["at_rest"], document["leading"]) == (0, 0.5, False, ["x"])
    table = holonom_here("linearize", "examples/linkage.mac", "--equilibrium", "e2")
    assert (table.returncode, "± 3.43103 i" in table.stdout) == (0, True)


def test_modes_are_drawn_about_the_state(holonom_here, tmp_path):
    figure = tmp_path / "modes.svg"
    assert holonom_here("linearize", "examples/chain.mac", "--set", "N=3", "--plot", figure).returncode == 0
    assert figure.read_text().startswith("<?xml")
    found = holonom.load("examples/chain.mac", N=3).linearize()
    values, *panels = found.plot().figure.axes
    assert values.lines[-1].get_ydata() == pytest.approx(found.eigenvalues.imag)
    upper = found.eigenvalues.imag > 0
    titles = [f"± {each.imag:.4g} i" for each in found.eigenvalues[upper]]
    assert [panel.get_title("left") for panel in panels[:3]] == titles
    for panel, mode in zip(panels, found.modes.T[upper], strict=False):
        rest, there, _, back, _ = (np.array(line.get_xydata()) for line in panel.lines[:5])  # of the polyline
        moved = np.ravel(there - rest)[2:]
        assert moved / np.max(np.abs(moved)) == pytest.approx(mode.real, abs=1e-9)
        assert there + back == pytest.approx(2 * rest)


def test_modes_of_a_system_without_drawing_are_stems():
    found = holonom.system(DOUBLE_PENDULUM).linearize()
    _, *panels = found.plot().figure.axes
    stems = [panel.containers[0].markerline.get_ydata() for panel in panels[:2]]
    assert np.array(stems) == pytest.approx(found.modes.T[found.eigenvalues.imag >= 0].real)


@pytest.mark.parametrize("library", ["scipy.signal", "control"])
def test_libraries_take_the_state_space(library):
    module = pytest.importorskip(library)
    found = holonom.system(CART.format(y=-1)).linearize()
    system = module.StateSpace(*found.state_space("u", ["s", "x"]))
    assert np.sort_complex(np.linalg.eigvals(system.A)) == pytest.approx(np.sort_complex(found.eigenvalues), abs=1e-9)
    assert (system.B.shape, system.C.shape) == ((4, 1), (2, 4))
    driven = module.StateSpace(*found.state_space("ddot", ["s", "x"]))
    assert driven.A.shape == (6, 6)


# ---- outputs of the scene ------------------------------------------------------------------------------------------

OBSERVED = """system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [m, g],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, potential_energy = [gravity = m*g*y], constraints = [x^2 + y^2 - u^2])$
swing : holonomic_scene(system, control_law = [u = 1 + t/10], parameter_values = [m = 3/2, g = 981/100],
  initial_state = [x = 3/5, y = -4/5, dot(x) = 1/2], time_span = [0, 2], observe = [trajectory, pull = lambda1*x,
    law = m*ddot(x) - 2*lambda1*x, length = dot(x)^2 + x*ddot(x) + dot(y)^2 + y*ddot(y) - dot(u)^2 - u*ddot(u),
    E = energy, side = abs(x)])$
"""


def test_outputs_of_the_scene_deviate_with_what_they_are_made_of():
    """Newton's law and the constraint hold for neighbouring motions, and the energy is that of the state."""
    found = holonom.system(OBSERVED).linearize(at=0)
    x, y, v, w = 0.6, -0.8, 0.5, 0.25  # x v + y w = u du/dt
    multiplier = (0.01 - v**2 - w**2 + 9.81 * y) * 0.75  # of v^2 + w^2 + x ddot x + y ddot y = (u^2)''/2
    for rows in (found.C, *found.D.values()):
        row = dict(zip(found.outputs, rows, strict=True))
        assert row["law"] == pytest.approx(0 * row["law"], abs=1e-13)
        assert row["length"] == pytest.approx(0 * row["length"], abs=1e-13)
        assert row["pull"] == pytest.approx(multiplier * row["x"] + x * row["lambda1"])
        assert row["side"] == pytest.approx(row["x"])
        assert row["E"] == pytest.approx(1.5 * (v * row["dot(x)"] + w * row["dot(y)"] + 9.81 * row["y"]))


CUT = """bob : particle(1, [x, y])$  thread : distance_joint(bob, [0, 0], 1)$
system : holonomic_system(parameters = [g], assembly(bob, thread, uniform_gravity(g, bob)))$
run : holonomic_scene(system, parameter_values = [g = 10], time_span = [0, 1], released = [thread = t - 1/2],
  initial_state = [x = 0, y = -1, dot(x) = 0])$
"""


def test_a_motion_is_linearised_before_a_release():
    """Truth: a pendulum of length one, whose thread is cut at t = 1/2."""
    scene = holonom.system(CUT)
    for t in (0, Fraction(1, 4)):
        assert sorted(scene.linearize(at=t).eigenvalues.imag) == pytest.approx(imaginary([10**0.5]), abs=1e-12)
    with pytest.raises(HolonomError) as refused:
        scene.linearize(at=Fraction(3, 4))
    assert refused.value.kind is ErrorKind.NOT_ANALYTIC


CHARGE = """
cone : holonomic_system(
  coordinates = [x, y, z], kinetic_energy = (dot(x)^2 + dot(y)^2 + dot(z)^2)/2 + 3*(x*dot(y) - y*dot(x))/2,
  potential_energy = [weight = 10*z], forces = [electric = [cos(t), 0, 0]], constraints = [x^2 + y^2 - z^2])$
orbit : holonomic_scene(cone, initial_state = [x = 3, y = 4, z = 5, dot(x) = -2, dot(y) = 1], time_span = [0, 5])$
"""


def test_the_figure_shows_rounded_zeros_as_zero_and_names_the_parts():
    found = holonom.system(CHARGE).linearize(at=1)
    assert found.eigenvalues[:2].all()
    assert (abs(found.eigenvalues) <= found.eigenvalue_errors).tolist() == [True, True, False, False]
    figure = found.plot().figure
    values, *panels = figure.axes
    assert [panel.get_title("left") for panel in panels[:2]] == ["0", "0"]
    assert all([values.get_xlabel(), values.get_ylabel()])
    assert len(figure.legends[0].get_texts()) == 2


def test_a_driven_linkage_has_no_table_of_modes(holonom_here, tmp_path):
    (tmp_path / "crank.mac").write_text(
        'load("holonom.mac")$ crank : holonomic_system(coordinates = [x], controls = [u], kinetic_energy = dot(x)^2/2,'
        " constraints = [x - u])$ turn : holonomic_scene(crank, control_law = [u = t], initial_state = [])$"
    )
    shown = holonom_here("linearize", tmp_path / "crank.mac")
    assert (shown.returncode, len(shown.stdout.splitlines())) == (0, 2)


INVERTED = """rod : rigid_body(2, [1/3, 1, 2], [x, y, z], [e0, e1, e2, e3])$
system : holonomic_system(parameters = [e], assembly(rod, uniform_gravity(10, rod),
  revolute_joint(marker(rod, [0, 0, 1/2], [1, 0, 0]), marker(ground, [0, 0, 0], [1, 0, 0]))))$
scene : holonomic_scene(system, time_span = [0, 1], initial_guess = [x = 0, y = 0, z = 1/2, e1 = 1],
  initial_state = [e0 = e, e2 = 0, e3 = 0, dot(e0) = 0])$
"""


@pytest.mark.parametrize("e", ["0", "6.1e-17", "1e-13", "1e-8"])
def test_a_half_turn_by_rounding_was_a_singular_configuration(e):
    """About it the mass of e1 is rounding: 4 J e0^2."""
    linear = holonom.system(INVERTED).with_settings(e=e).linearize()
    assert sorted(linear.eigenvalues.real) == pytest.approx([-(12**0.5), 12**0.5])  # m g l/(J + m l^2)
    assert linear.basis[1:4, 0] == pytest.approx([0.3**0.5, 0, 0.3**0.5], abs=1e-7)


LIGHT = """heavy : rigid_body(10^6, [10^7, 10^7, 10^7], [x0, y0, z0], [e00, e01, e02, e03])$
light : rigid_body(1/10^6, [1, 1, 1]/10^13, [x1, y1, z1], [e10, e11, e12, e13])$
system : holonomic_system(assembly(heavy, light, uniform_gravity(981/100, heavy, light),
  spherical_joint(marker(heavy, [0, 0, 10]), [0, 0, 0]),
  spherical_joint(marker(light, [0, 0, 1/1000]), marker(heavy, [0, 0, -10]))))$
scene : holonomic_scene(system, initial_guess = [x0 = 0, y0 = 0, z0 = -10, x1 = 0, y1 = 0, z1 = -20],
  initial_state = [e00 = 1, e01 = 0, e02 = 0, e03 = 0, e10 = 1, e11 = 0, e12 = 0, e13 = 0, dot(e01) = 0, dot(e02) = 0,
    dot(e03) = 0, dot(e11) = 0, dot(e12) = 0, dot(e13) = 0], time_span = [0, 1])$
"""


def test_a_light_body_on_a_heavy_one_swings_by_itself():
    """Of m g l/(J + m l^2), but for their ratio of 10^-12; the spins have none."""
    frequencies = np.sort(np.abs(holonom.system(LIGHT).linearize().eigenvalues.imag))
    alone = [(mass * 9.81 * length / (inertia + mass * length**2)) ** 0.5
             for mass, length, inertia in ((1e6, 10, 1e7), (1e-6, 1e-3, 1e-13))]  # fmt: skip
    assert frequencies[4:] == pytest.approx([alone[0]] * 4 + [alone[1]] * 4, rel=1e-9)
    assert frequencies[:4] == pytest.approx(0, abs=0.1)
