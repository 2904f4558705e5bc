"""Times at which a controlled length vanishes: a zero of the law, and a point without gradient on the constraint."""

import pickle
from math import pi, sqrt

import pytest
from problems import problem as example
from refusing import failing

from holonom.failures import ErrorKind, HolonomError
from holonom.program.motion_problem import MotionProblem, motion_problem
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.simulation.constraints.singularity import VanishingGradients, laws_of, zeros_of_controls
from holonom.simulation.matrices import MotionMatrices
from holonom.simulation.request import FINAL_STATE_ALONE, EngineName, SimulationRequest
from holonom.simulation.simulate import simulate

SCENE = """
load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  potential_energy = 10*y, constraints = [{constraint}])$
motion : holonomic_scene(system, control_law = [u = {law}], initial_state = [{state}], time_span = [0, {end}])$
"""
CIRCLE = "x^2 + y^2 - u^2"


@pytest.fixture
def described(write_scene):
    def describe(constraint: str, law: str, state: str, end: float = 2) -> MotionProblem:
        text = SCENE.format(constraint=constraint, law=law, state=state, end=end)
        return motion_problem(write_scene(text), Request(), Limits())

    return describe


def test_zeros_are_those_of_the_law(described):
    problem = described(CIRCLE, "cos(3*t)", "x = 0, y = -1, dot(x) = 0")
    assert zeros_of_controls(problem, laws_of(problem), 0.0, 2.0) == pytest.approx([pi / 6, pi / 2], abs=1e-15)


@pytest.mark.parametrize(
    ("law", "zeros"),
    [
        ("(t - 1)^2", [1]),
        ("(t - sqrt(2))^2*cos(3*t)", [pi / 6, sqrt(2), pi / 2]),
        ("1 - cos(9*t)", [2 * pi * k / 9 for k in (1, 2, 3)]),
        ("(t - sqrt(2))^2 + 10^-9", []),
    ],
)
def test_a_control_that_touches_zero_between_samples_was_taken_for_one_without_zeros(described, law, zeros):
    problem = described("y - u*x", law, "x = 0, y = 0, dot(x) = 0, dot(y) = 0")
    assert zeros_of_controls(problem, laws_of(problem), 0.0, 2.1) == pytest.approx(zeros, abs=1e-8)


@pytest.mark.parametrize("end", [2, 2.1])
def test_a_bob_drawn_into_its_hinge_and_out_again_went_on(described, end):
    """The time span decided: of 2 s, a sample was at the zero of the law."""
    problem = described(CIRCLE, "(1 - t)^2", "x = 0, y = -1, dot(x) = 0", end)
    with failing(ErrorKind.NO_GRADIENT, "t = 1,", "lambda1"):
        simulate(problem, SimulationRequest(samples=FINAL_STATE_ALONE))


@pytest.mark.parametrize(
    ("constraint", "state"),
    [
        ("y - u*x", "x = 1, y = 1, dot(x) = 0"),  # a gradient of at least one
        ("x^2 + y^2 - 2 - u", "x = 1, y = sqrt(2), dot(x) = 0"),  # a length that is not zero where its control is
        ("x*y - u*x - 1", "x = 1, y = 2, dot(x) = 0"),  # a hyperbola
    ],
)
def test_zeros_of_a_control_that_is_no_vanishing_length_are_harmless(described, constraint, state):
    problem = described(constraint, "1 - t", state)
    assert zeros_of_controls(problem, laws_of(problem), 0.0, 2.0) == [1.0]
    assert VanishingGradients(problem, MotionMatrices(problem), laws_of(problem), 2.0).times == []


def test_a_rate_that_is_a_number_hid_the_zero_of_its_law():
    """Where a parameter is open, values are put into programs, and dot(u) = -1 was no assignment any more."""
    problem = example("hard/vanishing_length.mac", "whirling_scene", open_parameters=("m",))
    assert zeros_of_controls(problem, laws_of(problem), 0.0, 2.0) == [1.0]
    assert VanishingGradients(problem, MotionMatrices(problem), laws_of(problem), 2.0).times == [1.0]


def test_length_vanishes_about_a_hinge_that_moves(described):
    """The point without gradient is the hinge, wherever it is then."""
    problem = described("(x - sin(t))^2 + y^2 - u^2", "1 - t", "x = 3/5, y = -4/5, dot(x) = 0")
    assert VanishingGradients(problem, MotionMatrices(problem), laws_of(problem), 2.0).times == [1.0]


@pytest.mark.parametrize("engine", [EngineName.AUTO, EngineName.TAYLOR])
def test_straight_way_into_the_hinge_is_stopped_although_nothing_in_the_motion_warns_of_it(described, engine):
    problem = described(CIRCLE, "1 - t", "x = 0, y = -1, dot(x) = 0")
    with failing(ErrorKind.NO_GRADIENT, "t = 1,", "lambda1"):
        simulate(problem, SimulationRequest(engine=engine, samples=FINAL_STATE_ALONE))


def test_a_law_in_parts_of_constant_rates_went_through_the_hinge(described):
    problem = described(CIRCLE, "if t < 1/2 then 1 else 3/2 - t", "x = 0, y = -1, dot(x) = 0")
    with failing(ErrorKind.NO_GRADIENT, "t = 1.5,", "lambda1"):
        simulate(problem, SimulationRequest(samples=FINAL_STATE_ALONE))


def test_motion_goes_on_past_a_zero_at_which_the_bob_is_far_from_the_hinge(described):
    """On the hyperbola x^2 - y^2 = u^2 the bob slides along the branch y = -x at u = 0, unless it is in the corner."""
    problem = described("x^2 - y^2 - u", "1 - t", "x = 2, y = -sqrt(3), dot(x) = 0")
    assert VanishingGradients(problem, MotionMatrices(problem), laws_of(problem), 2.0).times == [1.0]
    report = simulate(problem, SimulationRequest(samples=FINAL_STATE_ALONE)).report
    assert report.t == 2.0
    assert [segment.engine for segment in report.segments] == [EngineName.TAYLOR]
    assert report.coordinates["x"] ** 2 - report.coordinates["y"] ** 2 == pytest.approx(-1, abs=1e-12)


def test_a_refusal_holds_what_its_sentence_is_made_of_also_from_another_process():
    refused = HolonomError(ErrorKind.NO_GRADIENT, time=1.0, multiplier="lambda1")
    again = pickle.loads(pickle.dumps(refused))
    assert again.facts == {"time": 1.0, "multiplier": "lambda1"}
    assert str(again) == str(refused)
    assert (again.kind, again.facts) == (ErrorKind.NO_GRADIENT, {"time": 1, "multiplier": "lambda1"})
