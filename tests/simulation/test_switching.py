"""Motions that are not analytic everywhere, against piecewise integrations by mpmath in polar coordinates.

The pendulum of the README in the angle phi, x = u sin(phi): between switchings it is one differential equation, and at
a kink of u the impulse is radial, so that dot(phi) does not jump.
"""

import math
import sys
from fractions import Fraction
from functools import cache
from itertools import count, pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace

import numpy as np
import pytest
from refusing import failing
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import beta

import holonom
from holonom.failures import ErrorKind, HolonomError
from holonom.program.motion_problem import MotionProblem, motion_problem
from holonom.program.numpy_function import NumpyFunction
from holonom.program.request import Request
from holonom.program.sign_pattern import drawing_at_any_time
from holonom.sandbox import Limits
from holonom.simulation.engines.engine import Task
from holonom.simulation.engines.taylor import TaylorEngine
from holonom.simulation.hybrid_motion import CROWD, CROWDED, EventOutcome, HybridMotion
from holonom.simulation.request import EngineName, SimulationRequest
from holonom.simulation.result import Report
from holonom.simulation.simulate import simulate

ENGINES = [EngineName.TAYLOR, EngineName.RUNGE_KUTTA, EngineName.ROBUST]
DIGITS = {EngineName.TAYLOR: 5e-13, EngineName.RUNGE_KUTTA: 1e-11, EngineName.ROBUST: 1e-9}

PENDULUM = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [m, g],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, potential_energy = [gravity = m*g*y{potential}],
  forces = [{forces}], constraints = [x^2 + y^2 - u^2])$
swing : holonomic_scene(system, control_law = [u = {law}], parameter_values = [m = 1, g = 981/100],
  initial_state = [{start}, dot(x) = 0], time_span = [0, {end}])$
"""
MASS = """load("holonom.mac")$
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, potential_energy = {potential},
  forces = [{force}])$
slide : holonomic_scene(system, initial_state = [x = {x}, dot(x) = {v}], time_span = [0, {end}])$
"""

STEERED = """load("holonom.mac")$
system : holonomic_system(coordinates = [x], controls = [u], kinetic_energy = dot(x)^2/2, forces = [{force}])$
slide : holonomic_scene(system, control_law = [u = {law}], initial_state = [x = 0, dot(x) = 0], time_span = [0, 1])$
"""
FIXED = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2, forces = [0, {force}],
  constraints = [{constraint}])$
slide : holonomic_scene(system, initial_state = [y = 0, dot(y) = 0], time_span = [0, 1])$
"""
LIFT = """load("holonom.mac")$
system : holonomic_system(coordinates = [z], controls = [u], kinetic_energy = dot(z)^2/2, constraints = [z - u],
  drawing = [point([0, u])])$
rise : holonomic_scene(system, control_law = [u = max(t, 1)], initial_state = [], time_span = [0, 2])$
"""

HOOK = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, z], controls = [u], kinetic_energy = (dot(x) + dot(u))^2/2,
  potential_energy = z^2, constraints = [z - x - u])$
run : holonomic_scene(system, control_law = [u = if t < 1 then t else 2 - t], initial_state = [x = 0, dot(x) = 0],
  time_span = [0, 2])$
