"""Programs made of others: operations on numbers are done when they are written."""

from fractions import Fraction

import pytest

from holonom.program.motion_program import Call, Name, Operation, Program
from holonom.program.rewriting import ONE, ZERO, folded, with_joined_roots, with_numbers

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


def call(operation, *arguments):
    return Call(Operation[operation], arguments)


def test_weights_within_weights_are_computed_once():
    """Twice at each level is 2^60 times."""
    nested = X
    for _ in range(60):
        nested = Call(Operation.MULTIPLY, (Call(Operation.ADD, (Name("m"), nested)), Fraction(1, 2)))
    found = with_numbers(
        Program(None, "direct", "", ("x", "m"), (("w", nested),), {"w": Name("w")}), {"x": ONE, "m": ONE}
    )
    assert found.outputs == {"w": ONE}


@pytest.mark.parametrize(
    ("factors", "expected"),
    [
        ((X, call("SQRT", X)), call("POWER", X, Fraction(3, 2))),
        ((call("SQRT", X), Y, call("POWER", X, Fraction(2))), call("MULTIPLY", Y, call("POWER", X, Fraction(5, 2)))),
        ((X, call("MULTIPLY", Name("r"), Y)), call("MULTIPLY", call("POWER", X, Fraction(3, 2)), Y)),
        ((X, Name("s")), call("MULTIPLY", call("POWER", X, Fraction(3, 2)), call("DIVIDE", ONE, Y))),
        ((Y, Name("r")), call("MULTIPLY", Y, Name("r"))),
        ((call("POWER", X, -ONE), Name("r")), call("MULTIPLY", call("POWER", X, -ONE), Name("r"))),
    ],
)
def test_a_root_times_what_it_is_a_root_of_is_a_power(factors, expected):
    roots = (("r", call("SQRT", X)), ("s", call("DIVIDE", call("SQRT", X), Y)))
    product = ("w", call("NEGATE", call("MULTIPLY", *factors)))
    found = with_joined_roots(Program(None, "direct", "", ("x", "y"), (*roots, product), {"w": Name("w")}))
    assert found.assignments[-1] == ("w", call("NEGATE", expected))
    assert len(found.assignments) == 1 + (Name("r") in expected.arguments)
