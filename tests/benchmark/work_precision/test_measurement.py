"""Truth: differences of numbers that are written down."""

from itertools import count

import pytest

from holonom.benchmark.work_precision.measurement import numbers_of, relative_error
from holonom.program import timing
from holonom.program.timing import python_batch, shortest_times


def test_the_error_is_relative_to_the_largest_coordinate_and_the_largest_velocity():
    true = numbers_of(["3", "-4", "0", "100"])
    found = numbers_of(["3", "-4.002", "1", "100"])
    assert relative_error(found, true) == 1 / 100
    assert relative_error(numbers_of(["3.2", "-4", "0", "100"]), true) == 0.2 / 4


def test_where_the_truth_is_zero_the_error_is_absolute():
    assert relative_error(numbers_of(["1", "0.25"]), numbers_of(["1", "0"])) == 0.25


def test_digits_far_beyond_double_precision_count():
    digits = 120
    true, found = numbers_of(["1", "1"]), numbers_of([f"1.{'0' * (digits - 1)}1", "1"])
    assert abs(relative_error(found, true) / 10.0**-digits - 1) < 1e-12


def test_a_call_takes_its_share_of_a_batch_and_the_least_of_all_rounds():
    """Truth: by a clock that the call moves on, from 100 s on and by 2 s once in a hundred calls."""
    clock, calls = [100.0], count(1)

    def call(seconds):
        clock[0] += 2.0 if next(calls) % 100 == 0 else seconds

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(timing.time, "perf_counter", lambda: clock[0])
        assert python_batch(call, 0.25)(8) == 0.25
        assert python_batch(call, 0.25)(100) == (99 * 0.25 + 2) / 100
        assert shortest_times({seconds: python_batch(call, seconds) for seconds in (0.5, 0.125)}) == {
            0.5: 0.5,
            0.125: 0.125,
        }
