"""The rows of sweeps: against closed forms, against `holonom simulate`, and against themselves however they are cut."""

from pathlib import Path

import heyoka
import numpy as np
import pyarrow as pa
import pytest
from refusing import failing

import holonom
from holonom.failures import ErrorKind
from holonom.simulation.request import Stabilization
from holonom.sweeps import batch_engine, time_watch
from holonom.sweeps.rows import RowMaker, Status

EXAMPLES = Path(__file__).parents[2] / "examples"
OSCILLATOR = """load("holonom.mac")$
system : holonomic_system(coordinates = [x], parameters = [m, k],
  kinetic_energy = m*dot(x)^2/2, potential_energy = k*x^2/2, constraints = [])$
released : holonomic_scene(system, initial_state = [x = 1, dot(x) = 0], time_span = [0, 3])$"""
HANGING = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [m, g],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, potential_energy = m*g*y, constraints = [x^2 + y^2 - u^2])$
hanging : holonomic_scene(system, control_law = [u = l + v*t], parameter_values = [m = 1, g = 10, l = 1, v = 0],
  initial_state = [x = 1/2, dot(x) = 0], initial_guess = [y = -1, dot(y) = 0], time_span = [0, 2])$"""
FRICTION = """load("holonom.mac")$
system : holonomic_system(coordinates = [x], parameters = [m, mu],
  kinetic_energy = m*dot(x)^2/2, forces = [-mu*signum(dot(x))], constraints = [])$
braked : holonomic_scene(system, parameter_values = [m = 1, mu = 1],
  initial_state = [x = 0, dot(x) = 1], time_span = [0, 3])$"""

THROWN = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, z], parameters = [g],
  kinetic_energy = (dot(x)^2 + dot(z)^2)/2, potential_energy = g*z, constraints = [])$
thrown : holonomic_scene(system, parameter_values = [g = 10],
  initial_state = [x = 0, z = 0, dot(x) = 1, dot(z) = 5], time_span = [0, 3], until = [z = 0, x = 5/2])$"""
TURNING = THROWN.replace("z = 0, x = 5/2", "cos(1000*x) = -99/100")
BEYOND_A_KINK = THROWN.replace("z = 0, x = 5/2", "abs(x - 1) + x = 3/2")
SKIDDING = FRICTION.replace("time_span = [0, 3]", "time_span = [0, 3], until = [x = 1/4]")
PUSHED = """load("holonom.mac")$
system : holonomic_system(coordinates = [x], parameters = [k, m, q],
  kinetic_energy = m*dot(x)^2/2, potential_energy = k*x^2/2, forces = [push = [if t < q then 1 else 0]],
  constraints = [])$
pushed : holonomic_scene(system, parameter_values = [k = 4, m = 1, q = 1],
  initial_state = [x = 0, dot(x) = 0], time_span = [0, 3])$"""
STRUCK = PUSHED.replace("if t < q then 1 else 0", "exp(-10^8*(t - q)^2)")
DRIVEN = OSCILLATOR.replace("constraints", "forces = [drive = [sin(k*t)]], constraints")
NAMES = """load("holonom.mac")$
system : holonomic_system(coordinates = [x], parameters = [t0, q, h, row],
  kinetic_energy = q*dot(x)^2/2, potential_energy = h*x^2/2, forces = [drag = [-t0*dot(x)], push = [row]],
  constraints = [])$
released : holonomic_scene(system, parameter_values = [t0 = 0, q = 1, h = 4, row = 0],
  initial_state = [x = 1, dot(x) = 0], time_span = [0, 2])$"""


def columns(table: pa.Table) -> dict[str, np.ndarray]:
    return {name: table[name].to_numpy(zero_copy_only=False) for name in table.column_names}


@pytest.fixture(scope="module")
def scenes(tmp_path_factory):
    folder = tmp_path_factory.mktemp("scenes")
    for name, text in {
        "oscillator": OSCILLATOR,
        "hanging": HANGING,
        "friction": FRICTION,
        "thrown": THROWN,
        "turning": TURNING,
        "beyond_a_kink": BEYOND_A_KINK,
        "skidding": SKIDDING,
        "pushed": PUSHED,
        "struck": STRUCK,
        "names": NAMES,
        "driven": DRIVEN,
    }.items():
        (folder / f"{name}.mac").write_text(text)
    return folder


