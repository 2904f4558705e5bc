"""What a record may say of an indexed quantity: every entry once, in its place, and of nothing else."""

import pytest
import sympy as sp

from holonom.crosscheck.claims import NotComparable, entries_of, require_names, residual_pairs, solved_for
from holonom.record import Relation

X, Y = sp.symbols("x y", real=True)


def entry(name: str, *indices: int, value: int = 5) -> Relation:
    return Relation(["Subscript", name, *indices], value)


def of(name: str, value: int = 5) -> Relation:
    return Relation(name, value)


def test_entries_are_found_by_their_indices_among_others():
    relations = [entry("A", 1, 2), entry("B", 1, value=7), entry("A", 2, 2, value=6), of("T0")]
    assert entries_of("A", (2, 2), relations) == {(1, 2): 5, (2, 2): 6}
    assert entries_of("B", (2,), relations) == {(1,): 7}


@pytest.mark.parametrize("indices", [(0, 1), (1, 3), (1,), (1, 1, 1)])
def test_an_entry_out_of_place_is_refused(indices):
    with pytest.raises(NotComparable, match="out of place"):
        entries_of("A", (2, 2), [entry("A", *indices)])


def test_a_later_duplicate_of_an_entry_took_its_place():
    with pytest.raises(NotComparable, match="out of place"):
        entries_of("A", (2, 2), [entry("A", 1, 1), entry("A", 1, 1, value=6)])


@pytest.mark.parametrize("stray", [entry("B", 1), of("T0")])
def test_a_relation_about_something_else_is_refused(stray):
    require_names(["A"], [entry("A", 1)])
    with pytest.raises(NotComparable, match="out of place"):
        require_names(["A"], [entry("A", 1), stray])


def test_a_residual_is_the_left_side_less_the_right():
    (pair,) = residual_pairs("f", [Relation("x", "y")], [X])
    assert (pair.claimed, pair.independent) == (X - Y, X)


@pytest.mark.parametrize("relations", [[], [of("x"), of("y")]], ids=["fewer", "more"])
def test_more_or_fewer_relations_than_there_are_residuals_are_refused(relations):
    with pytest.raises(NotComparable, match="1 belong"):
        residual_pairs("f", relations, [X])


@pytest.mark.parametrize(
    "relations", [[of("x")], [of("x"), of("y"), of("y")], [of("x"), of("z")]], ids=["fewer", "twice", "another"]
)
def test_what_is_solved_for_stands_on_the_left_each_once(relations):
    assert solved_for([X, Y], [of("y"), of("x", 6)]) == {X: 6, Y: 5}
    with pytest.raises(NotComparable, match="x, y belong"):
        solved_for([X, Y], relations)
