"""Random points: anywhere, and every second one positive; their values exact, finite and real."""

import pytest
import sympy as sp
from mpmath import mp

from holonom.crosscheck.evaluation import Steps
from holonom.crosscheck.irregular_point import IrregularPoint
from holonom.crosscheck.points import random_point
from holonom.crosscheck.seed import fresh_seed

X = sp.Symbol("x", real=True)


def test_every_second_point_is_positive_and_the_others_are_of_both_signs():
    draws = [random_point("abc", attempt, "seed") for attempt in range(40)]
    signs = [{number > 0 for number in draw.values()} for draw in draws]
    assert all(each == {True} for each in signs[::2])
    assert {True, False} == set().union(*signs[1::2])


def test_each_attempt_is_another_point_with_an_unforeseen_seed():
    assert random_point(["x"], 0, "seed") != random_point(["x"], 2, "seed") != random_point(["x"], 4, "seed")
    assert fresh_seed() != fresh_seed()


def test_a_fraction_has_all_the_digits_that_are_worked_with():
    with mp.workdps(60):
        (found,) = Steps([3 * X - 1]).real_at({X: mp.mpf(1) / 3})
        assert found == pytest.approx(0, abs=1e-58)


def test_rates_of_a_step_are_zero_beside_it():
    assert Steps([sp.sign(X).diff(X, 2)]).real_at({X: mp.mpf(-1) / 3}) == [0]  # which ended in an internal error


@pytest.mark.parametrize(
    "expression",
    [sp.log(X), sp.sqrt(-1 - X**2), sp.sqrt(-1 - X**2) ** 4 * sp.sqrt(-2 - X**2), sp.DiracDelta(X)],
    ids=str,
)
def test_what_is_infinite_or_imaginary_is_no_value(expression):
    with pytest.raises(IrregularPoint):
        Steps([expression]).real_at({X: mp.zero})


def test_a_power_has_a_value_up_to_an_exponent_of_e_of_ten_to_the_eight():
    y = sp.Symbol("y", real=True)
    near, far = (Steps([X**y]).at({X: mp.mpf("1.001"), y: mp.mpf(10) ** digits})[0] for digits in (4, 12))
    assert near == pytest.approx(21916.681339048373)  # exp(10000 log(1.001))
    assert far is None
