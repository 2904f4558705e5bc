"""Typeset a formula as a box, on one line or broken over several.

Lines are broken at the top level: between sides, before the sign of a term, before a factor, and in the brackets of a
sum that fits on no line. Terms and factors keep the order of the tree. Trees are those of
`holonom.expression.mathjson`, with additions for the paper's equations:

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
from itertools import chain, groupby
from math import inf
from typing import NamedTuple

from ..expression.functions import CONSTANTS, FUNCTIONS
from ..expression.trees import Tree, with_decimals
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


class Part(NamedTuple):
    """A part of a formula that stays on one line."""

    box: Box
    leading: Box = NOTHING  # stands before it at the head of a line
    between: Box = NOTHING  # stands before it elsewhere


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
    return stacked(formula_lines(tree, room))


def formula_lines(tree: Tree, room: float) -> list[Box]:
    """Typeset a formula as lines below each other.

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
    for box, leading, between in _parts(with_decimals(tree), room):
        if rows and rows[-1].width + between.width + box.width <= room:
            rows[-1] = beside(rows[-1], between, box)
        else:
            rows.append(beside(leading, box) if rows else box)
    return rows


def _parts(tree: Tree, room: float) -> list[Part]:
    """Return the parts between which a formula may be broken, one if it fits."""
    whole = _set(tree)
    if whole.width <= room:
        return [Part(whole)]
    match tree:
        case ["Equal", left, right]:
            rest = _after(EQUALS, _parts(right, room - EQUALS.width - INDENT.width))
            return [*_parts(left, room), *(part._replace(leading=beside(INDENT, part.leading)) for part in rest)]
        case ["List", *items]:
            *rows, last = (_parts(item, room - COMMA.width) for item in items)
            return [*(part for row in rows for part in _before(row, COMMA, WIDE_SPACE)), *last]
        case _ if _is_sum(tree):
            return [part for place, term in enumerate(_signed_terms(tree)) for part in _term_parts(term, place, room)]
        case ["Divide", 1, ["Multiply", *divisors]]:
            return _product_parts([["Divide", 1, divisor] for divisor in divisors], room)
        case ["Divide", numerator, denominator] if numerator != 1:
            factors = numerator[1:] if _head(numerator) == "Multiply" else [numerator]
            return _product_parts([["Divide", 1, denominator], *factors], room)
        case ["Multiply", *factors]:
            return _product_parts(factors, room)
        case ["Marked", colour, inner]:
            return [part._replace(box=coloured(part.box, colour)) for part in _parts(inner, room)]
        case ["Sqrt", radicand]:
            return _bracketed_parts(OPENING, radicand, above(CLOSING, _set(["Rational", 1, 2])), room)
        case ["Divide", 1, ["Power", base, int(exponent)]]:
            return _parts(["Power", base, -exponent], room)
        case ["Divide", 1, divisor]:
            return _bracketed_parts(OPENING, divisor, above(CLOSING, _set(-1)), room)
        case ["Power", base, exponent] if _is_sum(base):
            return _bracketed_parts(OPENING, base, above(CLOSING, _set(exponent)), room)
        case [str(head), argument] if head in NAMES:
            return _bracketed_parts(beside(word(NAMES[head], 3), OPENING), argument, CLOSING, room)
        case _:
            return [Part(whole)]


def _after(box: Box, parts: Sequence[Part]) -> list[Part]:
    """Return parts with a box before the first."""
    return [Part(beside(box, parts[0].box)), *parts[1:]]


def _before(parts: Sequence[Part], *boxes: Box) -> list[Part]:
    """Return parts with boxes after the last."""
    return [*parts[:-1], parts[-1]._replace(box=beside(parts[-1].box, *boxes))]


def _term_parts(term: SignedTerm, place: int, room: float) -> list[Part]:
    sign = _sign(term, place)
    return _after(sign, _factor_parts(term.content, room - sign.width))


def _product_parts(factors: Sequence[Tree], room: float) -> list[Part]:
    room -= CROSS.width
    found: list[Part] = []
    for factor, separator in zip(factors, _separators(factors, list(map(_factor, factors))), strict=True):
        first, *others = _factor_parts(factor, room)
        found += [first._replace(leading=CROSS, between=separator), *others]
    return found


def _factor_parts(tree: Tree, room: float) -> list[Part]:
    """Return the parts of a term or factor. A sum has brackets."""
    if not _is_sum(tree):
        return _parts(tree, room)
    whole = _factor(tree)
    if whole.width <= room:
        return [Part(whole)]
    return _bracketed_parts(OPENING, tree, CLOSING, room)


def _bracketed_parts(opening: Box, inner: Tree, closing: Box, room: float) -> list[Part]:
    return _before(_after(opening, _parts(inner, room - opening.width - closing.width)), closing)


def _signed_terms(tree: Tree) -> list[SignedTerm]:
    """Return the terms of a sum with their signs, or the expression as one term."""
    match tree:
        case ["Marked", colour, inner]:
            return [_marked_term(term, colour) for term in _signed_terms(inner)]
        case ["Add", *terms]:
            return [signed for term in terms for signed in _summand(term)]
        case ["Subtract", first, second]:
            return [*_signed_terms(first), SignedTerm("-", second)]
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
    return [SignedTerm("+", term)] if _head(term) == "Add" else _signed_terms(term)


def _sign(term: SignedTerm, place: int) -> Box:
    """Return the sign of a term, without a leading plus sign."""
    mark = SIGNS[term.sign] if place else PREFIX_MINUS if term.sign == "-" else NOTHING
    return coloured(mark, term.sign_colour) if term.sign_colour else mark


