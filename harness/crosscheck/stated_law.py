"""A control law as it is stated, with switches and tables, evaluated at an instant; nothing of it is simplified."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from operator import eq, ge, gt, le, lt, ne

import sympy as sp
from mpmath import mp

from ..described import expression
from ..description import Table
from ..trees import Tree
from .evaluation import Number, Steps
from .system import exact

COMPARED: Mapping[str, Callable[[Number, Number], bool]] = {
    "Less": lt,
    "LessEqual": le,
    "Greater": gt,
    "GreaterEqual": ge,
    "Equal": eq,
    "Same": eq,
    "NotEqual": ne,
    "NotSame": ne,
}
SWITCHING = ("Max", "Min", "UnitStep", "HalfStep", "Which", "Table")

Values = Mapping[sp.Symbol, Number]


def is_switched(tree: Tree) -> bool:
    """Whether there is a switch or a table in a law."""
    return isinstance(tree, list) and (tree[0] in SWITCHING or any(map(is_switched, tree[1:])))


class StatedLaw:
    """The laws and tables of a description, with numbers for the parameters and the time."""

    def __init__(self, tables: Sequence[Table], values: Values) -> None:
        self._splines = [Spline(table) for table in tables]
        self._values: dict[sp.Symbol, Number] = dict(values)

    def number(self, tree: Tree) -> Number | None:
        """The value of an expression; None where it has none."""
        return Steps([exact(expression(self._plain(tree)))]).at(self._values)[0]

    def _plain(self, tree: Tree) -> Tree:
        """The tree with a name of its own for each switch and table in it."""
        if not is_switched(tree):
            return tree
        if tree[0] not in SWITCHING:
            return [tree[0], *map(self._plain, tree[1:])]
        name = f"switched_{len(self._values)}"
        self._values[sp.Symbol(name, real=True)] = self._chosen(tree)
        return name

    def _chosen(self, tree: list) -> Number | None:
        head, *arguments = tree
        if head == "Which":
            pairs = zip(arguments[::2], arguments[1::2], strict=True)
            return next((self.number(value) for condition, value in pairs if self._holds(condition)), None)
        if head == "Table":
            return self._splines[arguments[0]].at(self.number(arguments[1]))
        numbers = list(map(self.number, arguments))
        if None in numbers:
            return None
        if head in ("Max", "Min"):
            return max(numbers) if head == "Max" else min(numbers)
        return (1 + mp.sign(numbers[0])) / 2

    def _holds(self, condition: Tree) -> bool:
        match condition:
            case "True" | "False":
                return condition == "True"
            case ["And" | "Or" as head, *parts]:
                return (all if head == "And" else any)(map(self._holds, parts))
            case ["Not", part]:
                return not self._holds(part)
            case [head, left, right]:
                return COMPARED[head](self.number(left), self.number(right))
            case _:
                raise ValueError(condition)


class Spline:
    """The cubic spline through the points of a table, by its second rates at the points."""

    def __init__(self, table: Table) -> None:
        self._table = table

    def at(self, time: Number) -> Number:
        """Its value at an instant."""
        times, values = self._points
        k = max((i for i, begin in enumerate(times[:-1]) if begin <= time), default=0)
        h, bends = times[k + 1] - times[k], self._bends
        left, right = times[k + 1] - time, time - times[k]
        return (
            (bends[k] * left**3 + bends[k + 1] * right**3) / (6 * h)
            + (values[k] / h - bends[k] * h / 6) * left
            + (values[k + 1] / h - bends[k + 1] * h / 6) * right
        )

    @cached_property
    def _points(self) -> tuple[list[Number], list[Number]]:
        points = Steps([exact(expression(each)) for point in self._table.points for each in point]).at({})
        return points[::2], points[1::2]

    @cached_property
    def _bends(self) -> list[Number]:
        """Second rates at the points: those of continuous first rates, solved for from the first point on."""
        times, values = self._points
        h = [end - begin for begin, end in itertools.pairwise(times)]
        slopes = [(high - low) / step for low, high, step in zip(values[:-1], values[1:], h, strict=True)]
        diagonal = [mp.one, *(2 * (a + b) for a, b in itertools.pairwise(h)), mp.one]
        below, above = [mp.zero, *h[:-1], mp.zero], [mp.zero, *h[1:], mp.zero]
        right = [mp.zero, *(6 * (b - a) for a, b in itertools.pairwise(slopes)), mp.zero]
        if self._table.ends is not None:
            first, last = Steps([exact(expression(end)) for end in self._table.ends]).at({})
            diagonal[0], above[0], right[0] = 2 * h[0], h[0], 6 * (slopes[0] - first)
            diagonal[-1], below[-1], right[-1] = 2 * h[-1], h[-1], 6 * (last - slopes[-1])
        for k in range(1, len(diagonal)):
            factor = below[k] / diagonal[k - 1]
            diagonal[k] -= factor * above[k - 1]
            right[k] -= factor * right[k - 1]
        bends = [right[-1] / diagonal[-1]]
        for k in range(len(diagonal) - 2, -1, -1):
            bends.append((right[k] - above[k] * bends[-1]) / diagonal[k])
        return bends[::-1]
