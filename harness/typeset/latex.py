"""LaTeX of expressions, of relations, and of the equations that the paper prints."""

from math import inf

from sympy import Expr

from ..mathjson import Tree
from ..record import Relation
from .formula import formula_box, relation_box
from .marks import marked
from .presentation import presented

MISPRINT, CORRECTION = "misprint", "correction"  # colours that a document defines


def latex(expression: Expr, width: float = inf) -> str:
    """Typeset an expression.

    Parameters
    ----------
    expression : Expr
        In the symbols of a derivation record: q1 is a letter with an index, dot(q1) the same under a dot, q1_0 and
        dot(q1)_0 their initial values, with a further index 0.
    width : float
        Width to keep to where the formula can be broken over lines, in digits of its typeface.

    Returns
    -------
    str
        LaTeX for math mode, with amsmath.

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

    Parameters
    ----------
    tree, other : int, str, dict or list
        Two equations of much the same form, for instance as printed and as corrected.
    colour : str
        Name of the colour, which a document defines: MISPRINT or CORRECTION.
    width : float
        As in `latex`.

    Returns
    -------
    str
        LaTeX for math mode, with amsmath and xcolor.
    """
    return formula_box(marked(tree, other, colour), width).latex
