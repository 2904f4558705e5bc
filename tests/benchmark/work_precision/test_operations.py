"""Truth: operations counted one by one while a program is carried out on truncated power series."""

from collections import Counter
from fractions import Fraction
from pathlib import Path

import pytest

from holonom.benchmark.work_precision.operations import expansion_operations
from holonom.program.arithmetic import Arithmetic, run_program
from holonom.program.motion_program import Name, Operation, Program

EXAMPLES = Path(__file__).parents[3] / "examples"


class CountingSeries:
    """A truncated power series that counts what it does; a constant one is a number."""

    def __init__(self, coefficients, done):
        self.c, self.done = coefficients, done

    @property
    def is_number(self):
        return not any(self.c[1:])

    def __add__(self, other):
        self.done["operations"] += len(self.c)
        return CountingSeries([a + b for a, b in zip(self.c, other.c, strict=True)], self.done)

    def __mul__(self, other):
        if self.is_number or other.is_number:
            number, series = (self, other) if self.is_number else (other, self)
            self.done["operations"] += 0 if series.is_number else len(self.c)
            return CountingSeries([number.c[0] * x for x in series.c], self.done)
        result = []
        for n in range(len(self.c)):
            total = self.c[0] * other.c[n]
            for k in range(1, n + 1):
                total += self.c[k] * other.c[n - k]
            self.done["operations"] += 2 * n + 1
            result.append(total)
        return CountingSeries(result, self.done)


def program(assignments):
    return Program.of_document(
        {
            "format": "holonom-program",
            "version": 2,
            "scene": None,
            "solve": "direct",
            "method": "schur",
            "redundant": [],
            "operations": 0,
            "inputs": ["x", "y"],
            "assignments": assignments,
            "outputs": {"z": assignments[-1][0]},
        }
    )


@pytest.mark.parametrize("order", [1, 4, 9])
@pytest.mark.parametrize(
    "assignments",
    [
        [["z", ["Add", "x", "y"]]],
        [["z", ["Multiply", "x", "y"]]],
        [["z", ["Multiply", 3, "x", "y"]]],
        [["a", ["Multiply", 2, 5]], ["z", ["Multiply", "a", "x"]]],
        [["a", ["Multiply", "x", "y", "x"]], ["b", ["Add", "a", "x", 7]], ["z", ["Multiply", "b", "a"]]],
    ],
)
def test_sums_and_products_are_counted_as_they_are_carried_out(assignments, order):
    done = Counter()
    arithmetic = Arithmetic(
        number=lambda value: CountingSeries([value, *[Fraction(0)] * order], done),
        constants={},
        power=None,
        operations={
            Operation.ADD: lambda first, *rest: sum(rest, start=first),
            Operation.MULTIPLY: lambda first, *rest: product(first, rest),
        },
    )
    given = {name: CountingSeries([Fraction(k + 2) for k in range(order + 1)], done) for name in ("x", "y")}
    taken = program(assignments)
    run_program(taken, given, arithmetic)
    assert isinstance(taken.outputs["z"], Name)
    assert expansion_operations(taken, order) == done["operations"]


def product(first, rest):
    for factor in rest:
        first = first * factor
    return first


def test_a_quotient_takes_one_product_and_a_sine_takes_its_cosine_along():
    order = 6
    assert expansion_operations(program([["z", ["Divide", "x", "y"]]]), order) == (order + 1) ** 2
    assert expansion_operations(program([["z", ["Divide", "x", 3]]]), order) == order + 1
    assert expansion_operations(program([["z", ["Sin", "x"]]]), order) == 2 * (order + 1) ** 2
    assert expansion_operations(program([["z", ["Sin", 2]]]), order) == 0
