"""Motions that end at an event, against the times that closed forms give."""

import io
import math
import random

import mpmath
import numpy as np
import pytest
from refusing import failing
from rich.console import Console

import holonom
from holonom.display.motion import show_simulation
from holonom.failures import ErrorKind, HolonomError
from holonom.simulation.events import Ending
from holonom.simulation.output import report_document
from holonom.simulation.result import Report

THROWN = """
system : holonomic_system(coordinates = [x, y], parameters = [g], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  potential_energy = g*y)$
thrown : holonomic_scene(system, parameter_values = [g = 981/100],
  initial_state = [x = 0, y = 0, dot(x) = 3, dot(y) = 4], time_span = [0, 5], until = [{until}])$
"""
STRING = """
system : holonomic_system(coordinates = [x, y], parameters = [g], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  potential_energy = g*y, constraints = [x^2 + y^2 - 1])$
swung : holonomic_scene(system, parameter_values = [g = 981/100],
  initial_state = [x = 0, y = -1, dot(x) = 2*sqrt(981/100)], time_span = [0, 5], until = [lambda1])$
"""
ENGINES = {"taylor": 1e-14, "runge-kutta": 1e-12, "robust": 1e-10}
FALL = 8 / 9.81  # until a body thrown upward at 4 m/s is back
BY_STEPS = "robust", "runge-kutta"


def thrown(until: str) -> holonom.Scene:
    return holonom.system(THROWN.format(until=until))


@pytest.mark.parametrize("engine", ENGINES)
def test_a_body_thrown_upward_is_back_after_2_v_over_g(engine, c_compiler):
    motion = thrown("y, x = 100").simulate(samples=5, engine=engine)
    assert float(motion.report.t) == pytest.approx(FALL, rel=ENGINES[engine])
    assert motion.report.ending == Ending(("y", "x-100"), "y")
    assert motion.times == pytest.approx([FALL * k / 4 for k in range(5)], rel=ENGINES[engine])
    assert motion["y"][-1] == pytest.approx(0, abs=ENGINES[engine])


@pytest.mark.parametrize("engine", ENGINES)
def test_a_string_is_slack_at_two_thirds_of_its_length_above_the_centre(engine, c_compiler):
    """From below at 2 sqrt(g l): the tension vanishes where v^2 = g y, and v^2 = 4 g - 2 g (1 + y)."""
    report = holonom.system(STRING).simulate(samples=2, engine=engine).report
    assert float(report.coordinates["y"]) == pytest.approx(2 / 3, rel=10 * ENGINES[engine])
    assert float(report.multipliers["lambda1"]) == pytest.approx(0, abs=100 * ENGINES[engine])


def test_the_end_has_as_many_digits_as_the_motion():
    report = thrown("y").simulate(samples=2, precision=40).report
    with mpmath.workdps(45):
        assert abs(mpmath.mpf(str(report.t)) - mpmath.mpf(800) / 981) < mpmath.mpf("1e-38")


def test_what_never_crosses_zero_leaves_the_end_to_the_time_span():
    report = thrown("x + 1, (t - 1)^2").simulate(samples=2).report  # the second touches zero
    assert report.t == 5
    assert report.ending.crossed is None
    assert report_document(report)["ending"] == {"of": ["x+1", "(t-1)^2"], "crossed": None}


@pytest.mark.parametrize("engine", ENGINES)
def test_rounding_errors_end_no_motion(engine, c_compiler):
    """The energy of a bob on its string, which stays what it was."""
    report = (
        holonom.system(STRING.replace("[lambda1]", "[(dot(x)^2 + dot(y)^2)/2 + g*(y - 1)]"))
        .simulate(samples=2, engine=engine, until=1)
        .report
    )
    assert report.ending.crossed is None
    assert report.t == 1


def test_two_crossings_within_one_step_are_seen():
    """The motion is a parabola, one step of the engine; the expression is negative for 2 ms."""
    report = thrown("(t - 1)^2 - 10^-6").simulate(samples=2).report
    assert float(report.t) == pytest.approx(0.999, rel=1e-14)


