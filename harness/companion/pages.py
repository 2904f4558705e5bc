"""Parts of pages from templates, as XHTML."""

import re
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from inspect import isfunction
from typing import TYPE_CHECKING

import jinja2
import numpy as np
from markupsafe import Markup, escape
from sympy import Expr, Float, Rational, simplify  # noqa: F401

from ..explanations import advice, engine_text, notes  # noqa: F401, for the heads of pages, as simplify
from ..failures import ErrorKind, HolonomError
from ..figures import benchmark, curves, drawing, motion
from ..figures.style import Picture
from ..files import shared
from ..free_motion import FirstCoefficient, UniversalLaw
from ..language import gettext, ngettext, spoken, translated
from ..maxima import statement_ends
from ..number_texts import number
from ..program.motion_program import Program
from ..program.targets import javascript
from ..record import Scene
from ..typeset.latex import latex, latex_tree
from . import EXAMPLES, TEMPLATES, cards, convergence, mathematics, motions, power, table, worked_example
from .cards import Card

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LONGEST_COEFFICIENT = 12  # characters of an exact number in a table
NAMED_BY_MAXIMA = re.compile(r"(no control law makes every motion free: .* is )(.+)($)")
NOT_OF_A_WORD = re.compile(r"[^\w ]")
CODE_IN_TEXT = re.compile(r"`([^`]+)`")
NEGLIGIBLE = 1e-9  # of a complex number: a part of it that is rounding alone
MODULES = (benchmark, curves, drawing, motion, cards, convergence, mathematics, motions, power, worked_example)
NAMED = {"Panel": curves.Panel, "TIMES": benchmark.TIMES, "exhibits": table("gallery")["exhibit"]}
NAMED |= {"linspace": np.linspace, "array": np.array, "sin": np.sin}
MACROS = ("tables.html", "cards.html", "answers.html", "motions.html")
WHITESPACE = {"trim_blocks": True, "lstrip_blocks": True, "keep_trailing_newline": True}


@cache
def environment(language: str) -> jinja2.Environment:
    """Return the environment of the templates with its macros, one per language.

    The functions of this module and of `MODULES` are known by their names, as filters and as functions.

    Parameters
    ----------
    language : str
        Language code.

    Returns
    -------
    jinja2.Environment
        Environment of the language.
    """
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        extensions=["jinja2.ext.i18n"],
        **WHITESPACE,
    )
    named = [pair for module in MODULES for pair in vars(module).items() if not pair[0].startswith("_")]
    own = [(name.removeprefix("_"), each) for name, each in globals().items()]
    functions = {name: each for name, each in named + own if isfunction(each)}
    environment.filters = functions | environment.filters
    environment.globals |= functions | NAMED | {"language": language, "in_repository": shared("tests").is_dir()}
    environment.install_gettext_callables(gettext, ngettext)
    for library in MACROS:
        macros = environment.get_template(library).module
        environment.globals |= {name: macro for name, macro in vars(macros).items() if not name.startswith("_")}
    return environment


def excerpt(file: str, name: str) -> str:
    """Return the statement of an example that assigns a name.

    Parameters
    ----------
    file : str
        Scene file, relative to the folder of the examples.
    name : str
        Name that the statement assigns, at the beginning of a line.

    Returns
    -------
    str
        Lines as they are in the file.

    Raises
    ------
    HolonomError
        The file does not assign the name.
    """
    text = "\n" + (EXAMPLES / file).read_text(encoding="utf-8")
    start = text.find(f"\n{name} : ") + 1
    if not start:
        raise HolonomError(ErrorKind.DEFINITION_MISSING, file, name)
    return text[start : next(statement_ends(text, start), len(text))]


def _words_of(card: Card) -> Markup:
    """Return the plain words for an equation."""
    keys = (card.id, f"{card.number} {card.name}", card.number, card.name)
    found = next((found for key in keys if (found := table("words").get(key))), {})
    plain = found.get("words", "")
    return mathematics.prose(translated(plain if card.controlled else found.get("without_controls", plain)))


def _sentence(text: str) -> str:
    return text if text[1:2].isdigit() else text[:1].upper() + text[1:]  # q1 is a symbol


