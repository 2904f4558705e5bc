"""Read the relations of a record, and check their left sides."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import sympy as sp

from ..expression.trees import Tree
from ..language import translatable
from ..record import Relation
from .system import exact
from .verdict import Pair

Entries = Mapping[tuple[int, ...], sp.Expr]
"""Entries of an indexed quantity, by their indices, which count from one."""

NO_RELATION = translatable("no relation for %(left)s")


class NotComparable(Exception):
    """A relation that is missing, or has another left side.

    Parameters
    ----------
    pattern : str
        Message with placeholders, which a catalog translates.
    **values : object
        Values of the placeholders.
    """

    def __init__(self, pattern: str, **values: object) -> None:
        super().__init__(pattern)
        self.reason = translatable(pattern, **values)


def read_exactly(keys: Sequence[Tree], relations: Sequence[Relation]) -> list[sp.Expr]:
    """Return the right sides of the relations with these left sides, in this order.

    Parameters
    ----------
    keys : sequence of Tree
        Left sides that belong there, as trees.
    relations : sequence of Relation
        Relations of the record.

    Returns
    -------
    list of Expr
        Right sides, with decimal numbers as fractions.

    Raises
    ------
    NotComparable
        A left side is another, is missing, or is one too many.
    """
    for i, relation in enumerate(relations):
        if i >= len(keys) or relation.left_tree != keys[i]:
            belongs = shown(keys[i]) if i < len(keys) else translatable("nothing")
            raise NotComparable(
                translatable("%(left)s where %(belongs)s belongs"), left=shown(relation.left_tree), belongs=belongs
            )
    if len(relations) < len(keys):
        raise NotComparable(NO_RELATION, left=shown(keys[len(relations)]))
    return [exact(relation.right) for relation in relations]


def solved_for(symbols: Sequence[sp.Symbol], relations: Sequence[Relation]) -> dict[sp.Symbol, sp.Expr]:
    """Return the right side of the relation for each symbol, in their order.

    Parameters
    ----------
    symbols : sequence of Symbol
        Symbols that belong on the left sides.
    relations : sequence of Relation
        Relations of the record.

    Returns
    -------
    dict of Symbol to Expr

    Raises
    ------
    NotComparable
        As `read_exactly`.
    """
    return dict(zip(symbols, read_exactly([symbol.name for symbol in symbols], relations), strict=True))


def list_of(name: str, length: int, relations: Sequence[Relation]) -> list[sp.Expr]:
    """Return the entries of the list ``name``, each in its place.

    Parameters
    ----------
    name : str
        Name of the list.
    length : int
        Number of its entries.
    relations : sequence of Relation
        Relations of the record.

    Returns
    -------
    list of Expr

    Raises
    ------
    NotComparable
        As `read_exactly`.
    """
    return read_exactly([["Subscript", name, i] for i in range(1, length + 1)], relations)


def sparse_entries(
    name: str, shape: Sequence[int], order: Sequence[int], relations: Sequence[Relation]
) -> dict[tuple[int, ...], sp.Expr]:
    """Return the entries of the indexed quantity ``name``, sorted by their indices.

    Missing entries are zero. The indices are compared in the order in which they are named: (2, 0, 1) for the third,
    the first, the second.

    Parameters
    ----------
    name : str
        Name of the quantity.
    shape : sequence of int
        Largest value of each index.
    order : sequence of int
        Places of the indices, the most significant one first.
    relations : sequence of Relation
        Relations of the record.

    Returns
    -------
    dict of tuple of int to Expr
        Entries by their indices, which count from one.

    Raises
    ------
    NotComparable
        An index is outside the shape, or an entry is there twice or out of order.
    """
    entries: dict[tuple[int, ...], sp.Expr] = {}
    last: list[int] = []
    for relation in relations:
        match relation.left_tree:
            case ["Subscript", str(named), *indices] if named == name and len(indices) == len(shape):
                inside = all(
                    isinstance(i, int) and not isinstance(i, bool) and 1 <= i <= n
                    for i, n in zip(indices, shape, strict=True)
                )
            case _:
                inside = False
        if not inside or (place := [indices[i] for i in order]) <= last:
            raise NotComparable(translatable("an entry %(left)s that is out of place"), left=shown(relation.left_tree))
        last = place
        entries[tuple(indices)] = exact(relation.right)
    return entries


def numbered(what: str, number: int) -> str:
    """Return the name of a quantity, for messages: "constraint 2".

    Parameters
    ----------
    what : str
        Name of the quantities.
    number : int
        Place among them, counted from 1.

    Returns
    -------
    str
    """
    return translatable("%(what)s %(number)s", what=what, number=number)


def residual_pairs(what: str, relations: Sequence[Relation], expected: Sequence[sp.Expr]) -> tuple[Pair, ...]:
    """Pair left side less right side of each relation with the expected residual.

    Parameters
    ----------
    what : str
        Name of the relations, for messages.
    relations : sequence of Relation
        Relations of the record.
    expected : sequence of Expr
        Residuals by the independent evaluation, as many.

    Returns
    -------
    tuple of Pair
        One for each relation.

    Raises
    ------
    NotComparable
        There are more or fewer relations than residuals.
    """
    if len(relations) != len(expected):
        raise NotComparable(
            translatable("%(count)s relations (%(what)s) where %(expected)s belong"),
            count=len(relations),
            what=what,
            expected=len(expected),
        )
    return tuple(
        Pair(numbered(what, i), exact(relation.left) - exact(relation.right), residual)
        for i, (relation, residual) in enumerate(zip(relations, expected, strict=True), start=1)
    )


def shown(left: Tree) -> str:
    """Return a left side for people: ``A[1, 2]``.

    Parameters
    ----------
    left : Tree
        Left side, as a tree.

    Returns
    -------
    str
    """
    match left:
        case ["Subscript", str(name), *indices]:
            return f"{name}[{', '.join(map(str, indices))}]"
        case str():
            return left
        case _:
            return translatable("an expression")
