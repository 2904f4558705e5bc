"""Bounds on rounding errors, and differences that must exceed them."""

import pytest
import sympy as sp
from mpmath import mp
from systems import symbols

from holonom.crosscheck.evaluation import Steps
from holonom.crosscheck.linear import LinearEquations
from holonom.crosscheck.report import Verdict
from holonom.crosscheck.rounding import Bounded, NoValue, bounded, rational
from holonom.crosscheck.verdict import Comparison, Pair, verify

X, Y, Z = symbols("x y z")
DIGITS = 40
THIRD = sp.Rational(1, 3)
ZERO = sp.sin(X) ** 2 + sp.cos(X) ** 2 - 1


def at(expression: sp.Expr, point: dict) -> Bounded | NoValue:
    with mp.workdps(DIGITS):
        return bounded(Steps([expression]), {x: rational(sp.Rational(number)) for x, number in point.items()})[0]


@pytest.mark.parametrize(
    "expression",
    [
        X + 10**30 * Y - 10**30 * Y * sp.sqrt(2) / sp.sqrt(2) + sp.exp(X),
        sp.exp(100 * X) * (1 - sp.tanh(20 * X) ** 2),
        (X - THIRD + sp.Rational(1, 10**30)) ** -2,
        sp.log(1 + X / 10**25) * sp.atan(Y) ** 3 + X ** sp.Rational(5, 3),
        sp.sqrt(X - 2) * sp.exp(Y) + sp.Abs(X - Y),
        sp.cos(10**9 * X) / sp.gamma(Y),
    ],
    ids=str,
)
def test_exact_value_is_within_the_bound(expression):
    point = {X: sp.Rational(2, 7), Y: sp.Rational(-31, 11)}
    found = at(expression, point)
    with mp.workdps(10 * DIGITS):
        exact = Steps([expression]).at({x: mp.mpf(number.p) / number.q for x, number in point.items()})[0]
        assert 0 < abs(found.value - exact) <= found.error
    assert found.error <= mp.mpf(10) ** (30 - DIGITS) * max(1, abs(found.value))


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        (1 / ZERO, NoValue.LOST),
        (sp.log(sp.Abs(ZERO)), NoValue.LOST),
        (sp.sign(ZERO), NoValue.LOST),
        (sp.atanh(sp.tanh(200 * X)), NoValue.LOST),
        (1 / X, NoValue.UNDEFINED),
        (sp.log(X), NoValue.UNDEFINED),
        (sp.exp(10**9 * (X + 1)), NoValue.TOO_LARGE),
        (sp.Symbol("unknown", real=True), NoValue.UNDEFINED),
    ],
    ids=str,
)
def test_expression_without_a_bound_has_a_reason(expression, expected):
    number = 0 if expected is NoValue.UNDEFINED else sp.Rational(5, 3)
    assert at(expression, {X: number}) is expected


def test_solution_of_badly_scaled_equations_is_within_the_bound():
    equations = LinearEquations((Y, Z), (sp.exp(40 * X) * Y + Z - 1, Y - sp.exp(-30 * X) * Z - X))
    with mp.workdps(DIGITS):
        found = equations.bounded_solution({X: rational(THIRD)})
    with mp.workdps(10 * DIGITS):
        exact = equations.solution({X: mp.mpf(1) / 3})
        for unknown in equations.unknowns:
            assert abs(found[unknown].value - exact[unknown]) <= found[unknown].error < mp.mpf(10) ** (10 - DIGITS)


@pytest.mark.parametrize(("entry", "expected"), [(sp.Integer(0), NoValue.UNDEFINED), (ZERO, NoValue.LOST)])
def test_singular_equations_have_no_bounded_solution(entry, expected):
    equations = LinearEquations((Y, Z), (entry * Y + Z, entry * Y + X * Z - 1))
    with mp.workdps(DIGITS):
        assert set(equations.bounded_solution({X: rational(THIRD)}).values()) == {expected}


@pytest.mark.parametrize("seed", ["1", "q1"])
@pytest.mark.parametrize("factor", [1, 1 + sp.Rational(1, 10**9), -1, 2])
def test_difference_lost_at_large_points_is_found_at_others(factor, seed):
    equations = LinearEquations((Y,), (Y * sp.cosh(X) ** 2 + sp.exp(2 * X) * (Y - Z),))
    expected = factor * sp.exp(2 * X) * Z / (sp.exp(2 * X) + sp.cosh(X) ** 2)
    found = verify(Comparison((Pair("y", expected, Y),), solves=(equations,)), seed)
    assert (found.verdict is Verdict.DISAGREES) is (factor != 1)
    assert found.verdict is not Verdict.UNDECIDED
