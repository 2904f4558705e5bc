"""Every relation of a scene is compared with something: changed, left out, added or beyond its order, it is found."""

import dataclasses
import re
from itertools import pairwise
from math import inf

import pytest
import sympy as sp

import holonom
from holonom.crosscheck.derivation import CheckedDerivation
from holonom.crosscheck.independent import IndependentEquations
from holonom.crosscheck.initial_motion import COMPARISONS, CheckedScene, _without_closed_form
from holonom.crosscheck.relations import NotComparable
from holonom.crosscheck.report import Verdict
from holonom.crosscheck.system import described_system
from holonom.crosscheck.verdict import verify_all
from holonom.description import Description
from holonom.record import Equation, Record, Relation

THOUSANDTH = ["Rational", 1, 1000]
LATER = ["Power", ["Add", "t", -1], 4]
"""(t - t0)^4: beyond the order of the series, and zero at the start with its first three rates."""


@pytest.fixture(scope="module")
def checked(every_term_record: Record, every_term_description: Description) -> CheckedScene:
    return checked_of(every_term_record, every_term_description, 0)


def checked_of(record: Record, description: Description, scene: int) -> CheckedScene:
    described = record.scenes[scene]
    derived = record.derivations[described.derivation]
    known = IndependentEquations(described_system(record.system, derived.effects))
    return CheckedScene(described, description.scenes[scene], CheckedDerivation(known, known, tuple(derived.equations)))


def verdict(checked: CheckedScene, equation: Equation, relations: tuple[Relation, ...]) -> Verdict:
    try:
        comparisons = COMPARISONS[equation.id](checked, relations)
    except NotComparable:
        return Verdict.DISAGREES
    alone = [dataclasses.replace(comparison, certificate=None) for comparison in comparisons]
    return verify_all(alone, equation.id).verdict


def equation(checked: CheckedScene, wanted: str) -> Equation:
    (found,) = [each for each in checked.scene.equations if each.id == wanted]
    return found


@pytest.mark.parametrize("scene", [0, 1])
def test_the_equations_are_right_as_they_are(every_term_record, every_term_description, scene):
    """The second scene calls for some effects alone, and its motion is that of these."""
    checked = checked_of(every_term_record, every_term_description, scene)
    for each in checked.scene.equations:
        assert verdict(checked, each, each.relations) is not Verdict.DISAGREES, each.id


def test_each_relation_changed_left_out_or_added_is_found(checked):
    stray = Relation(["Subscript", "Z", 1], 1)
    for each in checked.scene.equations:
        for i, relation in enumerate(each.relations):
            larger = Relation(relation.left_tree, ["Add", relation.right_tree, THOUSANDTH])
            before, after = each.relations[:i], each.relations[i + 1 :]
            assert verdict(checked, each, (*before, larger, *after)) is Verdict.DISAGREES, (each.id, i)
            assert verdict(checked, each, (*before, *after)) is Verdict.DISAGREES, (each.id, i)
        assert verdict(checked, each, (*each.relations, stray)) is Verdict.DISAGREES, each.id
        assert verdict(checked, each, (*each.relations, each.relations[-1])) is Verdict.DISAGREES, each.id


def test_conditions_of_free_motion_are_counted_from_one(checked):
    relations = equation(checked, "free_motion_residual").relations
    (comparison,) = COMPARISONS["free_motion_residual"](checked, relations)
    assert [re.findall(r"\d+", str(pair.quantity)) for pair in comparison.pairs] == [["1"]]


def test_a_series_that_goes_on_beyond_its_order_is_found(checked):
    """Its remainder was dropped from the comparison, and nothing noticed."""
    series = equation(checked, "initial_series")
    first, *others = series.relations
    longer = Relation(first.left_tree, ["Add", first.right_tree, LATER])
    assert verdict(checked, series, (longer, *others)) is Verdict.DISAGREES


def test_a_start_off_the_constraints_is_found_where_all_agree_on_it(checked):
    """(12) lists the same values as the scene; only the constraints and their rates can tell."""
    state = equation(checked, "initial_state")
    for name in ("y", "dot(y)"):
        moved = {**checked.scene.initial_state, name: checked.scene.initial_state[name] + 1}
        scene = dataclasses.replace(checked.scene, initial_state=moved)
        relations = tuple(
            Relation(each.left_tree, ["Add", each.right_tree, 1]) if str(each.left) == f"{name}_0" else each
            for each in state.relations
        )
        assert verdict(dataclasses.replace(checked, scene=scene), state, relations) is Verdict.DISAGREES, name


def test_a_start_that_is_not_the_scene_s_is_found(checked):
    """Along the constraints, which hold there as well."""
    state = equation(checked, "initial_state")
    moved = {**checked.scene.initial_state, "dot(x)": checked.scene.initial_state["dot(x)"] + 1}
    moved["dot(y)"] = checked.scene.initial_state["dot(y)"] + 2
    scene = dataclasses.replace(checked.scene, initial_state=moved)
    assert verdict(dataclasses.replace(checked, scene=scene), state, state.relations) is Verdict.DISAGREES


