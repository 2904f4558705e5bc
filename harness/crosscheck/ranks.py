"""Ranks of sparse matrices, and solutions of sparse equations, by elimination row after row."""

from __future__ import annotations

from collections.abc import Sequence

from mpmath import mp

Row = dict[int, mp.mpf]
"""Entries of a row by their columns; what is not there is zero."""

SMALLEST = 30
"""Digits below the largest entry of its row at which what is left of an entry is rounding."""


class Elimination:
    """Rows of a matrix, reduced by one another in their order; a row that follows from those before is not kept."""

    def __init__(self, rows: Sequence[Row], right: Sequence[mp.mpf] | None = None) -> None:
        self.kept: list[int] = []
        self._pivots: dict[int, tuple[Row, mp.mpf]] = {}
        for place, row in enumerate(rows):
            if self._add(row, right[place] if right else mp.zero):
                self.kept.append(place)

    @property
    def rank(self) -> int:
        """The number of independent rows."""
        return len(self.kept)

    def solution(self) -> Row:
        """A solution of the equations kept: what no pivot determines is zero."""
        found: Row = {}
        for column, (row, right) in reversed(self._pivots.items()):
            others = mp.fsum(value * found.get(k, mp.zero) for k, value in row.items() if k != column)
            found[column] = (right - others) / row[column]
        return found

    def _add(self, row: Row, right: mp.mpf) -> bool:
        scale = max(map(abs, row.values()), default=mp.zero)
        left = dict(row)
        for column, (pivot_row, pivot_right) in self._pivots.items():
            if column in left:
                factor = left[column] / pivot_row[column]
                scale = max(scale, _subtract(left, factor, pivot_row))
                del left[column]
                right -= factor * pivot_right
        left = {k: value for k, value in left.items() if abs(value) > mp.mpf(10) ** -SMALLEST * scale}
        if not left:
            return False
        pivot = max(left, key=lambda k: abs(left[k]))
        self._pivots[pivot] = (left, right)
        return True


def _subtract(left: Row, factor: mp.mpf, row: Row) -> mp.mpf:
    """Subtract a multiple of a row from another; return the largest of what was subtracted."""
    largest = mp.zero
    for k, value in row.items():
        change = factor * value
        left[k] = left.get(k, mp.zero) - change
        largest = max(largest, abs(change))
    return largest
