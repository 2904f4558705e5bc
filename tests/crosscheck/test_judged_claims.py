"""Claims at a state, found once more in twice the digits."""

import pytest
from mpmath import mp

from holonom.crosscheck.digits import WORKING_DIGITS
from holonom.crosscheck.irregular_point import IrregularPoint
from holonom.crosscheck.judged_claims import first_differences
from holonom.crosscheck.motion_states import Claim


def test_rounding_beside_a_value_that_is_missing_is_no_difference():
    """A program that divides by what cancels has a value in 70 digits, and none in 140."""

    def claims(attempt):
        if mp.dps > WORKING_DIGITS:
            raise IrregularPoint
        yield "program", Claim("a", mp.mpf(10) ** -72, mp.zero, mp.mpf(10) ** -72)

    assert first_differences(claims, 0) == ({}, False)


@pytest.mark.parametrize("missing", [False, True])
def test_difference_is_found_though_a_later_value_is_missing(missing):
    def claims(attempt):
        yield "program", Claim("a", mp.one, mp.zero, mp.one)
        if missing:
            raise IrregularPoint

    found, regular = first_differences(claims, 0)
    assert list(found) == ["program"]
    assert regular is not missing
