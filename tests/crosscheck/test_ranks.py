"""Elimination of sparse rows, against matrices whose ranks and solutions are known."""

import random

import pytest
from mpmath import mp

from holonom.crosscheck import ranks
from holonom.crosscheck.digits import WORKING_DIGITS
from holonom.crosscheck.ranks import Elimination, least_solution, solved


@pytest.fixture(autouse=True)
def working_digits():
    with mp.workdps(WORKING_DIGITS):
        yield


def as_rows(matrix):
    return [{k: mp.mpf(value) for k, value in enumerate(row) if value} for row in matrix]


@pytest.mark.parametrize("seed", range(5))
def test_rank_of_a_product_of_random_factors(seed):
    draw = random.Random(seed)
    left, right = ([[draw.randint(-9, 9) for _ in range(n)] for _ in range(m)] for m, n in ((7, 3), (3, 8)))
    product = [[sum(a * right[k][j] for k, a in enumerate(row)) for j in range(8)] for row in left]
    assert Elimination(as_rows(product)).rank == 3


def test_a_small_entry_is_no_pivot_however_sparse_its_column():
    """As a pivot 1e-25 would cost 25 of the digits."""
    matrix, right = [["1e-25", 1, 1], [0, 1, 2], [1, 0, 3]], (1, 2, 5)
    solution = Elimination(as_rows(matrix), [mp.mpf(each) for each in right]).solution()
    for row, side in zip(matrix, right, strict=True):
        assert abs(mp.fsum(mp.mpf(a) * solution[k] for k, a in enumerate(row)) - side) < mp.mpf(10) ** -45


def test_least_solution_is_the_projection_of_any_other():
    rows = as_rows([[1, 2, 0, 1], [0, 1, 1, -1]])
    least = least_solution(rows, [mp.mpf(3), mp.mpf(1)])
    assert [mp.fsum(a * least[k] for k, a in row.items()) for row in rows] == pytest.approx([3, 1], abs=1e-45)
    for null in ([-2, 1, -1, 0], [3, -1, 0, -1]):  # perpendicular to what the equations leave open
        assert abs(mp.fsum(a * least[k] for k, a in enumerate(null))) < mp.mpf(10) ** -45


def bordered_chain(masses):
    """[A -J^T; J 0] of a chain in a plane, from its nearest link on, with random directions of the links."""
    draw, n = random.Random(masses), 2 * masses
    links = [[(2 * k + axis, draw.randint(1, 9)) for axis in range(2)] for k in range(masses)]
    rows = [{column: mp.one} for column in range(n)]
    for k, link in enumerate(links):
        others = [(column - 2, -value) for column, value in link if column >= 2]
        rows.append({column: mp.mpf(value) for column, value in [*others, *link]})
        for column, value in rows[-1].items():
            rows[column][n + k] = -value
    return rows


def test_equations_of_a_chain_are_solved_in_a_time_that_grows_as_its_length(monkeypatch):
    changed, subtract = [], ranks._subtract
    monkeypatch.setattr(ranks, "_subtract", lambda left, *by: changed.append(len(by[1])) or subtract(left, *by))

    def work(masses):
        changed.clear()
        rows = bordered_chain(masses)
        solution = solved(rows, [mp.one] * len(rows))
        assert all(abs(mp.fsum(a * solution[k] for k, a in row.items()) - 1) < mp.mpf(10) ** -40 for row in rows)
        return sum(changed)

    assert work(40) < 2.2 * work(20)
