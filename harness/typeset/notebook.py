"""Show equations and symbols in a notebook, as MathML and as LaTeX."""

from collections.abc import Iterator, Sequence
from html import escape
from math import inf
from typing import Any

from sympy import Symbol

from ..record import Equation
from .equations import latex_equation
from .mathml import mathml
from .quantities import RATE, name_box, spelled_apart

WIDTH = 90  # digits of a formula's typeface that fit a notebook's cell


class TypesetSymbol(Symbol):
    """A real quantity of a system, printed as its symbol.

    ``dot(q1)`` is printed with a dot and an index.
    """

    def __new__(cls, name: str) -> "TypesetSymbol":
        """Return the one symbol of that name."""
        return Symbol.__new__(cls, name, real=True)

    def __getnewargs_ex__(self) -> tuple[tuple[str], dict[str, Any]]:
        return (self.name,), {}

    def _latex(self, printer: Any) -> str:
        return name_box(self.name).latex

    def _pretty(self, printer: Any) -> Any:
        rate = RATE.fullmatch(self.name)  # dot(q1) is q1dot to SymPy, which draws the dot
        name = f"{rate[2]}{rate[1]}ot{rate[3]}" if rate else self.name
        return printer._print_Symbol(Symbol(name))


def equations_html(equations: Sequence[Equation]) -> str:
    """Return equations under their numbers and names, formulas in MathML.

    Parameters
    ----------
    equations : sequence of Equation
        Equations of a derivation record.

    Returns
    -------
    str
        HTML.
    """
    with spelled_apart(_names(equations)):
        return "\n".join(_html_parts(equations))


def _names(equations: Sequence[Equation]) -> set[str]:
    sides = (side for equation in equations for each in equation.relations for side in (each.left, each.right))
    return {symbol.name for side in sides for symbol in side.free_symbols}


def _html_parts(equations: Sequence[Equation]) -> Iterator[str]:
    for equation in equations:
        yield f"<p><b>({escape(equation.number)})</b> {escape(equation.name)}</p>"
        yield from map(mathml, latex_equation(equation, WIDTH) if equation.relations else ())


def equations_latex(equations: Sequence[Equation]) -> str:
    """Return equations below each other, as LaTeX for a notebook's Markdown.

    Parameters
    ----------
    equations : sequence of Equation
        Equations of a derivation record. Those without relations are left out.

    Returns
    -------
    str
        Displayed formulas between ``$$``.
    """
    with spelled_apart(_names(equations)):
        formulas = (formula for each in equations if each.relations for formula in latex_equation(each, inf))
        return "\n".join(f"$$\n{formula}\n$$" for formula in formulas)