@pytest.mark.long
def test_what_turns_within_one_step_ended_rows_late_and_had_another_largest_value(rows_of, scenes):
    """A body thrown is one step of the engine for all of its way; x = t."""
    ended = columns(rows_of(scenes / "turning.mac", "final", "g=9:10:2").table(0, 2))
    ends = np.arccos(-0.99) / 1000
    assert ended["x"] == pytest.approx([ends, ends], rel=1e-12)
    t = np.linspace(0, 0.9, 10**6)
    thrown = columns(rows_of(scenes / "thrown.mac", "max(cos(100*x + 1/3) + z/100)", "g=9:10:2").table(0, 2))
    (seen,) = [values for name, values in thrown.items() if name.startswith("max")]
    for g, found in zip((9, 10), seen, strict=True):
        assert found == pytest.approx(np.max(np.cos(100 * t + 1 / 3) + (5 * t - g * t**2 / 2) / 100), abs=1e-8)


@pytest.mark.parametrize("start", ["0", "1/10 + 1/5 - 3/10 + 1/10^17"])
def test_what_was_thrown_lands_long_before_the_end_of_its_step(rows_of, scenes, start):
    """The batch saw 17 samples of a step, which is all of the motion, and a sign in the rounding of the start."""
    file = scenes / "landing.mac"
    file.write_text(
        THROWN.replace("z = 0, x = 5/2", "z = 0").replace("[0, 3]", "[0, 1000]").replace("z = 0, d", f"z = {start}, d")
    )
    found = columns(rows_of(file, "t", "g=5:10:2").table(0, 2))
    assert found["t"] == pytest.approx(10 / found["g"], rel=1e-12)
    assert (found["status"] == Status.OK).all()


def test_an_end_beyond_a_kink_was_never_met(rows_of, scenes):
    """abs(x - 1) + x is 1 up to x = 1, and 3/2 at x = 5/4."""
    found = columns(rows_of(scenes / "beyond_a_kink.mac", "final", "g=9:10:2").table(0, 2))
    assert found["x"] == pytest.approx([5 / 4, 5 / 4], rel=1e-12)


def test_the_oscillator_is_the_cosine(rows_of, scenes):
    keep = "final,x,at(x,1/2),max(x),min(dot(x)),max(abs(ddot(x))),mean(x),zero(x),energy"
    found = columns(rows_of(scenes / "oscillator.mac", keep, "k=4:25:22", "m=1:4:4").table(0, 88))
    w = np.sqrt(found["k"] / found["m"])
    truths = {
        "x": np.cos(3 * w),
        "dot(x)": -w * np.sin(3 * w),
        "at(x,1/2)": np.cos(w / 2),
        "max(x)": np.ones(88),
        "min(dot(x))": -w * np.where(3 * w >= np.pi / 2, 1, np.sin(3 * w)),
        "max(abs(ddot(x)))": w**2,
        "mean(x)": np.sin(3 * w) / (3 * w),
        "zero(x)": np.where(3 * w > np.pi / 2, np.pi / 2 / w, np.nan),
        "energy": found["k"] / 2,
    }
    for name, truth in truths.items():
        assert found[name] == pytest.approx(truth, rel=1e-11, abs=1e-11, nan_ok=True), name
    assert (found["status"] == Status.OK).all()


HIDDEN = "exp(10*t)*(x-1/10)", "exp(-30*t)*(x-1/10)", "(x-1/10)^3"  # 7.75 came out, none, and 3e-5 too much


@pytest.mark.parametrize("quantity", [HIDDEN[0], *(pytest.param(each, marks=pytest.mark.long) for each in HIDDEN[1:])])
def test_polynomials_alone_lost_zeros_or_placed_them_beside(quantity, rows_of, scenes):
    """Truth: x = cos(w t) at 1/10."""
    found = columns(rows_of(scenes / "oscillator.mac", f"zero({quantity})", "k=1:4:2", "m=1:2:1").table(0, 2))
    assert found[f"zero({quantity})"] * np.sqrt(found["k"]) == pytest.approx(np.arccos(1 / 10), rel=1e-10)


