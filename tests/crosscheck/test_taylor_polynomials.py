"""Taylor polynomials: the rules of arithmetic."""

import pytest
from mpmath import mp

from holonom.crosscheck.irregular_point import IrregularPoint
from holonom.crosscheck.tape import value_of
from holonom.crosscheck.taylor import Taylor

ORDER = 5
TAYLOR = Taylor(ORDER)
X = tuple(map(mp.mpf, (2, -1, 3, 1)))
Y = tuple(map(mp.mpf, (3, 5, -2, 1, 7, 4)))


@pytest.fixture(autouse=True)
def digits():
    with mp.workdps(50):
        yield


def agree(found, expected):
    return len(found) <= ORDER + 1 and all(
        mp.almosteq(a, b, rel_eps=mp.mpf(10) ** -20, abs_eps=mp.mpf(10) ** -20)
        for a, b in zip([*found, *[0] * (ORDER + 1 - len(found))], expected, strict=True)
    )


def test_division_and_powers_undo_multiplication():
    product = TAYLOR.multiply(X, Y)
    assert len(product) == ORDER + 1
    assert agree(TAYLOR.divide(product, Y), [*X, 0, 0])
    assert agree(TAYLOR.divide(Y, (mp.mpf(2),)), [y / 2 for y in Y])
    root = TAYLOR.power(X, mp.mpf(1) / 2)
    assert agree(TAYLOR.multiply(root, root), [*X, 0, 0])
    assert agree(TAYLOR.multiply(TAYLOR.power(X, mp.mpf(-2)), TAYLOR.multiply(X, X)), [1, 0, 0, 0, 0, 0])
    assert agree(TAYLOR.power(X, mp.mpf(2)), TAYLOR.multiply(X, X))


@pytest.mark.parametrize("exponent", range(1, 12))
def test_whole_powers_of_what_vanishes_were_irregular(exponent):
    x = (mp.zero, mp.mpf(2))
    assert agree(TAYLOR.power(x, mp.mpf(exponent)), [2**exponent if k == exponent else 0 for k in range(ORDER + 1)])


def test_composition_rates_and_integrals():
    assert agree(value_of(TAYLOR, "Exp", [value_of(TAYLOR, "Ln", [X])]), [*X, 0, 0])
    assert agree(TAYLOR.integral(TAYLOR.rate(Y), Y[0]), Y)
    assert TAYLOR.rate(X) == (-1, 6, 3)
    assert TAYLOR.rate((mp.mpf(4),)) == (0,)


@pytest.mark.parametrize(("order", "exponent"), [(0, "0.25"), (1, "0.75"), (2, "1.5"), (5, "2.5")])
def test_powers_of_what_vanishes_to_its_order_vanish(order, exponent):
    """(x^(order + 1))^exponent has no term up to the order."""
    assert not any(Taylor(order).power((mp.zero,) * (order + 1), mp.mpf(exponent)))


@pytest.mark.parametrize(("order", "exponent"), [(1, "0.5"), (2, "0.5"), (5, "0.75"), (0, "-1")])
def test_powers_of_what_vanishes_to_its_order_may_have_terms(order, exponent):
    with pytest.raises(IrregularPoint):
        Taylor(order).power((mp.zero,), mp.mpf(exponent))


@pytest.mark.parametrize(("x", "exponent"), [(0, -1), (-2, mp.mpf(1) / 2)])
def test_powers_that_are_not_analytic_are_refused(x, exponent):
    with pytest.raises(IrregularPoint):
        TAYLOR.power((mp.mpf(x), mp.one), mp.mpf(exponent))
    with pytest.raises(IrregularPoint):
        TAYLOR.divide(Y, (mp.zero, mp.one))
