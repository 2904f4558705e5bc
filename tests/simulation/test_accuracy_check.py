"""What is out of proportion to its tolerance is no result."""

import json
import math
from fractions import Fraction

import numpy as np
import pytest

from holonom.program.motion_program import Call, Name, Operation, Program
from holonom.program.precision import read_precision
from holonom.program.request import Solve
from holonom.simulation.accuracy_check import FINEST, expected, finest, may_hide, trusted, violations

EXPECTED = {"position": 1e-16, "velocity": 1e-15, "energy": 1e-13}


def test_the_errors_of_a_motion_that_was_followed_are_in_proportion():
    assert not list(violations(EXPECTED, 1e-16, 500))


def test_a_position_residual_of_0_04_and_an_energy_error_of_13_were_passed_over():
    found = list(violations({**EXPECTED, "position": 0.04, "energy": 13.0 / 40.0}, 1e-16, 100))
    assert [violation.quantity for violation in found] == ["position", "energy"]
    assert found[1].error == 13.0 / 40.0


@pytest.mark.parametrize(("tol", "steps"), [(1e-15, 1), (1e-30, 1), (1e-30, 0), (1e-14, 10), (1e-12, 1000), (1e-7, 70)])
def test_errors_may_grow_with_tolerance_and_steps_and_rounding_is_no_error(tol, steps):
    allowed = float(expected(tol, steps))
    assert allowed == pytest.approx(min(1e4 * max(tol, 1e-15) * max(1, steps), 0.01))
    for value, rejected in ((0.0, False), (allowed, False), (np.nextafter(allowed, 1), True), (math.inf, True)):
        assert list(violations({"energy": value}, tol, steps)) == [("energy", value, allowed)] * rejected
        assert trusted({"energy": np.array([value])}, tol, np.array([steps])).tolist() == [not rejected]


def test_more_digits_are_checked_to_the_last_and_residuals_in_double_precision():
    quadruple = finest(read_precision("quadruple"))
    assert quadruple == pytest.approx(1e-33)
    assert finest(read_precision("double")) == pytest.approx(FINEST)
    errors = {"position": 1e-14, "velocity": 1e-14, "energy": 1e-20}
    assert not list(violations(errors, 2e-34, 50))
    assert [violation.quantity for violation in violations(errors, 2e-34, 50, quadruple)] == ["energy"]


def test_what_is_no_number_is_no_result():
    assert [violation.quantity for violation in violations({**EXPECTED, "energy": math.nan}, 1e-3, 10)] == ["energy"]


WELL = """
load("holonom.mac")$
system : holonomic_system(
  coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2, {place}, constraints = [y - x^2])$
scene : holonomic_scene(system, initial_state = [x = 0, dot(x) = 1], time_span = [0, 1])$
"""
NARROW = {
    "a well, which leaves the energy as it was": "potential_energy = -exp(-(1000*(x - 1/2))^2)/10",
    "a force that is no gradient, whose power was taken for none": "forces = [-exp(-(2000*(x - 1/2))^2), 0]",
}


@pytest.fixture
def simulated(holonom_here, write_scene):
    def simulate(place: str, *options: str):
        return holonom_here("simulate", write_scene(WELL.format(place=place)), *options, "--final", "--json", "-")

    return simulate


@pytest.mark.parametrize("engine", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("place", NARROW.values(), ids=NARROW)
def test_steps_that_miss_a_narrow_place_are_repeated(simulated, place, engine):
    done, short = simulated(place, "--engine", engine), simulated(place, "--max-step", "0.001")
    assert (done.returncode, done.stderr) == (0, "")
    found, expected = (json.loads(each.stdout) for each in (done, short))
    assert found["coordinates"] == pytest.approx(expected["coordinates"], rel=1e-12)


def test_a_narrow_place_was_passed_over_in_silence(simulated):
    done = simulated(NARROW["a force that is no gradient, whose power was taken for none"], "--engine", "robust")
    found = json.loads(done.stdout)
    assert (done.returncode, found["trusted"]) == (1, False)
    assert "acceleration" in [violation["quantity"] for violation in found["violations"]]
    assert "--max-step" in done.stderr


@pytest.mark.parametrize("place", NARROW.values(), ids=NARROW)
def test_a_narrow_place_that_the_steps_look_at_is_no_violation(simulated, place):
    done = simulated(place, "--max-step", "0.001")
    found = json.loads(done.stdout)
    assert (done.returncode, found["trusted"], done.stderr) == (0, True, "")


def test_exponentials_and_high_powers_of_the_state_alone_can_hide():
    def of(*expressions) -> bool:
        named = tuple((f"w{place}", expression) for place, expression in enumerate(expressions))
        return may_hide(Program(None, Solve.DIRECT, "composed", ("t", "x"), named, {"h": Name("w0")}))

    x, t = Name("x"), Name("t")
    assert of(Call(Operation.EXP, (x,)))
    assert of(Call(Operation.NEGATE, (x,)), Call(Operation.EXP, (Name("w0"),)))
    assert of(Call(Operation.ADD, (Fraction(1), Call(Operation.POWER, (x, Fraction(-1000))))))
    assert of(Call(Operation.POWER, (x, x)))
    assert not of(Call(Operation.EXP, (t,)))
    assert not of(Call(Operation.NEGATE, (t,)), Call(Operation.EXP, (Name("w0"),)))
    assert not of(Call(Operation.SIN, (x,)))
    assert not of(Call(Operation.POWER, (x, Fraction(2))))


ROUGH = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2, constraints = [y],
  forces = [friction = [-dot(x)/sqrt(dot(x)^2 + dot(y)^2)/2, 0], pull = [-x, 0]])$
s : holonomic_scene(system, initial_state = [x = 1, y = 0, dot(x) = 1, dot(y) = 0], time_span = [0, 3])$
"""


def test_a_velocity_over_its_size_ends_where_it_vanishes(tmp_path, holonom_here):
    scene = tmp_path / "rough.mac"
    scene.write_text(ROUGH)
    answer = holonom_here("simulate", str(scene), "--engine", "taylor", "--final")
    assert (answer.returncode, "0.5880026035" in answer.stderr) == (2, True)  # atan(2/3)
