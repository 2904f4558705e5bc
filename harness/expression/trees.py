"""MathJSON trees, the form of expressions in documents, and their traversal.

A tree is the result of `json.loads` for

    integer          7, or {"num": "12345678901234567890"} from 2^53 on
    float            {"num": "1.25e0"}: a double, or with more than 17 digits a number of that many digits
    symbol           "q1", "dot(q1)", "lambda1": always a real quantity
    constant         "Pi", "ExponentialE", "ImaginaryUnit", "EulerGamma"
    application      ["Add", a, b, ...], ["Power", a, b], ["Sin", a], ["Rational", 1, 3], ...
    indexed quantity ["Subscript", "A", 1, 2]

and for nothing else. The traversal uses a stack: the depth of an expression is bounded by memory, not by Python's
recursion limit. (`json.loads` itself is limited to about a thousand levels.)
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from decimal import Context
from typing import Any

from ..failures import ErrorKind, HolonomError
from .functions import CONSTANTS

Tree = int | str | dict | list

JSON_INTEGERS = 2**53  # integers below it are JSON numbers that every reader reads exactly
UNREADABLE = 10**30  # integers in a fraction that are not shown
ROUNDING = Context(prec=12)  # of the decimal that is shown instead
SHOWN = 60  # characters of a rejected fragment that the error shows

INTEGER = re.compile(r"-?\d{1,4300}")  # Python's own limit on decimal digits
FLOAT = re.compile(r"-?0*(\d+)\.?(\d*)(?:[eE][+-]?\d{1,9})?")
# A name, a time derivative of one, or the initial value of either: q1, %omega, dot(q1), ddot(u), q1_0, dot(q1)_0.
NAME = re.compile(r"%?[^\W\d][\w%]*|d{1,3}ot\(%?[^\W\d][\w%]*\)\w*")
RESERVED = frozenset({*CONSTANTS, "True", "False"})


@dataclass(frozen=True)
class _Application:
    """A function that waits for its last `arity` arguments to be converted."""

    build: Callable[..., object]
    arity: int


def converted(root: Any, expand: Callable[[Any], tuple[Callable[..., Any], list]]) -> Any:
    """Convert an expression, arguments first.

    Parameters
    ----------
    root : object
        Expression to convert.
    expand : callable
        Takes a node to a function and the arguments of that function, which are nodes.

    Returns
    -------
    object
        Value of the function of the root.
    """
    waiting = [root]
    found: list[Any] = []
    while waiting:
        node = waiting.pop()
        if isinstance(node, _Application):
            arguments = found[len(found) - node.arity :]
            del found[len(found) - node.arity :]
            found.append(node.build(*arguments))
        else:
            build, arguments = expand(node)
            waiting.append(_Application(build, len(arguments)))
            waiting.extend(reversed(arguments))
    return found.pop()


def with_decimals(tree: Tree) -> Tree:
    """Write fractions that are too long to read as decimals.

    Parameters
    ----------
    tree : Tree
        An expression to be shown.

    Returns
    -------
    Tree
        The expression with rounded numbers in place of those fractions.
    """
    return converted(tree, _with_decimals)


def _with_decimals(tree: Tree) -> tuple[Callable[..., Tree], list[Tree]]:
    match tree:
        case ["Rational" | "Divide", over, under] if None not in (parts := (_value(over), _value(under))):
            if max(map(abs, parts)) >= UNREADABLE:
                tree = {"num": str(ROUNDING.divide(*parts))}
        case [str(head), *arguments]:
            return lambda *shown: [head, *shown], arguments
    return lambda: tree, []


def _value(tree: Tree) -> int | None:
    """Return an integer of any size, None for another tree."""
    match tree:
        case {"num": str(digits)} if INTEGER.fullmatch(digits):
            return int(digits)
        case int():
            return tree
    return None


def integer(tree: object) -> int:
    """Return the value of a tree that is an integer.

    Parameters
    ----------
    tree : Tree
        A tree of any kind.

    Returns
    -------
    int

    Raises
    ------
    HolonomError
        It is not an integer.
    """
    match tree:
        case int() if not isinstance(tree, bool) and abs(tree) < JSON_INTEGERS:
            return tree
        case {"num": str(digits), **rest} if not rest and INTEGER.fullmatch(digits):
            return int(digits)
        case _:
            raise refusal(tree)


def integer_tree(value: int) -> Tree:
    """Return the tree of an integer of any size.

    Parameters
    ----------
    value : int
        The integer.

    Returns
    -------
    Tree
        `integer` returns its value.
    """
    return value if abs(value) < JSON_INTEGERS else {"num": str(value)}


def quantity(name: str) -> str:
    """Return a name if it names a quantity.

    Parameters
    ----------
    name : str
        A symbol of a tree.

    Returns
    -------
    str

    Raises
    ------
    HolonomError
        It is not.
    """
    if name in RESERVED or not NAME.fullmatch(name):
        raise refusal(name)
    return name


def refusal(part: object) -> HolonomError:
    """Return the error for a part that is not an expression.

    Parameters
    ----------
    part : object
        A part of a document.

    Returns
    -------
    HolonomError
    """
    shown = str(part)
    return HolonomError(ErrorKind.NOT_AN_EXPRESSION, detail=shown if len(shown) <= SHOWN else f"{shown[:SHOWN]}...")
