"""Convert MathJSON trees to SymPy expressions and back.

No part of a tree is ever evaluated as code.
"""

from collections.abc import Callable
from operator import neg, sub, truediv

import sympy
from sympy import Expr, Float, Indexed, IndexedBase, Integer, Rational, S, Symbol

from . import elliptic
from .functions import CONSTANTS, FUNCTIONS
from .trees import FLOAT, INTEGER, Tree, converted, integer, integer_tree, quantity, refusal

DOUBLE_DIGITS = 17  # decimal digits that distinguish any two doubles
DOUBLE_BITS = 53

SYMBOLS = {name: getattr(sympy, each.sympy) for name, each in CONSTANTS.items()}
CONSTANT_NAMES = {constant: name for name, constant in SYMBOLS.items()}
NOT_NUMBERS = (S.ComplexInfinity, S.Infinity, S.NegativeInfinity, S.NaN)

CLASSES = {each: getattr(elliptic if hasattr(elliptic, each.in_sympy) else sympy, each.in_sympy) for each in FUNCTIONS}
HEADS = {function: each.head for each, function in CLASSES.items() if each.head != "Sqrt"} | {
    sympy.Add: "Add",
    sympy.Mul: "Multiply",
    sympy.Pow: "Power",
}


APPLIED: dict[tuple[str, int], Callable[..., Expr]] = {
    **{(each.head, each.arity): function for each, function in CLASSES.items()},
    ("Negate", 1): neg,
    ("Power", 2): sympy.Pow,
    ("Divide", 2): truediv,
    ("Subtract", 2): sub,
}
VARIADIC: dict[str, Callable[..., Expr]] = {"Add": sympy.Add, "Multiply": sympy.Mul}


def to_sympy(tree: Tree) -> Expr:
    """Convert a MathJSON tree to a SymPy expression.

    It has only SymPy's automatic simplifications. Every symbol is real.

    Parameters
    ----------
    tree : Tree
        A tree of `holonom.expression.trees`.

    Returns
    -------
    SymPy expression

    Raises
    ------
    HolonomError
        The tree, or a part of it, is not of the kinds listed above, or has no finite value (1/0).
    """
    return converted(tree, _read)


def from_sympy(expression: Expr) -> Tree:
    """Convert a SymPy expression to a MathJSON tree.

    `to_sympy` converts it back.

    Parameters
    ----------
    expression : SymPy expression
        It consists of real symbols and functions that MathJSON shares with SymPy.

    Returns
    -------
    Tree

    Raises
    ------
    HolonomError
        The expression, or a part of it, cannot be written.
    """
    return converted(expression, _write)


def _read(tree: Tree) -> tuple[Callable[..., Expr], list]:
    match tree:
        case bool():
            raise refusal(tree)
        case int() | dict() | ["Rational", *_]:
            value = _number(tree)
        case str():
            value = SYMBOLS[tree] if tree in SYMBOLS else _symbol(tree)
        case ["Subscript", str(name), _, *_]:
            value = Indexed(IndexedBase(_symbol(name)), *map(_integer, tree[2:]))
        case [str(head), *arguments]:
            return _builder(head, tree), arguments
        case _:
            raise refusal(tree)
    return (lambda: value), []


def _builder(head: str, tree: list) -> Callable[..., Expr]:
    function = VARIADIC.get(head) or APPLIED.get((head, len(tree) - 1))
    if function is None or len(tree) == 1:
        raise refusal(tree)

    def build(*arguments: Expr) -> Expr:
        value = function(*arguments)
        if value in NOT_NUMBERS:
            raise refusal(tree)
        return value

    return build


def _number(tree: Tree) -> Expr:
    match tree:
        case ["Rational", numerator, denominator] if (below := _integer(denominator)) != 0:
            return Rational(_integer(numerator), below)
        case {"num": str(digits), **rest} if not rest and (found := FLOAT.fullmatch(digits)):
            if INTEGER.fullmatch(digits):
                return Integer(int(digits))
            precision = len(found[1] + found[2])
            return Float(float(digits)) if precision <= DOUBLE_DIGITS else Float(digits, precision)
        case int():
            return _integer(tree)
        case _:
            raise refusal(tree)


def _integer(tree: Tree) -> Integer:
    return Integer(integer(tree))


def _symbol(name: str) -> Symbol:
    return Symbol(quantity(name), real=True)


def _write(expression: Expr) -> tuple[Callable[..., Tree], list]:
    match expression:
        case Integer():
            tree = integer_tree(int(expression))
        case Rational():
            tree = ["Rational", integer_tree(expression.p), integer_tree(expression.q)]
        case Float():
            tree = {"num": _digits(expression)}
        case Symbol() if expression == _symbol(expression.name):
            tree = expression.name
        case Indexed() if all(isinstance(index, Integer) for index in expression.indices):
            indices = [integer_tree(int(index)) for index in expression.indices]
            tree = ["Subscript", expression.base.label.name, *indices]
        case _ if expression in CONSTANT_NAMES:
            tree = CONSTANT_NAMES[expression]
        case sympy.Pow(exp=S.Half):
            return (lambda base: ["Sqrt", base]), [expression.base]
        case _ if expression.func in HEADS:
            head = HEADS[expression.func]
            return (lambda *arguments: [head, *arguments]), list(expression.args)
        case _:
            raise refusal(expression)
    return (lambda: tree), []


def _digits(value: Float) -> str:
    """Return enough decimal digits to restore the same number."""
    if value._prec <= DOUBLE_BITS:
        return f"{float(value):.{DOUBLE_DIGITS - 1}e}"
    return sympy.sstr(value, full_prec=True)


# ---- numbers as text ----