def test_a_start_that_leaves_a_value_open_is_refused(checked):
    state = equation(checked, "initial_state")
    short = {name: value for name, value in checked.scene.initial_state.items() if name != "dot(y)"}
    scene = dataclasses.replace(checked.scene, initial_state=short)
    with pytest.raises(NotComparable):
        COMPARISONS["initial_state"](dataclasses.replace(checked, scene=scene), state.relations)


def test_four_values_together_or_two_not_linearly_may_have_no_closed_form():
    """As many as the derivation may write as numbers (`is_brief_solution`), in whatever groups they share equations."""
    x = sp.symbols("x:9", real=True)
    groups = x[:3], x[3:7], x[7:]
    equations = [sum(x[:2]), x[1] - x[2], *(a + b for a, b in pairwise(x[3:7])), x[7] * x[8]]
    containing = {each: [e for e in equations if each in e.free_symbols] for each in x}
    assert _without_closed_form({*x}, containing, inf) == {*groups[1], *groups[2]}
    assert _without_closed_form({*x[:6], x[8]}, containing, inf) == set()


@pytest.mark.parametrize(
    ("force", "constraint", "law", "start", "series"),
    [
        ("max(t, 0)", "y - x", "u = t", 0, "x_0 + dx*t + t**3/12"),
        pytest.param("max(t - 1, 0)", "y - x", "u = t", 1, "x_0 + dx*(t - 1) + (t - 1)**3/12", marks=pytest.mark.long),
        ("signum(u)", "y - x", "u = t", 0, "x_0 + dx*t + t**2/4"),
        pytest.param("dot(u)*signum(u)", "y - x", "u = -sin(t)", 0, "x_0 + dx*t + t**2/4", marks=pytest.mark.long),
        pytest.param("abs(t*x)", "y - x", "u = t", 0, "x_0 + dx*t + t**3*x_0*sign(x_0)/12", marks=pytest.mark.long),
        ("0", "x - max(u, 0)^2*y", "u = sin(t)", 0, "x_0 + dx*t + y_0*t**2 + dy*t**3"),
        pytest.param(
            "0", "x - (if t > 0 then t^3 else 0)*y", "u = t", 0, "x_0 + dx*t + y_0*t**3", marks=pytest.mark.long
        ),
    ],
)
def test_signs_of_functions_of_the_time_were_zero_at_their_zero(force, constraint, law, start, series):
    """(13) and (18) had the mean of both sides, and the check none."""
    scene = holonom.system(f"""
system : holonomic_system(coordinates = [x, y, z], controls = [u],
  kinetic_energy = (dot(x)^2 + dot(y)^2 + dot(z)^2)/2, forces = [{force}, 0, u], constraints = [{constraint}])$
scene : holonomic_scene(system, control_law = [{law}], time_span = [{start}, 3],
  initial_state = [y = 1, dot(y) = 1, z = 0, dot(z) = 0])$""")
    (found,) = [each for each in scene.record.scenes[0].equations if each.id == "initial_series"]
    names = {"dx": sp.Symbol("dot(x)_0", real=True), "dy": sp.Symbol("dot(y)_0", real=True)}
    names |= {name: sp.Symbol(name, real=True) for name in ("t", "x_0", "y_0")}
    truth = sp.sympify(series, names)
    assert sp.simplify(found.relations[0].right - truth) == 0
    expanded = scene.series(order=3, digits="exact").coordinates
    numbers = {f"{name}_0": sp.Rational(expanded[name][0]) for name in "xy"}
    numbers |= {f"dot({name})_0": sp.Rational(expanded[name][1]) for name in "xy"}
    values = truth.xreplace({sp.Symbol(name, real=True): number for name, number in numbers.items()})
    powers = sp.Poly(sp.expand(values.xreplace({names["t"]: names["t"] + start})), names["t"])
    assert [sp.Rational(x) for x in expanded["x"][:4]] == [powers.coeff_monomial(names["t"] ** k) for k in range(4)]
    assert not scene.check().disagreements


@pytest.mark.parametrize("wrong", [["Multiply", 2, "dot(x)_0"], ["Multiply", "dot(x)_0", "x_0"], "dot(z)_0"])
def test_given_values_that_the_constraints_bind_too(wrong):
    """dot(x) = 0 follows, and is given; (19) has dot(y) in terms of it. The wrong forms have its value, too."""
    scene = holonom.system("""
system : holonomic_system(coordinates = [x, y, z], controls = [u], constraints = [x - u*y, x + y - u],
  kinetic_energy = (dot(x)^2 + dot(y)^2 + dot(z)^2)/2)$
scene : holonomic_scene(system, control_law = [u = 1 + t^2],
  initial_state = [x = 1/2, y = 1/2, dot(x) = 0, z = 0, dot(z) = 0])$""")
    checked = checked_of(scene.record, scene.description, 0)
    fixed = equation(checked, "determined_initial_values")
    assert verdict(checked, fixed, fixed.relations) is not Verdict.DISAGREES
    assert [str(relation.left) for relation in fixed.relations] == ["dot(y)_0"]
    relation = Relation(fixed.relations[0].left_tree, wrong)
    assert verdict(checked, fixed, (relation,)) is Verdict.DISAGREES
