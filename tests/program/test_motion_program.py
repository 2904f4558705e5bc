"""Reading a motion program, and counting its operations."""

import json

import pytest
from programs import PENDULUM, chain, document, program
from refusing import failing

from holonom.failures import ErrorKind, HolonomError
from holonom.formats import VERSION
from holonom.program.motion_program import (
    Call,
    Constant,
    Name,
    Operation,
    operations_in,
    read_program,
)


def expression(tree):
    return program(["a", "b"], [("w", tree)], {"out": "w"}).assignments[0][1]


def test_expression_stays_as_written():
    assert expression(["Add", "a", ["Multiply", "a", "b"], "a"]) == Call(
        Operation.ADD, (Name("a"), Call(Operation.MULTIPLY, (Name("a"), Name("b"))), Name("a"))
    )


def test_numbers_are_exact():
    third, large, decimal = (expression(tree) for tree in (["Rational", 1, 3], {"num": str(2**70)}, {"num": "-123e-2"}))
    assert third * 3 == 1
    assert large == 2**70
    assert decimal * 100 == -123


def test_constants_are_not_names():
    assert expression("Pi") is Constant.PI


@pytest.mark.parametrize(
    ("tree", "operations"),
    [
        ("a", 0),
        (["Rational", 1, 3], 0),
        (["Add", "a"], 0),
        (["Add", "a", "b", 1], 2),
        (["Multiply", 2, "a", "b", "b"], 3),
        (["Subtract", "a", ["Negate", "b"]], 2),
        (["Divide", ["Power", "a", 2], ["Sqrt", "b"]], 3),
        (["Arctan2", ["Sin", "a"], "b"], 2),
    ],
)
def test_every_operation_counts_one(tree, operations):
    assert operations_in(expression(tree)) == operations


def test_operations_of_a_program_are_those_of_its_assignments():
    assert PENDULUM.operations == 12


def test_count_grows_with_the_chain_link_by_link():
    counts = [chain(links).operations for links in (5, 6, 7)]
    assert counts[2] - counts[1] == counts[1] - counts[0]


@pytest.mark.parametrize(
    ("change", "kind", "part"),
    [
        ({"version": VERSION + 1}, ErrorKind.NOT_A_DOCUMENT, "version"),
        ({"solve": "iterative"}, ErrorKind.NOT_A_DOCUMENT, "solve"),
        ({"operations": -1}, ErrorKind.NOT_A_DOCUMENT, "operations"),
        ({"inputs": ["a", "a"]}, ErrorKind.NOT_A_DOCUMENT, "inputs"),
        ({"outputs": {}}, ErrorKind.NOT_A_DOCUMENT, "outputs"),
        ({"outputs": {"out": "b"}}, ErrorKind.NOT_A_PROGRAM, "b"),
        ({"assignments": [["w", "v"]]}, ErrorKind.NOT_A_PROGRAM, "v"),
        ({"assignments": [["w", "a"], ["w", "a"]]}, ErrorKind.NOT_A_PROGRAM, "w"),
        ({"assignments": [["a", 1]]}, ErrorKind.NOT_A_PROGRAM, "a"),
        ({"assignments": [["w", ["Power", "a"]]]}, ErrorKind.NOT_A_PROGRAM, "Power"),
        ({"assignments": [["w", ["__import__", "a"]]]}, ErrorKind.NOT_A_PROGRAM, "__import__"),
        ({"assignments": [["w", ["Rational", 1, 0]]]}, ErrorKind.NOT_A_PROGRAM, "Rational"),
        ({"assignments": [["w", 1.5]]}, ErrorKind.NOT_A_PROGRAM, "1.5"),
        ({"assignments": [["w", True]]}, ErrorKind.NOT_A_PROGRAM, "True"),
        ({"assignments": [["w", "ImaginaryUnit"]]}, ErrorKind.NOT_A_PROGRAM, "ImaginaryUnit"),
        ({"assignments": [["w", {"num": "1e99999999"}]]}, ErrorKind.NOT_A_PROGRAM, "1e99999999"),
        ({"assignments": [["w", {"num": "nan"}]]}, ErrorKind.NOT_A_PROGRAM, "nan"),
    ],
)
def test_what_is_no_program_is_refused_by_its_part(change, kind, part):
    text = json.dumps(document(["a"], [], {"out": "a"}) | change)
    with failing(kind, part) as refusal:
        read_program(text)
    assert "\n" not in str(refusal.value)


def test_a_number_beyond_double_precision_is_refused():
    with failing(ErrorKind.NUMBER_TOO_LARGE):
        read_program(json.dumps(document(["a"], [["w", {"num": "1e9999"}]], {"out": "a"})))


@pytest.mark.parametrize("depth", [200, 100_000])
def test_deep_nesting_is_refused(depth):
    text = json.dumps(document(["a"], [["w", "DEEP"]], {"out": "w"}))
    nested = '["Sin",' * depth + '"a"' + "]" * depth
    with pytest.raises(HolonomError):
        read_program(text.replace('"DEEP"', nested))


def test_text_that_is_not_json_is_refused():
    with pytest.raises(HolonomError):
        read_program("{")
