"""Truth: differences of numbers that are written down."""

from holonom.benchmark.work_precision.measurement import numbers_of, relative_error


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
