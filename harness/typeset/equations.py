"""Typeset equations of a derivation record.

Relations stand below each other. The entries of an array form one matrix.
"""

from collections.abc import Sequence
from itertools import groupby
from math import inf, prod

from sympy import Indexed

from ..expression.presentation import presented
from ..record import Equation, Relation
from .boxes import EQUALS, INDENT, Box, aligned
from .formula import formula_box, formula_lines
from .quantities import symbol_box

COLUMN_GAP = 2  # digits


def latex_equation(equation: Equation, width: float = inf) -> tuple[str, ...]:
    """Typeset an equation.

    Parameters
    ----------
    equation : Equation
        Equation of a derivation record.
    width : float
        Line width, in digits of the typeface.

    Returns
    -------
    tuple of str
        LaTeX for math mode, with amsmath: one formula for each block of relations.
    """
    return tuple(rows[0].replace("&", "", 1) if len(rows) == 1 else aligned(rows) for rows in blocks(equation, width))


def blocks(equation: Equation, width: float = inf) -> list[list[str]]:
    """Return the blocks of `latex_equation`, with the mark & of LaTeX's alignments.

    Parameters
    ----------
    equation : Equation
        Equation of a derivation record.
    width : float
        Line width, in digits of the typeface.

    Returns
    -------
    list of list of str
        Lines of each block, in LaTeX.
    """
    runs = groupby(equation.relations, _array)
    return [
        _plain_rows(list(relations), width) if name is None else _array_rows(name, list(relations), width)
        for name, relations in runs
    ]


def _array(relation: Relation) -> str | None:
    """Return the name of the vector or matrix that the left side is an entry of."""
    left = relation.left
    return left.base.label.name if isinstance(left, Indexed) and len(left.indices) < 3 else None


def _plain_rows(relations: Sequence[Relation], width: float) -> list[str]:
    """Return relations aligned at their equals signs, or flush left.

    They are flush left if one of them has a long left side.
    """
    sides = [(presented(relation.left), presented(relation.right)) for relation in relations]
    margins = [formula_box(left) for left, _ in sides]
    widest = max(margin.width for margin in margins)
    if widest > width / 3:
        return [f"& {line.latex}" for left, right in sides for line in formula_lines(["Equal", left, right], width)]
    return [
        f"{margin.latex} &= {line.latex}" if place == 0 else rf"& {INDENT.latex} {line.latex}"
        for (_, right), margin in zip(sides, margins, strict=True)
        for place, line in enumerate(formula_lines(right, width - widest - EQUALS.width - INDENT.width))
    ]


def _array_rows(name: str, entries: Sequence[Relation], width: float) -> list[str]:
    """Return the entries in brackets if they are short, else listed without zeros."""
    whole = _has_all_indices(entries)
    if whole and _suits_brackets(entries) and (matrix := _matrix(entries)).width <= width:
        letter = "A^{-1}" if name == "A_inverse" else symbol_box(name).latex
        return [f"{letter} &= {matrix.latex}"]
    present = [entry for entry in entries if entry.right != 0]
    if whole and len(present) in (0, len(entries)):
        return _plain_rows(entries, width)
    return [*_plain_rows(present, width), r"& \text{and zero for all other indices}"]


def _has_all_indices(entries: Sequence[Relation]) -> bool:
    """Return True if no entry was left out for being zero."""
    return len(entries) == prod(max(places) for places in zip(*(entry.left.indices for entry in entries), strict=True))


def _suits_brackets(entries: Sequence[Relation]) -> bool:
    """Return True for matrices, and for vectors of numbers."""
    return len(entries) > 1 and (len(entries[0].left.indices) == 2 or all(entry.right.is_number for entry in entries))


def _matrix(entries: Sequence[Relation]) -> Box:
    rows = [list(map(_value, row)) for _, row in groupby(entries, lambda entry: entry.left.indices[0])]
    widths = [max(entry.width for entry in column) + COLUMN_GAP for column in zip(*rows, strict=True)]
    cells = r" \\ ".join(" & ".join(entry.latex for entry in row) for row in rows)
    return Box(rf"\begin{{pmatrix}} {cells} \end{{pmatrix}}", sum(widths) + 2 * COLUMN_GAP + EQUALS.width, len(rows))


def _value(entry: Relation) -> Box:
    return formula_box(presented(entry.right))
