"""Truth: times that grow by a known factor with every digit."""

from fractions import Fraction

import pytest

from holonom.benchmark.work_precision.advice import ASKED_DIGITS, cheapest_methods, prices
from holonom.benchmark.work_precision.measurement import Group, Measurement


def measurement(method, digits, seconds, group=Group.SOLVER):
    return Measurement(group, method, f"tol 1e-{digits}", Fraction(10), 10.0**-digits, seconds, 0.1, 1000)


def test_the_price_of_a_digit_is_the_factor_by_which_times_grow():
    rows = [measurement("DOP853", digits, 1e-3 * 1.33**digits) for digits in (3, 5, 8, 12)]
    (price,) = prices(rows)
    assert price.factor == pytest.approx(1.33, rel=1e-9)
    assert (round(price.first_digits), round(price.last_digits)) == (3, 12)


def test_runs_at_the_rounding_errors_do_not_spoil_the_price():
    rows = [measurement("DOP853", digits, 1e-3 * 1.33**digits) for digits in (3, 5, 8, 12)]
    stuck = measurement("DOP853", 11.5, 7.0)
    assert next(prices([*rows, stuck])).factor == pytest.approx(1.33, rel=1e-9)


def test_the_cheapest_method_is_the_fastest_of_those_that_are_accurate_enough():
    rows = [
        measurement("rough", 4, 1e-6),
        measurement("slow", 13, 1.0),
        measurement("fast", 10, 1e-3),
        measurement("at another time", 20, 1e-9, Group.SERIES),
    ]
    found = {advice.digits: advice.cheapest and advice.cheapest.method for advice in cheapest_methods(rows)}
    assert found == {3: "rough", 6: "fast", 9: "fast", 12: "slow", 15: None, 30: None}
    assert tuple(found) == ASKED_DIGITS
