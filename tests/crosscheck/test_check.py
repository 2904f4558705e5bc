"""Records of the examples pass; a record with one wrong relation does not.

The short form of the second is in test_derivation.py and test_initial_motion.py, on one system with every term; that
nothing is missing and nothing too much is in test_skeleton.py.
"""

import dataclasses
from types import SimpleNamespace

import pytest
import sympy as sp

import holonom
from holonom.crosscheck.check import check_record
from holonom.crosscheck.draws import Draws
from holonom.crosscheck.points import random_point
from holonom.crosscheck.questions import holds_special_functions
from holonom.crosscheck.report import EquationVerdict, Verdict
from holonom.crosscheck.seed import fresh_seed
from holonom.crosscheck.verdict import Comparison, Pair, verify
from holonom.description import Description
from holonom.expression.functions import FUNCTIONS
from holonom.record import Equation, Record, Relation

NUMERICAL = ("lagranges_method", "redundant_constraints")  # verdicts that are never proofs


def test_every_equation_of_an_example_is_proved(example_record: Record, example_description: Description) -> None:
    report = check_record(example_record, example_description)
    assert not report.disagreements, [found for found in report.verdicts if found.verdict is Verdict.DISAGREES]
    with_verdicts = [found for found in report.verdicts if found.id not in NUMERICAL]
    assert {found.verdict for found in with_verdicts if found.verdict is not Verdict.NOTHING} == {Verdict.PROVED}
    parts = (*example_record.derivations, *example_record.scenes)
    empty = {equation.name for each in parts for equation in each.equations if not equation.relations}
    assert {found.name for found in with_verdicts if found.verdict is Verdict.NOTHING} == empty


def test_every_equation_has_one_verdict_and_the_third_opinion_is_asked(
    paper_record: Record, paper_description: Description
) -> None:
    verdicts = check_record(paper_record, paper_description).verdicts
    recorded = [equation.id for equation in paper_record.derivations[0].equations]
    assert [found.id for found in verdicts if not found.scene] == [*recorded, *NUMERICAL]


@pytest.mark.long
def test_each_wrong_relation_is_found(example_record: Record, example_description: Description) -> None:
    """Each relation of each equation in turn, its right side larger by a thousandth, or not there."""
    (derived, *others) = example_record.derivations
    for i, equation in enumerate(derived.equations):
        for wrong in with_one_relation_changed(equation):
            equations = (*derived.equations[:i], wrong, *derived.equations[i + 1 :])
            changed = dataclasses.replace(derived, equations=equations)
            false = dataclasses.replace(example_record, derivations=(changed, *others), scenes=())
            assert verdict_on(wrong, false, example_description).verdict is Verdict.DISAGREES, wrong


@pytest.mark.long
def test_each_wrong_relation_of_a_scene_is_found(example_record: Record, example_description: Description) -> None:
    scene = example_record.scenes[0]
    for i, equation in enumerate(scene.equations):
        for wrong in with_one_relation_changed(equation):
            equations = (*scene.equations[:i], wrong, *scene.equations[i + 1 :])
            changed = dataclasses.replace(scene, equations=equations)
            false = dataclasses.replace(example_record, scenes=(changed,))
            assert verdict_on(wrong, false, example_description).verdict is Verdict.DISAGREES, wrong


def with_one_relation_changed(equation: Equation) -> list[Equation]:
    changed = []
    for i, relation in enumerate(equation.relations):
        before, after = equation.relations[:i], equation.relations[i + 1 :]
        larger = Relation(relation.left_tree, ["Add", relation.right_tree, ["Rational", 1, 1000]])
        changed.append(dataclasses.replace(equation, relations=(*before, larger, *after)))
        changed.append(dataclasses.replace(equation, relations=(*before, *after)))
    return changed


def verdict_on(equation: Equation, record: Record, description: Description) -> EquationVerdict:
    found = check_record(record, description).verdicts
    return next(each for each in found if each.id == equation.id)


def test_points_are_drawn_afresh_and_a_seed_draws_them_again(paper_record, paper_description):
    """A record that is made to vanish at the points of one check is found out by the next one."""
    wrong = dataclasses.replace(paper_record, scenes=(), derivations=())
    first, second = check_record(wrong, paper_description), check_record(wrong, paper_description)
    assert first.seed != second.seed
    assert random_point(["x"], 0, f"{first.seed} 2") != random_point(["x"], 0, f"{second.seed} 2")
    assert check_record(wrong, paper_description, first.seed) == first