@pytest.mark.parametrize("a", [1, 30, pytest.param(1000, marks=pytest.mark.long)])
def test_largest_and_mean_values_of_sharp_quantities_had_half_of_their_digits(a, rows_of, scenes):
    """Truth: the peak is where x = 1/2; the mean of 1/(1 + a^2 (cos(t) - c)^2) by Gauss's formula."""
    sharp, plan = f"1/(1+{a * a}*(x-1/2)^2)", "max({0}),mean({0})"
    found = columns(rows_of(scenes / "oscillator.mac", plan.format(sharp), "k=1:4:2", "m=1:2:1").table(0, 1))
    places, weights = np.polynomial.legendre.leggauss(20)
    edges = np.linspace(0, 3, 20001)
    t = edges[:-1, None] + np.diff(edges)[:, None] * (places + 1) / 2
    mean = np.sum(weights / (1 + (a * (np.cos(t) - 0.5)) ** 2)) / 2 / (len(edges) - 1)
    assert found[f"max({sharp})"] == pytest.approx(1, rel=1e-12)
    assert found[f"mean({sharp})"] == pytest.approx(mean, rel=1e-11)
    assert found["status"].tolist() == [Status.OK]


@pytest.mark.parametrize("alone", [False, True])
def test_rounding_errors_of_an_integral_of_the_motion_crossed_zero(alone, rows_of, scenes, monkeypatch):
    integral = "x^2+m*dot(x)^2/k-1"
    monkeypatch.setattr(RowMaker, "_batched", not alone)
    found = columns(rows_of(scenes / "oscillator.mac", f"zero({integral})", "k=1:4:3", "m=1:2:2").table(0, 6))
    assert np.isnan(found[f"zero({integral})"]).all()
    assert (found["status"] == Status.OK).all()


def test_a_quantity_that_no_polynomials_resolve_was_recorded_as_if_they_did(rows_of, scenes):
    """Ten million oscillations on the way."""
    found = columns(rows_of(scenes / "oscillator.mac", "max(sin(10^7*x)),x", "k=1:4:2", "m=1:2:1").table(0, 1))
    assert found["status"].tolist() == [Status.INACCURATE]
    assert found["note"][0].startswith("max(sin(10^7*x))")
    assert np.isfinite(found["x"]).all()


@pytest.mark.long
def test_rows_are_the_same_to_the_last_bit_however_they_are_cut(rows_of, monkeypatch):
    asked = ("crane.mac", "final,max(abs(lambda1)),zero(x-s),mean(y)", "m=50:500:7", "c=0:40:11")
    whole = rows_of(*asked).table(0, 77)
    alone = rows_of(*asked[:1], "final", *asked[2:]).table(30, 31)  # in a batch: with all outputs one motion by itself
    assert alone["x"][0].as_py() == pytest.approx(whole["x"][30].as_py(), rel=1e-14)
    for elements in (2, 8):
        monkeypatch.setattr(batch_engine, "ELEMENTS", elements)
        maker = rows_of(*asked)
        assert pa.concat_tables([maker.table(0, 5), maker.table(5, 40), maker.table(40, 77)]).equals(whole)


def test_rows_are_the_same_however_little_room_there_is_for_steps_at_first(rows_of, monkeypatch):
    asked = "crane.mac", "max(abs(lambda1)),mean(y),zero(x-s-1/10)", "m=50:500:8"
    roomy = rows_of(*asked).table(0, 8)
    monkeypatch.setattr(batch_engine, "ROOM", 4)
    monkeypatch.setattr(batch_engine, "TOGETHER", 48)  # batches of 4 steps: 3 of 64
    for elements in (batch_engine.ELEMENTS, 2):
        monkeypatch.setattr(batch_engine, "ELEMENTS", elements)
        assert rows_of(*asked).table(0, 8).equals(roomy)


def test_the_time_is_scanned_once_for_each_set_of_parameters_in_it(rows_of, scenes, monkeypatch):
    scanned = []
    scan = time_watch.time_dependence_of_motion
    monkeypatch.setattr(time_watch, "time_dependence_of_motion", lambda *asked: scanned.append(asked) or scan(*asked))
    for file, axes, times in (
        (EXAMPLES / "crane.mac", ("m=50:500:3", "c=0:40:4"), 1),
        (scenes / "driven.mac", ("m=1:2:3", "k=1:2:4"), 4),
    ):
        maker = rows_of(file, "x", *axes)
        for first in range(0, 12, 3):
            maker.table(first, first + 3)
        assert len(scanned) == times
        scanned.clear()


