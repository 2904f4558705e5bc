"""Open parameters: one derivation and one compilation for all their values, and a start that follows them."""

from fractions import Fraction
from pathlib import Path

import heyoka
import numpy as np
import pytest
from refusing import failing, refused

import holonom
from holonom.failures import ErrorKind
from holonom.program.motion_problem import motion_problem
from holonom.program.numpy_function import NumpyFunction
from holonom.program.request import Request
from holonom.program.sign_pattern import with_values_in
from holonom.sandbox import Limits
from holonom.simulation import derivations
from holonom.simulation.engines import taylor
from holonom.simulation.engines.engine import Task, advance
from holonom.simulation.initial_state import InitialStates, at_values

EXAMPLES = Path(__file__).parents[2] / "examples"
HANGING = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [m, g],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, potential_energy = m*g*y, constraints = [x^2 + y^2 - u^2])$
hanging : holonomic_scene(system, control_law = [u = l0 + v*t], parameter_values = [m = 1, g = 10, l0 = 1, v = 1/10],
  initial_state = [x = 1/10, dot(x) = 1/10], initial_guess = [y = -1, dot(y) = 0], time_span = [0, 2])$"""
LINEAR = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], parameters = [k],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2, constraints = [y - k*x - t])$
slide : holonomic_scene(system, parameter_values = [k = 1], initial_state = [x = k^2, dot(x) = 1/k],
  time_span = [0, 1])$"""
CUBIC = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], parameters = [k],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2, constraints = [y^3 + k*y - x])$
slide : holonomic_scene(system, parameter_values = [k = 1], initial_state = [x = 2, dot(x) = 1], time_span = [0, 1])$"""
IN_PARTS = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [m],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, constraints = [x^2 + y^2 - u^2])$
paid_out : holonomic_scene(system, control_law = [u = if t < b then 1 else 1 + t - b],
  parameter_values = [m = 1, b = 1], initial_state = [x = 3/5, dot(x) = 0],
  initial_guess = [y = -1, dot(y) = 0], time_span = [0, 2])$"""


@pytest.fixture(scope="module")
def hanging(tmp_path_factory):
    file = tmp_path_factory.mktemp("scene") / "hanging.mac"
    file.write_text(HANGING)
    return file


@pytest.fixture(scope="module")
def problem(hanging):
    return motion_problem(hanging, Request(), Limits(), open_parameters=("l0", "m", "v", "N"))


def test_the_parameters_among_the_names_stay_open(problem):
    assert problem.parameters == ("l0", "m", "v")
    assert (
        problem.motion.inputs[-3:] == problem.energy.inputs[-3:] == problem.projection.inputs[-3:] == ("l0", "m", "v")
    )
    assert {name: float(value) for name, value in problem.values.items()} == {"l0": 1, "m": 1, "v": 0.1}


def test_open_programs_with_numbers_in_them_are_those_derived_with_the_numbers(hanging, problem):
    settings = {"l0": "3/2", "m": "2", "v": "-1/5"}
    derived = motion_problem(hanging, Request(settings=settings), Limits())
    filled = with_values_in(at_values(problem, {"l0": 1.5, "m": 2, "v": -0.2}))
    points = np.random.default_rng(2).uniform(0.5, 1.5, (len(derived.motion.inputs), 5))
    for part in ("motion", "projection", "matrices", "energy"):
        theirs, ours = getattr(derived, part), getattr(filled, part)
        found = dict(zip(ours.outputs, NumpyFunction(ours)(points), strict=True))
        for name, row in zip(theirs.outputs, NumpyFunction(theirs)(points), strict=True):
            assert found[name] == pytest.approx(row, rel=1e-12), (part, name)


def test_motions_of_two_values_do_not_share_their_state(problem):
    numbers = ({"l0": "3/2", "m": "2", "v": "-1/5"}, {"l0": "1", "m": "1", "v": "1/10"})
    values = [{name: Fraction(text) for name, text in each.items()} for each in numbers]
    alone = []
    for each in values:
        engine = taylor.TaylorEngine(Task.of(at_values(problem, each)))
        advance(engine, 1.0)
        alone.append(engine.state.copy())
    both = [taylor.TaylorEngine(Task.of(at_values(problem, each))) for each in values]
    for engine in both:
        advance(engine, 1.0)
    assert [engine.state.tolist() for engine in both] == [state.tolist() for state in alone]


def test_the_start_on_the_circle_follows_its_radius_and_its_rate(problem):
    l0, v = np.linspace(0.5, 3, 11), np.linspace(-1, 1, 11)
    starts = InitialStates(problem)(np.array([l0, np.ones(11), v]))
    y = -np.sqrt(l0**2 - 0.01)
    assert starts.found.all()
    assert starts.states[0] == pytest.approx(np.full(11, 0.1))
    assert starts.states[1] == pytest.approx(y, rel=1e-14)
    assert starts.states[3] == pytest.approx((l0 * v - 0.01) / y, rel=1e-13, abs=1e-14)


