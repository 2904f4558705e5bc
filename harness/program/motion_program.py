"""Straight-line programs for accelerations and multipliers, as frozen objects.

One JSON document from Maxima:

    inputs        names, in the order of every function made of the program: t, coordinates, velocities, controls,
                  control velocities, control accelerations, parameters
    assignments   [name, expression], each of the inputs and the names before it
    outputs       name -> a name or a number

An expression is a MathJSON tree. It stays as written, unlike in `holonom.expression.mathjson`, where SymPy sorts and
collects terms: its operations are what the program costs, and their order decides the last bits of the numbers.
"""

import re
from collections.abc import Iterator, Mapping, Set
from dataclasses import dataclass, field
from enum import StrEnum
from fractions import Fraction
from functools import cached_property
from typing import Any, ClassVar

from ..expression.functions import FUNCTIONS
from ..failures import ErrorKind, HolonomError
from ..formats import Document, read, require
from ..language import translatable
from ..schema import Names, NumberText
from ..structs import computed, entry, structured
from .request import Solve

LawSpan = tuple[NumberText, NumberText]
LAW_SPAN = "The times between which the tables and special functions in it have values; null without any."


DEEPEST = 100  # levels of an expression: Maxima names what is deeper, and Python's recursion limit stays far away
LONGEST_NUMBER = 4000  # characters of a number's digits; Python reads 4300
ROUNDED = 1e-9  # of the times between which functions of time have values: how far outside they have them, too
SHOWN = 60  # characters of a rejected fragment that the error shows
DECIMAL = re.compile(r"-?\d+(\.\d*)?([eE][+-]?\d{1,4})?")


ARITHMETIC = ("Add", "Multiply", "Subtract", "Divide", "Power", "Negate")
CALLED = tuple(each for each in FUNCTIONS if each.program)
Operation = StrEnum(
    "Operation", {head.upper(): head for head in (*ARITHMETIC, *(each.head for each in CALLED))}, module=__name__
)
"""The operations of a program; the value is the head of the MathJSON tree."""

OPERATIONS = {operation.value: operation for operation in Operation}
VARIADIC = frozenset({Operation.ADD, Operation.MULTIPLY})
BINARY = frozenset({Operation.SUBTRACT, Operation.DIVIDE, Operation.POWER}) | {
    Operation(each.head) for each in CALLED if each.arity == 2
}


class Constant(StrEnum):
    """A number with a name."""

    PI = "Pi"
    E = "ExponentialE"


CONSTANTS = frozenset(Constant)


@dataclass(frozen=True, slots=True)
class Name:
    """The value of an input or of an assignment."""

    text: str


@dataclass(frozen=True, slots=True)
class Call:
    """An operation on its arguments."""

    operation: Operation
    arguments: tuple["Expression", ...]
    # of the values that it is made of, from the first time that they are asked for
    _names: frozenset[str] | None = field(init=False, default=None, repr=False, compare=False)

    @property
    def names(self) -> frozenset[str]:
        """Names of the values that it is made of."""
        if self._names is None:
            object.__setattr__(self, "_names", frozenset(_names_below(self)))
        return self._names


Atom = Name | Fraction | Constant
Expression = Atom | Call


@dataclass(frozen=True)
class Program:
    """A motion program."""

    scene: str | None = entry("Name of the scene; null for a system alone.")
    solve: Solve = entry("How the multipliers are solved for.")
    method: str = entry("Factored matrix, such as bordered or schur.")
    inputs: Names = entry("Names, in the order of every function made of the program.")
    assignments: tuple[tuple[str, Expression], ...] = entry("Name and expression, each of inputs and names before it.")
    outputs: Mapping[str, Atom] = entry("Name or number of each quantity that is computed.", minProperties=1)
    redundant: tuple[str, ...] = entry(
        "Multipliers that were put to zero, for their constraints follow from the others near the initial state.", ()
    )
    law_span: LawSpan | None = entry(LAW_SPAN, None)

    SHAPE: ClassVar = {"type": "object"}  # within other documents, where it is a document of its own

    @property
    def times(self) -> tuple[float, float]:
        """The first and the last time of `law_span`, with room for rounding."""
        first, last = map(float, self.law_span)
        room = ROUNDED * max(abs(first), abs(last))
        return first - room, last + room

    @cached_property
    @computed("Number of operations of all assignments.", minimum=0)
    def operations(self) -> int:
        """Number of operations, by the rule of `operations_in`."""
        return sum(operations_in(expression) for _, expression in self.assignments)

    @staticmethod
    def of_document(document: Any) -> "Program":
        """Read a program that is part of a larger document.

        Parameters
        ----------
        document : dict
            Decoded JSON of the program.

        Returns
        -------
        Program

        Raises
        ------
        HolonomError
            As `read_program`.
        """
        require(Document.PROGRAM, document, Program)
        return _checked(document)


def read_program(text: str) -> Program:
    """Read the document of a motion program.

    Parameters
    ----------
    text : str
        JSON document of the program.

    Returns
    -------
    Program

    Raises
    ------
    HolonomError
        The text is not such a document, names a value that nothing before it computes, or computes one twice.
    """
    return read(Document.PROGRAM, text, Program)


