"""Linearisation along motions: Hill's equation, disturbed motions, and deviations from free motions in closed form."""

import json

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import holonom
from holonom.failures import ErrorKind, HolonomError
from holonom.formats import Publication, require
from holonom.stability.along import LinearizedMotion
from holonom.stability.equilibria import Stability

# ---- periodic motions --------------------------------------------------------------------------------------------

KAPITZA = """system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [a, c],
  kinetic_energy = (dot(x)^2 + (dot(y) + dot(u))^2)/2, potential_energy = [gravity = y],
  forces = [damping = [-c*dot(x), -c*dot(y)]], constraints = [x^2 + y^2 - 1])$
upright : holonomic_scene(system, parameter_values = [a = 1/4, c = 0], control_law = [u = a*cos(2*%pi*t)],
  initial_state = [x = 0, y = 1, dot(x) = 0, dot(y) = 0], time_span = [0, 1])$
"""


def hill(a, c):
    """Monodromy matrix of phi'' + c phi' = (1 + ddot u) phi, the upright pendulum of length 1 on a shaken support."""

    def rate(t, y):
        return [y[1], (1 - 4 * np.pi**2 * a * np.cos(2 * np.pi * t)) * y[0] - c * y[1]]

    columns = [solve_ivp(rate, (0, 1), start, rtol=1e-12, atol=1e-14).y[:, -1] for start in ([1, 0], [0, 1])]
    return np.array(columns).T


@pytest.mark.parametrize(
    ("a", "c", "stability"),
    [
        (0.2, 0, Stability.UNSTABLE),  # a w < sqrt(2 g l), Kapitza's limit
        (0.25, 0, Stability.UNDECIDED),
        (0.25, 0.1, Stability.ASYMPTOTIC),
        (0.6, 0, Stability.UNSTABLE),  # parametric resonance: a multiplier below -1
    ],
)
def test_pendulum_on_a_shaken_support_has_the_multipliers_of_hills_equation(a, c, stability):
    along = holonom.system(KAPITZA).with_settings(a=a, c=c).linearize_along(samples=3)
    truth = np.linalg.eigvals(hill(a, c))
    assert along.floquet.period == 1
    assert np.sort_complex(along.floquet.multipliers) == pytest.approx(np.sort_complex(truth), rel=1e-9)
    assert along.floquet.stability is stability
    assert along.free is None
    assert np.exp(along.floquet.exponents) == pytest.approx(along.floquet.multipliers)


@pytest.mark.parametrize("law", ["t^3/4", "cos(2*%pi*t) + t^3*(1 - t)^3"])
def test_motion_without_a_period_has_no_multipliers(law):
    """Of the second law, both ends agree and the next interval differs."""
    text = KAPITZA.replace("a*cos(2*%pi*t)", f"a*({law})")
    assert holonom.system(text).linearize_along(samples=2).floquet is None


# ---- motions that are followed -------------------------------------------------------------------------------------

CURVED = """system : holonomic_system(coordinates = [x, y, z], controls = [u], parameters = [e],
  kinetic_energy = (1 + x^2)*(dot(x)^2 + dot(y)^2 + dot(z)^2)/2 + dot(u)*dot(x)/5,
  potential_energy = [gravity = 5*y, spring = x^2*z], forces = [drag = [-dot(x)/5, u*dot(u)/7, -dot(z)]],
  constraints = [x^2 + y^2 + z^2*u - u^2])$
s : holonomic_scene(system, control_law = [u = 1 + t/4], time_span = [0, 1], parameter_values = [e = 0],
  initial_state = [x = 3/5 + e/3, dot(x) = 1 - e, z = e, dot(z) = e/2], initial_guess = [y = -4/5, dot(y) = 0],
  observe = [trajectory, multipliers])$
"""


def disturbed(scene, samples):
    """Derivatives by e of coordinates, velocities and multipliers, shape (samples, 7)."""

    def numbers(e):
        motion = scene.simulate(samples=samples, tol=1e-15, e=e)
        return np.array([*motion.coordinates.values(), *motion.velocities.values(), *motion.multipliers.values()]).T

    def derivative(h):
        return (numbers(h) - numbers(-h)) / (2 * h)

    return (4 * derivative(1e-4) - derivative(2e-4)) / 3


