"""LaTeX of expressions, of relations, and of the equations that the paper prints, with marks on what differs."""

from math import inf

from sympy import Expr

from ..mathjson import Tree
from ..record import Relation
from .formula import formula_box, relation_box
from .presentation import presented

MISPRINT, CORRECTION = "misprint", "correction"  # colours that a document defines


def latex(expression: Expr, width: float = inf) -> str:
    """Typeset an expression in LaTeX's math mode, with amsmath.

    Parameters
    ----------
    expression : Expr
        In the symbols of a derivation record: q1 is a letter with an index, dot(q1) the same under a dot, q1_0 and
        dot(q1)_0 their initial values, with a further index 0.
    width : float
        Width to keep to where the formula can be broken over lines, in digits of its typeface.

    Raises
    ------
    HolonomError
        A part of the expression is none that a derivation record can hold.
    """
    return formula_box(presented(expression), width).latex


def latex_relation(relation: Relation, width: float = inf) -> str:
    """Typeset left = right, broken over the lines of an `aligned` environment if it is wider than `width`."""
    return relation_box(presented(relation.left), presented(relation.right), width).latex


def latex_tree(tree: Tree, width: float = inf) -> str:
    """Typeset an equation of the errata, terms and factors in its own order; `holonom.typeset.formula` lists trees."""
    return formula_box(tree, width).latex


def latex_marked(tree: Tree, other: Tree, colour: str = MISPRINT, width: float = inf) -> str:
    """Typeset an equation of the errata, what is not in the other one in a colour.

    LaTeX for math mode, with amsmath and xcolor.

    Parameters
    ----------
    tree, other : int, str, dict or list
        Two equations of much the same form, for instance as printed and as corrected.
    colour : str
        Name of the colour, which a document defines: MISPRINT or CORRECTION.
    width : float
        As in `latex`.
    """
    return formula_box(marked(tree, other, colour), width).latex


IN_ANY_ORDER = {"Add", "Multiply"}
QUANTITIES = {"Subscript", "Dot", "Ddot", "Dddot", "Partial"}  # marked whole


def marked(tree: Tree, other: Tree, colour: str) -> Tree:
    """Mark the parts of a tree that are not in the other one.

    Each part that differs is put into ["Marked", colour, part].
    """
    if tree == other:
        return tree
    if not _same_form(tree, other):
        return ["Marked", colour, tree]
    head, *parts = tree
    partners = _partners(head, parts, other[1:])
    return ["Marked", colour, tree] if partners is None else [head, *_marked_parts(parts, partners, colour)]


def _same_form(tree: Tree, other: Tree) -> bool:
    if not (isinstance(tree, list) and isinstance(other, list)) or tree[0] != other[0] or tree[0] in QUANTITIES:
        return False
    return len(tree) == len(other) or tree[0] in IN_ANY_ORDER


def _partners(head: str, parts: list[Tree], others: list[Tree]) -> list[Tree | None] | None:
    """For each part the one to compare it with, if there is one; None for all where a part is missing."""
    if head not in IN_ANY_ORDER:
        return list(others)
    lone, spare = _without(parts, others), _without(others, parts)
    if len(lone) < len(spare):
        return None
    left = iter(spare if len(lone) == len(spare) else [])
    return [part if part in others else next(left, None) for part in parts]


def _without(parts: list[Tree], others: list[Tree]) -> list[Tree]:
    return [part for part in parts if part not in others]


def _marked_parts(parts: list[Tree], partners: list[Tree | None], colour: str) -> list[Tree]:
    return [
        ["Marked", colour, part] if partner is None else marked(part, partner, colour)
        for part, partner in zip(parts, partners, strict=True)
    ]
