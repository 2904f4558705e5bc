"""Typeset a formula as a box, on one line or broken over several.

Sums are broken before a sign, products before a factor, and everything else inside its arguments. Terms and factors
keep the order of the tree. Trees are those of `holonom.expression.mathjson`, with additions for the paper's equations:

    ["Equal", left, right], ["NotEqual", left, right], ["List", item, ...]
    ["Subscript", "f", "beta"], ["Subscript", "A_inverse", "l", "s"], ["Subscript", "christoffel", "k", "m", "s"]
    ["Dot", x], ["Ddot", x], ["Dddot", x]     x differentiated by the time, under dots
    ["Rate", x]                               dx/dt along a motion
    ["Partial", x, y, ...]                    partial derivative of x by y, ...
    ["Apply", F, argument, ...], ["Factorial", n]
    ["Determinant", x]                        of the matrix that the free indices of x span
    ["Marked", colour, x]                     x in a colour
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby
from math import inf

from ..expression.functions import FUNCTIONS
from ..expression.mathjson import Tree
from ..failures import ErrorKind, HolonomError
from .boxes import (
    CLOSING,
    COMMA,
    CROSS,
    EQUALS,
    FACTORIAL,
    INDENT,
    NOTHING,
    OPENING,
    PREFIX_MINUS,
    SIGNS,
    THIN_SPACE,
    TIMES,
    UNEQUAL,
    WIDE_SPACE,
    Box,
    above,
    aligned,
    below,
    beside,
    bracketed,
    coloured,
    digits,
    over,
    root,
    separated,
    stacked,
    word,
)
from .quantities import indexed_box, name_box

NARROWEST = 14  # digits below which nothing is pressed
TALLEST = 10  # lines that brackets reach over at most
CONSTANTS = {"Pi": r"\pi", "ExponentialE": "e", "ImaginaryUnit": "i", "EulerGamma": r"\gamma"}
NAMES = {each.head: each.operator for each in FUNCTIONS if each.latex and not each.of_an_order}
NAMES |= {"Determinant": r"\det"}
OF_AN_ORDER = {each.head: each.latex for each in FUNCTIONS if each.of_an_order}
FRACTIONS = {"Divide", "Rational", "Partial", "Rate"}
SUMS = {"Add", "Negate", "Subtract"}
LOOSE = (  # in brackets under an exponent
    SUMS | FRACTIONS | NAMES.keys() | OF_AN_ORDER.keys() | {"Multiply", "Power", "Exp", "Factorial"}
)
PARTIAL, TOTAL, TIME = word(r"\partial", 1), word("d", 1), word("t", 1)


@dataclass(frozen=True)
class SignedTerm:
    """A term of a sum: its sign, the content after the sign, and the sign's colour."""

    sign: str
    content: Tree
    sign_colour: str | None = None


def formula_box(tree: Tree, room: float = inf) -> Box:
    """Typeset a formula in LaTeX's math mode.

    Parameters
    ----------
    tree : int, str, dict or list
        The formula.
    room : float
        Width to keep to where the formula can be broken, in digits.

    Returns
    -------
    Box

    Raises
    ------
    HolonomError
        The tree, or a part of it, is not of the kinds listed above.
    """
    whole, width = _set(tree, inf), max(room, NARROWEST)
    return whole if whole.width <= width else _set(tree, width)


def relation_box(left: Tree, right: Tree, room: float = inf) -> Box:
    """Typeset left = right, broken at the equals sign if it is too wide.

    The break is after the equals sign, or before it if the left side is long.

    Parameters
    ----------
    left, right : Tree
        Both sides, in the trees described above.
    room : float
        Line width, in digits.

    Returns
    -------
    Box
    """
    start = formula_box(left)
    if is_long(start, room) or beside(start, EQUALS, formula_box(right)).width <= room:
        return stacked(relation_lines(left, right, room))
    rows = relation_rows(left, right, room)
    return Box(aligned(rows), room, len(rows)) if len(rows) > 1 else Box(rows[0].replace("&", "", 1), room)


def relation_lines(left: Tree, right: Tree, room: float = inf) -> list[Box]:
    """Return the lines of a relation, indented from the second on.

    Parameters
    ----------
    left, right : Tree
        Both sides.
    room : float
        Line width, in digits.

    Returns
    -------
    list of Box
        One box for each line.
    """
    whole = beside(formula_box(left), EQUALS, formula_box(right))
    if whole.width <= room:
        return [whole]
    *rows, last = sum_lines(left, room - INDENT.width)
    first, *others = sum_lines(right, room - EQUALS.width - INDENT.width)
    return _set_in([*rows, *_filled([last, beside(EQUALS, first)], room - INDENT.width), *others])