def test_disturbed_motion_follows_the_transition_matrix():
    scene = holonom.system(CURVED)
    along, truth = scene.linearize_along(samples=5), disturbed(scene, 5)
    for k, deviation in enumerate(truth):
        here = along[k]
        assert here.basis.T @ here.mass @ here.basis == pytest.approx(np.eye(2), abs=1e-12)
        start, now = (
            np.concatenate([each.basis.T @ each.mass @ part[rows] for rows in (slice(3), slice(3, 6))])
            for each, part in ((along[0], truth[0]), (here, deviation))
        )
        assert along.transition[k] @ start == pytest.approx(now, abs=1e-8)
        for name, value in zip(("x", "y", "z", "dot(x)", "dot(y)", "dot(z)", "lambda1"), deviation, strict=True):
            assert along.response(name)[k] @ start == pytest.approx(value, abs=1e-7)
    assert along.error < 1e-8


def test_matrices_belong_to_a_basis_that_moves_along():
    """The rate of the transition matrix is A Phi, by differences."""
    along = holonom.system(CURVED).linearize_along(until="1/100", samples=5)
    stencil = np.array([1, -8, 0, 8, -1]) / 12 / 0.0025
    rate = np.einsum("k,kab->ab", stencil, along.transition)
    assert rate == pytest.approx(along.A[2] @ along.transition[2], abs=1e-7)


# ---- free motions --------------------------------------------------------------------------------------------------

THROWN = """system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [g],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2, potential_energy = [gravity = g*y], constraints = [x^2 + y^2 - u^2])$
s : holonomic_scene(system, parameter_values = [g = 1], control_law = [u = sqrt((1 + t)^2 + (1 - g*t^2/2)^2)],
  initial_state = [x = 1, y = 1, dot(x) = 1, dot(y) = 0], time_span = [0, 2])$
"""


def test_body_in_free_flight_at_a_string_stays_free_if_it_is_turned_about_the_support():
    """Without gravity, one of two deviations is a turn, which changes no length."""
    along = holonom.system(THROWN).with_settings(g=0).linearize_along(samples=5)
    assert along.free.staying == 1
    turned = np.concatenate([along[0].basis.T @ each for each in ([-1, 1], [0, 1])])  # about the origin, of q and v
    assert abs(along.free.basis[:, 0] @ turned) == pytest.approx(np.linalg.norm(turned), rel=1e-9)
    assert along.free.stability is None


def test_multipliers_of_a_disturbed_flight_against_polar_coordinates():
    """r is u(t); 2 u lambda = ddot u - u dot(phi)^2 + g sin(phi), and r phi deviates by its own equation."""
    along = holonom.system(THROWN).linearize_along(samples=5)
    assert along.free.staying == 0

    def flight(t):
        x, y, vy = 1 + t, 1 - t**2 / 2, -t
        r2 = x**2 + y**2
        return np.arctan2(y, x), (x * vy - y) / r2, np.sqrt(r2), (x + y * vy) / np.sqrt(r2)

    def rate(t, d):
        phi, turning, r, out = flight(t)
        return [d[1], np.sin(phi) * d[0] / r - 2 * out * d[1] / r]

    columns = [
        solve_ivp(rate, (0, 2), start, t_eval=along.times, rtol=1e-12, atol=1e-14).y for start in ([1, 0], [0, 1])
    ]
    for k, t in enumerate(along.times):
        phi, turning, r, _ = flight(t)
        by_angles = np.array([(np.cos(phi) * c[0, k] - 2 * r * turning * c[1, k]) / (2 * r) for c in columns])
        # xi = r delta phi, eta the tangential part of d/dt (r delta phi e_phi), up to the sign of the basis
        r0, out0 = flight(0)[2:]
        sign = np.sign(along[0].basis[:, 0] @ [-1, 1])
        truth = by_angles @ np.linalg.inv(np.array([[r0, 0], [out0, r0]])) * sign
        assert along.response("lambda1")[k] == pytest.approx(truth, abs=1e-9)
    assert along.free.sizes == pytest.approx(np.linalg.norm(along.response("lambda1"), axis=1), rel=1e-9)


def test_law_that_frees_every_motion_keeps_every_deviation_free():
    scene = holonom.load("examples/paper/paper.mac", scene="free_motion_scene")
    assert scene.linearize_along(until=1, samples=2).free.staying == 4