def test_a_narrow_pulse_in_the_time_span_takes_its_row_out_of_the_batch(rows_of, scenes):
    problem = rows_of(scenes / "struck.mac", "x", "q=1:5:2").plan.problem
    assert time_watch.TimeWatch(problem, 3.0).look(np.array([[1.0, 5.0]]))[0].tolist() == [True, False]


@pytest.mark.long
def test_rows_are_those_of_single_simulations(rows_of):
    keep = "final,lambda1,max(abs(lambda1)),min(y),zero(x-1)"
    found = columns(rows_of("crane.mac", keep, "m=50:500:4", "c=0:40:3").table(0, 12))
    scene = holonom.load(EXAMPLES / "crane.mac")
    for row in (0, 5, 11):
        motion = scene.simulate(samples=2001, m=found["m"][row], c=found["c"][row])
        for name in ("s", "x", "y", "dot(s)", "dot(x)", "dot(y)", "lambda1"):
            assert found[name][row] == pytest.approx(motion[name][-1], rel=1e-10, abs=1e-10)
        assert found["max(abs(lambda1))"][row] == pytest.approx(peak(np.abs(motion["lambda1"])), rel=1e-9)
        assert found["min(y)"][row] == pytest.approx(-peak(-motion["y"]), rel=1e-9)
        place = np.flatnonzero(np.diff(np.sign(motion["x"] - 1)))[0]
        assert motion["t"][place] <= found["zero(x-1)"][row] <= motion["t"][place + 1]


def peak(samples: np.ndarray) -> float:
    """The largest value of a smooth function, from the parabola through the samples around the largest."""
    k = samples.argmax()
    if k in (0, len(samples) - 1):
        return samples[k]
    before, at, after = samples[k - 1 : k + 2]
    return at + (after - before) ** 2 / (8 * (2 * at - before - after))


@pytest.mark.long
def test_impossible_rows_are_marked_and_the_rest_is_right(rows_of, scenes):
    found = columns(rows_of(scenes / "hanging.mac", "final", "l=0:2:5", "m=-1:1:3").table(0, 15))
    expected = np.where(found["l"] < 0.5, "no start", np.where(found["m"] <= 0, "broken off", "ok"))
    assert (found["status"] == expected).all()
    scene = holonom.load(scenes / "hanging.mac")
    for row in np.flatnonzero(expected == "ok"):
        motion = scene.simulate(samples=2, l=found["l"][row])
        assert found["y"][row] == pytest.approx(motion["y"][-1], rel=1e-10)
    assert np.isnan(found["x"][found["status"] != "ok"]).all()
    assert all(found["note"][found["status"] != "ok"])


def test_rows_of_a_kinetic_energy_that_is_negative_for_some_velocities_break_off(rows_of, tmp_path):
    file = tmp_path / "coupled.mac"
    file.write_text("""load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], parameters = [c],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2 + c*dot(x)*dot(y))$
scene : holonomic_scene(system, parameter_values = [c = 0], time_span = [0, 1],
  initial_state = [x = 0, y = 0, dot(x) = 1, dot(y) = 0])$
""")
    found = columns(rows_of(file, "final", "c=-2:2:3").table(0, 3))
    assert list(found["status"]) == ["broken off", "ok", "broken off"]


SHORT = ("0/0", "at(1/(x-x),1)", "zero(1/(k-k))")
LONG = ("1/0", "log(-1-x^2)", "max(1/(k-k))", "mean(sqrt(-1-x^2))")
NOWHERE_FINITE = [*SHORT, *(pytest.param(outputs, marks=pytest.mark.long) for outputs in LONG)]


@pytest.mark.parametrize("outputs", NOWHERE_FINITE)
def test_a_row_without_a_finite_value_says_so_and_keeps_none(rows_of, scenes, outputs):
    found = columns(rows_of(scenes / "oscillator.mac", f"{outputs},x", "k=1:4:3", "m=1:2:1").table(0, 3))
    assert (found["status"] == Status.UNDEFINED).all()
    assert all(note.startswith(outputs) for note in found["note"])
    assert np.isnan(found[outputs]).all()
    assert np.isfinite(found["x"]).all()


