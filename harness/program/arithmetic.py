"""Evaluation of expressions in each target, such as C text or heyoka expressions.

A target is an arithmetic: it defines the form of a number, of a constant and of each operation.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Generic, TypeVar

from ..expression import infix
from .motion_program import CALLED, Atom, Call, Constant, Expression, Name, Operation, Program

Value = TypeVar("Value")

ELEMENTARY = {Operation(each.head): each.program for each in CALLED}
"""Functions that C, Python, NumPy, JavaScript and heyoka, or most of them, call by the same names."""


INFIX = {
    Operation.ADD: infix.add,
    Operation.MULTIPLY: infix.multiply,
    Operation.SUBTRACT: infix.subtract,
    Operation.DIVIDE: infix.divide,
    Operation.NEGATE: infix.negate,
}
"""Operations that C, Python and JavaScript write alike."""


@dataclass(frozen=True)
class Arithmetic(Generic[Value]):
    """The form of numbers, constants and operations in a target."""

    number: Callable[[Fraction], Value]  # takes a Fraction
    constants: Mapping[Constant, Value]
    power: Callable[[Value, Fraction], Value]  # takes the base's value and a rational exponent
    # each takes the values of the arguments. ``POWER`` has an exponent that is not a number.
    operations: Mapping[Operation, Callable[..., Value]]

    def value(self, expression: Expression, names: Mapping[str, Value]) -> Value:
        """Return the form of an expression, given the forms of its names.

        Parameters
        ----------
        expression : Expression
            Expression to translate.
        names : mapping of str to Value
            Form of each name in the expression.

        Returns
        -------
        Value
            Form in the target.
        """
        if not isinstance(expression, Call):
            return self.atom(expression, names)
        if expression.operation is Operation.POWER and isinstance(exponent := expression.arguments[1], Fraction):
            return self.power(self.value(expression.arguments[0], names), exponent)
        return self.operations[expression.operation](*[self.value(each, names) for each in expression.arguments])

    def atom(self, atom: Atom, names: Mapping[str, Value]) -> Value:
        """Return the form of a name, a number or a constant.

        Parameters
        ----------
        atom : Atom
            A name, a number or a constant.
        names : mapping of str to Value
            Form of each name.

        Returns
        -------
        Value
            Form in the target.
        """
        if isinstance(atom, Name):
            return names[atom.text]
        return self.constants[atom] if isinstance(atom, Constant) else self.number(atom)


def run_program(program: Program, inputs: Mapping[str, Value], arithmetic: Arithmetic[Value]) -> dict[str, Value]:
    """Evaluate a program, given a value of each input.

    Parameters
    ----------
    program : Program
    inputs : mapping of str to Value
        Value of each input of the program.
    arithmetic : Arithmetic[Value]
        Arithmetic of the values.

    Returns
    -------
    dict of str to Value
        Value of each output, in order.
    """
    names = dict(inputs)
    for name, expression in program.assignments:
        names[name] = arithmetic.value(expression, names)
    return {output: arithmetic.atom(atom, names) for output, atom in program.outputs.items()}