"""


@cache
def asked(text: str) -> MotionProblem:
    with TemporaryDirectory() as directory:
        file = Path(directory) / "scene.mac"
        file.write_text(text, encoding="utf-8")
        return motion_problem(file, Request(), Limits(), 40)


def pendulum(potential="", forces="0, 0", law="1 + t/10", start="x = 3/5, y = -4/5", end="1") -> MotionProblem:
    return asked(PENDULUM.format(potential=potential, forces=forces, law=law, start=start, end=end))


def mass(force="0", potential="0", x="0", v="0", end="1") -> MotionProblem:
    return asked(MASS.format(force=force, potential=potential, x=x, v=v, end=end))


def steered(law: str, force: str) -> MotionProblem:
    return asked(STEERED.format(law=law, force=force))


def end_of(problem: MotionProblem, engine: EngineName = EngineName.TAYLOR, **wanted) -> Report:
    return simulate(problem, SimulationRequest(samples=0, engine=engine, **wanted)).report


def outcomes(report: Report) -> list[EventOutcome]:
    return [switching.outcome for switching in report.switchings]


@pytest.mark.parametrize("engine", ENGINES)
def test_a_potential_with_a_kink_gave_0_6266(engine):
    report = end_of(pendulum(potential=" + 20*abs(x)"), engine)
    assert report.coordinates["x"] == pytest.approx(0.5961010442662413546, abs=DIGITS[engine])
    assert [s.t for s in report.switchings] == pytest.approx([0.241223089019445, 0.724039911056838], abs=1e-9)
    assert report.trusted


@pytest.mark.parametrize("engine", ENGINES)
def test_a_force_that_jumps_at_a_place_gave_0_6266(engine):
    report = end_of(pendulum(forces="-20*signum(x), 0"), engine)
    assert report.coordinates["x"] == pytest.approx(0.5961010442662413546, abs=DIGITS[engine])
    assert outcomes(report) == [EventOutcome.CROSSED, EventOutcome.CROSSED]


def contact_time(stiffness: float, speed: float) -> float:
    """Return the time that a contact with the force of Hertz takes."""
    deepest = (5 * speed**2 / (4 * stiffness)) ** 0.4
    return 2 * deepest / speed * beta(0.4, 0.5) * 0.4


def rebound(stiffness: float, speed: float, time: float) -> float:
    """Return the place at a time after a contact at x = 1 that begins at half a second."""
    return 1 - speed * (time - 0.5 - contact_time(stiffness, speed))


@pytest.mark.parametrize(
    "contact",
    [
        {"force": "-50*max(0, x - 1)^(3/2)"},
        {"potential": "20*max(0, x - 1)^(5/2)"},
        {"force": "if x > 1 then -50*(x - 1)^(3/2) else 0"},
    ],
    ids=["force", "potential", "parts"],
)
@pytest.mark.parametrize("engine", ENGINES)
def test_hertz_contact_ended_in_short_steps(contact, engine):
    problem = mass(**contact, x="0", v="2", end="2")
    report = end_of(problem, engine)
    assert [switch.function for switch in report.switchings] == ["x-1", "x-1"]
    assert report.coordinates["x"] == pytest.approx(rebound(50, 2, 2), abs=10 * DIGITS[engine])
    assert report.velocities["dot(x)"] == pytest.approx(-2, abs=10 * DIGITS[engine])


@pytest.mark.parametrize("engine", ENGINES)
def test_second_hertz_contact_with_a_wall_ended_in_short_steps(engine):
    """Between walls at x = 1 and x = -1 the mass flies for a second after each contact."""
    problem = mass(force="50*(max(0, -x - 1)^(3/2) - max(0, x - 1)^(3/2))", x="0", v="2", end="5")
    report = end_of(problem, engine)
    again = 2 * (1 + contact_time(50, 2))
    assert report.coordinates["x"] == pytest.approx(rebound(50, 2, 5 - again), abs=20 * DIGITS[engine])
    assert [segment.engine for segment in report.segments] == [engine]


@pytest.mark.parametrize("engine", ENGINES)
def test_dry_friction_gave_minus_0_43423(engine):
    report = end_of(pendulum(forces="-signum(dot(x)), 0"), engine)
    assert report.coordinates["x"] == pytest.approx(-0.4279510709884412871, abs=DIGITS[engine])
    assert report.trusted


@pytest.mark.parametrize("engine", ENGINES)
def test_friction_that_sticks_from_the_start_gave_0_46239(engine):
    """7.36 at first and 6.39 at the end is all that holding x takes, of 12: x stays where it is."""
    report = end_of(pendulum(forces="-12*signum(dot(x)), 0"), engine)
    assert report.coordinates["x"] == pytest.approx(0.6, abs=DIGITS[engine])
    assert report.velocities["dot(x)"] == pytest.approx(0.0, abs=DIGITS[engine])


def test_surfaces_that_lie_closer_than_a_step_samples_were_missed():
    """Over bands of 1/100 pi that push forward and back by turns: v^2 changes by 2 a d over each, t by 2 d/(v + v')."""
    force, band, t, x, v = 1e-3, math.pi / 100, 0.0, 0.0, 1.0
    for index in count():
        width, push = band / 2 if index == 0 else band, force * (-1) ** index
        left, rest = math.sqrt(v**2 + 2 * push * width), 2 - t
        if 2 * width / (v + left) > rest:
            break
        t, x, v = t + 2 * width / (v + left), x + width, left
    report = end_of(mass(force="signum(cos(100*x))/1000", v="1", end="2"))
    assert len(report.switchings) == index
    assert report.coordinates["x"] == pytest.approx(x + v * rest + push * rest**2 / 2, rel=1e-12)


@pytest.mark.parametrize("engine", ENGINES)
def test_quadratic_drag_switches_where_the_velocity_turns(engine):
    report = end_of(pendulum(forces="0, -dot(y)*abs(dot(y))"), engine)
    assert report.coordinates["x"] == pytest.approx(-0.5998452322132196187, abs=DIGITS[engine])
    assert [s.t for s in report.switchings] == pytest.approx([0.552522907210528], abs=1e-9)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_law_with_a_kink_left_a_residual_of_0_04(engine):
    problem = pendulum(law="5 - abs(t - 3)/4", start="x = 3, y = -sqrt(145)/4", end="6")
    report = end_of(problem, engine)
    assert report.coordinates["x"] == pytest.approx(-1.92623973081555933, abs=10 * DIGITS[engine])
    assert report.coordinates["y"] == pytest.approx(-3.78841662168083112, abs=10 * DIGITS[engine])
    assert [(s.t, s.outcome) for s in report.switchings] == [(3.0, EventOutcome.IMPULSE)]
    assert report.trusted


@pytest.mark.parametrize("engine", ENGINES)
def test_a_pulse_of_3_ms_was_skipped(engine):
    law = "if t > 1/2 and t < 503/1000 then 1 + (t - 1/2)*(503/1000 - t)*10000 else 1"
    report = end_of(pendulum(law=law), engine)
    assert report.coordinates["x"] == pytest.approx(-0.597929713958746253, abs=DIGITS[engine])
    assert outcomes(report) == [EventOutcome.IMPULSE, EventOutcome.IMPULSE]


@pytest.mark.parametrize("engine", ENGINES)
def test_a_pulse_in_a_part_that_would_grow_later_was_skipped(engine):
    report = end_of(mass("if t < 1 then t^40 + exp(-((t - 1/2)*5000)^2) else 0", end="100"), engine)
    assert report.velocities["dot(x)"] == pytest.approx(1 / 41 + math.sqrt(math.pi) / 5000, rel=DIGITS[engine])


@pytest.mark.parametrize("word", ["elseif", "else if"])
def test_a_law_in_sixty_parts_was_too_deep_for_a_program(word):
    parts = f" {word} ".join(f"t < {k} then {k}" for k in range(1, 60))
    report = end_of(mass(f"if {parts} else 0", end="3"), EngineName.TAYLOR)
    assert report.velocities["dot(x)"] == pytest.approx(1 + 2 + 3, rel=1e-15)
    assert [s.t for s in report.switchings] == [1, 2]


@pytest.mark.long
def test_a_pulse_beside_faint_oscillations_was_skipped():
    """Steps at a tolerance of 1e-9 do not follow the oscillations."""
    report = end_of(mass("exp(-((t - 1/3)*20000)^2) + sin(400000*t)/10^9", end="1"), EngineName.RUNGE_KUTTA, tol=1e-9)
    assert report.velocities["dot(x)"] == pytest.approx(math.sqrt(math.pi) / 20000, rel=1e-5)


def test_an_impulse_where_a_coordinate_has_no_mass():
    """z = x + u obeys z'' = -2 z: its rate does not jump where that of u does, and that of x does."""
    report = end_of(asked(HOOK))
    assert outcomes(report) == [EventOutcome.IMPULSE]
    assert report.coordinates["z"] == pytest.approx(math.sin(2 * math.sqrt(2)) / math.sqrt(2), rel=1e-13)
    assert report.velocities["dot(x)"] == pytest.approx(math.cos(2 * math.sqrt(2)) + 1, rel=1e-12)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_narrow_smooth_feature_was_stepped_over(engine):
    report = end_of(pendulum(law="1 + exp(-(1000*(t - 1/2))^2)/10"), engine)
    assert report.coordinates["x"] == pytest.approx(-0.59792649978278629, abs=DIGITS[engine])
    assert report.switchings == ()
    assert report.trusted


def test_motion_under_a_pulse_within_a_step_is_trusted():
    """The energy 10^5 comes and goes between two samples; the rounding of its work was taken for an error of 1/2."""
    pulse = "(if t < 1/2 then 0 else if t < 501/1000 then (t - 1/2)^3*(501/1000 - t)^3*10^19 else 0)"
    scene = holonom.system(f"""
        system : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
          constraints = [x - u])$
          pulsed : holonomic_scene(system, control_law = [u = {pulse}], time_span = [0, 1],
            initial_state = [y = 0, dot(y) = 1])$
    """)
    motion = scene.simulate()
    assert (motion["x"][-1], motion["y"][-1]) == (0, pytest.approx(1, rel=1e-14))
    assert motion.report.trusted


def test_an_odd_root_of_a_size_had_no_real_value_before_the_zero():
    """x(2) is the integral of (2 - t) abs(t - 1)^(5/3) from 0 on, 3/4."""
    report = end_of(mass(force="abs(t - 1)^(5/3)", end="2"), EngineName.RUNGE_KUTTA)
    assert report.coordinates["x"] == pytest.approx(0.75, rel=1e-11)
    assert [s.t for s in report.switchings] == [1.0]


def test_a_law_with_a_far_pulse_took_all_memory():
    """exp(-2500000000) is no fraction to be written out. Truth: the pulse gives a velocity of sqrt(pi)."""
    text = MASS.replace("coordinates = [x]", "coordinates = [x], controls = [u]").replace(
        "(system, ", "(system, control_law = [u = 10^4*exp(-((t - 5)/10^-4)^2)], "
    )
    report = end_of(asked(text.format(potential="0", force="u", x="0", v="0", end="10")))
    assert report.velocities["dot(x)"] == pytest.approx(math.sqrt(math.pi), rel=1e-12)
    assert report.trusted  # its work was missed: at a few times, however chosen, there is none


def test_a_law_that_decays_like_one_over_cosh_overflowed():
    report = end_of(pendulum(law="1 + 1/cosh(1000*(t - 1/2))"))
    assert report.coordinates["x"] == pytest.approx(-0.5979952624087093629942783, abs=1e-12)
    assert report.trusted


def test_switchings_keep_the_digits_of_a_longer_precision():
    x = end_of(pendulum(potential=" + 20*abs(x)"), precision="quadruple").coordinates["x"]
    assert str(x).startswith("0.59610104426624135462")


def test_each_of_many_switchings_took_as_long_as_all_before_it():
    """Operations that join its parts are counted, not seconds: as many for a late switching as for an early one."""
    problem, taken = mass(potential="abs(x)", x="1/2"), 0

    def count_operations(frame, event, argument):
        nonlocal taken
        if not frame.f_code.co_filename.endswith(("hybrid_motion.py", "mode.py")):
            return None
        frame.f_trace_opcodes, frame.f_trace_lines = True, False
        taken += event == "opcode"
        return count_operations

    counts = []
    for until in (80, 160, 320):
        before, tracing, wanted = taken, sys.gettrace(), SimulationRequest(until=Fraction(until), samples=until)
        sys.settrace(count_operations)
        try:
            report = simulate(problem, wanted).report
        finally:
            sys.settrace(tracing)
        assert len(report.switchings) == until // 2
        counts.append(taken - before)
    first, second = np.diff(counts)
    assert second < 2.2 * first


@pytest.mark.parametrize("engine", ENGINES)
def test_dry_friction_holds_until_the_force_is_as_large(engine):
    """Truth: x'' = t - 1/2 from t = 1/2 on, where the force has grown to the friction; x(1) = 1/48."""
    report = end_of(mass(force="t - signum(dot(x))/2"), engine)
    assert report.coordinates["x"] == pytest.approx(1 / 48, abs=1e-10)
    assert outcomes(report) == [EventOutcome.RELEASED]
    assert report.switchings[0].t == pytest.approx(0.5, abs=1e-9)


@pytest.mark.parametrize("engine", ENGINES)
def test_dry_friction_stops_a_mass_and_holds_it(engine):
    """Truth: x'' = -5 from v = 1 ends at t = 1/5, x = 1/10."""
    report = end_of(mass(force="-5*signum(dot(x))", v="1"), engine)
    assert report.coordinates["x"] == pytest.approx(0.1, abs=1e-10)
    assert [(s.outcome) for s in report.switchings] == [EventOutcome.SLIDING]
    assert report.switchings[0].t == pytest.approx(0.2, abs=1e-9)


COUPLED = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  potential_energy = [spring = (x - y)^2], forces = [t - 3*signum(dot(x)), -signum(dot(y))])$
scene : holonomic_scene(system, initial_state = [x = 0, y = 0, dot(x) = 0, dot(y) = 0], time_span = [0, 6])$
"""


@pytest.mark.parametrize("engine", ENGINES)
def test_masses_with_dry_friction_rest_together(engine):
    """They were refused. Truth: x'' = t - 3 - 2 x from t = 3 on, and y moves from 2 x = 1 on."""
    report = end_of(asked(COUPLED), engine)
    w = math.sqrt(2)
    moves = brentq(lambda s: s - math.sin(w * s) / w - 1, 0, 3)
    assert outcomes(report) == [EventOutcome.RELEASED] * 2
    assert [each.t for each in report.switchings] == pytest.approx([3, 3 + moves], abs=1e-9)


def test_a_mass_rests_at_the_bottom_of_a_kink():
    assert end_of(mass(potential="abs(x)")).coordinates["x"] == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize(
    ("problem", "time", "facts"),
    [
        (lambda: pendulum(law="1 + unit_step(t - 1/2)"), "0.5", ()),
        (lambda: mass(potential="signum(x)", v="-1", x="1/2"), "0.5", ("x",)),
        (lambda: mass(potential="-abs(x)"), "0", ("x",)),
        (lambda: pendulum(law="1/(2 - t)", start="x = 3/10, y = -2/5", end="3"), "2", ()),
        (lambda: pendulum(law="1 + sqrt(1 - t)", start="x = 6/5, y = -8/5", end="3"), "1", ()),
        (lambda: mass(force="sqrt(1 - t)", end="3"), "1", ()),
        # functions of a law that remain zero, whose signs were taken for 1 or -1
        (lambda: steered("1", "if u > 1 then -8 else -1"), "0", ("u-1",)),
        (lambda: steered("if t < 1/2 then 2 else 1", "if u > 1 then -8 else -1"), "0.5", ("u-1",)),
        (lambda: steered("max(t, 1/2)", "-signum(dot(u))"), "0", ("dot(u)",)),
        (lambda: steered("max(t, 1/2)", "-signum(u - 1/2)"), "0", ("u-1/2",)),
        # functions that a constraint keeps at zero
        (lambda: asked(FIXED.format(force="if x > y then -8 else -1", constraint="x - y")), "0", ("y-x",)),
        (lambda: asked(FIXED.format(force="-signum(dot(x))", constraint="x")), "0", ("dot(x)",)),
        # on the boundary of two halves of the time span, with a wrong number and exit status 1
        (lambda: mass(force="atan2(t - 1, -1)", end="2"), "1", ()),
        # infinitely many switchings before t = 1, which were passed with a wrong velocity and exit status 0
        pytest.param(lambda: mass(force="-10*signum(sin(1/(1 - t)))", end="3"), "0.99997", (), marks=pytest.mark.long),
    ],
)
def test_what_mechanics_does_not_decide_is_refused_with_its_time(problem, time, facts):
    with failing(ErrorKind.NO_WAY_ON, *facts) as stopped:
        end_of(problem(), EngineName.AUTO)
    assert float(stopped.value.detail.split(",")[0]) == pytest.approx(float(time), abs=1e-4)


@pytest.mark.parametrize(
    ("law", "force", "place"),
    [("max(t, 1/2) - 1/2", "-max(0, u)", -1 / 48), ("0", "1 - abs(u)", 1 / 2), ("t^40", "signum(u)", 1 / 2)],
)
def test_a_function_may_remain_zero_or_small_if_its_sign_does_not_matter(law, force, place):
    assert end_of(steered(law, force)).coordinates["x"] == pytest.approx(place, abs=1e-12)


@pytest.mark.parametrize("first", [0.0, 700.0])
def test_many_switchings_are_crowded_in_a_small_part_of_the_span_whenever_that_is(first):
    for apart, together in ((0.99 * CROWDED / CROWD, True), (1.01 * CROWDED / CROWD, False)):
        starts = [first * 10 + 10 * apart * k for k in range(CROWD + 1)]
        for few in (0, 1):
            motion = SimpleNamespace(intervals=[SimpleNamespace(start=t) for t in starts[few:]], _span=10.0)
            assert HybridMotion._crowded(motion, starts[-1] + 10 * apart) is (together and not few)


@pytest.mark.parametrize("precision", ["double", "quadruple"])
@pytest.mark.parametrize("engine", ENGINES)
def test_no_step_is_longer_than_asked_for(engine, precision):
    """Truth: sin(t)."""
    if precision != "double" and engine is not EngineName.TAYLOR:
        return
    problem = mass(force="-x", v="1")
    motion = simulate(problem, SimulationRequest(max_step=0.01, engine=engine, precision=precision))
    t = motion.times
    assert max(later - earlier for earlier, later in pairwise(t)) < 0.010001
    assert len(t) == motion.report.steps + 1
    assert float(motion.coordinates["x"][-1]) == pytest.approx(np.sin(float(t[-1])), abs=1e-9)
    alone = simulate(problem, SimulationRequest(max_step=0.01, engine=engine, samples=0)).report
    assert alone.steps == len(t) - 1


def test_a_motion_of_one_analytic_part_ends_with_its_time():
    with pytest.raises(HolonomError) as refused:
        TaylorEngine(Task.of(pendulum(potential=" + 20*abs(x)")))
    assert (refused.value.kind, refused.value.detail) == (ErrorKind.NOT_ANALYTIC, "x")


def test_a_drawing_takes_each_sign_as_it_is_where_it_is_drawn():
    problem = asked(LIFT)
    draw = NumpyFunction(drawing_at_any_time(problem).program)
    assert draw([0.5, 0.0, 0.0, 0.0]).tolist() == [0.0, 1.0]
    assert draw([2.0, 0.0, 0.0, 0.0]).tolist() == [0.0, 2.0]


def test_phases_that_different_engines_follow_could_not_be_put_together():
    """In closed form, (t - 1)^(9/2)/(63/4): heyoka has no powers of zero that are not whole, the robust engine has."""
    motion = holonom.system("""
