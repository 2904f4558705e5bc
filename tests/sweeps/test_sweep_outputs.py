"""Outputs of a sweep: items of a small language, which nothing runs as code."""

from fractions import Fraction

import pytest

from holonom.failures import ErrorKind, HolonomError
from holonom.program.motion_program import Call, Name, Operation
from holonom.sweeps.outputs import Kind, read_quantities


def test_items_are_distinguished_by_commas_outside_of_brackets():
    outputs = read_quantities(["final, at(x, 5/2)", "max(abs(lambda1)),zero( dot(y) )", "final"])
    assert [(item.text, item.kind) for item in outputs] == [
        ("final", Kind.FINAL),
        ("at(x,5/2)", Kind.AT),
        ("max(abs(lambda1))", Kind.LARGEST),
        ("zero(dot(y))", Kind.ZERO),
    ]
    assert outputs[1].time == Fraction(5, 2)
    assert outputs[3].quantity == Name("dot(y)")


def test_an_expression_has_the_precedence_of_maxima():
    (outputs,) = read_quantities(["-x^2/2 + m*Lambda[1]"])
    two = Fraction(2)
    power = Call(Operation.POWER, (Name("x"), two))
    half = Call(Operation.DIVIDE, (Call(Operation.NEGATE, (power,)), two))
    assert outputs.quantity == Call(Operation.ADD, (half, Call(Operation.MULTIPLY, (Name("m"), Name("Lambda[1]")))))
    assert (outputs.kind, outputs.time) == (Kind.AT, None)


@pytest.mark.parametrize(
    "item",
    [
        "",
        "x +",
        "__import__('os')",
        "x.y",
        "(lambda: 1)()",
        "[1]",
        "'x'",
        "True",
        "mean(abs(x))",
        "min(abs(x))",
        "at(x,soon)",
        "at(x,1/0)",
        "at(x,1.5/2)",
        "(" * 400 + "x" + ")" * 400,
        "1e999",
    ],
)
def test_an_unknown_output_is_an_error(item):
    with pytest.raises(HolonomError) as refused:
        read_quantities([item])
    assert refused.value.kind is ErrorKind.NOT_AN_OUTPUT