@pytest.mark.parametrize(
    ("until", "truth"),
    [
        ("cos(1000*x) + 99/100", mpmath.acos(mpmath.mpf("-0.99")) / 3000),
        ("1/2 - exp(-(1000*(t - 16/5))^2)", 3.2 - mpmath.sqrt(mpmath.log(2)) / 1000),
        ("sqrt(1 - x) - 1/2", 0.25),  # it has no value soon after
        ("max(x, y + 3) - 39/10", 1.3),
        ("if x < 1 then -1 else x - 5/4", 5 / 12),
    ],
)
def test_what_turns_within_one_step_of_the_engine_was_passed_over_or_found_late(until, truth):
    """The step is as long as the motion is smooth: the parabola is one, whatever is made of it."""
    assert float(thrown(until).simulate(samples=2, engine="taylor").report.t) == pytest.approx(float(truth), rel=1e-13)


def test_a_change_of_sign_through_infinity_was_a_zero():
    with failing(ErrorKind.NO_EVENT_VALUE, "tan(t+1) at t = 0.5707963268"):
        thrown("tan(t + 1)").simulate(samples=2)


def test_a_switched_motion_ends_in_a_later_part():
    """Pushed by 1 until t = 1 and by -1 from there, a body is at 1/2 and as fast as 1 at t = 1, and rests at t = 2."""
    scene = holonom.system("""
        system : holonomic_system(coordinates = [x], controls = [u], kinetic_energy = dot(x)^2/2, forces = [u])$
        braked : holonomic_scene(system, control_law = [u = if t < 1 then 1 else -1],
          initial_state = [x = 0, dot(x) = 0], time_span = [0, 5], until = [dot(x)])$""")
    report = scene.simulate(samples=2).report
    assert (report.t, report.coordinates["x"]) == pytest.approx((2, 1), rel=1e-14)
    assert [switching.t for switching in report.switchings] == [1]


@pytest.mark.parametrize("engine", ["auto", *(pytest.param(name, marks=pytest.mark.long) for name in BY_STEPS)])
@pytest.mark.parametrize("belt", ["0", "1/2 + t/4"])
def test_a_speed_that_friction_stops_ended_no_motion(belt, engine, c_compiler):
    """Braked by 1, the block has the speed of the belt at 1 - t = 0 or 1/2 + t/4."""
    scene = holonom.system(f"""
        system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2,
          forces = [-signum(dot(x) - ({belt}))])$
        stopped : holonomic_scene(system, initial_state = [x = 0, dot(x) = 1], time_span = [0, 5],
          until = [dot(x) - ({belt}), x - 3])$""")
    report = scene.simulate(samples=2, engine=engine).report
    assert report.ending.crossed == report.ending.of[0]
    assert float(report.t) == pytest.approx(1 if belt == "0" else 0.4, rel=1e-9)


@pytest.mark.parametrize("engine", ["auto", *(pytest.param(name, marks=pytest.mark.long) for name in BY_STEPS)])
def test_a_touch_that_an_engine_takes_for_a_stop_ends_no_motion(engine, c_compiler):
    """It slips from t = 1 on, when x = 1/3, and touches the belt's speed each 2 pi/sqrt(3), where friction ends."""
    report = (
        holonom.system("""
        system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2,
          forces = [-signum(dot(x) - 1/3) - 3*x])$
        belt : holonomic_scene(system, initial_state = [x = 0, dot(x) = 1/3], time_span = [0, 10],
          until = [dot(x) - 1/3])$""")
        .simulate(samples=2, engine=engine)
        .report
    )
    assert report.ending.crossed is None
    assert float(report.t) == 10


OSCILLATORS = """
system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  potential_energy = x^2/2 + y^2)$
swings : holonomic_scene(system, initial_state = [x = 0, y = 0, dot(x) = 1, dot(y) = sqrt(2)], time_span = [0, 60],
  until = [{until}])$
"""
SHORT_STEPS = (("taylor", "double"), ("taylor", "extended"), ("runge-kutta", "double"))


def swung(until: str, engine: str, precision: str = "double", max_step: float = 0.1) -> Report:
    """x = sin(t), y = sin(sqrt(2) t), in steps of which many are examined at a time if they are short."""
    scene = holonom.system(OSCILLATORS.format(until=until))
    report = scene.simulate(samples=2, engine=engine, precision=precision, tol=1e-14, max_step=max_step).report
    assert report.steps >= report.t / max_step
    return report