def relation_rows(left: Tree, right: Tree, room: float = inf) -> list[str]:
    """Return the lines of a relation, aligned at the equals sign by LaTeX's &.

    Its left side is short.

    Parameters
    ----------
    left, right : Tree
        Both sides.
    room : float
        Line width, in digits.

    Returns
    -------
    list of str
        LaTeX of each line, with ``&`` at the place to align.
    """
    start = formula_box(left)
    first, *others = sum_lines(right, room - start.width - EQUALS.width - INDENT.width)
    return [f"{start.latex} &= {first.latex}", *(f"& {row.latex}" for row in map(_indented, others))]


def is_long(left: Box, room: float) -> bool:
    """Return True if the left side leaves too little room for the right one.

    Parameters
    ----------
    left : Box
        Left side of a relation, on one line.
    room : float
        Line width, in digits.

    Returns
    -------
    bool
        True if the left side takes more than a third of the line.
    """
    return left.width > room / 3


def sum_lines(tree: Tree, room: float) -> list[Box]:
    """Typeset a formula as lines below each other.

    A sum has several lines if it is too wide for one.

    Parameters
    ----------
    tree : Tree
        The formula.
    room : float
        Line width, in digits.

    Returns
    -------
    list of Box
        One box for each line.
    """
    rows: list[Box] = []
    for place, term in enumerate(signed_terms(tree)):
        rows = _appended(rows, _term_lines(term, place, room), room)
    return rows


def signed_terms(tree: Tree) -> list[SignedTerm]:
    """Return the terms of a sum with their signs, or the expression as one term.

    Parameters
    ----------
    tree : Tree
        The formula.

    Returns
    -------
    list of SignedTerm
        Terms in the order of the tree.
    """
    match tree:
        case ["Marked", colour, inner]:
            return [_marked_term(term, colour) for term in signed_terms(inner)]
        case ["Add", *terms]:
            return [signed for term in terms for signed in _summand(term)]
        case ["Subtract", first, second]:
            return [*signed_terms(first), SignedTerm("-", second)]
        case ["Negate", inner]:
            return [SignedTerm("-", inner)]
        case int() if tree < 0:
            return [SignedTerm("-", -tree)]
        case {"num": str(number)} if number.startswith("-"):
            return [SignedTerm("-", {"num": number[1:]})]
        case _:
            return [SignedTerm("+", tree)]


def _marked_term(term: SignedTerm, colour: str) -> SignedTerm:
    return SignedTerm(term.sign, ["Marked", colour, term.content], colour if term.sign == "-" else None)


def _summand(term: Tree) -> list[SignedTerm]:
    return [SignedTerm("+", term)] if _head(term) == "Add" else signed_terms(term)


def _sign(term: SignedTerm, place: int) -> Box:
    """Return the sign of a term, without a leading plus sign."""
    mark = SIGNS[term.sign] if place else PREFIX_MINUS if term.sign == "-" else NOTHING
    return coloured(mark, term.sign_colour) if term.sign_colour else mark


def _term_lines(term: SignedTerm, place: int, room: float) -> list[Box]:
    """Return the lines of a term.

    It has several if it is a product to be broken or its brackets would be too high.
    """
    sign = _sign(term, place)
    first, *others = _factor_lines(term.content, room - sign.width)
    if others or first.height <= TALLEST:
        return _set_in([beside(sign, first), *others])
    before, inner, after = _around_brackets(term.content)
    if inner is None:
        return [beside(sign, first)]
    start = beside(sign, _factor(before, room), OPENING)
    *others, last = sum_lines(inner, room - INDENT.width - CLOSING.width)
    end = beside(last, CLOSING, *(_factor(factor, room / 2) for factor in after))
    return _set_in(_filled([start, *others, end], room))


def _around_brackets(term: Tree) -> tuple[Tree, Tree | None, list[Tree]]:
    """Return the parts of a term before, inside and after its longest brackets.

    The brackets are those of the longest sum among its factors.
    """
    match term:
        case ["Divide", ["Multiply", *factors], denominator]:
            factors = [["Divide", 1, denominator], *factors]
        case ["Divide", numerator, denominator]:
            factors = [["Divide", 1, denominator], numerator]
        case ["Multiply", *factors]:
            pass
        case _:
            return term, None, []
    sums = [place for place, factor in enumerate(factors) if _is_sum(factor) and place]
    if not sums:
        return term, None, []
    longest = max(sums, key=lambda place: formula_box(factors[place]).width)
    return ["Multiply", *factors[:longest]], factors[longest], factors[longest + 1 :]


def _set_in(rows: Sequence[Box]) -> list[Box]:
    """Return lines, indented from the second on."""
    return [rows[0], *map(_indented, rows[1:])]


