"""Boxes: parts of formulas in LaTeX with estimated widths.

Widths are in digits: half an em, the width of "0". They only decide about line breaks, and belong to no particular
typeface.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

SCRIPT = 0.7  # size of a subscript or superscript
OPERATOR = 2.4  # a plus or minus sign with the space around it
RELATION = 2.7  # an equals sign, crossed out or not, with the space around it
LETTER = 1.1
NARROW = 0.8  # a bracket, a comma
ACCENTS = ("", "dot", "ddot", "dddot")


@dataclass(frozen=True)
class Box:
    """LaTeX in math mode, with its width, height and brackets.

    The width is in digits, the height in lines of text.
    """

    latex: str
    width: float
    height: float = 1
    brackets: bool = False


NOTHING = Box("", 0)
SIGNS = {sign: Box(sign, OPERATOR) for sign in "+-"}
PREFIX_MINUS = Box("-", OPERATOR / 2)
EQUALS = Box("=", RELATION)
UNEQUAL = Box(r"\neq", RELATION)
THIN_SPACE = Box(r"\,", 0.3)
WIDE_SPACE = Box(r"\quad", 2)
INDENT = Box(r"\quad", 2)
COMMA = Box(",", NARROW)
SEMICOLON = Box(";", NARROW)
FACTORIAL = Box("!", NARROW)
TIMES = Box(r"\cdot", 1.5)
OPENING, CLOSING = Box(r"\Bigl(", 1), Box(r"\Bigr)", 1)  # of brackets on different lines
CROSS = Box(r"\times", OPERATOR)


def word(latex: str, letters: int) -> Box:
    """Return a box of letters, or of a command that prints letters.

    Parameters
    ----------
    latex : str
        Letters, or a command that prints them.
    letters : int
        Number of printed letters, each of the average width.

    Returns
    -------
    Box
    """
    return Box(latex, letters * LETTER)


def digits(number: str) -> Box:
    """Return a number.

    Parameters
    ----------
    number : str
        Printed digits, with a sign or a point if it has one.

    Returns
    -------
    Box
    """
    return Box(number, len(number))


def beside(*boxes: Box) -> Box:
    """Return boxes on one line.

    Parameters
    ----------
    *boxes : Box
        Boxes from left to right.

    Returns
    -------
    Box
        As high as the highest of the boxes.
    """
    return Box(
        " ".join(box.latex for box in boxes if box.latex),
        sum(box.width for box in boxes),
        max((box.height for box in boxes), default=1),
        any(box.brackets for box in boxes),
    )


def separated(boxes: Iterable[Box], *separator: Box) -> Box:
    """Return boxes on one line with a separator between any two.

    Parameters
    ----------
    boxes : iterable of Box
        One box or more, from left to right.
    *separator : Box
        Boxes between any two neighbours.

    Returns
    -------
    Box
    """
    first, *others = boxes
    return beside(first, *(part for box in others for part in (*separator, box)))


def over(numerator: Box, denominator: Box) -> Box:
    """Return a fraction.

    Parameters
    ----------
    numerator, denominator : Box
        Boxes above and below the bar.

    Returns
    -------
    Box
    """
    width = max(numerator.width, denominator.width) + 0.5
    return Box(rf"\frac{{{numerator.latex}}}{{{denominator.latex}}}", width, numerator.height + denominator.height)


def below(base: Box, index: Box) -> Box:
    """Return a box with a subscript.

    Parameters
    ----------
    base : Box
        Box that gets the subscript.
    index : Box
        The subscript.

    Returns
    -------
    Box
    """
    return replace(base, latex=f"{base.latex}_{{{index.latex}}}", width=base.width + SCRIPT * index.width)


def above(base: Box, exponent: Box) -> Box:
    """Return a box with a superscript.

    Parameters
    ----------
    base : Box
        Box that gets the superscript.
    exponent : Box
        The superscript.

    Returns
    -------
    Box
    """
    width, height = base.width + SCRIPT * exponent.width, max(base.height, SCRIPT * exponent.height)
    return replace(base, latex=f"{base.latex}^{{{exponent.latex}}}", width=width, height=height)


def dotted(letter: Box, dots: int) -> Box:
    """Return a symbol under up to three dots.

    Parameters
    ----------
    letter : Box
        Box under the dots.
    dots : int
        Number of dots, 0 to 3.

    Returns
    -------
    Box
    """
    return replace(letter, latex=rf"\{ACCENTS[dots]}{{{letter.latex}}}") if dots else letter


def root(radicand: Box) -> Box:
    """Return a square root.

    Parameters
    ----------
    radicand : Box
        Box under the root sign.

    Returns
    -------
    Box
    """
    return Box(rf"\sqrt{{{radicand.latex}}}", radicand.width + 2, radicand.height)


def bracketed(inner: Box, opening: str = "(", closing: str = ")") -> Box:
    """Return a box in brackets of its height, larger than those inside.

    Parameters
    ----------
    inner : Box
        Box between the brackets.
    opening, closing : str
        Brackets in LaTeX, or bars.

    Returns
    -------
    Box
    """
    if inner.height > 1:
        opening, closing = rf"\left{opening} ", rf" \right{closing}"
    elif inner.brackets:
        opening, closing = rf"\bigl{opening} ", rf" \bigr{closing}"
    elif opening == "|":
        opening, closing = r"\lvert ", r"\rvert"  # a bar alone opens and closes nothing
    return Box(opening + inner.latex + closing, inner.width + 2 * NARROW, inner.height, brackets=True)


def coloured(inner: Box, colour: str) -> Box:
    """Return a box in a colour known by a name.

    Parameters
    ----------
    inner : Box
        Box to colour.
    colour : str
        Name of the colour, which the document defines.

    Returns
    -------
    Box
    """
    return replace(inner, latex=rf"\textcolor{{{colour}}}{{{inner.latex}}}") if inner.latex else inner


def stacked(rows: Sequence[Box]) -> Box:
    """Return boxes below each other, flush left.

    Parameters
    ----------
    rows : sequence of Box
        One box or more, from top to bottom.

    Returns
    -------
    Box
    """
    if len(rows) == 1:
        return rows[0]
    width, height = max(row.width for row in rows), sum(row.height for row in rows)
    return Box(aligned(f"& {row.latex}" for row in rows), width, height)


def aligned(lines: Iterable[str]) -> str:
    """Return lines of LaTeX below each other, each with its mark &.

    Parameters
    ----------
    lines : iterable of str
        LaTeX of each line, with ``&`` at the place to align.

    Returns
    -------
    str
        An ``aligned`` environment.
    """
    return "\\begin{aligned}\n" + " \\\\\n".join(map(_guarded, lines)) + "\n\\end{aligned}"


def _guarded(line: str) -> str:
    """Guard a bracket at the head of a line, which LaTeX takes for an option."""
    return f"{{}}{line}" if line.startswith("[") else line
