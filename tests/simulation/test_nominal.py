"""Nominal sizes: what functions change by with them."""

import math
import warnings

import numpy as np
import pytest

import holonom
from holonom.failures import HolonomError
from holonom.program.precision import read_precision
from holonom.simulation import nominal
from holonom.simulation.hard_cases import Difficulty
from holonom.simulation.nominal import Nominal, first_order_changes, share_of


@pytest.mark.parametrize("at_once", [1, 10, 4096])
@pytest.mark.parametrize("each", [False, True])
def test_changes_of_linear_functions_are_sums_of_their_coefficients(at_once, each, monkeypatch):
    """However many moved states are evaluated together; sizes may be of one motion or of each."""
    monkeypatch.setattr(nominal, "STATES_AT_ONCE", at_once)
    draw = np.random.default_rng(1)
    coefficients, times, states = draw.normal(size=(3, 5)), draw.normal(size=6), draw.normal(size=(4, 6))
    sizes = Nominal(draw.uniform(0, 2, 6 if each else None), draw.uniform(0, 2, (4, 6) if each else 4))
    calls = []

    def functions(t, state):
        calls.append(len(t))
        return coefficients @ np.concatenate([t[None], state])

    found = first_order_changes(functions, times, states, sizes)
    state_sizes = sizes.state if each else sizes.state[:, None]
    reach = np.concatenate([np.maximum(sizes.time, np.abs(times))[None], np.maximum(state_sizes, np.abs(states))])
    assert found == pytest.approx(np.abs(coefficients) @ reach, rel=1e-9)
    assert len(calls) == 1 + {1: 5, 10: 3, 4096: 1}[at_once]


def test_changes_that_are_not_finite_do_not_count_beyond_double_precision():
    number = read_precision("quadruple").number
    times, states = np.array([number("0")]), np.array([[number("1")], [number("2")]])

    def functions(t, state):
        return np.where(t == 0, np.array([state[0] * 3, state[0] + state[1]]), np.inf)

    found = first_order_changes(functions, times, states, Nominal(1.0, np.ones(2)))
    assert found[:, 0] == pytest.approx([3.0, 3.0])


@pytest.mark.parametrize("unit", [1e-10, 1.0, 1e9])
def test_a_change_is_relative_to_nominal_sizes_or_to_the_largest_number_beyond_them(unit):
    """No number counts as one: a state of 1e-10 that moves by itself has moved by all of its size."""
    sizes = unit * np.array([1.0, 1e-3])
    change = unit * np.array([[1e-6, 0.0], [1e-6, 1e-6]])
    numbers = unit * np.array([[0.5, 0.0], [1e-4, 4e-3]])
    assert share_of(change, numbers, sizes) == pytest.approx([1e-3, 1e-3 / 4])
    assert share_of(change, 1.4 * numbers, sizes) == pytest.approx([1e-3, 1e-3 / 5.6])
    assert Nominal(1.0, sizes).share(change[:, 0], numbers[:, 0]) == pytest.approx(1e-3)


def test_a_singular_start_is_refused_without_warnings_of_numpy():
    text = """system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
        forces = [1, 0], constraints = [x*y])$
        s : holonomic_scene(system, initial_state = [x = 0, y = 0, dot(x) = 0, dot(y) = 0], time_span = [0, 1])$"""
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        with pytest.raises(HolonomError):
            holonom.system(text).simulate()


BODY = """b : rigid_body(1, [1, 3/2, 2], [x, y, z], [e0, e1, e2, e3])$
system : holonomic_system(assembly(b))$
scene : holonomic_scene(system, initial_state = [x = 0, y = 0, z = 0, e0 = {e0}, e1 = {e1}, e2 = {e2}, e3 = 0,
  dot(e0) = {w}*e1, dot(e1) = -({w})*e0, dot(e2) = -1/12, dot(e3) = -1/6, dot(x) = 0, dot(y) = 0, dot(z) = 0],
  time_span = [0, 10])$
"""