def _indented(row: Box) -> Box:
    return beside(INDENT, row)


def _filled(boxes: Sequence[Box], room: float) -> list[Box]:
    """Return lines of boxes side by side, each as full as the room allows."""
    rows: list[Box] = []
    for box in boxes:
        rows = _appended(rows, [box], room)
    return rows


def _appended(rows: list[Box], more: list[Box], room: float) -> list[Box]:
    """Append lines to lines.

    A single line joins the last one if there is room.
    """
    if rows and len(more) == 1 and rows[-1].width + more[0].width <= room:
        return [*rows[:-1], beside(rows[-1], more[0])]
    return [*rows, *more]


def _head(tree: Tree) -> str | None:
    """Return the head of a tree, without its mark."""
    return tree[0] if isinstance(tree, list) else None


def _content(tree: Tree) -> Tree:
    """Return a tree without its mark."""
    return _content(tree[2]) if _head(tree) == "Marked" else tree


def _is_sum(tree: Tree) -> bool:
    return _head(_content(tree)) in SUMS or signed_terms(_content(tree))[0].sign == "-"


def _is_loose(tree: Tree) -> bool:
    return _is_sum(tree) or _head(_content(tree)) in LOOSE


def _set(tree: Tree, room: float) -> Box:
    match tree:
        case str():
            return word(CONSTANTS[tree], 1) if tree in CONSTANTS else name_box(tree)
        case _ if _is_sum(tree):
            return stacked(sum_lines(tree, room))
        case int():
            return digits(str(tree))
        case {"num": str(number)}:
            return _decimal(number)
        case [str(head), *parts] if head in SETTERS:
            return SETTERS[head](room, *parts)
        case [str(head), *arguments] if head in NAMES:
            return _function(word(NAMES[head], 3), arguments, room)
        case [str(head), order, argument] if head in OF_AN_ORDER:
            return _of_an_order(OF_AN_ORDER[head], order, argument, room)
        case _:
            raise _refusal(tree)


def _refusal(tree: Tree) -> HolonomError:
    return HolonomError(ErrorKind.NOT_AN_EXPRESSION, detail=str(tree))


def _decimal(number: str) -> Box:
    mantissa, _, exponent = number.lower().partition("e")
    if not exponent:
        return digits(mantissa)
    return beside(digits(mantissa), TIMES, above(digits("10"), digits(str(int(exponent)))))


# ---- products, fractions, powers, functions ----------------------------------------------------------


def _factor(tree: Tree, room: float) -> Box:
    if _is_sum(tree):
        return bracketed(formula_box(tree, room - 2))
    return formula_box(tree, room)


def _factor_lines(tree: Tree, room: float) -> list[Box]:
    whole = _factor(tree, inf)
    if whole.width <= room:
        return [whole]
    return _product_lines(tree[1:], room) if _head(tree) == "Multiply" else [_factor(tree, room)]


def _product(room: float, *factors: Tree) -> Box:
    return stacked(_product_lines(factors, room))


def _product_lines(factors: Sequence[Tree], room: float) -> list[Box]:
    """Return the lines of a product.

    It stays on one line if breaking its widest factor leaves enough room. Else it is broken before factors.
    """
    boxes = [_factor(factor, inf) for factor in factors]
    widest = max(range(len(boxes)), key=lambda place: boxes[place].width)
    rest = sum(box.width for box in boxes) - boxes[widest].width
    if rest + min(NARROWEST, boxes[widest].width) <= room:
        boxes[widest] = _factor(factors[widest], room - rest)
        return [_joined(factors, boxes)]
    first, *others = _filled([_factor(factor, room - CROSS.width) for factor in factors], room - CROSS.width)
    return [first, *(beside(CROSS, row) for row in others)]


def _joined(factors: Sequence[Tree], boxes: Sequence[Box]) -> Box:
    apart = [_stands_apart(factor, box) for factor, box in zip(factors, boxes, strict=True)]
    parts = [boxes[0]]
    for place, factor in enumerate(factors[1:], start=1):
        space = (
            THIN_SPACE if apart[place - 1] or (apart[place] and not _begins_with_digit(factors[place - 1])) else NOTHING
        )
        parts += [TIMES if _begins_with_digit(factor) else space, boxes[place]]
    return beside(*parts)


def _begins_with_digit(tree: Tree) -> bool:
    match _content(tree):
        case int() | dict():
            return True
        case ["Power" | "Multiply" | "Factorial", first, *_]:
            return _begins_with_digit(first)
        case _:
            return False


def _stands_apart(tree: Tree, box: Box) -> bool:
    return box.height > 1 or _head(_content(tree)) in NAMES or r"\text{" in box.latex


