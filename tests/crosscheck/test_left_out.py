"""An equation that should be there and is not: it disagrees, unless the record states why it was not made."""

import dataclasses

import pytest

from holonom.crosscheck import CheckReport, Verdict, check, check_record, lagranges_method
from holonom.crosscheck.check import (
    SERIES_IN_SCENE,
    SOLVED,
    SOLVED_IN_SCENE,
    STATED,
    STATED_IN_SCENE,
    UNDER_LAW_IN_SCENE,
)
from holonom.crosscheck.verdict import Comparison, Judgement
from holonom.record import Equation, LeftOut, Record, Relation, derived_record

TWICE = Relation(["Subscript", "A", 1, 1], 1)


@pytest.fixture
def nothing_held(every_term_record: Record, monkeypatch: pytest.MonkeyPatch) -> Record:
    """The record of the first derivation, without its equations and its scenes; the third opinion is not asked."""
    monkeypatch.setattr(lagranges_method, "can_take", lambda system: False)
    derived = dataclasses.replace(every_term_record.derivations[0], equations=())
    return dataclasses.replace(every_term_record, derivations=(derived,), scenes=())


def missing(report: CheckReport) -> set[str]:
    return {found.id for found in report.verdicts if found.verdict is Verdict.DISAGREES and not found.held}


def with_equations(record: Record, *equations: Equation) -> Record:
    derived = dataclasses.replace(record.derivations[0], equations=equations)
    return dataclasses.replace(record, derivations=(derived,))


def held(record: Record, wanted: str) -> Equation:
    (found,) = [each for each in record.derivations[0].equations if each.id == wanted]
    return found


def test_all_closed_forms_are_missed_of_a_system_that_has_readable_ones(nothing_held):
    assert missing(check_record(nothing_held)) == {*STATED, *SOLVED}


def test_the_stated_equations_alone_are_missed_of_a_system_that_is_too_large(nothing_held, monkeypatch):
    monkeypatch.setattr(check, "READABLE", 0)
    assert missing(check_record(nothing_held)) == {*STATED}


def test_of_a_large_system_that_has_some_closed_forms_the_others_are_missed(nothing_held, monkeypatch):
    monkeypatch.setattr(check, "READABLE", 0)
    one = Equation("free_motion_condition", "10", "condition of free motion", ())
    assert missing(check_record(with_equations(nothing_held, one))) == {*STATED, *SOLVED} - {one.id}


def test_what_was_left_out_for_a_reason_is_told_and_counts_for_nothing(nothing_held, every_term_record):
    why = LeftOut(("4", "8"), 900, 500)
    derived = dataclasses.replace(nothing_held.derivations[0], left_out=why)
    (scene, _) = every_term_record.scenes
    silent = dataclasses.replace(scene, equations=(), left_out=LeftOut(("18",), 900, 500))
    found = check_record(dataclasses.replace(nothing_held, derivations=(derived,), scenes=(silent,))).verdicts
    told = [(each.number, each.scene, each.held) for each in found if each.verdict is Verdict.LEFT_OUT]
    assert told == [("4", None, False), ("8", None, False), ("18", "whole", False)]
    assert {each.left_out.limit for each in found if each.verdict is Verdict.LEFT_OUT} == {500}


def test_what_is_wrong_disagrees_and_says_where(nothing_held, every_term_record):
    (constraint,) = held(every_term_record, "constraints").relations
    wrong = Equation("constraints", "1", "constraints", (Relation(constraint.left_tree, 1),))
    found = check_record(with_equations(nothing_held, wrong)).verdicts[0]
    assert found.verdict is Verdict.DISAGREES
    assert found.detail.startswith("constraint 1: the record gives")


def test_an_equation_that_nothing_is_known_of_disagrees(nothing_held):
    unknown = Equation("new", "20", "an equation of another paper", ())
    found = check_record(with_equations(nothing_held, unknown)).verdicts[0]
    assert (found.verdict, found.detail) == (Verdict.DISAGREES, "there is no comparison for this equation")