@pytest.mark.long
def test_a_circle_too_small_for_its_data_has_no_start_and_leaves_the_others_theirs(problem):
    l0 = np.array([0.05, 1.0, 0.0, 2.0])
    starts = InitialStates(problem)(np.array([l0, np.ones(4), np.zeros(4)]))
    assert starts.found.tolist() == [False, True, False, True]
    alone = InitialStates(problem)(np.array([[2.0], [1.0], [0.0]]))
    assert (alone.states[:, 0] == starts.states[:, 3]).all()


def test_data_may_contain_parameters_and_what_is_linear_needs_no_guess(write_scene):
    problem = motion_problem(write_scene(LINEAR), Request(), Limits(), open_parameters=("k",))
    k = np.array([[0.5, 2.0, -3.0, 0.0]])
    starts = InitialStates(problem)(k)
    assert starts.found.tolist() == [True, True, True, False]  # dot(x) = 1/k
    k = k[0, :3]
    assert starts.states[:, :3] == pytest.approx(np.array([k**2, k**3, 1 / k, np.full(3, 2.0)]), rel=1e-14)


def test_a_start_without_a_guess_is_followed_from_the_scenes_own(write_scene):
    file = write_scene(CUBIC)
    problem = motion_problem(file, Request(), Limits(), open_parameters=("k",))
    k = np.array([[1.0, 3.0, 8.0, -3.0]])
    starts = InitialStates(problem)(k)
    assert starts.found.all()  # also where the slope 3 y^2 + k vanishes, at y = 1 for k = -3
    y = starts.states[1]
    assert y**3 + k[0] * y == pytest.approx(np.full(4, 2.0), rel=1e-14)
    with failing(ErrorKind.NO_INITIAL_STATE):
        at_values(problem, {"k": Fraction(3)})
    found = holonom.load(file).simulate(k=3, samples=2)  # Maxima counts the roots for each number
    assert found["y"][0] == pytest.approx(y[1], rel=1e-14)


def test_a_law_in_parts_leaves_the_start_its_first_part(write_scene):
    problem = motion_problem(write_scene(IN_PARTS), Request(), Limits(), open_parameters=("m", "b"))
    values = np.array([[1.0, 2.0, 1.0], [1.0, 5.0, -1.0]])
    starts = InitialStates(problem)(values)
    assert starts.found.all()
    assert starts.states[1] == pytest.approx([-0.8, -0.8, -(3.64**0.5)], rel=1e-14)  # u = 1 before b, 2 from it on
    moved = at_values(problem, {"m": Fraction(2), "b": Fraction(5)})
    assert float(moved.start["y"]) == pytest.approx(-0.8, rel=1e-14)


def test_data_that_contradict_the_constraints_for_other_values_are_refused_with_their_sentence():
    scene = holonom.load(EXAMPLES / "pendulum.mac", scene="swing_scene")
    assert scene.simulate(until=1, samples=2, g=5)["x"][0] == pytest.approx(np.sin(np.pi / 13))
    with refused("contradicting_start"):
        scene.simulate(until=1, samples=2, l0=2)


def test_a_second_value_derives_and_compiles_nothing(hanging, monkeypatch):
    monkeypatch.setattr(taylor, "worthwhile_code", lambda *_: None)  # better code for long runs, by the clock
    scene = holonom.load(hanging)
    first = scene.simulate(samples=3, l0=1.5, m=2)

    def refuse(*_, **__):
        raise AssertionError("this was done before")

    monkeypatch.setattr(derivations, "motion_problem", refuse)
    monkeypatch.setattr(heyoka, "cfunc", refuse)
    monkeypatch.setattr(heyoka, "taylor_adaptive", refuse)
    second = scene.simulate(samples=3, l0=2, m=3)
    again = scene.with_settings(m=2).simulate(samples=3, l0="3/2")
    monkeypatch.undo()
    assert (again["y"] == first["y"]).all()
    alone = holonom.load(hanging).simulate(samples=3, l0=2, m=3)
    assert second["lambda1"] == pytest.approx(alone["lambda1"], rel=1e-12)
    assert second["y"] == pytest.approx(alone["y"], rel=1e-13)


def test_a_mass_of_zero_is_derived_with_the_zero_in_it(write_scene):
    scene = holonom.load(
        write_scene("""load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], parameters = [m],
  kinetic_energy = (dot(x)^2 + m*dot(y)^2)/2, constraints = [y - x])$
slide : holonomic_scene(system, parameter_values = [m = 1], initial_state = [x = 0, dot(x) = 1],
  time_span = [0, 1])$""")
    )
    assert scene.simulate(samples=2, m=1)["x"][-1] == pytest.approx(1)
    assert scene.simulate(samples=2, m=0)["x"][-1] == pytest.approx(1)


def test_a_setting_that_is_no_parameter_changes_the_equations(write_scene):
    """A force of 2 moves the mass M by 1/M in the time 1."""
    scene = holonom.load(
        write_scene("""load("holonom.mac")$
system : holonomic_system(coordinates = [x], kinetic_energy = setting('M, 1)*dot(x)^2/2, forces = [2])$
push : holonomic_scene(system, initial_state = [x = 0, dot(x) = 0], time_span = [0, 1])$""")
    )
    moved = [scene.simulate(samples=2, M=mass)["x"][-1] for mass in (1, 4, 5)]
    assert moved == pytest.approx([1, 1 / 4, 1 / 5])
