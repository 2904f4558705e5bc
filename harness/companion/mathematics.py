"""Mathematics on a page: what the templates call to have formulas typeset."""

import re

from markupsafe import Markup, escape
from sympy import Expr, Symbol, sympify

from ..errata import PrintedEquation
from ..mathjson import Tree, from_sympy
from ..record import Equation, Relation
from ..typeset.equations import latex_equation
from ..typeset.latex import CORRECTION, MISPRINT, latex, latex_marked, latex_relation, latex_tree
from ..typeset.mathml import inline_mathml, mathml

WIDTH = 62  # digits that fit in a card on a desk; a phone scrolls the card
NOTHING = {
    "6": "There are none: the mass matrix does not depend on the coordinates.",
    "19": "No formula: the constraints are not linear in what the scene leaves out, or it leaves nothing out.",
}
UNCONSTRAINED = "There are no constraints, and so no multipliers: every motion is free."
FORMULA_IN_PROSE = re.compile(r"\$([^$]+)\$")


def tex(formula: str) -> Markup:
    """A formula within a line of text."""
    return Markup(inline_mathml(formula))


def prose(text: str) -> Markup:
    """Text with the TeX between its dollar signs typeset."""
    literal = Markup if isinstance(text, Markup) else escape
    pieces = FORMULA_IN_PROSE.split(str(text))
    return Markup("").join(tex(piece) if place % 2 else literal(piece) for place, piece in enumerate(pieces))


def expression(value: Expr) -> Markup:
    """A SymPy expression within a line of text."""
    return Markup(inline_mathml(latex(value), str(value)))


def equality(name: str, value: Expr) -> Markup:
    """A named value within a line of text."""
    return symbol(name) + tex("=") + expression(value)


def display(left: Expr, right: Expr | int) -> Markup:
    """Both sides of an equation on lines of its own."""
    relation = Relation(from_sympy(left), from_sympy(sympify(right)))
    return Markup(mathml(latex_relation(relation, WIDTH), f"{left} = {right}"))


def display_named(name: str, value: Expr) -> Markup:
    """A named value on lines of its own."""
    return display(Symbol(name, real=True), value)


def display_expression(value: Expr) -> Markup:
    """An expression on lines of its own."""
    return Markup(mathml(latex(value, WIDTH), str(value)))


def symbol(name: str) -> Markup:
    """The letter of a quantity within a line of text."""
    return expression(Symbol(name, real=True))


def typeset(equation: Equation) -> list[Markup]:
    """The relations of an equation; those of the entries of one array as one, where it is narrow enough."""
    said = "; ".join(f"{relation.left} = {relation.right}" for relation in equation.relations)
    return [Markup(mathml(formula, said)) for formula in latex_equation(equation, WIDTH)]


def nothing_to_show(equation: Equation) -> str:
    """What an equation without relations says."""
    return NOTHING.get(equation.number, UNCONSTRAINED)


def as_printed(printed: PrintedEquation) -> Markup:
    """An equation as the paper prints it, the misprint marked."""
    if printed.agrees:
        return _printed(printed.printed_tree, printed.printed_tree, MISPRINT, printed.printed)
    return _printed(printed.printed_tree, printed.corrected_tree, MISPRINT, printed.printed)


def as_corrected(printed: PrintedEquation) -> Markup:
    """The printed equation mended, the correction marked."""
    return _printed(printed.corrected_tree, printed.printed_tree, CORRECTION, printed.corrected)


def difference(printed: PrintedEquation) -> Markup:
    """What is printed less what is derived."""
    return _block(latex_tree(printed.difference_tree, WIDTH), printed.difference)


def _printed(tree: Tree, other: Tree, colour: str, text: str) -> Markup:
    return _block(latex_marked(tree, other, colour, WIDTH), text)


def _block(formula: str, said: str) -> Markup:
    return Markup('<div class="formula" tabindex="0">{}</div>').format(Markup(mathml(formula, said)))
