"""Every relation of a scene is compared with something: changed, left out, added or beyond its order, it is found."""

import dataclasses

import pytest

from holonom.crosscheck.claims import NotComparable
from holonom.crosscheck.derivation import DerivationClaims
from holonom.crosscheck.independent import IndependentEquations
from holonom.crosscheck.initial_motion import COMPARISONS, SceneClaims
from holonom.crosscheck.report import Verdict
from holonom.crosscheck.system import described_system
from holonom.crosscheck.verdict import judge_all
from holonom.description import Description
from holonom.record import Equation, Record, Relation

THOUSANDTH = ["Rational", 1, 1000]
LATER = ["Power", ["Add", "t", -1], 4]
"""(t - t0)^4: beyond the order of the series, and zero at the start with its first three rates."""


@pytest.fixture(scope="module")
def claims(every_term_record: Record, every_term_description: Description) -> SceneClaims:
    return claims_of(every_term_record, every_term_description, 0)


def claims_of(record: Record, description: Description, scene: int) -> SceneClaims:
    described = record.scenes[scene]
    derived = record.derivations[described.derivation]
    known = IndependentEquations(described_system(record.system, derived.effects))
    return SceneClaims(described, description.scenes[scene], DerivationClaims(known, known, tuple(derived.equations)))


def verdict(claims: SceneClaims, equation: Equation, relations: tuple[Relation, ...]) -> Verdict:
    try:
        comparisons = COMPARISONS[equation.id](claims, relations)
    except NotComparable:
        return Verdict.DISAGREES
    alone = [dataclasses.replace(comparison, certificate=None) for comparison in comparisons]
    return judge_all(alone, equation.id).verdict


def equation(claims: SceneClaims, wanted: str) -> Equation:
    (found,) = [each for each in claims.scene.equations if each.id == wanted]
    return found


@pytest.mark.parametrize("scene", [0, 1])
def test_the_equations_are_right_as_they_are(every_term_record, every_term_description, scene):
    """The second scene calls for some effects alone, and its motion is that of these."""
    claims = claims_of(every_term_record, every_term_description, scene)
    for each in claims.scene.equations:
        assert verdict(claims, each, each.relations) is not Verdict.DISAGREES, each.id


def test_each_relation_changed_left_out_or_added_is_found(claims):
    stray = Relation(["Subscript", "Z", 1], 1)
    for each in claims.scene.equations:
        for i, relation in enumerate(each.relations):
            larger = Relation(relation.left_tree, ["Add", relation.right_tree, THOUSANDTH])
            before, after = each.relations[:i], each.relations[i + 1 :]
            assert verdict(claims, each, (*before, larger, *after)) is Verdict.DISAGREES, (each.id, i)
            assert verdict(claims, each, (*before, *after)) is Verdict.DISAGREES, (each.id, i)
        assert verdict(claims, each, (*each.relations, stray)) is Verdict.DISAGREES, each.id
        assert verdict(claims, each, (*each.relations, each.relations[-1])) is Verdict.DISAGREES, each.id


def test_a_series_that_goes_on_beyond_its_order_is_found(claims):
    """Its remainder was dropped from the comparison, and nothing noticed."""
    series = equation(claims, "initial_series")
    first, *others = series.relations
    longer = Relation(first.left_tree, ["Add", first.right_tree, LATER])
    assert verdict(claims, series, (longer, *others)) is Verdict.DISAGREES


def test_a_start_off_the_constraints_is_found_where_all_agree_on_it(claims):
    """(12) lists the same values as the scene; only the constraints and their rates can tell."""
    state = equation(claims, "initial_state")
    for name in ("y", "dot(y)"):
        moved = {**claims.scene.initial_state, name: claims.scene.initial_state[name] + 1}
        scene = dataclasses.replace(claims.scene, initial_state=moved)
        relations = tuple(
            Relation(each.left_tree, ["Add", each.right_tree, 1]) if str(each.left) == f"{name}_0" else each
            for each in state.relations
        )
        assert verdict(dataclasses.replace(claims, scene=scene), state, relations) is Verdict.DISAGREES, name


def test_a_start_that_is_not_the_scene_s_is_found(claims):
    """Along the constraints, which hold there as well."""
    state = equation(claims, "initial_state")
    moved = {**claims.scene.initial_state, "dot(x)": claims.scene.initial_state["dot(x)"] + 1}
    moved["dot(y)"] = claims.scene.initial_state["dot(y)"] + 2
    scene = dataclasses.replace(claims.scene, initial_state=moved)
    assert verdict(dataclasses.replace(claims, scene=scene), state, state.relations) is Verdict.DISAGREES


def test_a_start_that_leaves_a_value_open_is_refused(claims):
    state = equation(claims, "initial_state")
    short = {name: value for name, value in claims.scene.initial_state.items() if name != "dot(y)"}
    scene = dataclasses.replace(claims.scene, initial_state=short)
    with pytest.raises(NotComparable, match="not complete"):
        COMPARISONS["initial_state"](dataclasses.replace(claims, scene=scene), state.relations)