def test_a_record_forged_to_vanish_at_all_points_of_a_seed_disagrees_under_another():
    x = sp.Symbol("x", real=True)
    draws = Draws(["x"], (), "known")
    points = [draws.point(attempt)[x] for attempt in range(8)]
    forged = Comparison((Pair("x", x + sp.prod(x - point for point in points), x),))
    assert verify(forged, "known").points == 8
    assert verify(forged, "known").verdict is not Verdict.DISAGREES
    assert verify(forged, fresh_seed()).verdict is Verdict.DISAGREES


@pytest.mark.parametrize("force", ["-abs(x)^(2/3)*signum(x)", "x^(1/3)", "x^(-7/5)*dot(x)", "u^(1/3)/(m*x)^(2/3)"])
def test_real_roots_of_negative_numbers_are_those_of_sympy(force):
    """To Maxima (-8)^(1/3) is -2; to SymPy it is a complex number."""
    report = holonom.system(f"""
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [m], constraints = [y - u*x],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, forces = [{force}, 0])$
motion : holonomic_scene(system, control_law = [u = -1 - t], parameter_values = [m = 2],
  initial_state = [x = -1, dot(x) = 0], time_span = [0, 1])$""").check()
    assert not report.disagreements, [found for found in report.verdicts if found.verdict is Verdict.DISAGREES]
    assert Verdict.UNDECIDED not in {found.verdict for found in report.verdicts}


@pytest.mark.parametrize("contact", ["20*max(0, -x)^(3/2)", "if x > 0 then -2*sqrt(x) else -3*x", "3*abs(x)^(3/2)"])
def test_roots_in_a_branch_left_the_program_undecided(contact):
    report = holonom.system(f"""system : holonomic_system(coordinates = [x],
  kinetic_energy = dot(x)^2/2, forces = [{contact}])$
scene : holonomic_scene(system, initial_state = [x = 1, dot(x) = 0], time_span = [0, 1])$""").check()
    assert {found.verdict for found in report.verdicts} <= {Verdict.PROVED, Verdict.AGREES, Verdict.NOTHING}


@pytest.mark.parametrize(
    ("law", "start"), [("(t - sqrt(2))^2", "sqrt(2)"), ("1 + max(0, t - 1/3)^2", "1/3"), ("sin(abs(t - %pi))", "%pi")]
)
def test_the_check_took_rounded_initial_times_for_exact_ones(law, start):
    report = holonom.system(f"""
system : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  potential_energy = 10*y, constraints = [y - u])$
motion : holonomic_scene(system, control_law = [u = {law}], initial_state = [x = 0, dot(x) = 1],
  time_span = [{start}, 4])$""").check()
    assert not report.disagreements


@pytest.mark.parametrize(("force", "start"), [("t - sqrt(2)", "sqrt(2)"), ("abs(sin(t))*x", "%pi")])
def test_forces_that_cancel_at_an_irrational_time_were_wrong(force, start):
    report = holonom.system(f"""
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [{force}])$
motion : holonomic_scene(system, initial_state = [x = 2, dot(x) = 0], time_span = [{start}, 4])$""").check()
    assert not report.disagreements


@pytest.mark.parametrize(("bend", "speed"), [("x*abs(x)", 0), ("max(x^3, 0)", 1), ("x^(5/3)", 0)])
def test_a_constraint_without_derivatives_in_the_start_was_an_internal_error(bend, speed):
    report = holonom.system(f"""
system : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  constraints = [y - {bend} - u])$
motion : holonomic_scene(system, control_law = [u = t], initial_state = [x = 0, dot(x) = {speed}])$""").check()
    assert not report.disagreements
    assert Verdict.UNDECIDED in {found.verdict for found in report.verdicts}


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda each: each.head)
def test_special_functions_are_met_in_a_description_by_their_heads(function):
    """Maxima takes minutes to evaluate one in 50 digits, which is therefore not asked for."""
    description = SimpleNamespace(text=f'{{"forces": ["{function.head}", "t"]}}')
    assert holds_special_functions(description) is function.special