system : holonomic_system(coordinates = [x], controls = [u], kinetic_energy = dot(x)^2/2, forces = [u])$
pushed : holonomic_scene(system, control_law = [u = if t < 1 then 0 else (t - 1)^(5/2)],
  initial_state = [x = 0, dot(x) = 0], time_span = [0, 2], observe = [trajectory, residuals])$""").simulate(samples=9)
    assert {segment.engine for segment in motion.report.segments} == {"taylor", "robust"}
    assert motion["x"] == pytest.approx(np.maximum(motion.times - 1, 0) ** 4.5 * 4 / 63, abs=1e-10)


STICKING = """
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [{force} - 5*signum(dot(x))])$
motion : holonomic_scene(system, initial_state = [x = 0, dot(x) = 0], time_span = [0, {span}])$
"""


@pytest.mark.parametrize("engine", ["auto", "robust"])
@pytest.mark.parametrize(
    ("force", "span", "end"),
    [
        ("t", 4, 0),
        pytest.param("t", 5.5, 0.5**3 / 6, marks=pytest.mark.long),
        ("t", 7, 2**3 / 6),
        pytest.param("t", 8, 3**3 / 6, marks=pytest.mark.long),
        pytest.param("2*t", 3, 2 * 0.5**3 / 6, marks=pytest.mark.long),
        ("(5 - t)", 3, 0),
        ("5*sin(t)", 5, 0),
        ("-t", 7, -(2**3) / 6),
        pytest.param("3*t/2", 6, 1.5 * (6 - 10 / 3) ** 3 / 6, marks=pytest.mark.long),
        ("4*cos(3*t)", 3, 0),
    ],
)
def test_friction_sticks_from_rest_until_the_force_is_larger(force, span, end, engine):
    """The force grows as k t: it breaks away at k t = 5."""
    motion = holonom.system(STICKING.format(force=force, span=span)).simulate(samples=2, engine=engine)
    assert motion["x"][-1] == pytest.approx(end, abs=1e-9)
    assert motion.report.trusted


@pytest.mark.parametrize(
    ("force", "function"),
    [("if abs(x) > 1/2 then -1 else -x", "abs(x)-1/2"), ("max(0, signum(x - 1/2) + x)", "x+signum(x-1/2)")],
)
def test_a_switching_function_contained_a_symbol_for_another_sign(force, function):
    report = end_of(mass(force=force, x="1/10", v="1", end="1"))
    assert function in {switching.function for switching in report.switchings}


@pytest.mark.parametrize(
    ("condition", "end"),
    [
        ("max(0, -x) > 0", 1 / 2),
        ("abs(x) > x", 1 / 2),
        ("max(0, x) > 0", -17 / 8),
        ("unit_step(x) > 0", -17 / 8),
        ("signum(x) > signum(dot(x))", -17 / 8),
        ("max(0, x) >= 0", -3),
    ],
)
def test_a_condition_on_what_vanishes_between_signs_was_true_or_false_by_chance(condition, end):
    """From x = 1 at rest with the acceleration -8 while the condition holds, -1 elsewhere."""
    report = end_of(mass(force=f"if {condition} then -8 else -1", x="1", v="0", end="1"))
    assert report.coordinates["x"] == pytest.approx(end, abs=1e-12)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("force", ["-9*max(0, x)^(3/2) - 1", "if x > 0 then -1 - sqrt(x) else -1"])
def test_a_start_at_rest_on_the_surface_of_a_root_ended_in_an_internal_error(force, engine):
    report = end_of(mass(force=force), engine)
    assert report.coordinates["x"] == pytest.approx(-1 / 2, abs=DIGITS[engine])


WALL = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y, v, w],
  kinetic_energy = (dot(x)^2 + dot(y)^2 + dot(v)^2 + dot(w)^2)/2, potential_energy = 10*(y + w),
  forces = [0, 0, {force}, 0], constraints = [x^2 + y^2 - 1/4, (v - x)^2 + (w - y)^2 - 1/4])$
scene : holonomic_scene(system, initial_state = [x = 1/2, y = 0, v = 1/2, w = -1/2, dot(x) = 0, dot(y) = 0,
  dot(v) = 0, dot(w) = 0], time_span = [0, 1/4])$"""


