"""Verdicts on systems whose terms cancel or vanish at many random points."""

import dataclasses
import random

import pytest

import holonom
from holonom.crosscheck.check import check_record
from holonom.crosscheck.report import Verdict

# potential energy and constraint
SYSTEMS = [
    ("exp(x - y)", "x + y"),
    ("exp(x - y) + exp(y - x)", "x + y"),
    ("tanh(x)^2", "x + y"),
    ("cosh(x - y)", "x + y"),
    ("exp((x - y)^2)", "x + y"),
    ("exp(x + y)", "x - y"),
    ("exp(-10^6*x) + exp(-10^6*y)", "x - y - 1"),
    ("0", "y - tanh(x)"),
    ("0", "y - exp(-x^2)"),
    ("0", "y - x - exp(x)"),
]
UNDESIRED = Verdict.DISAGREES, Verdict.UNDECIDED
GROWING = "Exp", "Tanh", "Cosh", "Sinh", "Sech"
CHANGES = {
    "by 1e-9": lambda tree: ["Multiply", ["Rational", 10**9 + 1, 10**9], tree],
    "twice": lambda tree: ["Multiply", 2, tree],
    "squared": lambda tree: ["Power", tree, 2],
}


@pytest.fixture(scope="module", params=SYSTEMS, ids="; ".join)
def scene(request):
    potential, constraint = request.param
    return holonom.system(f"""system : holonomic_system(coordinates = [x, y], kinetic_energy = dot(x)^2/2 + dot(y)^2/2,
  potential_energy = {potential}, constraints = [{constraint}])$
motion : holonomic_scene(system, initial_state = [x = 1/2, dot(x) = 1], time_span = [0, 1])$""")


@pytest.mark.parametrize("seed", ["1", pytest.param("q1", marks=pytest.mark.long)])
def test_true_record_agrees(scene, seed):
    report = check_record(scene.record, scene.description, seed)
    assert [found for found in report.verdicts if found.verdict in UNDESIRED] == []


def first_changed(tree, change):
    """Change the first function that grows, and return the tree itself if there is none."""
    if isinstance(tree, list) and tree[0] in GROWING:
        return change(tree)
    for i, part in enumerate(tree if isinstance(tree, list) else ()):
        if (changed := first_changed(part, change)) is not part:
            return [*tree[:i], changed, *tree[i + 1 :]]
    return tree


def wrong_equations(equation, change):
    """Yield the equation with one relation changed, for each relation with such a function."""
    for k, relation in enumerate(equation.relations):
        for side in ("left_tree", "right_tree"):
            tree = getattr(relation, side)
            if (changed := first_changed(tree, change)) is not tree:
                wrong = dataclasses.replace(relation, **{side: changed})
                relations = (*equation.relations[:k], wrong, *equation.relations[k + 1 :])
                yield dataclasses.replace(equation, relations=relations)


def drawn_wrong_record(record, change, seed):
    """Return a record with one function that grows changed, and the id of its equation."""
    (derived,) = record.derivations
    wrong = [(i, each) for i, equation in enumerate(derived.equations) for each in wrong_equations(equation, change)]
    i, changed = random.Random(seed).choice(wrong)
    equations = (*derived.equations[:i], changed, *derived.equations[i + 1 :])
    return dataclasses.replace(record, derivations=(dataclasses.replace(derived, equations=equations),)), changed.id


@pytest.mark.parametrize("seed", ["1", *(pytest.param(each, marks=pytest.mark.long) for each in "234")])
def test_record_with_a_drawn_wrong_term_disagrees(scene, seed):
    change = random.Random(str(scene.record) + seed).choice([*CHANGES.values()])
    wrong, name = drawn_wrong_record(scene.record, change, seed)
    verdicts = check_record(wrong, scene.description, seed).verdicts
    assert Verdict.DISAGREES in {each.verdict for each in verdicts if each.id == name}
