"""Output quantities of a sweep.

    final               the coordinates and velocities at the end
    EXPR                a quantity at the end, at(EXPR, T) at a given time
    max(EXPR)           its largest value on the way. So min, mean, and max(abs(EXPR))
    d(NAME, P)          derivative at the end of a quantity by a parameter that varies, or by an initial value
    zero(EXPR)          the first time after the initial time at which it crosses zero or an event at its zero ends
                        the motion, empty where it does not
    free                true if the multipliers stay at zero, condition (10) of free motion
    radius              radius of convergence of the initial motion, empty if uncertain by more than 5 %
    residual            how far the end is from the constraints. It is always recorded

The end is where the scene's `until` ends the motion, or else its time span. At a given time after it there is nothing.
EXPR is made of t, coordinates, dot(x), ddot(x), multipliers, Lambda[s] and controls where the scene observes them,
outputs that it names, energy and the parameters. It becomes an expression of the motion program. Nothing of it is run
as code.
"""

import ast
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction
from math import isfinite

from ..failures import ErrorKind, HolonomError
from ..language import translatable
from ..options import within_reach
from ..program.motion_program import CALLED, Call, Constant, Expression, Name, Operation

LONGEST = 500  # characters of an item
OPERATORS = {
    ast.Add: Operation.ADD,
    ast.Sub: Operation.SUBTRACT,
    ast.Mult: Operation.MULTIPLY,
    ast.Div: Operation.DIVIDE,
    ast.Pow: Operation.POWER,
}
CALLS = {each.scene: Operation(each.head) for each in CALLED if each.arity == 1}
DERIVATIVES = ("dot", "ddot")


class Kind(StrEnum):
    """The kind of an output of a sweep."""

    FINAL = "final"
    AT = "at"
    MAX = "max"
    MIN = "min"
    LARGEST = "largest"  # max(abs(...)), which is not analytic where its quantity changes its sign
    MEAN = "mean"
    ZERO = "zero"
    DERIVATIVE = "d"
    FREE = "free"
    RADIUS = "radius"
    RESIDUAL = "residual"


EXTREMES = (Kind.MAX, Kind.MIN, Kind.LARGEST, Kind.MEAN)
ALONG = (*EXTREMES, Kind.ZERO)
WHOLE = {kind.value: kind for kind in (Kind.FINAL, Kind.FREE, Kind.RADIUS, Kind.RESIDUAL)}


@dataclass(frozen=True)
class OutputQuantity:
    """A quantity that a sweep records."""

    text: str  # as it was requested, without blanks: the name of its column
    kind: Kind
    quantity: Expression | None = None  # None where the whole motion is meant
    time: Fraction | None = None  # of `Kind.AT`; None for the end
    direction: str = ""  # of `Kind.DERIVATIVE`: a parameter, or a name of the state


def read_quantities(texts: Iterable[str]) -> tuple[OutputQuantity, ...]:
    """Read the output quantities of a command line, separated by commas, each once.

    Parameters
    ----------
    texts : iterable of str
        Options of the command line, in the forms listed above.

    Returns
    -------
    tuple of OutputQuantity
        Quantities without repetitions, in their order.

    Raises
    ------
    HolonomError
        One of them is not an output.
    """
    items = [item for text in texts for item in items_of(text)]
    return tuple(dict.fromkeys(_quantity(item) for item in items))


def words_in(outputs: Iterable[OutputQuantity]) -> set[str]:
    """Return the words of outputs that have a meaning of their own.

    Parameters
    ----------
    outputs : iterable of OutputQuantity

    Returns
    -------
    set of str
        Of ``final``, ``free``, ``radius``, ``residual`` and ``pi``.
    """
    return {
        word
        for output in outputs
        for word in ([output.text] if output.kind in WHOLE.values() else re.findall(r"\bpi\b", output.text))
    }


def items_of(text: str) -> Iterator[str]:
    """Yield the parts between commas that no bracket encloses.

    Parameters
    ----------
    text : str
        List separated by commas.

    Yields
    ------
    str
        One item.
    """
    depth, begin = 0, 0
    for place, letter in enumerate(text):
        depth += (letter in "([") - (letter in ")]")
        if letter == "," and depth == 0:
            yield text[begin:place]
            begin = place + 1
    yield text[begin:]