def test_rows_with_a_finite_value_are_not_those_without(rows_of, scenes):
    found = columns(rows_of(scenes / "oscillator.mac", "1/(k-2),log(k-1),zero(x)", "k=1:3:3", "m=1:100:2").table(0, 6))
    finite = np.isin(found["k"], [3])
    assert (found["status"] == np.where(finite, Status.OK, Status.UNDEFINED)).all()
    assert np.isnan(found["zero(x)"][found["m"] == 100]).all()  # there is none, and that is no fault


def test_a_motion_followed_by_itself_without_a_finite_value_says_so_too(rows_of, scenes):
    found = columns(rows_of(scenes / "friction.mac", "1/0,max(log(-1-x^2)),zero(1/(mu-mu)),x", "mu=1:2:2").table(0, 2))
    assert (found["status"] == Status.UNDEFINED).all()
    assert np.isfinite(found["x"]).all()


@pytest.mark.long
def test_a_length_that_vanishes_on_the_way_ends_its_row_and_no_other(rows_of, scenes):
    found = columns(rows_of(scenes / "hanging.mac", "final", "v=-1:1:3").table(0, 3))
    assert found["status"].tolist() == ["broken off", "ok", "ok"]
    assert found["note"][0]


def test_motions_that_switch_are_followed_one_by_one(rows_of, scenes):
    found = columns(rows_of(scenes / "friction.mac", "final,max(x),at(x,1/4)", "mu=0.5:2:4").table(0, 4))
    assert found["at(x,1/4)"] == pytest.approx(1 / 4 - found["mu"] / 32, rel=1e-10)
    assert found["x"] == pytest.approx(1 / (2 * found["mu"]), rel=1e-10)  # v^2/(2 mu), then it sticks
    assert found["max(x)"] == pytest.approx(found["x"], rel=1e-10)
    assert (found["status"] == Status.OK).all()


@pytest.mark.parametrize("scene", ["friction", "skidding"])
def test_what_switching_motions_need_is_compiled_once(rows_of, scenes, monkeypatch, scene):
    maker = rows_of(scenes / f"{scene}.mac", "final", "mu=1/2:1:6")
    first = maker.table(5, 6)
    for name in ("cfunc", "taylor_adaptive"):
        monkeypatch.setattr(heyoka, name, None)
    end = 1 / (2 * np.linspace(0.5, 1, 6)) if scene == "friction" else np.full(6, 0.25)
    assert pa.concat_tables([maker.table(0, 5), first])["x"].to_numpy() == pytest.approx(end, rel=1e-11)


def test_each_motion_ends_where_its_own_event_is(rows_of, scenes):
    keep = "t,final,max(z),at(x,2),zero(z-1),zero(2*z),mean(z)"
    found = columns(rows_of(scenes / "thrown.mac", keep, "g=1:10:10").table(0, 10))
    g, end = found["g"], np.minimum(10 / found["g"], 2.5)
    crossing = (5 - np.sqrt(25 - 2 * g)) / g
    truths = {
        "t": end,
        "x": end,
        "z": 5 * end - g * end**2 / 2,
        "max(z)": np.where(5 / g <= end, 25 / (2 * g), 5 * end - g * end**2 / 2),
        "at(x,2)": np.where(end >= 2, 2.0, np.nan),
        "zero(z-1)": crossing,
        "mean(z)": 5 * end / 2 - g * end**2 / 6,
    }
    for name, truth in truths.items():
        assert found[name] == pytest.approx(truth, rel=1e-11, abs=1e-11, nan_ok=True), name
    assert list(found["zero(2*z)"][g > 4]) == list(found["t"][g > 4])
    assert np.isnan(found["zero(2*z)"][g < 4]).all()
    assert (found["status"] == Status.OK).all()


