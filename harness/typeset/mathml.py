"""Convert LaTeX to MathML that browsers show natively, by latex2mathml.

Chromium and Firefox read MathML Core, a subset of the output of latex2mathml: columns are aligned and spaced by
style, marks are classes, and a formula has a text alternative.
"""

from itertools import pairwise
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from ..extras import missing_package

NAMESPACE = "http://www.w3.org/1998/Math/MathML"
COLOURS = ("misprint", "correction")
PUNCTUATION = {";", "!"}  # characters to latex2mathml
SIGNS = {"+", "\u2212"}
BEFORE_A_PREFIX = {"=", "(", "[", ","}  # what a sign that belongs to one term alone stands after
ROWS = ("}math", "}mrow", "}mstyle", "}mtd")
WITH_SCRIPTS = ("}msub", "}msubsup", "}msup")
UNKNOWN_TO_CORE = ("columnspacing", "rowspacing", "columnalign", "fence")

ElementTree.register_namespace("", NAMESPACE)


def mathml(latex: str, alt: str = "") -> str:
    """Return a displayed formula, a <math display="block"> element.

    Marked parts have the class of their colour.

    Parameters
    ----------
    latex : str
        LaTeX for math mode, as `holonom.typeset.latex` makes it.
    alt : str
        Text alternative. Without it, the LaTeX on one line.

    Returns
    -------
    str
        The ``math`` element.

    Raises
    ------
    HolonomError
        latex2mathml is not installed.
    xml.etree.ElementTree.ParseError
        The output of latex2mathml is not well-formed.
    """
    return _converted(latex, alt, "block")


def inline_mathml(latex: str, alt: str = "") -> str:
    """Return a formula within a line of text, otherwise like `mathml`.

    Parameters
    ----------
    latex : str
        LaTeX for math mode.
    alt : str
        Text alternative. Without it, the LaTeX on one line.

    Returns
    -------
    str
        The ``math`` element.
    """
    return _converted(latex, alt, "inline")


def _converted(latex: str, alt: str, display: str) -> str:
    root = ElementTree.fromstring(_by_latex2mathml(latex.replace("{aligned}", "{split}"), display))
    for element in root.iter():  # a row before what is in it
        _set_functions_apart(element)
        _to_core(element)
        _bind_signs(element)
    root.set("alttext", alt or " ".join(latex.split()))
    return ElementTree.tostring(root, encoding="unicode")


def _by_latex2mathml(latex: str, display: str) -> str:
    try:
        from latex2mathml.converter import convert
    except ImportError:
        raise missing_package("latex2mathml") from None
    return convert(latex, display=display)


def _to_core(element: Element) -> None:
    kind = element.tag.rpartition("}")[2]
    if kind == "mtable":
        _style_cells(element)
    elif kind == "mstyle" and element.get("mathcolor") in COLOURS:
        element.set("class", element.attrib.pop("mathcolor"))
    elif kind == "mi" and element.text in PUNCTUATION:
        element.tag = f"{{{NAMESPACE}}}mo"
    elif kind == "mo" and element.text.isalpha():
        element.tag = f"{{{NAMESPACE}}}mi"
    for unknown in UNKNOWN_TO_CORE:
        element.attrib.pop(unknown, None)


def _set_functions_apart(row: Element) -> None:
    """Insert a thin space between a function and an argument without brackets."""
    for place in reversed(range(1, len(row) if row.tag.endswith(ROWS) else 1)):
        before, argument = row[place - 1], _first_part(row[place])
        name = before[0] if before.tag.endswith(WITH_SCRIPTS) else before
        if len(name.text or "") > 1 and name.text.isalpha() and argument.tag.endswith(("}mi", "}mn")):
            row.insert(place, Element(f"{{{NAMESPACE}}}mspace", width="0.167em"))


def _first_part(element: Element) -> Element:
    """Return the innermost element that an element begins with."""
    return _first_part(element[0]) if len(element) else element


def _bind_signs(row: Element) -> None:
    """Join a sign after an equals sign or a bracket to the term after it."""
    for before, sign in pairwise(row):
        if sign.text in SIGNS and before.text in BEFORE_A_PREFIX:
            sign.set("form", "prefix")


def _style_cells(table: Element) -> None:
    """Align the columns, without gaps in an aligned equation."""
    padding = "0.3em 0" if table.get("columnspacing") == "0em" else "0.3em 0.4em"
    for cell in table.iterfind(f"{{{NAMESPACE}}}mtr/{{{NAMESPACE}}}mtd"):
        cell.set("style", f"text-align: {cell.get('columnalign', 'center')}; padding: {padding}")
