"""Records of the examples pass; a record with one wrong relation does not.

The short form of the second is in test_derivation.py and test_initial_motion.py, on one system with every term.
"""

import dataclasses

import pytest
import sympy as sp

from holonom.crosscheck import EquationVerdict, Verdict, check_record
from holonom.crosscheck.points import fresh_seed, random_point
from holonom.crosscheck.verdict import Comparison, Pair, judge
from holonom.record import Equation, Record, Relation


def test_every_equation_of_an_example_is_proved(example_record: Record) -> None:
    report = check_record(example_record)
    assert not report.disagreements, [found for found in report.verdicts if found.verdict is Verdict.DISAGREES]
    judged = [found for found in report.verdicts if "SymPy" not in found.name]
    assert {found.verdict for found in judged if found.verdict is not Verdict.NOTHING} == {Verdict.PROVED}
    parts = (*example_record.derivations, *example_record.scenes)
    empty = {equation.name for each in parts for equation in each.equations if not equation.relations}
    assert {found.name for found in judged if found.verdict is Verdict.NOTHING} == empty


def test_every_equation_has_one_verdict_and_the_third_opinion_is_asked(
    paper_record: Record,
) -> None:
    numbers = [found.number for found in check_record(paper_record).verdicts if not found.scene]
    held = [equation.number for equation in paper_record.derivations[0].equations]
    assert numbers == [*held, "2"]


@pytest.mark.long
def test_each_wrong_relation_is_found(example_record: Record) -> None:
    """Each relation of each equation in turn, its right side larger by a thousandth."""
    for equation in example_record.derivations[0].equations:
        for wrong in with_one_relation_changed(equation):
            found = verdict_on(with_equation(example_record, wrong))
            assert found.verdict is Verdict.DISAGREES, wrong


@pytest.mark.long
def test_each_wrong_relation_of_a_scene_is_found(example_record: Record) -> None:
    for equation in example_record.scenes[0].equations:
        for wrong in with_one_relation_changed(equation):
            found = verdict_on_scene(with_equation_in_scene(example_record, wrong))
            assert found.verdict is Verdict.DISAGREES, wrong


@pytest.mark.long
def test_each_relation_left_out_is_found(paper_record: Record) -> None:
    """Left out, an entry of A, B, T0 or A_inverse is zero: those that are zero may be left out."""
    for equation in paper_record.derivations[0].equations:
        for i, relation in enumerate(equation.relations):
            if relation.right == 0 and isinstance(relation.left, sp.Indexed | sp.Symbol):
                continue
            kept = equation.relations[:i] + equation.relations[i + 1 :]
            short = dataclasses.replace(equation, relations=kept)
            assert verdict_on(with_equation(paper_record, short)).verdict is Verdict.DISAGREES, short


@pytest.mark.parametrize("number", ["1", "2", "3a", "3", "4", "5", "6", "7", "8", "9", "10", "11"])
def test_equation_left_out_is_missed(paper_record: Record, number: str) -> None:
    held = paper_record.derivations[0].equations
    kept = tuple(equation for equation in held if equation.number != number)
    missing = [
        found.id
        for found in check_record(with_equations(paper_record, kept)).verdicts
        if not found.held and found.scene is None
    ]
    assert sorted(missing) == sorted(equation.id for equation in held if equation.number == number)


@pytest.mark.parametrize("number", ["10", "12", "13", "18", "19"])
def test_equation_of_a_scene_left_out_is_missed(paper_record: Record, number: str) -> None:
    scene = paper_record.scenes[0]
    kept = tuple(equation for equation in scene.equations if equation.number != number)
    record = dataclasses.replace(paper_record, scenes=(dataclasses.replace(scene, equations=kept),))
    missing = [found for found in check_record(record).verdicts if not found.held]
    assert [(found.number, found.scene) for found in missing] == [(number, scene.name)]


def with_one_relation_changed(equation: Equation) -> list[Equation]:
    changed = []
    for i, relation in enumerate(equation.relations):
        larger = Relation(relation.left_tree, ["Add", relation.right_tree, ["Rational", 1, 1000]])
        relations = (*equation.relations[:i], larger, *equation.relations[i + 1 :])
        changed.append(dataclasses.replace(equation, relations=relations))
    return changed


def with_equations(record: Record, equations: tuple[Equation, ...]) -> Record:
    derived = dataclasses.replace(record.derivations[0], equations=equations)
    return dataclasses.replace(record, derivations=(derived,))


def with_equation(record: Record, equation: Equation) -> Record:
    """The record with nothing but this equation in its derivation."""
    return dataclasses.replace(with_equations(record, (equation,)), scenes=())


def with_equation_in_scene(record: Record, equation: Equation) -> Record:
    """The record with nothing but this equation in its first scene, and none in its derivation."""
    scene = dataclasses.replace(record.scenes[0], equations=(equation,))
    return dataclasses.replace(with_equations(record, ()), scenes=(scene,))


def verdict_on(record: Record) -> EquationVerdict:
    return check_record(record).verdicts[0]


def verdict_on_scene(record: Record) -> EquationVerdict:
    return next(found for found in check_record(record).verdicts if found.scene)


def test_points_are_drawn_afresh_and_a_seed_draws_them_again(paper_record):
    """A record that is made to vanish at the points of one check is found out by the next one."""
    wrong = with_equations(paper_record, ())
    first, second = check_record(wrong), check_record(wrong)
    assert first.seed != second.seed
    assert random_point(["x"], 0, f"{first.seed} 2") != random_point(["x"], 0, f"{second.seed} 2")
    assert check_record(wrong, first.seed) == first


def test_a_record_forged_to_vanish_at_all_points_of_a_seed_disagrees_under_another():
    x = sp.Symbol("x", real=True)
    points = [random_point(["x"], attempt, "known")[x] for attempt in range(100)]
    forged = Comparison((Pair("x", x + sp.prod(x - point for point in points), x),))
    assert judge(forged, "known").verdict is not Verdict.DISAGREES
    assert judge(forged, fresh_seed()).verdict is Verdict.DISAGREES
