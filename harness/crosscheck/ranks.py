"""Compute ranks and solutions of sparse equations by elimination row after row."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from heapq import heapify, heappop, heappush

from mpmath import mp

from .irregular_point import IrregularPoint

Row = dict[int, mp.mpf]
"""Entries of a row by their columns; what is not there is zero."""

LOST = 40
"""Digits of those carried that an entry may lose: what is below the others, relative to its row, is rounding."""

SPARSE_RATIO = 1000
"""A pivot is at least the largest entry of its row over this: three digits lost for sparse rows."""


class Elimination:
    """Rows of a matrix, each reduced by those before.

    A row that follows from those before is left out.
    """

    def __init__(self, rows: Sequence[Row], right: Sequence[mp.mpf] | None = None) -> None:
        self._pivots: dict[int, tuple[Row, mp.mpf]] = {}
        self._order: dict[int, int] = {}  # place of each pivot among them
        self._uses = Counter(column for row in rows for column in row)  # in rows to come, and reduced
        for place, row in enumerate(rows):
            self._uses.subtract(row.keys())
            self._add(row, right[place] if right else mp.zero)

    @property
    def rank(self) -> int:
        """The number of independent rows."""
        return len(self._pivots)

    def solution(self) -> Row:
        """Return a solution of the independent equations, zero for undetermined unknowns.

        Returns
        -------
        Row
            Value of each determined unknown, by column. The others are zero.
        """
        found: Row = {}
        for column, (row, right) in reversed(self._pivots.items()):
            others = mp.fsum(value * found.get(k, mp.zero) for k, value in row.items() if k != column)
            found[column] = (right - others) / row[column]
        return found

    def _add(self, row: Row, right: mp.mpf) -> None:
        scale = max(map(abs, row.values()), default=mp.zero)
        left = dict(row)
        waiting = [(self._order[column], column) for column in left if column in self._order]
        heapify(waiting)
        while waiting:
            column = heappop(waiting)[1]
            if column in left:
                pivot_row, pivot_right = self._pivots[column]
                factor = left[column] / pivot_row[column]
                for each in pivot_row:
                    if each in self._order and each not in left:
                        heappush(waiting, (self._order[each], each))
                scale = max(scale, _subtract(left, factor, pivot_row))
                del left[column]
                right -= factor * pivot_right
        left = {k: value for k, value in left.items() if abs(value) > mp.mpf(10) ** (LOST - mp.dps) * scale}
        if left:
            pivot = self._pivot(left)
            self._pivots[pivot], self._order[pivot] = (left, right), len(self._order)
            self._uses.update(left.keys())

    def _pivot(self, left: Row) -> int:
        """Return the pivot column among those with large entries.

        The column in the fewest rows keeps these sparse. A later row is reduced by a reduced row, and so filled with
        its entries.
        """
        least = max(map(abs, left.values())) / SPARSE_RATIO
        return min((k for k, value in left.items() if abs(value) >= least), key=lambda k: self._uses[k])


def solved(rows: Sequence[Row], right: Sequence[mp.mpf]) -> list[mp.mpf]:
    """Solve as many equations as there are unknowns.

    Parameters
    ----------
    rows : sequence of Row
        Rows of the matrix.
    right : sequence of mpf
        Right side, one number for each row.

    Returns
    -------
    list of mpf
        Value of each unknown.

    Raises
    ------
    IrregularPoint
        The matrix is singular.
    """
    elimination = Elimination(rows, right)
    if elimination.rank < len(rows):
        raise IrregularPoint
    found = elimination.solution()
    return [found[k] for k in range(len(rows))]


def least_solution(rows: Sequence[Row], right: Sequence[mp.mpf]) -> Row:
    """Return the shortest solution of J x = r, J^T (J J^T)^-1 r, for independent rows.

    Parameters
    ----------
    rows : sequence of Row
        Rows of J.
    right : sequence of mpf
        Right side r, one number for each row.

    Returns
    -------
    Row
        Entries by column. Those left out are zero.
    """
    users: dict[int, list[tuple[int, mp.mpf]]] = {}
    for place, row in enumerate(rows):
        for column, value in row.items():
            users.setdefault(column, []).append((place, value))
    products: list[Row] = []
    for row in rows:
        product: Row = {}
        for column, value in row.items():
            for place, other in users[column]:
                product[place] = product.get(place, mp.zero) + value * other
        products.append(product)
    weights = Elimination(products, right).solution()
    return {
        column: mp.fsum(value * weights.get(place, mp.zero) for place, value in found)
        for column, found in users.items()
    }


def _subtract(left: Row, factor: mp.mpf, row: Row) -> mp.mpf:
    """Subtract a multiple of a row from another. Return the largest change."""
    largest = mp.zero
    for k, value in row.items():
        change = factor * value
        left[k] = left.get(k, mp.zero) - change
        largest = max(largest, abs(change))
    return largest