@pytest.mark.parametrize("engine", ENGINES)
def test_steps_were_tiny_where_a_motion_leaves_a_wall_with_zero_acceleration(engine):
    report = end_of(asked(WALL.format(force="-50*max(0, v - 1/2)^(3/2)")), engine)
    free = end_of(asked(WALL.format(force="0")))
    assert dict(report.coordinates) == pytest.approx(dict(free.coordinates), abs=DIGITS[engine])
    assert not report.switchings


DRIFT = """load("holonom.mac")$
system : holonomic_system(coordinates = [x1, y1, x2, y2, x3, y3], kinetic_energy = dot(x1)^2 + dot(y1)^2 +
  dot(x2)^2 + dot(y2)^2 + (dot(x3)^2 + dot(y3)^2)/2, potential_energy = 20*y1 + 20*y2 + 10*y3,
  forces = [-signum(x1 - 1/8), 0, if x2 < -1/4 then -5*(x2 + 1/4) - dot(x2) else 0, 0,
    -100*max(0, x3 - 1/8)^(3/2), 0],
  constraints = [x1^2 + y1^2 - 1/4, (x2 - x1)^2 + (y2 - y1)^2 - 1/4, (x3 - x2)^2 + (y3 - y2)^2 - 1/4])$
scene : holonomic_scene(system, initial_state = [x1 = 1/2, y1 = 0, x2 = 9/13, y2 = -6/13, x3 = 23/26, y3 = -12/13,
  dot(x1) = 0, dot(y1) = 0, dot(x2) = 0, dot(y2) = 0, dot(x3) = 0, dot(y3) = 0], time_span = [0, 2])$"""


