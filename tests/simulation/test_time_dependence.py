"""What a motion makes of the time alone, against features whose places are known."""

from fractions import Fraction

import pytest
from refusing import failing

import holonom
from holonom.explanations import notes, unresolved
from holonom.failures import ErrorKind
from holonom.program.motion_program import Call, Name, Operation, Program
from holonom.program.request import Solve
from holonom.simulation import time_dependence as scan
from holonom.simulation.mode import TOO_OFTEN
from holonom.simulation.time_dependence import NOT_SMOOTH, TimeDependence, time_dependence, time_expressions

T, X = Name("t"), Name("x")


def program(expression) -> Program:
    return Program(None, Solve.DIRECT, "composed", ("t", "x"), (("w1", expression),), {"h[1]": Name("w1")})


def of(operation: Operation, *arguments) -> Call:
    return Call(operation, arguments)


def shifted(by: Fraction) -> Call:
    return of(Operation.SUBTRACT, T, by)


def pulse(at: Fraction, width: Fraction) -> Call:
    square = of(Operation.POWER, of(Operation.DIVIDE, shifted(at), width), Fraction(2))
    return of(Operation.EXP, of(Operation.NEGATE, square))


def test_what_is_smooth_on_the_scale_of_the_time_span_needs_no_stops():
    for expression in (T, of(Operation.SIN, T), of(Operation.EXP, T)):
        assert time_dependence(program(expression), 0.0, 10.0) == TimeDependence()


@pytest.mark.parametrize("width", [Fraction(1, 100), Fraction(1, 1000), Fraction(1, 20000)])
def test_steps_stop_around_a_pulse_however_narrow(width):
    found = time_dependence(program(of(Operation.MULTIPLY, X, pulse(Fraction(1, 3), width))), 0.0, 1.0)
    near = [t for t in found.stops if abs(t - 1 / 3) < 8 * width]
    assert min(near) < 1 / 3 < max(near)
    assert found.end is None


@pytest.mark.parametrize(
    ("expression", "end", "smooth"),
    [
        (of(Operation.SQRT, of(Operation.SUBTRACT, Fraction(3, 10), T)), 0.3, True),
        (of(Operation.DIVIDE, Fraction(1), of(Operation.SUBTRACT, T, Fraction(3, 10))), 0.3, True),
        (of(Operation.DIVIDE, Fraction(1), of(Operation.SUBTRACT, T, Fraction(1, 2))), 0.5, True),
        (of(Operation.SIGN, of(Operation.SUBTRACT, T, Fraction(3, 10))), 0.3, False),
    ],
)
def test_the_time_is_found_at_which_an_expression_ends(expression, end, smooth):
    found = time_dependence(program(expression), 0.0, 1.0)
    assert found.end == pytest.approx(end, abs=1e-10)
    assert (found.reason == NOT_SMOOTH) is not smooth


def test_only_the_largest_expressions_of_the_time_alone_are_looked_at():
    expression = of(Operation.ADD, X, of(Operation.MULTIPLY, X, of(Operation.SIN, of(Operation.COS, T))))
    assert time_expressions(program(expression)).assignments == (
        ("of_time[0]", of(Operation.SIN, of(Operation.COS, T))),
    )
    assert time_expressions(program(of(Operation.SIN, X))).outputs == {}


@pytest.mark.parametrize(("faint", "often"), [(1, 10**6), (10**9, 10**6), (10**9, 10**4), (10**9, 3 * 10**7)])
def test_a_pulse_among_faint_oscillations_as_narrow_was_passed_over(faint, often):
    """A step is to begin where the pulse is felt, whatever an engine makes of the oscillations."""
    width = max(Fraction(1, often), Fraction(1, 20000))
    noise = of(Operation.DIVIDE, of(Operation.SIN, of(Operation.MULTIPLY, Fraction(often), T)), Fraction(faint))
    found = time_dependence(program(of(Operation.ADD, noise, pulse(Fraction(1, 3), width))), 0.0, 1.0)
    assert min(abs(t - 1 / 3) for t in found.stops) < 2 * width


def rounded_at(size: int) -> Call:
    return of(Operation.SUBTRACT, of(Operation.ADD, T, Fraction(size)), Fraction(size))


@pytest.mark.parametrize(
    "zero",
    [
        of(Operation.SUBTRACT, rounded_at(64), rounded_at(128)),
        of(
            Operation.SUBTRACT,
            of(Operation.SUBTRACT, of(Operation.MULTIPLY, T, Fraction(3)), T),
            of(Operation.ADD, T, T),
        ),
    ],
)
def test_rounding_of_a_zero_is_smooth(zero):
    """Times of few digits show no rounding, and neither do those next to them."""
    assert time_dependence(program(of(Operation.MULTIPLY, X, zero)), 0.0, 10.0) == TimeDependence()


def test_what_changes_too_often_to_be_resolved_was_given_up_in_silence():
    for often, start in ((10**4, None), (10**6, 0.0)):
        fast = of(Operation.SIN, of(Operation.MULTIPLY, Fraction(often), T))
        assert time_dependence(program(fast), 0.0, 1.0).unresolved == start


def test_a_motion_and_its_row_tell_what_the_scan_did_not_resolve(monkeypatch):
    monkeypatch.setattr(scan, "MOST", 4)
    scene = holonom.system("""system : holonomic_system(coordinates = [x], parameters = [k],
  kinetic_energy = dot(x)^2/2, potential_energy = k*x^2/2, forces = [sin(1000*t)])$
shaken : holonomic_scene(system, parameter_values = [k = 1], initial_state = [x = 1, dot(x) = 0], time_span = [0, 1])$
""")
    report = scene.simulate(samples=2).report
    assert report.unresolved == 0.0
    (noted,) = (note for note in notes(report) if note == unresolved(0.0))
    rows = holonom.sweep(scene, values={"k": [1, 2]}, keep=["x"], workers=1).to_pandas()
    assert rows[["status", "note"]].to_numpy().tolist() == [["ok", noted]] * 2


def test_a_sign_that_changes_too_often_is_followed_no_further(monkeypatch):
    monkeypatch.setattr(scan, "MOST", 4)
    scene = holonom.system("""system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2,
  forces = [signum(sin(1000*t))])$
driven : holonomic_scene(system, initial_state = [x = 1, dot(x) = 0], time_span = [0, 1])$
""")
    with failing(ErrorKind.NO_WAY_ON, str(TOO_OFTEN)):
        scene.simulate(samples=2)