def _fraction(room: float, numerator: Tree, denominator: Tree) -> Box:
    return over(formula_box(numerator, room), formula_box(denominator, room))


def _root(room: float, radicand: Tree) -> Box:
    return root(formula_box(radicand, room - 2))


def _power(room: float, base: Tree, exponent: Tree) -> Box:
    raised = formula_box(exponent)
    match base:
        case [str(head), argument] if head in NAMES:
            return _function(above(word(NAMES[head], 3), raised), [argument], room)
        case _ if _is_loose(base):
            return above(bracketed(formula_box(base, room - 2 - raised.width)), raised)
        case _:
            return above(formula_box(base, room), raised)


def _exponential(room: float, exponent: Tree) -> Box:
    return above(word("e", 1), formula_box(exponent, room))


def _function(name: Box, arguments: Sequence[Tree], room: float) -> Box:
    inner = separated([formula_box(argument, room - name.width - 2) for argument in arguments], COMMA)
    if len(arguments) == 1 and isinstance(_content(arguments[0]), str):
        return beside(name, inner)
    return beside(name, bracketed(inner))


def _of_an_order(letter: str, order: Tree, argument: Tree, room: float) -> Box:
    """Return a function that has its order as an index, with a bracketed argument."""
    name = below(word(letter, 1), formula_box(order))
    return beside(name, bracketed(formula_box(argument, room - name.width - 2)))


def _modulus(room: float, argument: Tree) -> Box:
    return bracketed(formula_box(argument, room - 2), r"\lvert", r"\rvert")


def _factorial(_: float, argument: Tree) -> Box:
    return beside(_tight(argument), FACTORIAL)


def _tight(tree: Tree) -> Box:
    return bracketed(formula_box(tree)) if _is_loose(tree) else formula_box(tree)


# ---- the language of the general equations -------------------------------------------------------------


def _subscript(_: float, name: str, *indices: Tree) -> Box:
    return indexed_box(name, list(map(formula_box, indices)))


def _dotted(dots: int) -> Callable[..., Box]:
    return lambda _, inner: _under_dots(dots, inner)


def _under_dots(dots: int, inner: Tree) -> Box:
    match inner:
        case str(name):
            return name_box(name, dots)
        case ["Subscript", str(name), *indices]:
            return indexed_box(name, list(map(formula_box, indices)), dots)
        case ["Marked", colour, marked]:
            return coloured(_under_dots(dots, marked), colour)
        case _:
            raise _refusal(inner)


def _partial(_: float, quantity: Tree, *variables: Tree) -> Box:
    """Return a partial derivative, with powers for equal adjacent variables."""
    orders = [(formula_box(variable), len(list(same))) for variable, same in groupby(variables)]
    divisor = [part for variable, order in orders for part in (PARTIAL, _to_the(order, variable))]
    return over(beside(_to_the(len(variables), PARTIAL), _tight(quantity)), beside(*divisor))


def _to_the(order: int, box: Box) -> Box:
    return box if order == 1 else above(box, digits(str(order)))


def _rate(_: float, quantity: Tree) -> Box:
    inner = formula_box(quantity)
    return beside(over(TOTAL, beside(TOTAL, TIME)), bracketed(inner) if _is_sum(quantity) else inner)


def _applied(room: float, function: Tree, *arguments: Tree) -> Box:
    return beside(formula_box(function), bracketed(separated(list(map(formula_box, arguments)), COMMA)))


def _marked(room: float, colour: str, inner: Tree) -> Box:
    return coloured(formula_box(inner, room), colour)


def _list(room: float, *items: Tree) -> Box:
    boxes = [formula_box(item, room) for item in items]
    return stacked(_filled([*(beside(box, COMMA, WIDE_SPACE) for box in boxes[:-1]), boxes[-1]], room))


def _equation(room: float, left: Tree, right: Tree) -> Box:
    return relation_box(left, right, room)


def _condition(room: float, left: Tree, right: Tree) -> Box:
    return beside(formula_box(left, room), UNEQUAL, formula_box(right))


SETTERS: dict[str, Callable[..., Box]] = {
    "Multiply": _product,
    "Divide": _fraction,
    "Rational": _fraction,
    "Sqrt": _root,
    "Power": _power,
    "Exp": _exponential,
    "Abs": _modulus,
    "Factorial": _factorial,
    "Subscript": _subscript,
    "Dot": _dotted(1),
    "Ddot": _dotted(2),
    "Dddot": _dotted(3),
    "Partial": _partial,
    "Rate": _rate,
    "Apply": _applied,
    "Marked": _marked,
    "List": _list,
    "Equal": _equation,
    "NotEqual": _condition,
}