def test_the_way_back_to_constraints_left_a_state_on_the_wrong_side_of_a_root():
    problem = asked(DRIFT)
    reports = [end_of(problem, engine) for engine in (EngineName.TAYLOR, EngineName.RUNGE_KUTTA)]
    assert [len(report.switchings) for report in reports] == [7, 7]
    assert dict(reports[1].coordinates) == pytest.approx(dict(reports[0].coordinates), abs=1e-9)


def test_a_bead_leaves_the_place_where_its_curve_bends():
    """On y = x |x| from x = 0: without forces the length of the way is the time."""
    motion = holonom.system(
        """system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
          constraints = [y = x*abs(x)])$
        s : holonomic_scene(system, initial_state = [x = 0, dot(x) = 1], time_span = [0, 1])$"""
    ).simulate(samples=5)
    x = motion["x"]
    assert np.arcsinh(2 * x) / 4 + x * np.sqrt(1 + 4 * x**2) / 2 == pytest.approx(np.linspace(0, 1, 5), abs=1e-12)


def test_a_root_of_the_greater_of_place_and_velocity_was_an_internal_error():
    def slope(t, state):
        return state[1], -state[0] - max(0, *state) ** 1.5 / 2

    scene = holonom.system("""
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2,
  forces = [-x - max(0, max(x, dot(x)))^(3/2)/2])$
scene : holonomic_scene(system, initial_state = [x = 2, dot(x) = 0], time_span = [0, 6])$""")
    found = scene.simulate(samples=2).report
    truth = solve_ivp(slope, (0, 6), (2, 0), method="DOP853", rtol=1e-11, atol=1e-13, max_step=0.01).y[0, -1]
    assert found.coordinates["x"] == pytest.approx(truth, rel=1e-8)