SHAKEN_FREE = """system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [c],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2, potential_energy = [spring = 2*%pi^2*y^2, side = x^2*{side}/2],
  forces = [damping = [-c*dot(x), 0]], constraints = [y - u - x/2])$
s : holonomic_scene(system, parameter_values = [c = 0], control_law = [u = cos(2*%pi*t)],
  initial_state = [x = 0, dot(x) = 0], initial_guess = [y = 1, dot(y) = 0], time_span = [0, 1])$
"""


@pytest.mark.parametrize(
    ("side", "c", "stability"),
    [(1, 1, Stability.ASYMPTOTIC), (-60, 0, Stability.UNSTABLE), (1, 0, Stability.UNDECIDED)],
)
def test_multipliers_of_deviations_from_a_periodic_free_motion_decay_or_grow(side, c, stability):
    """The spring alone moves y as the law does. Of x: 5/4 ddot(z) + c dot(z) + (side + pi^2) z = 0, z the deviation."""
    free = holonom.system(SHAKEN_FREE.format(side=side)).with_settings(c=c).linearize_along(samples=2).free
    assert (free.staying, free.stability) == (0, stability)


# ---- refusals, and the command -------------------------------------------------------------------------------------


def test_deviations_that_change_too_fast_are_refused(monkeypatch):
    monkeypatch.setattr("holonom.stability.along.BLOCKS", (1,))
    with pytest.raises(HolonomError) as refused:
        holonom.system(KAPITZA).linearize_along(samples=2)
    assert refused.value.kind is ErrorKind.NOT_LINEARIZED_ALONG


SPRING = """system : holonomic_system(coordinates = [x], controls = [u], kinetic_energy = dot(x)^2/2,
  potential_energy = {stiffness}*x^2/2, forces = [damping = [-dot(x)/5]])$
s : holonomic_scene(system, control_law = [u = {law}], initial_state = [x = 0, dot(x) = 0], nominal = [x = 1],
  time_span = [0, 1])$"""
AT_ITS_NODES = {
    "1 + sin(16*%pi*t)^2": (lambda t: 1 + np.sin(16 * np.pi * t) ** 2),
    "1 + t^2/10 + sin(32*%pi*t)": (lambda t: 1 + t**2 / 10 + np.sin(32 * np.pi * t)),
    "1/10 + 100*exp(-(200*t - 275/4)^2)": (lambda t: 1 / 10 + 100 * np.exp(-((200 * t - 275 / 4) ** 2))),
}


FIRST, *OTHERS = AT_ITS_NODES


@pytest.mark.parametrize("law", [FIRST, *(pytest.param(law, marks=pytest.mark.long) for law in OTHERS)])
@pytest.mark.parametrize("by_control", [True, pytest.param(False, marks=pytest.mark.long)])
def test_functions_of_the_time_were_not_met_between_the_nodes(law, by_control):
    """They are smooth at all of 17 nodes, and Phi had errors up to 0.5 with an estimate of 3e-10."""
    given = {"stiffness": "u", "law": law} if by_control else {"stiffness": f"u*({law})", "law": "1"}
    along = holonom.system(SPRING.format(**given)).linearize_along(samples=2)
    stiffness = AT_ITS_NODES[law]

    def rate(t, y):
        return [y[1], -stiffness(t) * y[0] - y[1] / 5]

    columns = [solve_ivp(rate, (0, 1), y, rtol=1e-11, atol=1e-13, max_step=1e-3).y[:, -1] for y in ([1, 0], [0, 1])]
    assert along.transition[-1] == pytest.approx(np.array(columns).T, abs=1e-8)
    assert along.error < 1e-8


ROTORS = {
    "an angle": ("theta", "cos(theta)", "", "theta = 0, dot(theta) = {speed}"),
    "on a circle": ("p, q", "p", "constraints = [p^2 + q^2 - 1],", "p = 1, q = 0, dot(p) = 0, dot(q) = {speed}"),
}
ROTOR = """system : holonomic_system(coordinates = [x, {names}], {constraints} kinetic_energy = {energy},
  potential_energy = (1 + {cosine})*x^2/2)$
s : holonomic_scene(system, initial_state = [x = 0, dot(x) = 0, {state}], nominal = [x = 1], time_span = [0, 1])$"""