def _listed(items: Iterable[Markup]) -> Markup:
    return Markup(gettext(", ")).join(items)


def _equalities(values: Mapping[str, Expr]) -> Markup:
    return _listed(mathematics.equality(name, value) for name, value in values.items())


def _numbers_of(scene: Scene) -> dict[str, Expr]:
    """Parameters and initial state of a scene."""
    return {**scene.parameter_values, **scene.initial_state}


def _symbols(names: Iterable[str]) -> Markup:
    return _listed(map(mathematics.symbol, names))


def _law_text(law: UniversalLaw) -> Markup:
    """Return a control law: controls, free controls and positivity conditions."""
    text = _equalities(law.controls)
    for name in law.free:
        message = Markup(gettext("%(law)s, %(control)s any function of the time"))
        text = message % {"law": text, "control": mathematics.symbol(name)}
    if law.positive:
        conditions = _listed(mathematics.expression(each) + " " + mathematics.tex("> 0") for each in law.positive)
        text = Markup(gettext("%(law)s, where %(conditions)s")) % {"law": text, "conditions": conditions}
    return text


def _rounded(value: float, digits: int = 6) -> str:
    return f"{float(f'{float(value):.{digits}g}'):.15g}"


def _counted(message: str, count: int, none: str) -> str:
    """Return the message with the count in it, or that there are none."""
    return message % {"count": count} if count else none


def _complex_numbers(values: Sequence[complex]) -> Markup:
    """Complex numbers, of each conjugate pair both at once."""
    return _listed(mathematics.tex(_pair(value)) for value in values if value.imag >= 0)


def _pair(value: complex) -> str:
    real = "" if abs(value.real) < NEGLIGIBLE * abs(value) else f"{value.real:.6g}"
    return rf"{real} \pm {value.imag:.6g}\,i" if value.imag else real


def _coefficient(text: str) -> str:
    """Return an exact number that is short, or a rounded one."""
    return text if len(text) <= LONGEST_COEFFICIENT else f"{float(number(text)):.10g}"


def _first_term(first: FirstCoefficient) -> Markup:
    """Return the first term of a power series, within a line of text."""
    shown = _coefficient(first.value)
    value = latex(Rational(shown) if shown == first.value else Float(shown))
    power = {0: "", 1: " (t - t_0)"}.get(first.order, f" (t - t_0)^{{{first.order}}}")
    return mathematics.tex(f"{latex_tree(first.multiplier)} = {value}{power} + \\ldots")


def _maxima_text(text: str) -> Markup:
    """Return a reason of Maxima's, an expression that it names as code."""
    return Markup(NAMED_BY_MAXIMA.sub(r"\1<code>\2</code>\3", str(escape(translated(text)))))


def _power_of_ten(value: float) -> Markup:
    """Return a small number with one digit and its power of ten."""
    if not value:
        return mathematics.tex("0")
    digit, exponent = f"{value:.0e}".split("e")
    return mathematics.tex(rf"{digit} \times 10^{{{int(exponent)}}}")


def _drawing(name: str) -> str:
    """Return a drawing that is a template, with its labels in the current language."""
    return environment(spoken()).get_template(name).render()


def _svg(figure: "Figure") -> str:
    """Return a figure as the text of an SVG document."""
    return Picture(figure)._repr_svg_()


def _javascript(program: Program, name: str) -> Markup:
    """Return a motion program as an object of JavaScript."""
    return Markup(javascript.write(program, name))


def _css_string(text: str) -> Markup:
    """Return a string of a style sheet. The space ends an escape."""
    return Markup('"{}"').format(Markup(NOT_OF_A_WORD.sub(lambda found: rf"\{ord(found[0]):x} ", text)))


def _with_names_typeset(text: str) -> Markup:
    """Return the text with names between backquotes as symbols."""
    return Markup(CODE_IN_TEXT.sub(lambda name: mathematics.symbol(name[1]), str(escape(text))))


def _with_code(text: str) -> Markup:
    """Return the text with parts between backquotes as code."""
    return Markup(CODE_IN_TEXT.sub(r"<code>\1</code>", str(escape(text))))
