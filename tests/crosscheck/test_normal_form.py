"""Identities of the textbook are proved; what is not an identity never is."""

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from holonom.crosscheck.normal_form import is_identically_zero

X, Y = sp.symbols("x y", real=True)

IDENTITIES = [
    sp.Integer(0),
    sp.sin(X) ** 2 + sp.cos(X) ** 2 - 1,
    sp.sin(2 * X) - 2 * sp.sin(X) * sp.cos(X),
    sp.sin(X + Y) - sp.sin(X) * sp.cos(Y) - sp.cos(X) * sp.sin(Y),
    sp.tan(X) - sp.sin(X) / sp.cos(X),
    sp.cosh(X) ** 2 - sp.sinh(X) ** 2 - 1,
    sp.exp(-X) * sp.exp(X + Y) - sp.exp(Y),
    sp.exp(X / 2) * sp.exp(X / 2, evaluate=False) - sp.exp(X),
    (X**2 - Y**2) / (X - Y) - X - Y,
    1 / (1 + 1 / (1 + X)) - (1 + X) / (2 + X),
    1 / (1 + sp.sqrt(X + Y)) - (1 - sp.sqrt(X + Y)) / (1 - X - Y),
    sp.sqrt(2 + sp.sin(X)) ** 3 - (2 + sp.sin(X)) * sp.sqrt(2 + sp.sin(X)),
    (sp.sqrt(5) / 2 - X) * (sp.sqrt(5) / 2 + X) - sp.Rational(5, 4) + X**2,
    sp.Abs(X) * sp.Abs(X, evaluate=False) - X**2,
    (sp.Abs(X) + 1) ** 2 - X**2 - 2 * sp.Abs(X) - 1,
    (sp.cbrt(X) + 1) ** 5 - sum(sp.binomial(5, k) * sp.cbrt(X) ** k for k in range(6)),
    (sp.cbrt(X) + Y) ** 3 - X - 3 * sp.cbrt(X) ** 2 * Y - 3 * sp.cbrt(X) * Y**2 - Y**3,
    sp.Float("0.5") * X - X / 2,
]

NO_IDENTITIES = [
    sp.sqrt(X) ** 3 - X,
    sp.cos(X) ** 3 - sp.cos(X) ** 2,
    (sp.sqrt(X) + 1) ** 3 - 4 * X - 3 * sp.sqrt(X) - 1,
    X - Y,
    sp.sin(X) ** 2 - sp.cos(X) ** 2,
    sp.sqrt(X**2 + 1) - X,
    sp.exp(X) - 1 - X,
    sp.Rational(1, 10**30),
]


@pytest.mark.parametrize("expression", IDENTITIES, ids=str)
def test_identity_is_proved(expression: sp.Expr) -> None:
    assert is_identically_zero([expression])


@pytest.mark.parametrize("expression", NO_IDENTITIES, ids=str)
def test_what_is_no_identity_is_not_proved(expression: sp.Expr) -> None:
    assert not is_identically_zero([expression])


def test_one_that_is_not_zero_spoils_the_proof() -> None:
    assert not is_identically_zero([*IDENTITIES, X])


def test_work_beyond_the_allowance_is_not_begun() -> None:
    identity = (X + Y) ** 40 - ((X + Y) ** 40).expand()
    assert not is_identically_zero([identity], allowance=1000)
    assert is_identically_zero([identity], allowance=100_000)


def test_what_is_too_long_to_be_read_is_not_proved() -> None:
    assert not is_identically_zero([X + Y], allowance=2)
    assert not is_identically_zero([sp.Integer(0), X + Y], allowance=3)


ATOMS = st.sampled_from([X, Y, sp.sin(X), sp.cos(X), sp.sqrt(Y**2 + 1), sp.exp(X), sp.Integer(2)])
EXPRESSIONS = st.recursive(
    ATOMS,
    lambda parts: st.builds(sp.Add, parts, parts)
    | st.builds(sp.Mul, parts, parts)
    | st.builds(lambda part: 1 / (1 + part**2), parts),
    max_leaves=8,
)


@settings(max_examples=60, derandomize=True)
@given(EXPRESSIONS, EXPRESSIONS)
def test_the_square_of_a_sum_is_proved_and_its_neighbour_is_not(a: sp.Expr, b: sp.Expr) -> None:
    square = (a + b) ** 2 - (a**2 + 2 * a * b + b**2)
    assert is_identically_zero([square])
    assert not is_identically_zero([square + sp.Rational(1, 1000) * X])