@pytest.mark.parametrize("rotor", [pytest.param("an angle", marks=pytest.mark.long), "on a circle"])
def test_a_rotor_at_the_same_place_at_all_nodes_was_at_rest(rotor):
    """It turns 32 times: x'' = -(1 + cos(64 pi t)) x. The error of Phi was 0.56, its estimate 5e-9."""
    names, cosine, constraints, state = ROTORS[rotor]
    energy = " + ".join(f"dot({q})^2/2" for q in ("x", *names.split(", ")))
    text = ROTOR.format(
        names=names, constraints=constraints, energy=energy, cosine=cosine, state=state.format(speed="64*%pi")
    )
    along = holonom.system(text).linearize_along(samples=2)
    x = along[0].leading.index("x")
    found = along.transition[-1][np.ix_([x, x + 2], [x, x + 2])]

    def rate(t, y):
        return [y[1], -(1 + np.cos(64 * np.pi * t)) * y[0]]

    columns = [solve_ivp(rate, (0, 1), y, rtol=1e-11, atol=1e-13, max_step=1e-3).y[:, -1] for y in ([1, 0], [0, 1])]
    assert found == pytest.approx(np.array(columns).T, abs=1e-8)


@pytest.mark.parametrize("law", ["2", "2 + cos(t)^2 + sin(t)^2", "10 + t/10^6", "0", "t*(1 - t)*10^(-9)"])
def test_a_law_of_rounding_errors_or_none_needs_no_more_nodes(law):
    along = holonom.system(SPRING.format(stiffness="(1 + u)", law=law)).linearize_along(samples=2)
    assert along.error < 1e-8


def test_the_command(holonom_here, write_scene):
    answer = holonom_here("linearize-along", write_scene(f"load(holonom)$\n{KAPITZA}"), "--samples", "3", "--json", "-")
    document = json.loads(answer.stdout)
    require(Publication.LINEARIZED_ALONG, document, LinearizedMotion)
    assert document["times"] == [0, 0.5, 1]
    assert document["floquet"]["stability"] == str(Stability.UNDECIDED)
    table = holonom_here("linearize-along", write_scene(f"load(holonom)$\n{THROWN}"), "--samples", "3")
    assert "0 of 2" in table.stdout


# ---- switchings ------------------------------------------------------------------------------------------------------

DRY = """system : holonomic_system(coordinates = [x], parameters = [c], kinetic_energy = dot(x)^2/2,
  potential_energy = [spring = x^2/2], forces = [dry = [-c*signum(dot(x))]])$
s : holonomic_scene(system, parameter_values = [c = 1/10], time_span = [0, 8],
  initial_state = [x = 1, dot(x) = -1/2])$"""


def oscillation(x, v, time, c=0.1):
    """An oscillator with dry friction: arcs of circles about the points c and -c."""
    while True:
        centre = -c * np.sign(v)
        turn = np.arctan2(v, x - centre) % np.pi or np.pi
        step = min(turn, time)
        x, v = (
            centre + (x - centre) * np.cos(step) + v * np.sin(step),
            v * np.cos(step) - (x - centre) * np.sin(step),
        )
        if step == time:
            return np.array([x, v])
        time, v = time - step, -1e-300 * np.sign(x)


def test_deviations_jump_where_friction_turns():
    along = holonom.system(DRY).linearize_along(until="79/10", samples=6)
    step = 1e-5
    for t, phi in zip(along.times, along.transition, strict=True):
        ahead, behind = (
            np.column_stack([oscillation(*(np.array([1, -0.5]) + side * move), t) for move in step * np.eye(2)])
            for side in (1, -1)
        )
        assert phi == pytest.approx((ahead - behind) / (2 * step), abs=1e-8)
    assert along.error < 1e-10


def test_sticking_forgets_the_velocity_and_has_no_linear_system():
    scene = holonom.system(DRY.replace("c = 1/10", "c = 4").replace("x^2/2]", "8*x^2]"))
    with pytest.raises(HolonomError) as refused:
        scene.linearize_along(until=8, samples=3)
    assert refused.value.kind is ErrorKind.NOT_ANALYTIC


TURNING = """wheel : rigid_body(1, [1, 1, 2], [x, y, z], [e0, e1, e2, e3])$
system : holonomic_system(assembly(wheel, revolute_joint(marker(wheel, [0, 0, 0], [0, 0, 1]),
  marker(ground, [0, 0, 0], [0, 0, 1]))))$
s : holonomic_scene(system, initial_state = [x = 0, y = 0, z = 0, e0 = 1, e1 = 0, e2 = 0, e3 = 0, dot(e3) = 1/2],
  time_span = [0, 2*%pi])$"""


