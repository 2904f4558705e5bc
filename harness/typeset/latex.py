"""Write expressions, relations and equations of the paper as LaTeX.

Differences between two equations can be marked.
"""

from math import inf

from sympy import Expr

from ..expression.mathjson import Tree
from ..expression.presentation import presented
from ..record import Relation
from .formula import formula_box

MISPRINT, CORRECTION = "misprint", "correction"  # colours that a document defines


def latex(expression: Expr, width: float = inf) -> str:
    """Typeset an expression in LaTeX's math mode, with amsmath.

    Parameters
    ----------
    expression : Expr
        In the symbols of a derivation record: q1 is a symbol with an index, dot(q1) the same under a dot, q1_0 and
        dot(q1)_0 their initial values, with a further index 0.
    width : float
        Width to keep to where the formula can be broken over lines, in digits of its typeface.

    Returns
    -------
    str
        LaTeX without delimiters of math mode.

    Raises
    ------
    HolonomError
        A part of the expression is none that a derivation record can hold.
    """
    return formula_box(presented(expression), width).latex


def latex_relation(relation: Relation, width: float = inf) -> str:
    """Typeset left = right, broken into an `aligned` environment if it is too wide.

    Parameters
    ----------
    relation : Relation
        Both sides are expressions in the symbols of a derivation record.
    width : float
        Line width, in digits of the typeface.

    Returns
    -------
    str
        LaTeX without delimiters of math mode.
    """
    return formula_box(["Equal", presented(relation.left), presented(relation.right)], width).latex


def latex_tree(tree: Tree, width: float = inf) -> str:
    """Typeset an equation of the errata, terms and factors in its own order.

    `holonom.typeset.formula` lists the kinds of trees.

    Parameters
    ----------
    tree : Tree
        Equation of the errata.
    width : float
        Line width, in digits of the typeface.

    Returns
    -------
    str
        LaTeX without delimiters of math mode.
    """
    return formula_box(tree, width).latex


def latex_marked(tree: Tree, other: Tree, colour: str = MISPRINT, width: float = inf) -> str:
    """Typeset an equation of the errata, its differences from another in a colour.

    Parameters
    ----------
    tree, other : int, str, dict or list
        Two equations of much the same form, for example as published and as corrected.
    colour : str
        Name of the colour, which a document defines: MISPRINT or CORRECTION.
    width : float
        Line width, in digits of the typeface.

    Returns
    -------
    str
        LaTeX for math mode, with amsmath and xcolor.
    """
    return formula_box(marked(tree, other, colour), width).latex


IN_ANY_ORDER = {"Add", "Multiply"}
QUANTITIES = {"Subscript", "Dot", "Ddot", "Dddot", "Partial"}  # marked whole


def marked(tree: Tree, other: Tree, colour: str) -> Tree:
    """Mark the parts of a tree that are missing in the other one.

    Each part that differs is put into ["Marked", colour, part].

    Parameters
    ----------
    tree : Tree
        Equation to mark.
    other : Tree
        Equation to compare it with.
    colour : str
        Name of the colour, which the document defines.

    Returns
    -------
    Tree
        The tree with its marks.
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
    """Return for each part the one to compare it with, or None.

    Return None for all of them if the tree lacks parts of the other.
    """
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
