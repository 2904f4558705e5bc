"""Tapes against Python's own arithmetic and differences: what signs decide, sizes, gradients."""

import operator
import random
from fractions import Fraction

import pytest
from mpmath import mp
from refusing import failing

from holonom.crosscheck.irregular_point import IrregularPoint
from holonom.crosscheck.tape import Tape
from holonom.crosscheck.taylor import Taylor
from holonom.failures import ErrorKind

TAYLOR = Taylor(0)
COMPARED = {"Greater": operator.gt, "GreaterEqual": operator.ge, "Less": operator.lt, "LessEqual": operator.le}
COMPARED |= {"Equal": operator.eq, "Same": operator.eq, "NotEqual": operator.ne, "NotSame": operator.ne}


@pytest.fixture(autouse=True)
def digits():
    with mp.workdps(40):
        yield


def value(tree, **known):
    tape = Tape()
    place = tape.place(tree)
    return tape.values(TAYLOR, {name: (mp.mpf(number),) for name, number in known.items()})[place][0]


def condition(draw, depth):
    """A tree of a condition on x, y, z, and whether it holds, as a function of them."""
    if depth == 0:
        head, (a, b) = draw.choice(sorted(COMPARED)), draw.sample("xyz", 2)
        return [head, a, b], lambda at: COMPARED[head](at[a], at[b])
    kind = draw.choice(["And", "Or", "Not"])
    parts = [condition(draw, depth - 1) for _ in range(1 if kind == "Not" else draw.randint(2, 3))]
    meant = {"And": all, "Or": any, "Not": lambda each: not next(each)}[kind]
    return [kind, *(tree for tree, _ in parts)], lambda at: meant(holds(at) for _, holds in parts)


@pytest.mark.parametrize("seed", range(40))
def test_conditions_hold_where_they_do(seed):
    draw = random.Random(seed)
    tree, holds = condition(draw, draw.randint(0, 3))
    at = {name: Fraction(number, 7) for name, number in zip("xyz", draw.sample(range(-20, 20), 3), strict=True)}
    known = {name: mp.mpf(number.numerator) / number.denominator for name, number in at.items()}
    assert value(["Which", tree, 5, "True", 7], **known) == (5 if holds(at) else 7)


def test_extremes_and_signs():
    assert value(["Max", "x", "y", 2], x=1, y=3) == 3
    assert value(["Min", "x", "y", 2], x=1, y=3) == 1
    assert [value(["Sign", "x"], x=x) for x in (-2, 5)] == [-1, 1]
    assert [value(["UnitStep", "x"], x=x) for x in (-2, 5)] == [0, 1]
    assert [value(["HalfStep", "x"], x=x) for x in (-2, 5)] == [0, 1]


@pytest.mark.parametrize("head", ["Max", "Min", "Greater", "LessEqual", "Equal"])
def test_nothing_is_decided_where_two_sides_meet(head):
    with pytest.raises(IrregularPoint):
        value([head, "x", "y"], x=3, y=3)


OF_BOTH = [
    ["Multiply", "x", "y", "x"],
    ["Divide", "x", ["Add", "y", 3]],
    ["Power", ["Abs", "x"], "y"],
    ["Power", "y", 3],
    ["Arctan2", "x", "y"],
    ["Subtract", ["Sin", "x"], ["Negate", ["Exp", "y"]]],
    ["Max", "x", "y"],
    ["Min", "x", ["Multiply", 5, "y"]],
    ["Which", ["Greater", "x", 0], "x", "True", ["Multiply", "x", "y"]],
    ["Multiply", ["Sign", "x"], ["Sqrt", "y"]],
    ["BesselJ", 2, ["Multiply", "x", "y"]],
    ["JacobiSn", ["Multiply", "x", "y"], ["Rational", 1, 3]],
]


@pytest.mark.parametrize("tree", OF_BOTH, ids=lambda tree: tree[0])
def test_gradients_are_what_differences_go_to(tree):
    known = {"x": mp.mpf("-0.7"), "y": mp.mpf("0.4")}
    tape = Tape()
    place = tape.place(tree)
    values = tape.values(TAYLOR, {name: (number,) for name, number in known.items()})
    gradient = tape.gradient(TAYLOR, values, {place: (mp.one,)})
    step = mp.mpf(10) ** -12
    for name, number in known.items():
        around = [value(tree, **{**known, name: number + side * step}) for side in (1, -1)]
        found = gradient.get(name, (mp.zero,))[0]
        assert abs(found - (around[0] - around[1]) / (2 * step)) < mp.mpf(10) ** -20


def test_a_power_is_differentiated_where_its_exponent_changes_in_time():
    """d/dx of x^y is y x^(y - 1): 1 + 2 t + ... for x = 1 + t^2 and y = 1 + 2 t, (1 + 2 t) x^(2 t)."""
    taylor, tape = Taylor(2), Tape()
    place = tape.place(["Power", "x", "y"])
    known = {"x": (mp.one, mp.zero, mp.one), "y": (mp.one, mp.mpf(2), mp.zero)}
    values = tape.values(taylor, known)
    gradient = tape.gradient(taylor, values, {place: (mp.one,)})
    assert [mp.nstr(each, 20) for each in gradient["x"][:3]] == ["1.0", "2.0", "0.0"]


def test_a_square_is_differentiated_where_its_base_is_zero_but_for_rounding():
    """A division by the base made the check of a closed chain's series blind."""
    tape, taylor = Tape(), Taylor(3)
    place = tape.place(["Power", "x", 2])
    base = (mp.mpf(10) ** -39, mp.one, mp.mpf(2), mp.mpf(3))
    values = tape.values(taylor, {"x": base})
    (slope,) = tape.gradient(taylor, values, {place: (mp.one,)}).values()
    assert slope == tuple(2 * each for each in base)


def test_a_name_without_a_value_is_refused():
    with failing(ErrorKind.NOT_AN_EXPRESSION, "z"):
        value(["Add", "x", "z"], x=1)