def block(force, initial, time_span="[0, 4]"):
    return holonom.system(f"""
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [{force}])$
scene : holonomic_scene(system, initial_state = [{initial}], time_span = {time_span})$""")


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    ("force", "initial", "end", "velocity"),
    [
        # a belt whose speed jumps, under a block that slips, and under one that moves with it
        ("-signum(dot(x) - (if t < 2 then 1 else -1))/5", "x = 0, dot(x) = 1/2", 4, 0.5),
        ("-signum(dot(x) - (if t < 2 then 1 else -1))/5", "x = 0, dot(x) = 1", 4, 0.6),
        ("-signum(dot(x) - (if t < 2 then 1 else 3))/5", "x = 0, dot(x) = 1", 4, 1.4),
        # two belts side by side
        ("-signum(dot(x) - (if x < 1 then 1 else -1))/5", "x = 0, dot(x) = 1/2", 3, None),
        # no friction: a right side that is continuous in the velocity
        ("abs((if t < 3/2 then 1 else 3) - dot(x))", "x = 0, dot(x) = 0", 4, 3 - (2 + math.exp(-1.5)) * math.exp(-2.5)),
    ],
)
def test_switching_function_may_jump_where_another_sign_changes(force, initial, end, velocity, engine):
    if velocity is None:  # v^2 = 1/4 + 2x/5 to x = 1, then dot(v) = -1/5
        reached = math.sqrt(0.65)
        velocity = reached - (end - (reached - 0.5) * 5) / 5
    found = block(force, initial).simulate(until=end, samples=2, engine=engine)
    assert found["dot(x)"][-1] == pytest.approx(velocity, abs=1e-8)


