"""Boxes: pieces of LaTeX that know how wide they will be.

Widths are estimates in digits: half an em, the width of "0". They decide where a formula is broken, nothing else, and
stand for no typeface in particular.
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
    """LaTeX in math mode, its width in digits, its height in lines of text, and whether it has brackets in it."""

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
    """Letters or a command that stands for that many of them."""
    return Box(latex, letters * LETTER)


def digits(number: str) -> Box:
    """Return a number."""
    return Box(number, len(number))


def beside(*boxes: Box) -> Box:
    """Boxes on one line."""
    return Box(
        " ".join(box.latex for box in boxes if box.latex),
        sum(box.width for box in boxes),
        max((box.height for box in boxes), default=1),
        any(box.brackets for box in boxes),
    )


def separated(boxes: Iterable[Box], *separator: Box) -> Box:
    """Boxes on one line with a separator between any two."""
    first, *others = boxes
    return beside(first, *(part for box in others for part in (*separator, box)))


def over(numerator: Box, denominator: Box) -> Box:
    """Return a fraction."""
    width = max(numerator.width, denominator.width) + 0.5
    return Box(rf"\frac{{{numerator.latex}}}{{{denominator.latex}}}", width, numerator.height + denominator.height)


def below(base: Box, index: Box) -> Box:
    """Return a box with a subscript."""
    return replace(base, latex=f"{base.latex}_{{{index.latex}}}", width=base.width + SCRIPT * index.width)


def above(base: Box, exponent: Box) -> Box:
    """Return a box with a superscript."""
    width, height = base.width + SCRIPT * exponent.width, max(base.height, SCRIPT * exponent.height)
    return replace(base, latex=f"{base.latex}^{{{exponent.latex}}}", width=width, height=height)


def dotted(letter: Box, dots: int) -> Box:
    """Return a letter under up to three dots."""
    return replace(letter, latex=rf"\{ACCENTS[dots]}{{{letter.latex}}}") if dots else letter


def root(radicand: Box) -> Box:
    """Return a square root."""
    return Box(rf"\sqrt{{{radicand.latex}}}", radicand.width + 2, radicand.height)


def bracketed(inner: Box, opening: str = "(", closing: str = ")") -> Box:
    """Return a box in brackets as high as it is, and larger than those in it."""
    if inner.height > 1:
        opening, closing = rf"\left{opening} ", rf" \right{closing}"
    elif inner.brackets:
        opening, closing = rf"\bigl{opening} ", rf" \bigr{closing}"
    return Box(opening + inner.latex + closing, inner.width + 2 * NARROW, inner.height, brackets=True)


def coloured(inner: Box, colour: str) -> Box:
    """Return a box in a colour known by a name."""
    return replace(inner, latex=rf"\textcolor{{{colour}}}{{{inner.latex}}}") if inner.latex else inner


def stacked(rows: Sequence[Box]) -> Box:
    """Boxes below each other, flush left."""
    if len(rows) == 1:
        return rows[0]
    width, height = max(row.width for row in rows), sum(row.height for row in rows)
    return Box(aligned(f"& {row.latex}" for row in rows), width, height)


def aligned(lines: Iterable[str]) -> str:
    """Return lines of LaTeX below each other, each with its mark &."""
    return "\\begin{aligned}\n" + " \\\\\n".join(map(_guarded, lines)) + "\n\\end{aligned}"


def _guarded(line: str) -> str:
    """LaTeX takes a bracket at the head of a line for an option."""
    return f"{{}}{line}" if line.startswith("[") else line