def test_a_body_turns_half_round():
    """In Euler parameters, over samples at the half turn. Of [[1, t], [0, 1]] the norm is known."""
    along = holonom.system(TURNING).linearize_along(samples=5)
    t = along.times
    assert np.linalg.norm(along.transition, 2, axis=(1, 2)) == pytest.approx((t + np.sqrt(t**2 + 4)) / 2)


MEISSNER = """system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2,
  forces = [spring = [-({a} + {b}*signum(sin(%pi*t + 1)))*x]])$
s : holonomic_scene(system, initial_state = [x = 0, dot(x) = 0], nominal = [x = 1], time_span = [0, 2])$"""


@pytest.mark.parametrize(("a", "b", "stability"), [(5, 2, "undecided"), (10, 4, "unstable")])
def test_square_wave_has_the_multipliers_of_meissners_equation(a, b, stability):
    """Meissner 1918: the trace of the product of two rotations, each of half a period."""
    floquet = holonom.system(MEISSNER.format(a=a, b=b)).linearize_along(until=2, samples=3).floquet
    one, two = np.sqrt(a + b), np.sqrt(a - b)
    trace = 2 * np.cos(one) * np.cos(two) - (one / two + two / one) * np.sin(one) * np.sin(two)
    assert np.sum(floquet.multipliers) == pytest.approx(trace, abs=1e-9)
    assert np.prod(floquet.multipliers) == pytest.approx(1)
    assert floquet.stability == stability


DRY_PENDULUM = """system : holonomic_system(coordinates = [x, y], parameters = [e],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2, potential_energy = [gravity = 10*y],
  forces = [dry = [-signum(dot(x))/2, 0]], constraints = [x^2 + y^2 - 1])$
s : holonomic_scene(system, initial_state = [x = 3/5 + e, dot(x) = 1/2 - 2*e], initial_guess = [y = -4/5, dot(y) = 0],
  time_span = [0, 2])$"""


def test_pendulum_with_friction_against_differences_of_motions():
    scene = holonom.system(DRY_PENDULUM)
    along = scene.with_settings(e=0).linearize_along(until="19/10", samples=5)
    step = 1e-5
    ahead, behind = (scene.simulate(until="19/10", samples=5, e=side * step) for side in (1, -1))
    names = ["x", "y", "dot(x)", "dot(y)"]
    moved = np.array([ahead[name] - behind[name] for name in names]) / (2 * step)
    start = np.concatenate([each.T @ along[0].mass @ part for each, part in
                            ((along[0].basis, moved[:2, 0]), (along[0].basis, moved[2:, 0]))])  # fmt: skip
    found = np.array([[along.response(name)[k] @ start for k in range(5)] for name in names])
    assert found == pytest.approx(moved, abs=1e-7)


def test_deviations_jump_with_an_impulse():
    """A pendulum without gravity turns at w, and at w + a cos(phi(T)) after its support halts at T = 1."""
    scene = holonom.system("""system : holonomic_system(coordinates = [x, y], controls = [u],
      kinetic_energy = (dot(x)^2 + dot(y)^2)/2, constraints = [(x - u)^2 + y^2 - 1])$
    s : holonomic_scene(system, control_law = [u = if t < 1 then 2*t else 2], time_span = [0, 3],
      initial_state = [x = 3/5, y = -4/5, dot(x) = 2 + 12/5, dot(y) = 9/5])$""")
    along, slope = scene.linearize_along(samples=5), -2 * np.sin(np.arcsin(3 / 5) + 3)
    for t, phi in zip(along.times, along.transition, strict=True):
        until, since = min(t, 1), max(t - 1, 0)
        rate = [slope, 1 + slope] if t > 1 else [0, 1]
        expected = [[1 + slope * since, until + (1 + slope) * since], rate]
        assert phi == pytest.approx(np.array(expected), abs=1e-9)


# ---- units ----------------------------------------------------------------------------------------------------------

