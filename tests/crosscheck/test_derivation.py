"""Every relation of a derivation is compared with something: changed, left out or added, it is found."""

import dataclasses

import pytest

from holonom.crosscheck.derivation import COMPARISONS, CheckedDerivation
from holonom.crosscheck.independent import IndependentEquations
from holonom.crosscheck.relations import NotComparable
from holonom.crosscheck.report import Verdict
from holonom.crosscheck.system import described_system
from holonom.crosscheck.verdict import verify
from holonom.record import Equation, Record, Relation

ADDED = Relation(["Subscript", "Z", 1], 1)


@pytest.fixture(scope="module")
def checked(every_term_record: Record) -> CheckedDerivation:
    return checked_of(every_term_record)


def checked_of(record: Record) -> CheckedDerivation:
    derived = record.derivations[0]
    known = IndependentEquations(described_system(record.system, derived.effects))
    return CheckedDerivation(known, known, tuple(derived.equations))


def verdict(checked: CheckedDerivation, equation: Equation, relations: tuple[Relation, ...]) -> Verdict:
    try:
        comparison = COMPARISONS[equation.id](checked, relations)
    except NotComparable:
        return Verdict.DISAGREES
    alone = dataclasses.replace(comparison, certificate=None)  # numbers alone: a proof is not what is tried here
    return verify(alone, equation.id).verdict


def test_the_equations_are_right_as_they_are(checked):
    for equation in checked.equations:
        assert verdict(checked, equation, equation.relations) is not Verdict.DISAGREES, equation.id


def test_each_relation_changed_or_left_out_is_found(checked):
    """The right side larger by a thousandth, or not there."""
    for equation in checked.equations:
        for i, relation in enumerate(equation.relations):
            larger = Relation(relation.left_tree, ["Add", relation.right_tree, ["Rational", 1, 1000]])
            before, after = equation.relations[:i], equation.relations[i + 1 :]
            assert verdict(checked, equation, (*before, larger, *after)) is Verdict.DISAGREES, (equation.id, i)
            assert verdict(checked, equation, (*before, *after)) is Verdict.DISAGREES, (equation.id, i)


def test_each_relation_given_twice_or_added_is_found(checked):
    """The second time with another value, which was taken no notice of."""
    for equation in checked.equations:
        for relation in (ADDED, Relation(equation.relations[-1].left_tree, 7)):
            assert verdict(checked, equation, (*equation.relations, relation)) is Verdict.DISAGREES, equation.id


def test_a_christoffel_symbol_that_there_is_not_is_found(checked):
    """It was compared with nothing where the record alone has it."""
    (symbols,) = [equation for equation in checked.equations if equation.id == "christoffel_symbols"]
    present = {tuple(map(int, relation.left.indices)) for relation in symbols.relations}
    assert (1, 2, 2) not in present
    wrong = Relation(["Subscript", "christoffel", 1, 2, 2], 1)
    assert verdict(checked, symbols, (*symbols.relations, wrong)) is Verdict.DISAGREES