def _quantity(item: str) -> OutputQuantity:
    text = "".join(item.split())
    if text in WHOLE:
        return OutputQuantity(text, WHOLE[text])
    match _tree(text):
        case ast.Call(ast.Name("max"), [ast.Call(ast.Name("abs"), [quantity], [])], []):
            return OutputQuantity(text, Kind.LARGEST, _analytic(quantity, text))
        case ast.Call(ast.Name("max" | "min" | "mean" | "zero" as kind), [quantity], []):
            return OutputQuantity(text, Kind(kind), _analytic(quantity, text))
        case ast.Call(ast.Name("d"), [quantity, direction], []):
            what, by = (_expression(each, text) for each in (quantity, direction))
            if not isinstance(what, Name) or not isinstance(by, Name):
                raise _error(
                    text, translatable("this is not a derivative of one quantity by one parameter or initial value")
                )
            return OutputQuantity(text, Kind.DERIVATIVE, what, direction=by.text)
        case ast.Call(ast.Name("at"), [quantity, _], []):
            inside, _, time = text[len("at(") : -1].rpartition(",")
            return OutputQuantity(text, Kind.AT, _expression(quantity, text), _time(time, text))
        case quantity:
            return OutputQuantity(text, Kind.AT, _expression(quantity, text))


def _tree(text: str) -> ast.expr:
    try:
        if not text or len(text) > LONGEST or text.count("(") > LONGEST // 10:
            raise ValueError
        return ast.parse(text.replace("^", "**"), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise _error(text or translatable("nothing"), translatable("this is not an expression")) from None


def _analytic(tree: ast.expr, text: str) -> Expression:
    if any(isinstance(node, ast.Name) and node.id == "abs" for node in ast.walk(tree)):
        raise _error(
            text, translatable("it contains abs inside of a quantity along the motion; only max(abs(...)) may")
        )
    return _expression(tree, text)


def _expression(tree: ast.expr, text: str) -> Expression:
    match tree:
        case ast.BinOp(left, operator, right) if type(operator) in OPERATORS:
            return Call(OPERATORS[type(operator)], (_expression(left, text), _expression(right, text)))
        case ast.UnaryOp(ast.USub(), operand):
            return Call(Operation.NEGATE, (_expression(operand, text),))
        case ast.Call(ast.Name(mark), [ast.Name(name)], []) if mark in DERIVATIVES:
            return Name(f"{mark}({name})")
        case ast.Call(ast.Name(function), [argument], []) if function in CALLS:
            return Call(CALLS[function], (_expression(argument, text),))
        case ast.Subscript(ast.Name(name), ast.Constant(int(place))):
            return Name(f"{name}[{place}]")
        case ast.Name("pi"):
            return Constant.PI
        case ast.Name(name):
            return Name(name)
        case ast.Constant(int(value) | float(value)) if _is_number(value):
            return Fraction(repr(value))
        case _:
            raise _error(
                text, translatable("it is made of something else than numbers, + - * / ^, functions and quantities")
            )


def _is_number(value: int | float) -> bool:
    return not isinstance(value, bool) and isfinite(value) and within_reach(repr(value))


def _time(written: str, text: str) -> Fraction:
    if not re.fullmatch(r"-?\d+(\.\d*|/\d+)?", written) or not within_reach(written):
        raise _error(text, translatable("it names no time"))
    try:
        return Fraction(written)
    except ZeroDivisionError:
        raise _error(text, translatable("it names no time")) from None


def not_an_output(reason: str) -> HolonomError:
    """Return the error of an output that is none of a motion.

    Parameters
    ----------
    reason : str
        Clause about it.

    Returns
    -------
    HolonomError
    """
    return HolonomError(ErrorKind.NOT_AN_OUTPUT, detail=reason)


def _error(text: str, reason: str) -> HolonomError:
    return not_an_output(translatable("%(text)s: %(reason)s", text=text[:60], reason=reason))
