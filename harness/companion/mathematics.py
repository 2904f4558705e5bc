"""Mathematics on a page: what the templates call to have formulas typeset."""

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import sympy
from markupsafe import Markup, escape
from sympy import Expr, IndexedBase, Symbol, sympify

from ..errata import PrintedEquation
from ..language import translatable, translated
from ..mathjson import Tree, from_sympy
from ..record import Equation, Relation, System
from ..typeset.equations import latex_equation
from ..typeset.latex import CORRECTION, MISPRINT, latex, latex_marked, latex_relation, latex_tree
from ..typeset.mathml import inline_mathml, mathml

WIDTH, NARROW = 62, 30  # digits that fit in a card on a desk and on a phone
TALL = 14  # lines of a formula that is folded, for it would fill a screen
NOTHING = {
    "6": translatable("There are none: the mass matrix does not depend on the coordinates."),
    "19": translatable(
        "No formula: the constraints are not linear in what the scene leaves out, or it leaves nothing out."
    ),
}
UNCONSTRAINED = translatable("There are no constraints, and so no multipliers: every motion is free.")
LINE_BREAK = r"\\"
FORMULA_IN_PROSE = re.compile(r"\$([^$]+)\$")


Formulas = Callable[[int], Sequence[str]]  # LaTeX at a width in digits


def tex(formula: str) -> Markup:
    """Return a formula within a line of text.

    Parameters
    ----------
    formula : str
        TeX formula.

    Returns
    -------
    Markup
        MathML.
    """
    return Markup(inline_mathml(formula))


def prose(text: str) -> Markup:
    """Text with the TeX between its dollar signs typeset.

    Parameters
    ----------
    text : str
        Text with TeX between dollar signs.

    Returns
    -------
    Markup
        HTML.
    """
    literal = Markup if isinstance(text, Markup) else escape
    pieces = FORMULA_IN_PROSE.split(str(text))
    return Markup("").join(tex(piece) if place % 2 else literal(piece) for place, piece in enumerate(pieces))


def expression(value: Expr) -> Markup:
    """Return a SymPy expression within a line of text.

    Parameters
    ----------
    value : Expr
        SymPy expression.

    Returns
    -------
    Markup
        MathML.
    """
    return Markup(inline_mathml(latex(value), str(value)))


def equality(name: str, value: Expr) -> Markup:
    """Return a named value within a line of text.

    Parameters
    ----------
    name : str
        Name of the quantity.
    value : Expr
        SymPy expression.

    Returns
    -------
    Markup
        MathML.
    """
    return symbol(name) + tex("=") + expression(value)


def display(left: Expr, right: Expr | int) -> Markup:
    """Return both sides of an equation on lines of its own.

    Parameters
    ----------
    left : Expr
        Left side.
    right : Expr or int
        Right side.

    Returns
    -------
    Markup
        MathML.
    """
    relation = Relation(from_sympy(left), from_sympy(sympify(right)))
    return _at_each_width(lambda width: [latex_relation(relation, width)], f"{left} = {right}")


def display_named(name: str, value: Expr) -> Markup:
    """Return a named value on lines of its own.

    Parameters
    ----------
    name : str
        Name of the quantity.
    value : Expr
        SymPy expression.

    Returns
    -------
    Markup
        MathML.
    """
    return display(Symbol(name, real=True), value)


def display_expression(value: Expr) -> Markup:
    """Return an expression on lines of its own.

    Parameters
    ----------
    value : Expr
        SymPy expression.

    Returns
    -------
    Markup
        MathML.
    """
    return _at_each_width(lambda width: [latex(value, width)], str(value))


def symbol(name: str) -> Markup:
    """Return the symbol of a quantity within a line of text.

    Parameters
    ----------
    name : str
        Name of the quantity.

    Returns
    -------
    Markup
        MathML.
    """
    return expression(Symbol(name, real=True))


@dataclass(frozen=True)
class Typeset:
    """An equation as it is shown."""

    formula: Markup  # empty where it has no relations
    lines: int  # how many it takes on a desk

    @property
    def is_tall(self) -> bool:
        """True if the picture would fill a screen."""
        return self.lines > TALL