def test_what_cannot_be_compared_disagrees_and_says_what_it_is(nothing_held, every_term_record):
    split = held(every_term_record, "kinetic_energy")
    twice = dataclasses.replace(split, relations=(*split.relations, TWICE))
    found = check_record(with_equations(nothing_held, twice)).verdicts[0]
    assert found.verdict is Verdict.DISAGREES
    assert found.detail.startswith("the record holds an entry A[1, 1]")


def test_each_equation_is_looked_at_in_points_of_its_own_and_of_this_check(
    nothing_held, every_term_record, monkeypatch
):
    seeds = []

    def noted(_comparison: Comparison, seed: str) -> Judgement:
        seeds.append(seed)
        return Judgement(Verdict.NOTHING, None, None)

    monkeypatch.setattr(check, "judge", noted)
    some = [held(every_term_record, wanted) for wanted in ("constraints", "accelerations")]
    check_record(with_equations(nothing_held, *some), seed="this one")
    assert len(set(seeds)) == len(seeds) == 2
    assert all(seed.startswith("this one ") for seed in seeds)


def test_the_third_opinion_is_asked_for(nothing_held, monkeypatch):
    monkeypatch.undo()
    (asked,) = [each for each in check_record(nothing_held).verdicts if each.id == "lagranges_method"]
    assert asked.verdict is Verdict.AGREES


@pytest.mark.parametrize("kept", [(), ("initial_series",)], ids=["none", "the series"])
def test_what_a_scene_with_a_law_should_hold_is_missed(every_term_record, monkeypatch, kept):
    """Its series is expected where the closed forms are short, and where it is there without the others."""
    monkeypatch.setattr(lagranges_method, "can_take", lambda system: False)
    monkeypatch.setattr(check, "judge", lambda comparison, seed: Judgement(Verdict.NOTHING, None, None))
    monkeypatch.setattr(check, "READABLE_SERIES", 0 if kept else 10_000)
    scene = every_term_record.scenes[0]
    part = dataclasses.replace(scene, equations=tuple(each for each in scene.equations if each.id in kept))
    found = missing(check_record(dataclasses.replace(every_term_record, scenes=(part,))))
    everything = {*STATED_IN_SCENE, *SOLVED_IN_SCENE, *SERIES_IN_SCENE, *UNDER_LAW_IN_SCENE}
    assert found == everything - {*kept}


def test_points_are_drawn_afresh_for_each_check(nothing_held):
    assert check_record(nothing_held).seed != check_record(nothing_held).seed
    assert check_record(nothing_held, seed="again").seed == "again"


def test_a_derivation_is_of_its_own_effects_and_of_a_supported_mass_matrix_where_it_says_so(every_term_record):
    derived = every_term_record.derivations[1]
    claims = check._claims(every_term_record, dataclasses.replace(derived, mass_matrix="supported"))
    assert claims.known.supported
    assert claims.system.potential_energy == 0
    assert not check._claims(every_term_record, derived).known.supported


COUPLED = """
load("holonom.mac")$
system : holonomic_system(coordinates = [x, y, z],
  kinetic_energy = dot(x)^2 + dot(x)*dot(z) + dot(y)^2 + dot(z)^2 + x*dot(y), constraints = [x - y])$
"""


def test_zeros_left_out_of_a_large_mass_matrix_are_zeros_and_nothing_else_may_be(write_scene):
    record = derived_record(write_scene(COUPLED), closed_form_size=8)
    split = held(record, "kinetic_energy")
    names = [str(relation.left) for relation in split.relations]
    assert names == ["A[1, 1]", "A[1, 3]", "A[2, 2]", "A[3, 1]", "A[3, 3]", "B[1]", "B[2]", "B[3]", "T0"]
    assert "without the zeros off the diagonal" in split.name

    def verdict(equation: Equation) -> Verdict:
        found = next(each for each in check_record(with_equations(record, equation)).verdicts if each.id == equation.id)
        return found.verdict

    assert verdict(split) is Verdict.PROVED
    assert verdict(dataclasses.replace(split, relations=split.relations[:1] + split.relations[2:])) is Verdict.DISAGREES
