"""Power series and the controls of servo-constraints, put into the equations of motion."""

import math
import random
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

import holonom
from holonom.crosscheck.motion_program import ScenePrograms
from holonom.crosscheck.motion_series import ORDER, SceneSeries, _expanded, verify_series, verify_servo
from holonom.crosscheck.motions import read_motions
from holonom.crosscheck.questions import ask_for_check
from holonom.crosscheck.report import Verdict
from holonom.program.motion_problem import motion_problem
from holonom.program.motion_program import Call, Operation
from holonom.program.request import Request, Solve
from holonom.sandbox import Limits
from holonom.series.request import EXACT
from holonom.source import Source

EXAMPLES = Path(__file__).parents[2] / "examples"
# Exact and rounded coefficients, a table, prescribed reactions, redundant constraints, a length that vanishes.
FILES = ("paper/paper", "pendulum", "hoist", "prescribed_tension", "linkage", "hard/vanishing_length")
EACH = 6  # wrong series of each file


@pytest.mark.parametrize("name", FILES)
def test_right_series_agree_and_wrong_ones_are_found(name):
    source = Source(EXAMPLES / f"{name}.mac")
    found = read_motions(source.description(), ask_for_check(source, {})).series
    verdicts = verify_series(source.description(), found)
    digits = [50 if each.series.arithmetic == EXACT else 22 for each in found]
    assert [(each.found.verdict, each.found.digits) for each in verdicts] == [(Verdict.AGREES, n) for n in digits]
    draw = random.Random(name)
    for _ in range(EACH):
        wrong = changed(draw.choice(found), draw)
        (verdict,) = verify_series(source.description(), [wrong])
        assert verdict.found.verdict is Verdict.DISAGREES


def changed(found: SceneSeries, draw: random.Random) -> SceneSeries:
    """The series with one coefficient changed, of a coordinate, a multiplier or a control."""
    group = draw.choice([group for group in ("coordinates", "multipliers", "controls") if getattr(found.series, group)])
    rows = dict(getattr(found.series, group))
    name = draw.choice(list(rows))
    place = draw.randrange(2 if group == "coordinates" else 0, 8)
    row = list(rows[name])
    row[place] = str(Fraction(row[place]) * Fraction(1001, 1000) + Fraction(1, 10**6))
    return replace(found, series=replace(found.series, **{group: rows | {name: tuple(row)}}))


IRRATIONAL = """load("holonom.mac")$
system : holonomic_system(coordinates = [y, w], controls = [u], parameters = [k],
  kinetic_energy = (dot(y)^2 + dot(w)^2)/2, potential_energy = k*(y - w)^2/2, {forces}
  constraints = [w - u])$
scene : holonomic_scene(system, control_law = [u = 1 - cos(t)], parameter_values = [k = 2000],
  initial_state = [y = sqrt(2), dot(y) = 0], initial_guess = [w = 0, dot(w) = 0], time_span = [0, 4])$"""
DAMPING = "forces = [-k*(dot(y) - dot(w)), k*(dot(y) - dot(w))],"


@pytest.mark.parametrize("forces", ["", DAMPING], ids=["undamped", "stiff"])
def test_rounding_of_large_terms_in_a_small_residual_is_found_no_error(forces, tmp_path):
    """w is small, and follows from a large multiplier and a large force of the spring, rounded to 30 digits."""
    scene = tmp_path / "scene.mac"
    scene.write_text(IRRATIONAL.format(forces=forces))
    source = Source(scene)
    (found,) = read_motions(source.description(), ask_for_check(source, {})).series

    def verdict(each: SceneSeries) -> Verdict:
        return verify_series(source.description(), [each])[0].found.verdict

    assert verdict(found) is Verdict.AGREES
    for group, name in (("coordinates", "y"), ("coordinates", "w"), ("multipliers", "lambda1")):
        rows = getattr(found.series, group)
        row = list(rows[name])
        row[6] = str(Fraction(row[6]) * (1 + Fraction(1, 10**6)))
        wrong = replace(found, series=replace(found.series, **{group: rows | {name: tuple(row)}}))
        assert verdict(wrong) is Verdict.DISAGREES


@pytest.mark.parametrize("name", ["arm", "overhead_crane"])
def test_wrong_controls_of_servo_constraints_are_found(name):
    source = Source(EXAMPLES / f"{name}.mac")
    motions = read_motions(source.description(), ask_for_check(source, {}))
    series, (*_, programs) = motions.series, motions.programs
    description = source.description()
    assert [each.found.verdict for each in verify_servo(description, [programs], series)] == [Verdict.AGREES]
    for control in set(description.system.controls) - set(description.scenes[-1].control_law):
        wrong = with_control_changed(programs, control)
        assert [each.found.verdict for each in verify_servo(description, [wrong], series)] == [Verdict.DISAGREES]


