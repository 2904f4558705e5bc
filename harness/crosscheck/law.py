"""Expand control laws and other functions of the time of a description.

Tables are splines, computed independently from their points (de Boor, A Practical Guide to Splines, chapter IV).
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from functools import cached_property
from itertools import pairwise

from mpmath import mp

from ..description import Table
from ..expression.trees import Tree
from .irregular_point import IrregularPoint
from .tape import Tape
from .taylor import Polynomial, Taylor

DATA_DIGITS = 250  # of numbers of a description, more than any comparison has


class Spline:
    """The cubic spline of a table."""

    def __init__(self, table: Table) -> None:
        with mp.workdps(DATA_DIGITS):
            self.times = [number(point[0]) for point in table.points]
            self.heights = [number(point[1]) for point in table.points]
            self.ends = None if table.ends is None else [number(rate) for rate in table.ends]

    @cached_property
    def bending(self) -> list[mp.mpf]:
        """Second derivatives at the points.

        A tridiagonal system is eliminated from the first row down.
        """
        with mp.workdps(DATA_DIGITS):
            return self._bending()

    def _bending(self) -> list[mp.mpf]:
        h = [b - a for a, b in zip(self.times, self.times[1:], strict=False)]
        slopes = [(b - a) / step for a, b, step in zip(self.heights, self.heights[1:], h, strict=False)]
        rows = [(h[k - 1], 2 * (h[k - 1] + h[k]), h[k], 6 * (slopes[k] - slopes[k - 1])) for k in range(1, len(h))]
        if self.ends is None:
            rows = [(0, mp.one, 0, mp.zero), *rows, (0, mp.one, 0, mp.zero)]
        else:
            first, last = 6 * (slopes[0] - self.ends[0]), 6 * (self.ends[1] - slopes[-1])
            rows = [(0, 2 * h[0], h[0], first), *rows, (h[-1], 2 * h[-1], 0, last)]
        return _tridiagonal(rows)

    def at(self, time: mp.mpf) -> Polynomial:
        """Return the polynomial that is valid at a given time, about it.

        Parameters
        ----------
        time : mpf
            Time inside the table, in the scene's unit.

        Returns
        -------
        Polynomial
            Four coefficients of powers of the time after the given one.

        Raises
        ------
        IrregularPoint
            The time is outside the table.
        """
        if not self.times[0] <= time < self.times[-1]:
            raise IrregularPoint
        k = bisect_right(self.times, time) - 1
        h, s = self.times[k + 1] - self.times[k], time - self.times[k]
        low, high = self.bending[k], self.bending[k + 1]
        slope = (self.heights[k + 1] - self.heights[k]) / h - h * (2 * low + high) / 6
        c = (self.heights[k], slope, low / 2, (high - low) / (6 * h))
        return (
            c[0] + s * (c[1] + s * (c[2] + s * c[3])),
            c[1] + s * (2 * c[2] + 3 * s * c[3]),
            c[2] + 3 * s * c[3],
            c[3],
        )


def _tridiagonal(rows: Sequence[tuple[mp.mpf, mp.mpf, mp.mpf, mp.mpf]]) -> list[mp.mpf]:
    pivots, rests = [rows[0][1]], [rows[0][3]]
    for (_, _, above, _), (below, diagonal, _, right) in pairwise(rows):
        ratio = below / pivots[-1]
        pivots.append(diagonal - ratio * above)
        rests.append(right - ratio * rests[-1])
    found = [rests[-1] / pivots[-1]]
    for (_, _, above, _), pivot, rest in zip(
        reversed(rows[:-1]), reversed(pivots[:-1]), reversed(rests[:-1]), strict=True
    ):
        found.append((rest - above * found[-1]) / pivot)
    return found[::-1]


def number(tree: Tree) -> mp.mpf:
    """Return the value of an expression without names.

    Parameters
    ----------
    tree : Tree
        Expression without names.

    Returns
    -------
    mpf
    """
    tape = Tape()
    place = tape.place(tree)
    return tape.values(Taylor(0), {})[place][0]


class Law:
    """Functions of the time, by name."""

    def __init__(self, trees: Mapping[str, Tree], splines: Sequence[Spline]) -> None:
        self.splines, self.tape = splines, Tape()
        self.places = {name: self.tape.place(_with_names(tree)) for name, tree in trees.items()}

    def at(self, taylor: Taylor, time: mp.mpf, known: Mapping[str, Polynomial]) -> dict[str, Polynomial]:
        """Return Taylor polynomials about a time.

        Parameters
        ----------
        taylor : Taylor
            Arithmetic up to the order of the polynomials.
        time : mpf
            Time of the expansion, in the scene's unit.
        known : mapping of str to Polynomial
            Polynomials of the other names in the functions.

        Returns
        -------
        dict of str to Polynomial
            Polynomial of each function.

        Raises
        ------
        IrregularPoint
            As `Tape.values`, or the time is outside a table.
        """
        tables = {f"table {k}": spline.at(time)[: taylor.order + 1] for k, spline in enumerate(self.splines)}
        values = self.tape.values(taylor, {**known, **tables, "t": (time, mp.one)[: taylor.order + 1]})
        return {name: values[place] for name, place in self.places.items()}


def _with_names(tree: Tree) -> Tree:
    """Return the tree with a quantity in place of each table."""
    match tree:
        case ["Table", int(k), "t"]:
            return f"table {k}"
        case [str(head), *arguments]:
            return [head, *map(_with_names, arguments)]
        case _:
            return tree


SIGNED = ("Abs", "Sign", "Max", "Min", "UnitStep", "HalfStep", "Which")
SWITCHING = (*SIGNED, "Table")


def is_switched(tree: Tree, heads: Sequence[str] = SWITCHING) -> bool:
    """Return True if there is a switch or a table in a law.

    Parameters
    ----------
    tree : Tree
        Expression of a law.
    heads : sequence of str
        Operations that are looked for.

    Returns
    -------
    bool
    """
    return isinstance(tree, list) and (tree[0] in heads or any(is_switched(each, heads) for each in tree[1:]))