def _checked(document: Mapping[str, Any]) -> Program:
    assignments = tuple((name, expression_of(tree)) for name, tree in document["assignments"])
    outputs = {name: _atom(tree) for name, tree in document["outputs"].items()}
    program = structured(Program, document, assignments=assignments, outputs=outputs)
    _require_straight_line(program)
    return program


def operations_in(expression: Expression) -> int:
    """Count the operations in one expression.

    Every +, -, multiplication, division, power, root and function call counts one: a sum or product of k terms k - 1.

    Parameters
    ----------
    expression : Expression

    Returns
    -------
    int
    """
    match expression:
        case Call(operation, arguments):
            own = len(arguments) - 1 if operation in VARIADIC else 1
            return own + sum(map(operations_in, arguments))
        case _:
            return 0


def names_in(expression: Expression) -> Set[str]:
    """Return names of the values that an expression is made of.

    Parameters
    ----------
    expression : Expression

    Returns
    -------
    set of str
    """
    if isinstance(expression, Call):
        return expression.names
    return {expression.text} if isinstance(expression, Name) else set()


def _names_below(call: Call) -> Iterator[str]:
    for argument in call.arguments:
        if isinstance(argument, Name):
            yield argument.text
        elif isinstance(argument, Call):
            yield from _names_below(argument)


def names_used(program: Program) -> Set[str]:
    """Return names that the assignments and outputs of a program are made of.

    Parameters
    ----------
    program : Program

    Returns
    -------
    set of str
    """
    expressions = [*(expression for _, expression in program.assignments), *program.outputs.values()]
    return set().union(*map(names_in, expressions))


def calls_in(expression: Expression) -> Iterator[Call]:
    """Yield the operations in an expression, each before those in its arguments.

    Parameters
    ----------
    expression : Expression

    Yields
    ------
    Call
        An operation with its arguments.
    """
    if isinstance(expression, Call):
        yield expression
        for argument in expression.arguments:
            yield from calls_in(argument)


def calls_of(program: Program) -> Iterator[Call]:
    """Yield the operations of a program.

    Parameters
    ----------
    program : Program

    Yields
    ------
    Call
        An operation with its arguments.
    """
    return (call for _, expression in program.assignments for call in calls_in(expression))


def expression_of(tree: object, levels: int = DEEPEST) -> Expression:
    """Read an expression.

    Parameters
    ----------
    tree : object
        A MathJSON tree.
    levels : int
        Levels that it has at most.

    Returns
    -------
    Expression

    Raises
    ------
    HolonomError
        It is not an expression that a program can hold.
    """
    if levels and isinstance(tree, list) and tree and _takes(tree[0], len(tree) - 1):
        return Call(OPERATIONS[tree[0]], tuple([expression_of(argument, levels - 1) for argument in tree[1:]]))
    return _atom(tree)


def _takes(head: object, arguments: int) -> bool:
    """Return True if there is an operation of that head with this number of arguments."""
    if not isinstance(head, str) or head not in OPERATIONS:
        return False
    if head in VARIADIC:
        return arguments >= 1
    return arguments == (2 if head in BINARY else 1)


def _atom(tree: object) -> Atom:
    if isinstance(tree, str):
        if tree in ("ImaginaryUnit", "True", "False"):
            raise _error(translatable("%(tree)s is not a real number", tree=tree))
        return Constant(tree) if tree in CONSTANTS else Name(tree)
    match tree:
        case ["Rational", numerator, denominator] if _number(denominator):
            return _within_double(_number(numerator) / _number(denominator))
        case _:
            return _within_double(_number(tree))


def _number(tree: object) -> Fraction:
    match tree:
        case bool():
            raise _error(translatable("%(tree)s is not a number", tree=tree))
        case int():
            return Fraction(tree)
        case {"num": str(digits), **rest} if not rest and len(digits) < LONGEST_NUMBER and DECIMAL.fullmatch(digits):
            return Fraction(digits)
        case _:
            raise _error(translatable("%(tree)s is not an expression that a program can hold", tree=_shown(str(tree))))


def _within_double(number: Fraction) -> Fraction:
    try:
        float(number)
    except OverflowError:
        raise HolonomError(ErrorKind.NUMBER_TOO_LARGE) from None
    return number


def _require_straight_line(program: Program) -> None:
    known = set(program.inputs)
    for name, expression in program.assignments:
        _require_known(names_in(expression), known)
        if name in known:
            raise _error(translatable("%(name)s is computed twice", name=name))
        known.add(name)
    for value in program.outputs.values():
        _require_known(names_in(value), known)


def _require_known(names: Set[str], known: Set[str]) -> None:
    if not names <= known:
        raise _error(translatable("%(name)s is used before it is computed", name=min(names - known)))


def _error(detail: str) -> HolonomError:
    return HolonomError(ErrorKind.NOT_A_PROGRAM, detail=detail)


def _shown(text: str) -> str:
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}..."