SMALL = """m_ : {mass}$ l_ : {length}$ t_ : {time}$
"""
HEAVIER_SPRING = """system : holonomic_system(coordinates = [x], parameters = [k, c], kinetic_energy = m_*dot(x)^2/2,
  potential_energy = k*x^2*(1 + {growth}*t/t_)/2, forces = [-c*dot(x)])$
s : holonomic_scene(system, parameter_values = [k = m_/t_^2, c = m_/t_/10], initial_state = [x = 0, dot(x) = 0],
  time_span = [0, t_])$
"""
PAPER = """system : holonomic_system(coordinates = [q1, q2, q3], controls = [u], parameters = [k, c],
  kinetic_energy = m_*(dot(q1)^2 + dot(q2)^2 + dot(q3)^2)/2,
  forces = [spring = [-k*(q1 + q2), 0, 0], damping = [0, -c*(dot(q1) + dot(q2)), 0]], constraints = [q3 - u*(q1 + q2)])$
s : holonomic_scene(system, control_law = [u = (1 + t/t_)/3], parameter_values = [k = m_/t_^2, c = 2*m_/t_],
  initial_state = [q1 = l_, q2 = -l_, dot(q1) = l_/t_, dot(q2) = -l_/t_], time_span = [0, t_])$
"""
ONE = {"mass": "1", "length": "1", "time": "1"}
ATOMS = {"mass": "1/10^27", "length": "1/10^10", "time": "1/10^13"}
PLANETS = {"mass": "10^30", "length": "10^9", "time": "10^7"}


@pytest.mark.parametrize("units", [ONE, {**ONE, "mass": "1/10^27"}, ATOMS])
@pytest.mark.parametrize("growth", [0, 1])
def test_equations_of_small_forces_that_grow_do_not_repeat(units, growth):
    """A spring of 1e-27 N/m that grew was the same later, so that the growing motion had Floquet multipliers."""
    scene = holonom.system(SMALL.format(**units) + HEAVIER_SPRING.format(growth=growth))
    found = scene.linearize_along(samples=2).floquet
    assert (found is None) is (growth == 1)


@pytest.mark.parametrize("units", [ONE, ATOMS, PLANETS])
def test_deviations_that_stay_free_are_counted_in_any_unit(units):
    """S = q1 + q2 = 0 is free. Its deviations S and dot(S) are not; q1 - q2 and its rate may deviate."""
    along = holonom.system(SMALL.format(**units) + PAPER).linearize_along(samples=2)
    assert along.free.staying == 2
    assert along.free.basis.T @ along.free.basis == pytest.approx(np.eye(2), abs=1e-14)
    time = along.at[0].point["q1"] / along.at[0].point["dot(q1)"]
    columns = along.free.basis / np.linalg.norm(along.free.basis * np.repeat([1, time], 2)[:, None], axis=0)
    for rows, unit in ((along.at[0].C[:2], 1), (along.at[0].C[3:5], time)):
        changes = unit * rows @ columns  # of q1 and q2, and of their rates
        assert changes.sum(axis=0) == pytest.approx(0, abs=1e-7 * np.abs(along.at[0].C[:2]).max())


def test_a_motion_that_servo_constraints_fix_has_no_deviations():
    """It ended as an internal error."""
    system = "system : holonomic_system(coordinates = [x], controls = [F], kinetic_energy = dot(x)^2/2, forces = [F])$"
    given = "servo_constraints = [x - sin(t)], initial_state = [], time_span = [0, 1]"
    scene = holonom.system(f"{system} s : holonomic_scene(system, {given})$")
    assert scene.linearize_along(samples=3).transition.shape == (3, 0, 0)


@pytest.mark.parametrize("k", [10, 400])
def test_a_table_whose_points_are_between_the_nodes(k):
    """z'' = -k (z - h(t)): the deviations do not contain h, and were refused as too fast."""
    found = holonom.system(f"""
      system : holonomic_system(coordinates = [z], controls = [h], kinetic_energy = dot(z)^2/2,
        potential_energy = {k}*(z - h)^2/2)$
      run : holonomic_scene(system, control_law = [h = table([[0, 0], [1/10, 1/20], [1/5, 0], [1, 0]])],
        initial_state = [z = 0, dot(z) = 0], time_span = [0, 1])$""").linearize_along(samples=3)
    w = np.sqrt(k)
    for t, transition in zip(found.times, found.transition, strict=True):
        true = [[np.cos(w * t), np.sin(w * t) / w], [-w * np.sin(w * t), np.cos(w * t)]]
        assert transition == pytest.approx(np.array(true), rel=1e-9, abs=1e-9)