def test_a_motion_followed_by_itself_ends_at_its_event_too(rows_of, scenes):
    keep = "t,dot(x),at(x,1),zero(x-1/4),zero(x-2)"
    found = columns(rows_of(scenes / "skidding.mac", keep, "mu=1/2:3/2:2").table(0, 2))
    speed = np.sqrt(1 - found["mu"] / 2)  # at x = 1/4
    assert found["dot(x)"] == pytest.approx(speed, rel=1e-10)
    assert found["t"] == pytest.approx((1 - speed) / found["mu"], rel=1e-10)
    assert list(found["zero(x-1/4)"]) == list(found["t"])
    assert np.isnan([found["at(x,1)"], found["zero(x-2)"]]).all()


def test_a_push_that_ends_at_a_swept_time_leaves_the_oscillation_of_two_steps(rows_of, scenes):
    found = columns(rows_of(scenes / "pushed.mac", "x,max(x)", "q=1/2:5/2:2", "k=4:9:2").table(0, 4))
    q, w = found["q"], np.sqrt(found["k"])
    assert found["x"] == pytest.approx((np.cos(w * (3 - q)) - np.cos(3 * w)) / found["k"], rel=1e-10)
    assert (found["status"] == Status.OK).all()
    assert found["max(x)"][2] == pytest.approx(2 / 4, rel=1e-10)  # it is pushed for more than half a period


@pytest.mark.long
@pytest.mark.parametrize("scene", ["recorded_scene", "pulled_scene"])
def test_rows_under_a_table_and_a_law_in_parts_are_those_of_single_simulations(rows_of, scene):
    found = columns(rows_of("hoist.mac", "final,lambda1", "m=1:2:2", scene=scene).table(0, 2))
    for row, mass in enumerate(found["m"]):
        motion = holonom.load(EXAMPLES / "hoist.mac", scene=scene).simulate(samples=2, m=mass)
        for name in ("x", "y", "dot(x)", "dot(y)", "lambda1"):
            assert found[name][row] == pytest.approx(motion[name][-1], rel=1e-10, abs=1e-10)
    assert (found["status"] == Status.OK).all()


def test_the_tip_of_the_arm_is_on_its_circle_and_the_torques_are_in_proportion_to_the_mass(rows_of):
    maker = rows_of("arm.mac", "final,tau1,tau2,max(abs(tau1))", "l=9/10:6/5:2", "m=1:2:2", scene="circle_scene")
    found = columns(maker.table(0, 4))
    for name, along, end in (("x", np.cos, 1 + np.cos(6) / 4), ("y", np.sin, np.sin(6) / 4)):
        assert found["l"] * (along(found["a"]) + along(found["b"])) == pytest.approx(end, rel=1e-11), name
    for torque in ("tau1", "tau2", "max(abs(tau1))"):
        assert found[torque][1::2] == pytest.approx(2 * found[torque][::2], rel=1e-9)
        assert (np.abs(found[torque]) > 0.1).all()


def test_parameters_may_have_names_that_the_library_uses(rows_of, scenes):
    found = columns(rows_of(scenes / "names.mac", "x,h", "t0=0:1:2", "q=1:2:2", "h=4:9:2").table(0, 8))
    t0, q, stiffness = (found[name] for name in ("t0", "q", "h"))
    decay, w = t0 / (2 * q), np.sqrt(stiffness / q - (t0 / (2 * q)) ** 2)
    truth = np.exp(-2 * decay) * (np.cos(2 * w) + decay / w * np.sin(2 * w))
    assert found["x"] == pytest.approx(truth, rel=1e-11)
    with failing(ErrorKind.NOT_AN_OUTPUT, "row"):
        rows_of(scenes / "names.mac", "x", "row=0:1:2")


@pytest.mark.parametrize("item", ["at(x,4)", "at(x,-1)"])
def test_an_time_outside_of_the_motion_is_refused(rows_of, scenes, item):
    with failing(ErrorKind.NOT_AN_OUTPUT, item):
        rows_of(scenes / "oscillator.mac", item, "k=4:25:22", "m=1:4:4")


@pytest.mark.long
def test_motions_under_the_exponential_law_are_free_and_others_are_not(rows_of):
    free = columns(rows_of("paper/paper.mac", "free", "u0=1/4:1:4", scene="free_motion_scene", until=2).table(0, 4))
    bound = columns(rows_of("paper/paper.mac", "free", "u0=1/4:1:4", scene="initial_motion_scene", until=2).table(0, 4))
    assert free["free"].all()
    assert not bound["free"].any()