@pytest.mark.parametrize("law", ["if t < 1 then 0 else (t - 1)^2", "max(0, t - 1)^2", "abs(t - 1)*(t - 1)"])
def test_a_law_whose_pieces_meet_at_the_start_was_refused(law):
    scene = holonom.system(f"""
system : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  potential_energy = 10*y, constraints = [y - u])$
scene : holonomic_scene(system, control_law = [u = {law}], initial_state = [x = 0, dot(x) = 2], time_span = [1, 2])$""")
    found = scene.simulate(samples=2)
    assert [found["y"][-1], found["dot(y)"][-1], *found["lambda1"]] == pytest.approx([1, 2, 12, 12])
    assert not scene.check().disagreements


def test_a_function_of_a_control_has_its_sign_by_the_part_of_the_law():
    """The signs of the law were found after those of functions of the control, and the check disagreed."""
    scene = holonom.system("""
system : holonomic_system(coordinates = [x], controls = [u], kinetic_energy = dot(x)^2/2, forces = [max(0, 3/2 - u)])$
scene : holonomic_scene(system, control_law = [u = if sin(t + 4) > 0 then 1 else 2],
  initial_state = [x = 0, dot(x) = 0], time_span = [0, 3])$""")
    assert scene.simulate(samples=2)["dot(x)"][-1] == pytest.approx((3 - (2 * math.pi - 4)) / 2)
    assert not scene.check().disagreements


@pytest.mark.parametrize(
    ("force", "ahead", "behind"),
    [
        ("max(signum(dot(x)), 1/5)", 1, 1 / 5),
        ("abs(signum(dot(x)) + 1/2)", 3 / 2, 1 / 2),
        ("abs(signum(dot(x)))", 1, 1),
        ("signum(dot(x))^2 + signum(signum(dot(x)) + 1/3)", 2, 0),
    ],
)
def test_functions_of_a_sign_slide_between_their_values_on_both_sides(force, ahead, behind):
    """Filippov's shares are 2/3 and 1/3 at rest. The forces were these functions of the amount 1/3."""
    scene = holonom.system(f"""
system : holonomic_system(coordinates = [x, z], kinetic_energy = (dot(x)^2 + dot(z)^2)/2,
  forces = [-3*signum(dot(x)) + 1, {force}])$
scene : holonomic_scene(system, initial_state = [x = 0, dot(x) = 2, z = 0, dot(z) = 0], time_span = [0, 3])$""")
    found = scene.simulate(samples=2)
    assert found["dot(x)"][-1] == pytest.approx(0, abs=1e-12)
    assert found["dot(z)"][-1] == pytest.approx(ahead + 2 * (2 * ahead + behind) / 3)


def test_a_force_that_is_not_linear_in_the_friction_of_another_was_that_of_the_amount_in_between():
    scene = holonom.system("""
system : holonomic_system(coordinates = [x, z], kinetic_energy = (dot(x)^2 + dot(z)^2)/2,
  forces = [t/10 - signum(dot(x)), cos(%pi/3*signum(dot(x)) + t)])$
scene : holonomic_scene(system, initial_state = [x = 0, dot(x) = 1, z = 0, dot(z) = 0])$""")
    assert scene.simulate(until=1, samples=2)["dot(z)"][-1] == pytest.approx(math.sin(math.pi / 3 + 1) - 3**0.5 / 2)
    with failing(ErrorKind.NO_WAY_ON):
        scene.simulate(until=2)


def test_continuous_forces_by_the_size_of_a_speed_that_friction_stops():
    """At rest they do not depend on the sign."""
    scene = holonom.system("""
system : holonomic_system(coordinates = [x, z], kinetic_energy = (dot(x)^2 + dot(z)^2)/2,
  forces = [t/10 - signum(dot(x)), exp(-dot(x)*signum(dot(x)))])$
scene : holonomic_scene(system, initial_state = [x = 0, dot(x) = 1, z = 0, dot(z) = 0])$""")
    stop = 10 - math.sqrt(80)
    moving = solve_ivp(lambda t, _: [math.exp(-(1 - t + t**2 / 20))], (0, stop), [0], rtol=1e-12, atol=1e-14).y[0, -1]
    assert scene.simulate(until=2, samples=2)["dot(z)"][-1] == pytest.approx(moving + 2 - stop, rel=1e-10)