@pytest.mark.parametrize("name", ["arm", "level_load", pytest.param("stewart_platform", marks=pytest.mark.long)])
def test_wrong_series_under_servo_constraints_are_found(name):
    """Coordinates, multipliers and controls, each coefficient changed in a draw."""
    source = Source(EXAMPLES / f"{name}.mac")
    motions, description = read_motions(source.description(), ask_for_check(source, {})), source.description()
    served = {scene.name for scene in description.scenes if scene.servo_trees}
    (*_, found) = (each for each in motions.series if each.scene in served)
    programs = [each for each in motions.programs if each.scene == found.scene]
    assert [each.found.verdict for each in verify_servo(description, programs, [found])] == [Verdict.AGREES]
    draw = random.Random(name)
    for _ in range(EACH):
        wrong = changed(found, draw)
        assert [each.found.verdict for each in verify_servo(description, programs, [wrong])] == [Verdict.DISAGREES]


def with_control_changed(programs: ScenePrograms, control: str) -> ScenePrograms:
    problem = programs.problems[Solve.DIRECT]
    assignments = tuple(
        (name, Call(Operation.MULTIPLY, (Fraction(1001, 1000), expression)) if name == control else expression)
        for name, expression in problem.motion.assignments
    )
    wrong = replace(problem, motion=replace(problem.motion, assignments=assignments))
    return replace(programs, problems=programs.problems | {Solve.DIRECT: wrong})


def test_a_motion_expanded_from_its_accelerations_is_the_cosine(tmp_path):
    """x = cos(2 t), with two powers more than its acceleration has."""
    scene = tmp_path / "scene.mac"
    scene.write_text("""load("holonom.mac")$
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, potential_energy = 2*x^2)$
scene : holonomic_scene(system, initial_state = [x = 1, dot(x) = 0], time_span = [0, 1])$""")
    known, computed = _expanded(motion_problem(scene, Request(), Limits()))
    coefficients = [0 if k % 2 else (-4) ** (k // 2) / math.factorial(k) for k in range(ORDER + 3)]
    assert [float(x) for x in known["x"]] == pytest.approx(coefficients, rel=1e-14)
    assert [float(x) for x in computed["ddot(x)"]] == pytest.approx([-4 * x for x in coefficients[:-2]], rel=1e-14)


def test_series_of_large_accelerations_agree(tmp_path):
    """One more than the initial acceleration, by which the next two powers were found, is the same in 60 digits."""
    scene = tmp_path / "scene.mac"
    scene.write_text("""load("holonom.mac")$
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, potential_energy = 10^240*x^2/2)$
scene : holonomic_scene(system, initial_state = [x = 1, dot(x) = 0])$""")
    source = Source(scene)
    found = read_motions(source.description(), ask_for_check(source, {})).series
    assert [each.found.verdict for each in verify_series(source.description(), found)] == [Verdict.AGREES]


def test_series_of_a_friction_that_begins_agree():
    """Their last powers followed from accelerations of the other sign."""
    scene = holonom.system("""system : holonomic_system(coordinates = [x, y], kinetic_energy = dot(x)^2 + dot(y)^2,
  potential_energy = 5*x^2 + 4*y^2, forces = [drag = [0, -signum(dot(y))]])$
scene : holonomic_scene(system, initial_state = [x = 1, y = 1, dot(x) = 0, dot(y) = 0], time_span = [0, 1])$""")
    assert not scene.check().disagreements


def test_a_parameter_that_no_motion_contains_needs_no_value():
    """Omega belongs to an effect that the scene leaves out; the check of an example ended with an error."""
    report = holonom.system("""
system : holonomic_system(coordinates = [x, y], parameters = [m, Omega], switches = [turning],
  kinetic_energy = [motion = m*((dot(x) - turning*Omega*y)^2 + (dot(y) + turning*Omega*x)^2)/2],
  constraints = [x^2 + y^2 - 1])$
scene : holonomic_scene(system, parameter_values = [m = 1], effects = [motion],
  initial_state = [x = 3/5, y = 4/5, dot(x) = 4/5], time_span = [0, 1])$""").check()
    assert {each.verdict for each in report.verdicts} <= {Verdict.PROVED, Verdict.AGREES, Verdict.NOTHING}