def test_the_radius_is_the_distance_of_the_nearest_singularity(rows_of):
    found = columns(rows_of("paper/paper.mac", "radius", "u0=-2:2:9", scene="initial_motion_scene").table(0, 9))
    assert found["radius"] == pytest.approx(np.sqrt(found["u0"] ** 2 + 0.5), rel=1e-3)


def test_without_projection_the_constraints_drift(rows_of):
    outputs, left = (
        columns(rows_of("crane.mac", "final", "m=50:500:3", stabilization=stabilization, tol=1e-6).table(0, 3))[
            "residual"
        ]
        for stabilization in (Stabilization.PROJECTION, Stabilization.NONE)
    )
    assert (outputs < 1e-14).all()
    assert (left > 100 * outputs).all()


def test_a_quantity_that_the_motion_does_not_have_is_refused(rows_of):
    with failing(ErrorKind.NOT_AN_OUTPUT, "lambda2"):
        rows_of("crane.mac", "max(lambda2)", "m=50:500:3")


@pytest.mark.parametrize(("force", "radii"), [("a", [np.inf, np.inf]), ("a + t^40/(1 - t)", [np.nan, np.nan])])
def test_infinite_radius_of_a_polynomial_takes_equations_that_it_satisfies(force, radii):
    scene = holonom.system(f"""
system : holonomic_system(coordinates = [x], parameters = [a], kinetic_energy = dot(x)^2/2, forces = [{force}])$
motion : holonomic_scene(system, initial_state = [x = 1, dot(x) = 1], parameter_values = [a = 1])$""")
    found = holonom.sweep(scene, values={"a": [0, 1]}, keep=["radius"]).to_pandas()["radius"]
    assert list(found) == pytest.approx(radii, nan_ok=True)


BEAD = """
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [k],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2, potential_energy = k*{energy} + y, constraints = [y - u*x])$
slide : holonomic_scene(system, control_law = [u = {law}], parameter_values = [k = 2],
  initial_state = [x = 1, dot(x) = 1])$"""


@pytest.mark.parametrize(
    ("energy", "law", "radii"),
    [("x*y", "2", [np.inf] * 2), ("x*y^3/10^9", "2", [np.inf, np.nan]), ("x*y", "1 + t/10", [200**0.5, np.nan])],
)
def test_radius_is_infinite_where_the_equations_prove_it_and_empty_where_it_is_uncertain(energy, law, radii):
    """Truth: 1 + u^2 = 0 at u = i; forces of third order are weak, and end a motion later than 40 orders show."""
    scene = holonom.system(BEAD.format(energy=energy, law=law))
    found = holonom.sweep(scene, values={"k": [0, 1]}, keep=["radius"]).to_pandas()["radius"]
    assert list(found) == pytest.approx(radii, rel=1e-6, nan_ok=True)


def test_sweep_over_a_parameter_that_cancels_gives_one_motion():
    """A body falls as fast whatever its mass."""
    scene = holonom.system("""
system : holonomic_system(coordinates = [x], parameters = [m], kinetic_energy = m*dot(x)^2/2, potential_energy = m*x)$
fall : holonomic_scene(system, parameter_values = [m = 1], initial_state = [x = 0, dot(x) = 0], time_span = [0, 1])$""")
    rows = holonom.sweep(scene, values={"m": [1, 2, 5]}, keep=["x", "radius"]).to_pandas()
    assert list(rows["x"]) == pytest.approx([-0.5] * 3)
    assert (rows["radius"] == np.inf).all()


