"""Solve sparse linear equations in mpmath's numbers, with threshold pivoting.

The row of the fewest entries is next, and in it the sparsest of the columns with an entry that is not small
(Markowitz 1957).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from heapq import heapify, heappop, heappush

from mpmath import mp

from .irregular_point import IrregularPoint

THRESHOLD = mp.mpf(1) / 1000  # of the largest entry of its row: what may be a pivot
LOST = 30  # digits that the pivots may lose

Row = dict[int, mp.mpf]


def solved(rows: Sequence[Mapping[int, mp.mpf]], right: Sequence[mp.mpf]) -> list[mp.mpf]:
    """Solve as many equations as there are unknowns.

    Parameters
    ----------
    rows : sequence of mapping of int to mpf
        Entries of each row, by column; those that are left out are zero.
    right : sequence of mpf
        Right side, one number for each row.

    Returns
    -------
    list of mpf
        Value of each unknown.

    Raises
    ------
    IrregularPoint
        The matrix is singular, or so near to it that digits are lost.
    """
    left, right = [{k: x for k, x in row.items() if x} for row in rows], list(right)
    sizes = [max(map(abs, row.values()), default=mp.zero) for row in left]
    columns: dict[int, set[int]] = {}
    for i, row in enumerate(left):
        for k in row:
            columns.setdefault(k, set()).add(i)
    waiting = [(len(row), i) for i, row in enumerate(left)]
    heapify(waiting)
    pivots: list[tuple[int, int]] = []
    done: set[int] = set()
    while waiting:
        count, i = heappop(waiting)
        if i in done or count != len(left[i]):
            continue
        k = _pivot(left[i], sizes[i], columns)
        done.add(i)
        pivots.append((i, k))
        for j in columns[k] - {i}:
            if j not in done:
                _eliminate(left, right, columns, i, j, k)
                heappush(waiting, (len(left[j]), j))
        for each in left[i]:
            columns[each].discard(i)
    if len(pivots) < len(left):
        raise IrregularPoint
    found: dict[int, mp.mpf] = {}
    for i, k in reversed(pivots):
        known = mp.fsum(x * found[each] for each, x in left[i].items() if each != k)
        found[k] = (right[i] - known) / left[i][k]
    return [found[k] for k in range(len(left))]


def _pivot(row: Row, size: mp.mpf, columns: Mapping[int, set[int]]) -> int:
    largest = max(map(abs, row.values()), default=mp.zero)
    if largest <= size * mp.mpf(10) ** (LOST - mp.dps):
        raise IrregularPoint
    return min((k for k, x in row.items() if abs(x) >= THRESHOLD * largest), key=lambda k: (len(columns[k]), k))


def _eliminate(left: list[Row], right: list[mp.mpf], columns: dict[int, set[int]], i: int, j: int, k: int) -> None:
    """Take row i out of row j by their entries in column k."""
    row, ratio = left[j], left[j][k] / left[i][k]
    for each, x in left[i].items():
        if each not in row:
            columns[each].add(j)
        row[each] = row.get(each, mp.zero) - ratio * x
    del row[k]
    right[j] -= ratio * right[i]