def _head(tree: Tree) -> str | None:
    """Return the head of a tree, without its mark."""
    return tree[0] if isinstance(tree, list) else None


def _content(tree: Tree) -> Tree:
    """Return a tree without its mark."""
    return _content(tree[2]) if _head(tree) == "Marked" else tree


def _is_sum(tree: Tree) -> bool:
    return _head(_content(tree)) in SUMS or _signed_terms(_content(tree))[0].sign == "-"


def _is_loose(tree: Tree) -> bool:
    return _is_sum(tree) or _head(_content(tree)) in LOOSE


def _set(tree: Tree) -> Box:
    """Typeset a formula on one line."""
    match tree:
        case str():
            return word(CONSTANTS[tree].latex, 1) if tree in CONSTANTS else name_box(tree)
        case _ if _is_sum(tree):
            terms = enumerate(_signed_terms(tree))
            return beside(*(box for k, term in terms for box in (_sign(term, k), _factor(term.content))))
        case int():
            return digits(str(tree))
        case {"num": str(number)}:
            return _decimal(number)
        case [str(head), *parts] if head in SETTERS:
            return SETTERS[head](*parts)
        case [str(head), *arguments] if head in NAMES:
            return _function(word(NAMES[head], 3), arguments)
        case [str(head), order, argument] if head in OF_AN_ORDER:
            return _of_an_order(OF_AN_ORDER[head], order, argument)
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


def _factor(tree: Tree) -> Box:
    return bracketed(_set(tree)) if _is_sum(tree) else _set(tree)


def _product(*factors: Tree) -> Box:
    boxes = list(map(_factor, factors))
    return beside(*chain.from_iterable(zip(_separators(factors, boxes), boxes, strict=True)))


def _separators(factors: Sequence[Tree], boxes: Sequence[Box]) -> list[Box]:
    """Return the separator before each factor of a product."""
    apart = list(map(_stands_apart, factors, boxes))
    found = [NOTHING]
    for place, factor in enumerate(factors[1:], start=1):
        spaced = apart[place - 1] or (apart[place] and not _begins_with_digit(factors[place - 1]))
        found.append(TIMES if _begins_with_digit(factor) else THIN_SPACE if spaced else NOTHING)
    return found


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


def _fraction(numerator: Tree, denominator: Tree) -> Box:
    return over(_set(numerator), _set(denominator))


def _root(radicand: Tree) -> Box:
    return root(_set(radicand))


def _power(base: Tree, exponent: Tree) -> Box:
    raised = _set(exponent)
    match base:
        case [str(head), argument] if head in NAMES:
            return _function(above(word(NAMES[head], 3), raised), [argument])
        case _ if _is_loose(base):
            return above(bracketed(_set(base)), raised)
        case _:
            return above(_set(base), raised)


def _exponential(exponent: Tree) -> Box:
    return above(word("e", 1), _set(exponent))


def _function(name: Box, arguments: Sequence[Tree]) -> Box:
    inner = separated([_set(argument) for argument in arguments], COMMA)
    if len(arguments) == 1 and isinstance(_content(arguments[0]), str):
        return beside(name, inner)
    return beside(name, bracketed(inner))


def _of_an_order(letter: str, order: Tree, argument: Tree) -> Box:
    """Return a function that has its order as an index, with a bracketed argument."""
    name = below(word(letter, 1), _set(order))
    return beside(name, bracketed(_set(argument)))


def _modulus(argument: Tree) -> Box:
    return bracketed(_set(argument), "|", "|")


def _factorial(argument: Tree) -> Box:
    return beside(_tight(argument), FACTORIAL)


def _tight(tree: Tree) -> Box:
    return bracketed(_set(tree)) if _is_loose(tree) else _set(tree)


# ---- the language of the general equations -------------------------------------------------------------


def _subscript(name: str, *indices: Tree) -> Box:
    return indexed_box(name, list(map(_set, indices)))


def _dotted(dots: int) -> Callable[..., Box]:
    return lambda inner: _under_dots(dots, inner)


def _under_dots(dots: int, inner: Tree) -> Box:
    match inner:
        case str(name):
            return name_box(name, dots)
        case ["Subscript", str(name), *indices]:
            return indexed_box(name, list(map(_set, indices)), dots)
        case ["Marked", colour, marked]:
            return coloured(_under_dots(dots, marked), colour)
        case _:
            raise _refusal(inner)


def _partial(quantity: Tree, *variables: Tree) -> Box:
    """Return a partial derivative, with powers for equal adjacent variables."""
    orders = [(_set(variable), len(list(same))) for variable, same in groupby(variables)]
    divisor = [part for variable, order in orders for part in (PARTIAL, _to_the(order, variable))]
    return over(beside(_to_the(len(variables), PARTIAL), _tight(quantity)), beside(*divisor))


def _to_the(order: int, box: Box) -> Box:
    return box if order == 1 else above(box, digits(str(order)))


def _rate(quantity: Tree) -> Box:
    inner = _set(quantity)
    return beside(over(TOTAL, beside(TOTAL, TIME)), bracketed(inner) if _is_sum(quantity) else inner)


def _applied(function: Tree, *arguments: Tree) -> Box:
    return beside(_set(function), bracketed(separated(list(map(_set, arguments)), COMMA)))


def _marked(colour: str, inner: Tree) -> Box:
    return coloured(_set(inner), colour)


def _list(*items: Tree) -> Box:
    return separated(map(_set, items), COMMA, WIDE_SPACE)


def _equation(left: Tree, right: Tree) -> Box:
    return beside(_set(left), EQUALS, _set(right))


def _condition(left: Tree, right: Tree) -> Box:
    return beside(_set(left), UNEQUAL, _set(right))


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