@pytest.mark.long
def test_outputs_of_the_scene_are_recorded_in_batches_and_singly(rows_of, scenes):
    """The tension of a pendulum of length 1 is m v^2 - m g y; friction, followed singly, brakes with mu to the stop."""
    file = scenes / "observed.mac"
    file.write_text(HANGING.replace("[0, 2])", "[0, 2], observe = [trajectory, pull = -2*lambda1*u, side = abs(x)])"))
    lacking = "max(abs(m*dot(x)^2+m*dot(y)^2-10*m*y-pull))"
    found = columns(rows_of(file, f"pull,at(side,1),{lacking},final", "m=1:3:3").table(0, 3))
    assert found[lacking] == pytest.approx(np.zeros(3), abs=1e-12)
    tension = found["m"] * (found["dot(x)"] ** 2 + found["dot(y)"] ** 2 - 10 * found["y"])
    assert found["pull"] == pytest.approx(tension, rel=1e-12)
    assert (found["at(side,1)"] > 0).all()
    (scenes / "braking.mac").write_text(FRICTION.replace("[0, 3]", "[0, 3], observe = [trajectory, F = m*ddot(x)]"))
    braked = columns(rows_of(scenes / "braking.mac", "at(F,1/4),min(F)", "mu=1:2:2").table(0, 2))
    assert braked["at(F,1/4)"] == pytest.approx([-1, -2])
    assert braked["min(F)"] == pytest.approx([-1, -2])


@pytest.mark.parametrize("item", ["min(side)", "max(side)", "zero(side)"])
def test_an_output_with_a_corner_is_recorded_at_times_only(item, rows_of, scenes):
    file = scenes / "cornered.mac"
    file.write_text(HANGING.replace("[0, 2])", "[0, 2], observe = [trajectory, side = abs(x)])"))
    rows_of(file, "at(side,1)", "m=1:3:3")
    with failing(ErrorKind.NOT_AN_OUTPUT, "side"):
        rows_of(file, item, "m=1:3:3")


@pytest.mark.parametrize("values", [["2"], ["1", "2"]])
def test_a_pulse_in_time_that_ends_motions_or_is_observed_alone_was_missed(values):
    pulse = "exp(-1000*(t - q)^2)"
    text = f"""
system : holonomic_system(coordinates = [x, y], parameters = [q], kinetic_energy = (dot(x)^2 + q*dot(y)^2)/2,
  potential_energy = x^2/2)$
seen : holonomic_scene(system, initial_state = [x = 1, dot(x) = 0, y = 0, dot(y) = 1], time_span = [0, 5],
  observe = [trajectory, p = {pulse}])$
ended : holonomic_scene(system, initial_state = [x = 1, dot(x) = 0, y = 0, dot(y) = 1], time_span = [0, 5],
  until = [{pulse} - 1/2])$"""
    early = np.sqrt(np.log(2) / 1000)
    last = holonom.sweep(holonom.system(text, "ended"), values={"q": values}, keep=["t"]).to_pandas()
    assert last["t"].to_numpy() == pytest.approx([float(q) - early for q in values], abs=1e-7)
    seen = holonom.sweep(holonom.system(text, "seen"), values={"q": values}, keep=["max(p)", "mean(p)", "zero(p-1/2)"])
    for row, q in zip(seen.to_pandas().itertuples(index=False), map(float, values), strict=True):
        assert list(row)[1:4] == pytest.approx([1, np.sqrt(np.pi / 1000) / 5, q - early], abs=1e-6)


@pytest.mark.parametrize("friction", ["0", "q*signum(dot(x))/100"])
def test_a_pulse_in_time_of_a_recorded_quantity_was_missed(friction):
    text = f"""
system : holonomic_system(coordinates = [x], parameters = [q], kinetic_energy = dot(x)^2/2, forces = [-{friction}])$
moving : holonomic_scene(system, initial_state = [x = 0, dot(x) = 1], time_span = [0, 5])$"""
    pulse = "exp(-10^7*(t-q)^2)"
    keep = [f"max({pulse})", f"mean({pulse})", f"zero({pulse}-1/2)"]
    found = holonom.sweep(holonom.system(text), values={"q": [1.2173, 3.1]}, keep=keep).to_pandas()
    for row, q in zip(found[keep].to_numpy(), found["q"], strict=True):
        assert row == pytest.approx([1, np.sqrt(np.pi / 1e7) / 5, q - np.sqrt(np.log(2) / 1e7)], abs=1e-9)


@pytest.mark.parametrize(("name", "keep"), [("pi", "2*pi"), ("free", "free"), ("final", "final")])
def test_a_name_of_the_scene_is_no_word_of_the_outputs(name, keep):
    text = OSCILLATOR.replace("x", name).replace('load("holonom.mac")$', "")
    with failing(ErrorKind.NOT_AN_OUTPUT):
        holonom.sweep(holonom.system(text), values={"k": [1], "m": [1]}, keep=[keep])
