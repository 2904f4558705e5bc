"""A scene's motion as Maxima hands it over."""

import pickle
from pathlib import Path

import pytest
from refusing import refused

from holonom.program.motion_problem import MotionProblem, motion_problem
from holonom.program.numpy_function import NumpyFunction
from holonom.program.request import Request
from holonom.program.rewriting import computing
from holonom.sandbox import Limits

PAPER = Path(__file__).parents[2] / "examples" / "paper" / "paper.mac"


@pytest.fixture(scope="module")
def paper() -> MotionProblem:
    return motion_problem(PAPER, Request(), Limits())


def test_paper_starts_where_the_scene_says(paper):
    assert paper.state == ("q1", "q2", "q3", "dot(q1)", "dot(q2)", "dot(q3)")
    start = {name: float(value) for name, value in paper.start.items()}
    # q3 = u0 (q1 + q2), and its rate under u = u0 + t, with u0 = 3/10
    assert start == pytest.approx(
        {"t": 0, "q1": 1, "q2": 2, "q3": 0.9, "dot(q1)": 1 / 2, "dot(q2)": -1 / 3, "dot(q3)": 3 + 0.3 / 6}
    )
    assert tuple(map(float, paper.time_span)) == (0, 10)


@pytest.mark.parametrize(("values", "start"), [("", {}), ("l = 2", {"x": 0, "y": -2, "dot(x)": 1, "dot(y)": 0})])
def test_a_start_has_numbers_for_all_or_there_is_none(values, start, write_scene):
    file = write_scene(f"""load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], parameters = [l], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  constraints = [x^2 + y^2 - l^2])$
swing : holonomic_scene(system, initial_state = [x = 0, y = -l, dot(x) = 1], time_span = [2, 5],
  parameter_values = [{values}])$""")
    found = motion_problem(file, Request(), Limits(), open_parameters=["l"]).start
    assert {name: float(value) for name, value in found.items()} == {"t": 2} | start


def test_another_process_has_all_but_what_was_compiled(paper):
    sent = pickle.loads(pickle.dumps(paper))
    assert (sent.start, sent.motion) == (paper.start, paper.motion)


def test_part_of_a_program_gives_the_numbers_of_the_whole(paper):
    part = computing(paper.motion, {"lambda1"})
    point = [0.1 * (k + 2) for k in range(len(part.inputs))]
    whole = dict(zip(paper.motion.outputs, NumpyFunction(paper.motion)(point), strict=True))
    assert NumpyFunction(part)(point) == pytest.approx([whole["lambda1"]])
    assert len(part.assignments) < len(paper.motion.assignments)
    assert part.operations < paper.motion.operations + len(paper.motion.assignments)


def test_a_constraint_given_twice_is_reported_and_its_multiplier_is_zero(write_scene):
    file = write_scene("""load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2, constraints = [x - y, x - y])$
slide : holonomic_scene(system, initial_state = [x = 0, dot(x) = 1])$""")
    problem = motion_problem(file, Request(), Limits())
    assert problem.obstruction is None
    assert problem.motion.redundant == ("lambda2",)
    assert problem.motion.outputs["lambda2"] == 0
    assert problem.independent == (0,)
    assert problem.dependent
    assert {"J[2,1]", "residual[2]", "h[1]"} <= problem.matrices.outputs.keys()


def test_control_without_a_law_is_refused(write_scene):
    file = write_scene("""load("holonom.mac")$
system : holonomic_system(coordinates = [x], controls = [u], kinetic_energy = dot(x)^2/2, potential_energy = u*x)$
pull : holonomic_scene(system, initial_state = [x = 0, dot(x) = 1])$""")
    with refused("control_without_law"):
        motion_problem(file, Request(), Limits())


def test_parameter_of_an_effect_that_is_not_called_for_needs_no_value(write_scene):
    text = """load("holonom.mac")$
system : holonomic_system(coordinates = [x], parameters = [c], kinetic_energy = dot(x)^2/2,
  forces = [drag = [-c*dot(x)]])$
glide : holonomic_scene(system, effects = {effects}, initial_state = [x = 0, dot(x) = 1])$"""
    assert motion_problem(write_scene(text.format(effects="[kinetic_energy]")), Request(), Limits()).scene == "glide"
    with refused("parameter_without_value"):
        motion_problem(write_scene(text.format(effects="all")), Request(), Limits())


CONTRADICTION = """
load("holonom.mac")$
pair : holonomic_system(
  coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  constraints = [x - y, x - y - t^3])$
pulled : holonomic_scene(pair, initial_state = [x = 0, y = 0, dot(x) = 1, dot(y) = 1])$
"""


def test_constraints_that_hold_together_at_the_start_alone_are_refused(write_scene):
    with refused("irregular_constraints"):
        motion_problem(write_scene(CONTRADICTION), Request(), Limits())
