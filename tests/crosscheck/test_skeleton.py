"""Which equations a record holds: all that belong there, each once, in order and under its names, and no others."""

import dataclasses
from collections.abc import Callable

import pytest
import sympy as sp

from holonom.crosscheck import check, lagranges_method
from holonom.crosscheck.check import check_record
from holonom.crosscheck.report import CheckResult, Verdict
from holonom.crosscheck.time_limit import TimeLimit
from holonom.description import Description
from holonom.record import Equation, LeftOut, Record, Relation, derived_record
from holonom.source import Source

AGREES = CheckResult(Verdict.AGREES, 50, 8)
SHORT = {"closed_form_size": "8"}


@pytest.fixture
def all_agrees(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every comparison that can be made agrees; the third opinion is not asked, and no rank is found."""
    monkeypatch.setattr(lagranges_method, "can_take", lambda system: False)
    monkeypatch.setattr(check, "verify_all", lambda comparisons, seed: AGREES)
    monkeypatch.setattr(check, "verify_redundancy", lambda *arguments: AGREES)


def disagreeing(record: Record, description: Description) -> set[str]:
    report = check_record(record, description)
    return {found.id for found in report.verdicts if found.verdict is Verdict.DISAGREES}


def with_equations(record: Record, *equations: Equation) -> Record:
    derived = dataclasses.replace(record.derivations[0], equations=equations)
    return dataclasses.replace(record, derivations=(derived, *record.derivations[1:]))


def with_derivation(record: Record, **changes: object) -> Record:
    derived = dataclasses.replace(record.derivations[0], **changes)
    return dataclasses.replace(record, derivations=(derived, *record.derivations[1:]))


def with_scene(record: Record, **changes: object) -> Record:
    scene = dataclasses.replace(record.scenes[0], **changes)
    return dataclasses.replace(record, scenes=(scene, *record.scenes[1:]))


def equation_of(record: Record, wanted: str) -> Equation:
    (found,) = [each for each in record.derivations[0].equations if each.id == wanted]
    return found


@pytest.mark.usefixtures("all_agrees")
class TestEquations:
    def test_the_true_record_has_what_belongs_there(self, every_term_record, every_term_description):
        assert not disagreeing(every_term_record, every_term_description)

    def test_each_equation_left_out_is_missed(self, every_term_record, every_term_description):
        for part in ("derivations", "scenes"):
            first, *others = getattr(every_term_record, part)
            for each in first.equations:
                remaining = tuple(equation for equation in first.equations if equation != each)
                parts = (dataclasses.replace(first, equations=remaining), *others)
                false = dataclasses.replace(every_term_record, **{part: parts})
                assert each.id in disagreeing(false, every_term_description)

    def test_each_equation_twice_or_under_another_name_is_found(self, every_term_record, every_term_description):
        equations = every_term_record.derivations[0].equations
        for i, each in enumerate(equations):
            changes = (
                (each, each),
                (dataclasses.replace(each, number="99"),),
                (dataclasses.replace(each, name="another"),),
                (dataclasses.replace(each, id="another"),),
            )
            for changed in changes:
                false = with_equations(every_term_record, *equations[:i], *changed, *equations[i + 1 :])
                assert disagreeing(false, every_term_description)

    def test_equations_out_of_order_are_found(self, every_term_record, every_term_description):
        first, second, *others = every_term_record.derivations[0].equations
        false = with_equations(every_term_record, second, first, *others)
        assert disagreeing(false, every_term_description) == {first.id}

    def test_an_empty_record_disagrees(self, every_term_record, every_term_description):
        false = dataclasses.replace(every_term_record, derivations=(), scenes=())
        assert disagreeing(false, every_term_description)

    def test_what_is_stated_besides_the_equations_is_found(self, every_term_record, every_term_description):
        true = every_term_record
        (whole, part) = true.scenes
        system = dataclasses.replace(true.system, velocities=true.system.velocities[::-1])
        wrong = (
            with_derivation(true, closed_form_operations=1),
            with_derivation(true, left_out=LeftOut(("4",), 900, 500)),
            with_derivation(true, effects=("bare",)),
            with_derivation(true, redundant=("lambda1",)),
            with_derivation(true, redundant=("lambda99",)),
            with_derivation(true, mass_matrix="supported"),
            with_scene(true, left_out=LeftOut(("18",), 900, 500)),
            with_scene(true, name="part"),
            with_scene(true, title="another"),
            with_scene(true, derivation=1),
            with_scene(true, effects=part.effects),
            with_scene(true, parameter_values=dict(whole.parameter_values) | {"m": 3}),
            with_scene(true, control_law={"u": sp.Integer(1)}),
            with_scene(true, span_trees=None),
            with_scene(true, observe=()),
            with_scene(true, given=(*whole.given, "y")),
            with_scene(true, correction=("x_0", "1e-12")),
            dataclasses.replace(true, scenes=(part, whole)),
            dataclasses.replace(true, scenes=(whole, part, part)),
            dataclasses.replace(true, scenes=(whole,)),
            dataclasses.replace(true, system=system),
        )
        for i, false in enumerate(wrong):
            assert disagreeing(false, every_term_description), i


COUPLED = """
load("holonom.mac")$
system : holonomic_system(coordinates = [x, y, z],
  kinetic_energy = dot(x)^2 + dot(x)*dot(z) + dot(y)^2 + dot(z)^2 + x*dot(y), constraints = [x - y])$
"""


@pytest.fixture
def coupled(write_scene) -> Source:
    return Source(write_scene(COUPLED))


def test_zeros_left_out_of_a_large_mass_matrix_are_zeros_and_nothing_else_may_be(coupled):
    record, description = derived_record(coupled, SHORT), coupled.description(SHORT)
    split = equation_of(record, "kinetic_energy")
    names = [str(relation.left) for relation in split.relations]
    assert names == ["A[1, 1]", "A[1, 3]", "A[2, 2]", "A[3, 1]", "A[3, 3]", "B[1]", "B[2]", "B[3]", "T0"]
    assert not disagreeing(record, description)
    for i in range(len(names)):
        short = dataclasses.replace(split, relations=split.relations[:i] + split.relations[i + 1 :])
        others = [short if each.id == split.id else each for each in record.derivations[0].equations]
        assert disagreeing(with_equations(record, *others), description) == {"kinetic_energy"}, names[i]


@pytest.mark.usefixtures("all_agrees")
def test_what_is_left_out_is_an_exact_group_of_a_known_size(coupled):
    record, description = derived_record(coupled, SHORT), coupled.description(SHORT)
    (derived,) = record.derivations
    assert derived.left_out.numbers == ("4", "5", "8", "9", "10", "11")
    for changes in ({"size": 9}, {"limit": 7}, {"numbers": ("4",)}, {"numbers": (*derived.left_out.numbers, "12")}):
        false = with_derivation(record, left_out=derived.left_out._replace(**changes))
        assert disagreeing(false, description) == {"left_out"}
    assert {"left_out", "accelerations"} <= disagreeing(record, coupled.description())


def test_what_a_time_limit_interrupts_is_undecided_and_not_what_was_before_it(
    every_term_record, every_term_description, all_agrees, monkeypatch
):
    works = []

    class ThreeWorks:
        def __init__(self, seconds: float) -> None:
            assert seconds == 60

        def result(self, work: Callable[[], CheckResult], otherwise: CheckResult) -> CheckResult:
            works.append(work)
            return work() if len(works) <= 3 else otherwise

    monkeypatch.setattr(check, "TimeLimit", ThreeWorks)
    report = check_record(every_term_record, every_term_description, "seed", seconds=60)
    verdicts = [each.verdict for each in report.verdicts]
    assert verdicts[:3] == [Verdict.AGREES] * 3
    assert set(verdicts[3:]) == {Verdict.UNDECIDED}


def test_endless_work_is_interrupted_and_no_other_begun():
    def endless() -> str:
        while True:
            pass

    limit = TimeLimit(0.05)
    assert limit.result(endless, "interrupted") == "interrupted"
    assert limit.result(endless, "not begun") == "not begun"
    assert TimeLimit().result(lambda: "done", "") == "done"


def test_each_equation_is_looked_at_in_points_of_its_own_and_of_this_check(
    every_term_record, every_term_description, monkeypatch
):
    seeds = []

    def noted(comparisons: object, seed: str) -> CheckResult:
        seeds.append(seed)
        return AGREES

    monkeypatch.setattr(check, "verify_all", noted)
    check_record(dataclasses.replace(every_term_record, scenes=()), every_term_description, seed="this one")
    derivations = len(every_term_record.derivations)
    assert len(set(seeds)) == len(seeds) // derivations
    assert all(seed.startswith("this one ") for seed in seeds)


def test_points_are_drawn_afresh_for_each_check(every_term_record, every_term_description):
    empty = dataclasses.replace(every_term_record, derivations=(), scenes=())
    assert check_record(empty, every_term_description).seed != check_record(empty, every_term_description).seed
    assert check_record(empty, every_term_description, seed="again").seed == "again"


def test_the_third_opinion_is_asked_for(every_term_record, every_term_description):
    found = check_record(every_term_record, every_term_description).verdicts
    assert [each.verdict for each in found if each.id == "lagranges_method"] == [Verdict.AGREES] * 2


def test_what_is_wrong_disagrees_and_says_where(every_term_record, every_term_description):
    (constraint,) = equation_of(every_term_record, "constraints").relations
    wrong = Equation("constraints", "1", "constraints", (Relation(constraint.left_tree, 1),))
    false = with_equations(every_term_record, wrong, *every_term_record.derivations[0].equations[1:])
    found = check_record(false, every_term_description).verdicts[0]
    assert found.verdict is Verdict.DISAGREES
    assert found.detail.startswith("constraint 1: ")


@pytest.mark.usefixtures("all_agrees")
def test_closed_forms_that_come_out_readable_belong_there(massless_hooks):
    source, strict = massless_hooks, {"closed_form_size": "30"}
    record, without = derived_record(source), derived_record(source, strict)
    assert record.derivations[0].left_out is None
    assert not disagreeing(record, source.description())
    assert not disagreeing(without, source.description(strict))
    assert {"left_out", "accelerations"} <= disagreeing(record, source.description(strict))
    absent = with_derivation(without, left_out=None)
    assert "accelerations" in disagreeing(absent, source.description(strict))