@pytest.mark.parametrize("turned", [("6.123e-17", "1", "0"), ("1", "1e-17", "0"), ("0", "1", "-2e-17")])
def test_orientations_by_rounding_had_sizes_of_rounding_errors(turned):
    """Steps and errors were relative to these: e had the length 7.6 after ten seconds, with exit status 0."""
    at = dict(zip(("e0", "e1", "e2"), turned, strict=True))
    exact = {name: f"{float(value):.0f}" for name, value in at.items()}
    w = "-1/6" if exact["e1"] == "1" else "0"
    rounded, true = (holonom.system(_with_values(each, w)).simulate(samples=2) for each in (at, exact))
    for name in ("e0", "e1", "e2", "e3"):
        assert rounded[name][-1] == pytest.approx(true[name][-1], abs=1e-10)


def _with_values(at, w):
    text = BODY.format(**at, w=w)
    return text.replace("*e1", f"*({at['e1']})").replace("*e0", f"*({at['e0']})")


BESIDE = """system : holonomic_system(coordinates = [x, y], kinetic_energy = {energy}, forces = [{force}, -{M}*y])$
scene : holonomic_scene(system, initial_state = [x = 2/5/10^9, dot(x) = -1/20/10^9, y = {y}, dot(y) = 0],
  time_span = [0, 1/2], observe = [trajectory, X = 10^9*x, A = 10^9*ddot(x)]{until})$
"""
LIGHT = {"energy": "(dot(x)^2/10^6 + dot(y)^2)/2", "force": "-signum(x)/10^15", "M": 1, "y": 1}
COUPLED = {
    "energy": "(10^18*dot(x)^2 + (1 + 10^18*x^2)*dot(y)^2/10^12)/2",
    "force": "-signum(x)*10^9",
    "M": 0,
    "y": "3*10^5",
}


@pytest.mark.parametrize("scene", [LIGHT, COUPLED], ids=["a light mass", "masses that depend on it"])
def test_a_small_coordinate_beside_a_large_one_has_its_sign(scene):
    """It was zero by the size of the other, and its force was left out, with exit status 0."""
    found = holonom.system(BESIDE.format(**scene, until="")).simulate(samples=2)
    assert (found["X"][-1], found["A"][-1]) == pytest.approx((1 / 4, -1))


def test_a_small_coordinate_beside_a_large_one_crosses_zero():
    """The event had no sign by the size of the other."""
    scene = LIGHT | {"force": "-1/10^15", "until": ", until = [10^9*x - 3/10]"}
    assert holonom.system(BESIDE.format(**scene)).simulate(samples=2)["t"][-1] == pytest.approx(0.4)


@pytest.mark.parametrize("engine", ["taylor", "robust"])
def test_small_swings_of_a_pendulum_are_accurate_in_their_size(engine):
    """They were to a size of one."""
    text = """system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
      potential_energy = 9*y, constraints = [x^2 + y^2 - 1])$
    scene : holonomic_scene(system, initial_state = [x = 1/10^9, dot(x) = 0],
      initial_guess = [y = -1, dot(y) = 0], time_span = [0, 10])$"""
    found = holonom.system(text).simulate(samples=2, engine=engine)
    assert found["x"][-1] == pytest.approx(1e-9 * math.cos(30), rel=1e-8)


@pytest.mark.parametrize("engine", ["runge-kutta", "robust"])
def test_a_small_difference_of_large_coordinates_has_not_its_own_size(engine):
    """Its rounding errors were larger than the tolerances: the engines did not end, or a pivot vanished for them."""
    text = """system : holonomic_system(coordinates = [y, z, x], kinetic_energy = (dot(x)^2 + dot(y)^2 + dot(z)^2)/2,
      potential_energy = (x^2 + y^2 + z^2)/2, constraints = [x - y + z])$
    scene : holonomic_scene(system, initial_state = [y = 1, x = 1/10^11, dot(y) = 0, dot(x) = 0],
      initial_guess = [z = 1, dot(z) = 0], time_span = [0, 1])$"""
    found = holonom.system(text).simulate(samples=2, engine=engine)
    assert found.report.steps < 30
    assert (found["x"][-1], found["y"][-1]) == pytest.approx((1e-11 * math.cos(1), math.cos(1)), abs=1e-13, rel=1e-11)
    assert Difficulty.MASS_RATIO not in found.report.cases