@pytest.mark.parametrize(("engine", "precision"), SHORT_STEPS)
@pytest.mark.parametrize("below", [1e-2, 1e-4, 1e-6, 1e-9, 1e-11])
def test_a_level_just_below_a_maximum_is_reached_twice_in_a_short_step(below, engine, precision, c_compiler):
    """No earlier maximum of x + y is as high. Truth: the zero of the closed form."""
    root = mpmath.sqrt(2)
    top = mpmath.findroot(lambda t: mpmath.cos(t) + root * mpmath.cos(root * t), 45.54)
    height = lambda t: mpmath.sin(t) + mpmath.sin(root * t)  # noqa: E731
    earlier = np.linspace(0, 45, 10_000)
    with mpmath.workdps(30):
        level = height(top) - below
        truth = mpmath.findroot(lambda t: height(t) - level, (top - 0.2, top), solver="illinois")
        assert np.max(np.sin(earlier) + np.sin(math.sqrt(2) * earlier)) < level
        found = swung(f"x + y - {mpmath.nstr(level, 20)}b0", engine, precision).t
    assert float(found) == pytest.approx(float(truth), abs=1e-13 / math.sqrt(below))


PULSES = [*((seed, "taylor", 0.1) for seed in range(4)), (4, "runge-kutta", 0.1), *((k, "taylor", 1.0) for k in (5, 6))]


@pytest.mark.parametrize(("seed", "engine", "max_step"), PULSES)
def test_a_pulse_as_short_as_a_part_of_a_step_is_found(seed, engine, max_step, c_compiler):
    """It lasts 1/2048 of the time span."""
    time, width = 5 + 50 * random.Random(seed).random(), 60 / 2048 / 2
    until = f"if t > {time - width!r} and t < {time + width!r} then -1 else 1"
    assert float(swung(until, engine, max_step=max_step).t) == pytest.approx(time - width, abs=1e-13)


@pytest.mark.parametrize(
    ("engine", "time"), [("taylor", 30.0499), ("taylor", 30.0999), ("taylor", 30.0001), ("runge-kutta", 30.0999)]
)
def test_a_jump_shortly_before_the_end_of_a_short_step_is_found_where_it_is(engine, time, c_compiler):
    assert float(swung(f"if t < {time} then 1 else -1", engine).t) == pytest.approx(time, abs=1e-13)


def test_the_first_of_several_events_in_a_short_step_ends_the_motion():
    report = swung("t - 30.0153, x^2 + 300152/10000 - t - x^2, t - 30.0154", "taylor")
    assert (report.t, report.ending.crossed) == (pytest.approx(30.0152, abs=1e-13), "37519/1250-t")


ONE_SIDED = """
system : holonomic_system(coordinates = [x], parameters = [a, b], kinetic_energy = dot(x)^2/2,
  forces = [if x > 0 then -b*x else -a*x])$
stretched : holonomic_scene(system, parameter_values = [a = {a}, b = {b}], initial_state = [x = {x}, dot(x) = 0],
  time_span = [0, {end}], until = [x])$
"""


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("length", "time"), [(1e-6, 1e-3), (1e6, 1e4)])
def test_a_step_as_short_as_rounding_changed_a_sign_again(length, time, engine, c_compiler):
    """The motion ends where the force switches, to the last bit but one. Truth: x = -cos(2 t) until then."""
    scene = ONE_SIDED.format(a=4 / time**2, b=9 / time**2, x=-length, end=10 * time)
    report = holonom.system(scene).simulate(samples=5, engine=engine, max_step=time / 100).report
    assert float(report.t) / time == pytest.approx(math.pi / 4, rel=10 * ENGINES[engine])
    assert report.trusted


@pytest.mark.parametrize(
    ("until", "failure", "refusal"),
    [
        ("y - h", ErrorKind.REFUSED, "unknown_name_in_until"),
        ("g - 3", ErrorKind.REFUSED, "constant_in_until"),
        ("sqrt(1/2 - t) + 1", ErrorKind.NO_EVENT_VALUE, None),
    ],
)
def test_what_cannot_end_a_motion_is_refused(until, failure, refusal):
    with pytest.raises(HolonomError) as caught:
        thrown(until).simulate(samples=2)
    assert (caught.value.kind, caught.value.refusal) == (failure, refusal)


def test_a_crossing_just_before_the_end_of_a_domain_ends_the_motion():
    report = thrown("log(1/2 - t) + 9").simulate(samples=2).report
    assert float(report.t) == pytest.approx(0.5 - math.exp(-9), abs=1e-12)


def test_the_table_says_what_ended_the_motion():
    console = Console(file=io.StringIO(), width=200)
    show_simulation(console, thrown("y").simulate(samples=2))
    assert f"The motion ends at t = {FALL:.10g}, where y crosses zero." in console.file.getvalue()
