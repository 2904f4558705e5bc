"""Functions of the time that are affine, against their values at rational times."""

import math
from fractions import Fraction

import pytest

import holonom
from holonom.program.motion_program import Name, Program, expression_of
from holonom.program.request import Solve
from holonom.simulation.time_events import _affine


def program(expression: object) -> Program:
    return Program(None, Solve.DIRECT, "bordered", ("t", "x"), (("w", expression_of(expression)),), {"f": Name("w")})


HALF = ["Rational", 1, 2]


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        (["Add", "t", 3, "t"], lambda t: 2 * t + 3),
        (["Subtract", 3, ["Multiply", 5, "t"]], lambda t: 3 - 5 * t),
        (["Negate", ["Add", "t", HALF]], lambda t: -t - Fraction(1, 2)),
        (["Multiply", ["Add", "t", 1], HALF, 6], lambda t: 3 * t + 3),
        (["Multiply", 2, ["Subtract", "t", 1]], lambda t: 2 * t - 2),
        (["Divide", ["Subtract", "t", 4], 3], lambda t: (t - 4) / 3),
        (["Subtract", ["Multiply", 4, "t"], ["Divide", "t", HALF]], lambda t: 2 * t),
        (["Divide", 1, 8], lambda t: Fraction(1, 8)),
    ],
)
def test_affine_functions_have_their_values(expression, value):
    found = _affine(program(expression))
    assert [found.a + found.b * t for t in (0, 1, 7)] == [value(Fraction(t)) for t in (0, 1, 7)]


@pytest.mark.parametrize(
    "expression",
    [
        ["Multiply", "t", "t"],
        ["Multiply", "t", 2, "t"],
        ["Divide", 1, "t"],
        ["Divide", "t", ["Subtract", 1, 1]],
        ["Power", "t", 2],
        ["Sin", "t"],
        ["Add", "t", "Pi"],
        ["Add", "t", "x"],
    ],
)
def test_others_have_no_known_times(expression):
    assert _affine(program(expression)) is None


@pytest.mark.parametrize("engine", ["taylor", "runge-kutta", "robust"])
def test_a_narrow_pulse_after_a_change_of_sign_is_not_passed_over(engine):
    pushed = holonom.system("""load("holonom.mac")$
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2,
  forces = [push = [signum(t - 1) + 1000*exp(-(1000*(t - 7))^2)]])$
pushed : holonomic_scene(system, initial_state = [x = 0, dot(x) = 0], time_span = [0, 10])$""")
    motion = pushed.simulate(until=10, samples=2, engine=engine)
    assert motion["dot(x)"][-1] == pytest.approx(-1 + 9 + math.sqrt(math.pi), rel=1e-9)
