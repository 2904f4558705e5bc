"""Values at a state, found again in more digits."""

import pytest
from mpmath import mp

from holonom.crosscheck.compared_values import first_differences
from holonom.crosscheck.digits import WORKING_DIGITS
from holonom.crosscheck.irregular_point import IrregularPoint
from holonom.crosscheck.motion_states import ComparedValue


def test_rounding_beside_a_value_that_is_missing_is_no_difference():
    """A program that divides by what cancels has a value in 70 digits, and none in 140."""

    def compared():
        if mp.dps > WORKING_DIGITS:
            raise IrregularPoint
        yield "program", ComparedValue("a", mp.mpf(10) ** -72, mp.zero, mp.mpf(10) ** -72)

    assert first_differences(compared) == ({}, False)


@pytest.mark.parametrize("missing", [False, True])
def test_difference_is_found_though_a_later_value_is_missing(missing):
    def compared():
        yield "program", ComparedValue("a", mp.one, mp.zero, mp.one)
        if missing:
            raise IrregularPoint

    found, regular = first_differences(compared)
    assert list(found) == ["program"]
    assert regular is not missing


@pytest.mark.parametrize("lucky", [1, 2])
def test_a_zero_that_rounding_left_by_luck_was_a_difference(lucky):
    """Its terms cancel to nothing in one precision, but for what the state has lost, and to rounding in the others."""

    def compared():
        rounding = mp.mpf(10) ** (-242 if mp.dps == lucky * WORKING_DIGITS else -2 - mp.dps)
        yield "program", ComparedValue("a", rounding, mp.zero, rounding)

    assert first_differences(compared) == ({}, True)


@pytest.mark.parametrize(("both", "size", "differ"), [(1, 1, True), (1, 10**20, False), (10**20, 1, False)])
def test_a_difference_counts_relative_to_the_largest_of_values_and_size(both, size, differ):
    def compared():
        yield "program", ComparedValue("a", mp.mpf(both), both + mp.mpf(10) ** -40, mp.mpf(size))

    found, regular = first_differences(compared)
    assert (list(found), regular) == (["program"] if differ else [], True)
