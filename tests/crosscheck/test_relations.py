"""What a record may say: every left side once, in its place, and of nothing else."""

import pytest
import sympy as sp

from holonom.crosscheck.relations import (
    NotComparable,
    list_of,
    read_exactly,
    residual_pairs,
    shown,
    solved_for,
    sparse_entries,
)
from holonom.record import Relation

X, Y = sp.symbols("x y", real=True)


def entry(name: str, *indices: int, value: int = 5) -> Relation:
    return Relation(["Subscript", name, *indices], value)


def of(name: str, value: int = 5) -> Relation:
    return Relation(name, value)


WRONG = {
    "fewer": [of("x")],
    "twice": [of("x"), of("y"), of("y")],
    "twice at first": [of("x"), of("x"), of("y")],
    "another": [of("x"), of("z")],
    "out of order": [of("y"), of("x")],
    "indexed": [of("x"), entry("y", 1)],
}


@pytest.mark.parametrize("relations", WRONG.values(), ids=WRONG)
def test_left_sides_are_those_that_belong_each_once_and_in_order(relations):
    assert read_exactly(["x", "y"], [of("x", 6), of("y")]) == [6, 5]
    assert solved_for([X, Y], [of("x", 6), of("y")]) == {X: 6, Y: 5}
    for read in (lambda: read_exactly(["x", "y"], relations), lambda: solved_for([X, Y], relations)):
        with pytest.raises(NotComparable):
            read()


def test_a_list_has_all_its_entries():
    assert list_of("B", 2, [entry("B", 1), entry("B", 2, value=7)]) == [5, 7]
    for relations in ([entry("B", 2), entry("B", 1)], [entry("B", 1)], [entry("B", 1), entry("A", 2)]):
        with pytest.raises(NotComparable):
            list_of("B", 2, relations)


def test_sparse_entries_are_found_by_their_indices_in_order():
    relations = [entry("A", 1, 2), entry("A", 2, 1, value=6)]
    assert sparse_entries("A", (2, 2), (0, 1), relations) == {(1, 2): 5, (2, 1): 6}
    assert sparse_entries("A", (2, 2), (1, 0), relations[::-1]) == {(1, 2): 5, (2, 1): 6}
    with pytest.raises(NotComparable):
        sparse_entries("A", (2, 2), (0, 1), relations[::-1])


@pytest.mark.parametrize("indices", [(0, 1), (1, 3), (1,), (1, 1, 1), (True, 1)])
def test_an_entry_out_of_place_is_refused(indices):
    with pytest.raises(NotComparable):
        sparse_entries("A", (2, 2), (0, 1), [entry("A", *indices)])


@pytest.mark.parametrize("stray", [entry("B", 1, 2), of("T0"), entry("A", 1, 1)])
def test_what_is_there_twice_or_about_something_else_is_refused(stray):
    with pytest.raises(NotComparable):
        sparse_entries("A", (2, 2), (0, 1), [entry("A", 1, 1), stray])


def test_a_residual_is_the_left_side_less_the_right():
    (pair,) = residual_pairs("f", [Relation("x", "y")], [X])
    assert pair == ("f 1", X - Y, X)


@pytest.mark.parametrize("relations", [[], [of("x"), of("y")]], ids=["fewer", "more"])
def test_more_or_fewer_relations_than_there_are_residuals_are_refused(relations):
    with pytest.raises(NotComparable):
        residual_pairs("f", relations, [X])


def test_a_decimal_is_read_as_the_fraction_that_it_is():
    (value,) = read_exactly(["x"], [Relation("x", {"num": "2.5e-1"})])
    assert value == sp.Rational(1, 4)


@pytest.mark.parametrize(("left", "expected"), [("x", "x"), (["Subscript", "A", 1, 2], "A[1, 2]")])
def test_a_left_side_is_shown_as_maxima_writes_it(left, expected):
    assert shown(left) == expected
