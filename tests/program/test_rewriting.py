"""Programs made of others: operations on numbers are done when they are written."""

from fractions import Fraction

import pytest

from holonom.program.motion_program import Call, Name, Operation, Program
from holonom.program.rewriting import ONE, ZERO, folded, with_numbers

X, Y = Name("x"), Name("y")


@pytest.mark.parametrize(
    ("operation", "arguments", "expected"),
    [
        (Operation.ADD, [X, ZERO], X),
        (Operation.ADD, [X, Fraction(2), Y, Fraction(3)], Call(Operation.ADD, (Fraction(5), X, Y))),
        (Operation.ADD, [X, Call(Operation.NEGATE, (X,))], ZERO),
        (Operation.MULTIPLY, [ONE, X], X),
        (Operation.MULTIPLY, [Fraction(2), X, Fraction(1, 2)], X),
        (Operation.MULTIPLY, [Fraction(2), Fraction(3)], Fraction(6)),
        (Operation.MULTIPLY, [X, ZERO], ZERO),
        (Operation.SUBTRACT, [X, X], ZERO),
        (Operation.SUBTRACT, [ZERO, X], Call(Operation.NEGATE, (X,))),
        (Operation.DIVIDE, [X, ONE], X),
        (Operation.POWER, [ZERO, Fraction(-1)], Call(Operation.POWER, (ZERO, Fraction(-1)))),
    ],
)
def test_what_numbers_leave_of_an_operation(operation, arguments, expected):
    assert folded(operation, arguments) == expected


def test_a_number_goes_through_the_assignments():
    """Of z = x m and y z + x nothing is left but x, if m is zero."""
    product = Call(Operation.MULTIPLY, (X, Name("m")))
    output = Call(Operation.ADD, (Call(Operation.MULTIPLY, (Y, Name("z"))), X))
    found = with_numbers(Program(None, "direct", "", ("x", "y", "m"), (("z", product),), {"out": output}), {"m": ZERO})
    assert (found.inputs, found.assignments, found.outputs) == (("x", "y"), (), {"out": X})