def test_a_product_of_two_signs_that_slide_was_that_of_their_means():
    scene = holonom.system("""
system : holonomic_system(coordinates = [x, y, z], kinetic_energy = (dot(x)^2 + dot(y)^2 + dot(z)^2)/2,
  forces = [t/10 - signum(dot(x)), t/5 - signum(dot(y)), signum(dot(x))*signum(dot(y))])$
scene : holonomic_scene(system,
  initial_state = [x = 0, dot(x) = 1, y = 0, dot(y) = 1/2, z = 0, dot(z) = 0])$""")
    with failing(ErrorKind.NO_WAY_ON):
        scene.simulate(until=2)


def test_function_of_the_velocities_may_jump_with_an_impulse():
    """The momentum of both is theirs behind the kink of u, where the friction has turned; the motion stayed at rest."""
    scene = holonom.system("""
system : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  forces = [-signum(dot(x))/5, 0], constraints = [y - x - u])$
scene : holonomic_scene(system, control_law = [u = 1 + 2*abs(t - 1)],
  initial_state = [x = 0, dot(x) = 1, y = 3, dot(y) = -1], time_span = [0, 2])$""")
    found = scene.simulate(samples=2)
    assert [found["dot(x)"][-1], found["dot(y)"][-1]] == pytest.approx([-1, 1], abs=1e-12)


def test_saturated_controller_follows_a_jump_of_its_set_point():
    scene = block("max(-1, (if t < 2 then 1/2 else -5) - x - dot(x))", "x = 0, dot(x) = 0")

    def rate(t, s):
        return s[1], max(-1, (0.5 if t < 2 else -5) - s[0] - s[1])

    half = solve_ivp(rate, (0, 2 - 1e-15), [0, 0], rtol=1e-10, atol=1e-12).y[:, -1]
    truth = solve_ivp(rate, (2, 4), half, rtol=1e-10, atol=1e-12, max_step=1e-2).y[:, -1]
    assert scene.simulate(samples=2)["x"][-1] == pytest.approx(truth[0], abs=1e-6)


def test_spring_with_backlash_is_the_same_in_both_forms():
    """A size within a switching function: the form of the manual was no motion program."""
    forms = "-max(0, abs(x) - 1)*signum(x)", "-max(0, x - 1) + max(0, -x - 1)"
    found = [block(force, "x = 2, dot(x) = 1", "[0, 10]").simulate(samples=20)["x"] for force in forms]
    assert found[0] == pytest.approx(found[1], abs=1e-12)


@pytest.mark.parametrize(
    ("force", "by_python"),
    [
        ("min(dot(x), max(0, dot(x) - x)^(3/2))", lambda x, v: min(v, max(0, v - x) ** 1.5)),
        ("min(3*dot(x), max(0, dot(x) - x)^(5/2))", lambda x, v: min(3 * v, max(0, v - x) ** 2.5)),
        ("abs(max(0, dot(x) - x)^(3/2) - 2*dot(x))", lambda x, v: abs(max(0, v - x) ** 1.5 - 2 * v)),
        ("max(0, 1/3 - dot(x))^(1/2)", lambda x, v: max(0, 1 / 3 - v) ** 0.5),
    ],
)
def test_a_root_in_a_switching_function_begins_where_another_sign_changes(force, by_python):
    """Rounding left v - x below zero there, and "changes its sign again and again" was the end."""
    found = block(f"{force} - 4*x", "x = 1/7, dot(x) = 1", "[0, 3]").simulate(samples=2)
    expected = solve_ivp(
        lambda _, y: [y[1], by_python(*y) - 4 * y[0]], (0, 3), [1 / 7, 1], rtol=1e-9, atol=1e-11, max_step=0.01
    )
    assert [found["x"][-1], found["dot(x)"][-1]] == pytest.approx(expected.y[:, -1], abs=1e-6)


@pytest.mark.parametrize(
    ("initial", "position", "velocity"), [("x = 0, dot(x) = 1/2", 4, 0), ("x = 0, dot(x) = 1", -2, -2)]
)
def test_sensitivities_pass_a_switching_function_that_jumps(initial, position, velocity):
    """Slipping: v = 1/2 + 2 c - 2 c. From the belt: v = 1 - 2 c, x = 4 - 2 c."""
    scene = holonom.system(f"""
system : holonomic_system(coordinates = [x], parameters = [c], kinetic_energy = dot(x)^2/2,
  forces = [-c*signum(dot(x) - (if t < 2 then 1 else -1))])$
scene : holonomic_scene(system, parameter_values = [c = 1/5], initial_state = [{initial}], time_span = [0, 4])$""")
    found = scene.simulate(samples=2, sensitivities=["c"]).report.sensitivities
    assert found == pytest.approx({"d(x, c)": position, "d(dot(x), c)": velocity}, abs=1e-9)