def typeset(equation: Equation) -> Typeset:
    """Return the relations of an equation, entries of an array as one if they fit.

    Parameters
    ----------
    equation : Equation
        Equation of a record.

    Returns
    -------
    Typeset
        Typeset relations.
    """
    spoken = "; ".join(f"{relation.left} = {relation.right}" for relation in equation.relations)
    lines = sum(formula.count(LINE_BREAK) + 1 for formula in latex_equation(equation, WIDTH))
    return Typeset(_at_each_width(lambda width: latex_equation(equation, width), spoken), lines)


def nothing_to_show(equation: Equation) -> str:
    """Return the text for an equation without relations.

    Parameters
    ----------
    equation : Equation
        Equation of a record.

    Returns
    -------
    str
        Message.
    """
    return translated(NOTHING.get(equation.number, UNCONSTRAINED))


def as_printed(printed: PrintedEquation) -> Markup:
    """Return an equation as the paper prints it, the misprint marked.

    Parameters
    ----------
    printed : PrintedEquation
        Equation of the paper.

    Returns
    -------
    Markup
        MathML.
    """
    if printed.agrees:
        return _printed(printed.printed_tree, printed.printed_tree, MISPRINT, printed.printed)
    return _printed(printed.printed_tree, printed.corrected_tree, MISPRINT, printed.printed)


def as_corrected(printed: PrintedEquation) -> Markup:
    """Return the printed equation mended, the correction marked.

    Parameters
    ----------
    printed : PrintedEquation
        Equation of the paper.

    Returns
    -------
    Markup
        MathML.
    """
    return _printed(printed.corrected_tree, printed.printed_tree, CORRECTION, printed.corrected)


def difference(printed: PrintedEquation) -> Markup:
    """Return the printed minus the derived expression.

    Parameters
    ----------
    printed : PrintedEquation
        Equation of the paper.

    Returns
    -------
    Markup
        MathML.
    """
    return _block(lambda width: [latex_tree(printed.difference_tree, width)], printed.difference)


def _printed(tree: Tree, other: Tree, colour: str, text: str) -> Markup:
    return _block(lambda width: [latex_marked(tree, other, colour, width)], text)


def _block(formulas: Formulas, spoken: str) -> Markup:
    return Markup('<div class="formula">{}</div>').format(_at_each_width(formulas, spoken))


def _at_each_width(formulas: Formulas, spoken: str) -> Markup:
    """Return a formula broken for a wide and for a narrow page."""
    wide, narrow = formulas(WIDTH), formulas(NARROW)
    if wide == narrow:
        return _blocks(wide, spoken)
    return Markup('<div class="wide">{}</div><div class="narrow">{}</div>').format(
        _blocks(wide, spoken), _blocks(narrow, spoken)
    )


def _blocks(formulas: Sequence[str], spoken: str) -> Markup:
    return Markup("").join(Markup(mathml(formula, spoken)) for formula in formulas)


def description(system: System) -> list[Markup]:
    """T, V, Q and f of a system, those that it has.

    Parameters
    ----------
    system : System
        Description of the system.

    Returns
    -------
    list of Markup
        Formulas.
    """
    return [display(left, right) for left, right in _parts(system)]


def _parts(system: System) -> Iterator[tuple[Expr, Expr]]:
    yield _symbol("T"), sympy.Add(*(effect.value for effect in system.kinetic_energy))
    if system.potential_energy:
        yield _symbol("V"), sympy.Add(*(effect.value for effect in system.potential_energy))
    if system.forces:
        for s, components in enumerate(zip(*(effect.value for effect in system.forces), strict=True), 1):
            yield IndexedBase(_symbol("Q"))[s], sympy.Add(*components)
    for beta, constraint in enumerate(system.constraints, 1):
        yield IndexedBase(_symbol("f"))[beta], constraint


def _symbol(name: str) -> Symbol:
    return Symbol(name, real=True)
