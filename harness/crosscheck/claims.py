"""The record's relations, sorted by the quantity on their left."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import sympy as sp

from ..record import Relation
from .verdict import Pair

Entries = Mapping[tuple[int, ...], sp.Expr]
"""Entries of an indexed quantity, by their indices, which count from one."""


class NotComparable(Exception):
    """A relation is missing, or it is about something else; says which."""


def residual_pairs(what: str, relations: Sequence[Relation], expected: Sequence[sp.Expr]) -> tuple[Pair, ...]:
    """Left side less right side of each relation, against the expected residual.

    Raises
    ------
    NotComparable
        There are more or fewer relations than residuals.
    """
    if len(relations) != len(expected):
        raise NotComparable(f"{len(relations)} relations ({what}) where {len(expected)} belong")
    return tuple(
        Pair(f"{what} {i}", relation.left - relation.right, residual)
        for i, (relation, residual) in enumerate(zip(relations, expected, strict=True), start=1)
    )


def solved_for(symbols: Sequence[sp.Symbol], relations: Sequence[Relation]) -> dict[sp.Symbol, sp.Expr]:
    """Right side of the relation for each symbol.

    Raises
    ------
    NotComparable
        The left sides are not these symbols, each once.
    """
    lefts = [relation.left for relation in relations]
    if sorted(lefts, key=str) != sorted(symbols, key=str):
        raise NotComparable(f"relations for {_listed(lefts)} where {_listed(symbols)} belong")
    return {relation.left: relation.right for relation in relations}


def entries_of(name: str, shape: Sequence[int], relations: Sequence[Relation]) -> Entries:
    """Entries of the indexed quantity ``name``; what is not there is zero.

    Raises
    ------
    NotComparable
        An index is outside the shape, or an entry is there twice.
    """
    entries: dict[tuple[int, ...], sp.Expr] = {}
    for relation in relations:
        if not (isinstance(relation.left, sp.Indexed) and relation.left.base.label.name == name):
            continue
        indices = tuple(int(index) for index in relation.left.indices)
        inside = len(indices) == len(shape) and all(1 <= i <= n for i, n in zip(indices, shape, strict=True))
        if not inside or indices in entries:
            raise NotComparable(f"an entry {relation.left} that is out of place")
        entries[indices] = relation.right
    return entries


def require_names(names: Iterable[str], relations: Sequence[Relation]) -> None:
    """Refuse relations about an indexed quantity or symbol that is not named."""
    allowed = set(names)
    for relation in relations:
        left = relation.left
        name = left.base.label.name if isinstance(left, sp.Indexed) else str(left)
        if name not in allowed:
            raise NotComparable(f"a relation for {left} that is out of place")


def _listed(symbols: Sequence[sp.Basic]) -> str:
    return ", ".join(map(str, symbols)) or "nothing"
