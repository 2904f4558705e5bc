"""Mathematics on a page: what the templates call to have formulas typeset."""

import re
from collections.abc import Callable, Sequence

from markupsafe import Markup, escape
from sympy import Add, Expr, IndexedBase, Symbol, sympify

from ..errata import PrintedEquation
from ..expression.mathjson import from_sympy
from ..language import translatable, translated
from ..record import Equation, Relation, System
from ..typeset.equations import latex_equation
from ..typeset.latex import CORRECTION, MISPRINT, latex, latex_marked, latex_relation, latex_tree
from ..typeset.mathml import inline_mathml, mathml
from . import table

WIDTH, NARROW = 62, 30  # digits that fit in a card on a desk and on a phone
UNCONSTRAINED = translatable("There are no constraints, and so no multipliers: every motion is free.")
LINE_BREAK = r"\\"
FORMULA_IN_PROSE = re.compile(r"\$([^$]+)\$")


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
    return _block(lambda width: [latex_relation(relation, width)], f"{left} = {right}")


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
    return _block(lambda width: [latex(value, width)], str(value))


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


def typeset(equation: Equation) -> Markup:
    """Return the relations of an equation, entries of an array as one if they fit.

    Parameters
    ----------
    equation : Equation
        Equation of a record.

    Returns
    -------
    Markup
        MathML.
    """
    spoken = "; ".join(f"{relation.left} = {relation.right}" for relation in equation.relations)
    return _block(lambda width: latex_equation(equation, width), spoken)


def lines(equation: Equation) -> int:
    """Return the number of lines that an equation takes on a desk.

    Parameters
    ----------
    equation : Equation
        Equation of a record.

    Returns
    -------
    int
        Number of lines.
    """
    return sum(formula.count(LINE_BREAK) + 1 for formula in latex_equation(equation, WIDTH))


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
    return translated(table("words").get(equation.id, {}).get("nothing", UNCONSTRAINED))


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
    derived = printed.corrected_tree or printed.printed_tree
    return _block(lambda width: [latex_marked(printed.printed_tree, derived, MISPRINT, width)], printed.printed)


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
    trees = printed.corrected_tree, printed.printed_tree
    return _block(lambda width: [latex_marked(*trees, CORRECTION, width)], printed.corrected)


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


def _block(formulas: Callable[[int], Sequence[str]], spoken: str) -> Markup:
    """Return a formula on lines of its own, for a wide and for a narrow page.

    It is given as LaTeX at a width in digits.
    """
    wide, narrow = (Markup("".join(mathml(each, spoken) for each in formulas(width))) for width in (WIDTH, NARROW))
    both = Markup('<div class="wide">{}</div><div class="narrow">{}</div>').format(wide, narrow)
    return Markup('<div class="formula">{}</div>').format(wide if wide == narrow else both)


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
    energies = zip(("T", "V"), (system.kinetic_energy, system.potential_energy), strict=True)
    sums = {name: Add(*(each.value for each in terms)) for name, terms in energies if terms}
    parts = [(Symbol(name, real=True), value) for name, value in sums.items()]
    components = zip(*(each.value for each in system.forces), strict=True)
    parts += [(IndexedBase("Q")[s], Add(*terms)) for s, terms in enumerate(components, 1)]
    parts += [(IndexedBase("f")[beta], each) for beta, each in enumerate(system.constraints, 1)]
    return [display(left, right) for left, right in parts]
