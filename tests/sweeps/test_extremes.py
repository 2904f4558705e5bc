"""Largest values and zeros of polynomials, step by step, against NumPy's roots and fine samples."""

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from holonom.sweeps.extremes import Steps, first_zero, largest, largest_size

ELEMENTS = 40


@pytest.fixture(scope="module", params=[0.0, -1.0])
def steps(request) -> Steps:
    """One function along four steps, its polynomials falling off as those of a Taylor step do."""
    random = np.random.default_rng(5)
    taylor = random.normal(size=(12, ELEMENTS)) * 0.6 ** np.arange(12)[:, None]
    whole = [Polynomial(column, domain=[0, 4], window=[-1, 1]) for column in taylor.T]
    coefficients = np.zeros((12, 4, ELEMENTS))
    for element, function in enumerate(whole):
        for step in range(4):
            inner = Polynomial([step, 1.0]) if request.param == 0 else Polynomial([step + 0.5, 0.5])
            coefficients[:, step, element] = function.convert(domain=[-1, 1])(inner).coef
    length = np.full((4, ELEMENTS), 1.0 if request.param == 0 else 0.5)
    middle = np.arange(4)[:, None] + (0.0 if request.param == 0 else 0.5) + np.zeros((4, ELEMENTS))
    return Steps(coefficients, middle, length, request.param)


def dense(steps: Steps) -> tuple[np.ndarray, np.ndarray]:
    x = np.linspace(steps.least, 1, 20001)
    values = [sum(c * x[:, None] ** k for k, c in enumerate(step)) for step in steps.coefficients.swapaxes(0, 1)]
    times = [m + x[:, None] * h for m, h in zip(steps.middle, steps.length, strict=True)]
    return np.concatenate(times), np.concatenate(values)


def test_the_largest_value_is_that_of_fine_samples(steps):
    _, values = dense(steps)
    assert largest(steps) == pytest.approx(values.max(axis=0), rel=1e-6)
    assert (largest(steps) >= values.max(axis=0) - 1e-12).all()
    assert -largest(steps.negative()) == pytest.approx(values.min(axis=0), rel=1e-6)
    assert largest_size(steps) == pytest.approx(np.maximum(largest(steps), largest(steps.negative())), rel=1e-14)


def test_the_first_zero_is_where_fine_samples_first_change_their_sign(steps):
    times, values = dense(steps)
    found, crossed = first_zero(steps), np.diff(np.sign(values), axis=0) != 0
    assert (np.isnan(found) == ~crossed.any(axis=0)).all()
    assert 5 < np.isnan(found).sum() < ELEMENTS - 5
    for element in np.flatnonzero(~np.isnan(found)):
        place = crossed[:, element].argmax()
        assert times[place, element] - 1e-9 <= found[element] <= times[place + 1, element] + 1e-9


def test_a_zero_at_the_start_is_no_crossing_and_one_between_two_steps_is():
    ramp = np.array([[[0.0], [1.0]], [[1.0], [-1.0]], [[0.0], [-1.0]]])  # 0..1, 1..0, 0..-1
    steps = Steps(ramp.swapaxes(0, 1), np.array([[0.0], [1.0], [2.0]]), np.ones((3, 1)), 0.0)
    assert first_zero(steps) == pytest.approx([2.0])


def test_what_comes_out_for_an_element_does_not_depend_on_the_others(steps):
    for function in (largest, largest_size, first_zero):
        whole = function(steps)
        for elements in (slice(3, 4), slice(10, 27)):
            parts = (each[..., elements] for each in (steps.coefficients, steps.middle, steps.length))
            assert np.array_equal(function(Steps(*parts, steps.least)), whole[elements], equal_nan=True)


@pytest.mark.parametrize("least", [0.0, -1.0])
@pytest.mark.parametrize("apart", [1e-1, 1e-3, 1e-5])
def test_two_zeros_between_two_samples_are_crossings_however_close(least, apart):
    """Truth: (x - a)^2 - (apart/2)^2, by its roots, beside one that only touches zero and one that stays above."""
    places = least + (1 - least) * (np.arange(40) + 0.37) / 40
    squares = np.array([places**2, -2 * places, np.ones(40)])[:, None, :]
    first = np.where(places - apart / 2 < least, places + apart / 2, places - apart / 2)
    for gap, truth in ((-((apart / 2) ** 2), first), (0.0, np.full(40, np.nan)), (1e-9, np.full(40, np.nan))):
        steps = Steps(squares + np.array([gap, 0, 0])[:, None, None], np.zeros((1, 40)), np.ones((1, 40)), least)
        found = first_zero(steps)
        decided = ~np.isinf(found)  # the next is 1e-13/apart off by rounding
        assert decided.all() == (gap >= 0 or apart == 1e-1)
        assert found[decided] == pytest.approx(truth[decided], abs=1e-9, nan_ok=True)


def test_the_zero_of_a_cube_was_off_by_5e_5_of_a_step():
    cube = np.array([-1.0, 3.0, -3.0, 1.0]) * 0.3 ** np.arange(3, -1, -1)  # (x - 3/10)^3
    both = np.array([cube, [-0.3, 1.0, 0.0, 0.0]]).T[:, None, :]
    found = first_zero(Steps(both, np.zeros((1, 2)), np.ones((1, 2)), -1.0))
    assert np.isinf(found[0])
    assert found[1] == pytest.approx(0.3, rel=1e-14)


def test_a_zero_after_the_quantity_was_large_was_none():
    """A ramp, then a zero in numbers of 1e-14 of it, whose rounding they may be."""
    ramp = np.array([[[0.5], [1.0]], [[-0.5e-14], [1e-14]]])
    both = Steps(ramp.swapaxes(0, 1), np.array([[0.0], [1.0]]), np.ones((2, 1)), 0.0)
    assert np.isinf(first_zero(both))
    assert both.resolved_until(np.array([0.5])) == [False]


def test_the_larger_of_two_peaks_was_not_that_of_the_largest_sample():
    """Truth: the roots of the slope. The peaks differ by less than what samples miss of them."""
    samples = np.linspace(-1, 1, 17)
    hills = -(Polynomial.fromroots([-0.5, 0.5625]) ** 2) + 1e-4 * Polynomial([0.0, 1.0])
    peaks = hills.deriv().roots().real
    highest = peaks[np.argmax(hills(peaks))]
    assert abs(samples[np.argmax(hills(samples))] - highest) > 1
    steps = Steps(hills.coef[:, None, None], np.zeros((1, 1)), np.ones((1, 1)), -1.0)
    assert largest(steps) == pytest.approx(hills(highest), rel=1e-12)


def test_rounding_at_the_start_is_no_sign():
    ball = np.array([[[1e-17, 0.0, -1e-17]], [[-100.0] * 3], [[1e4] * 3]])  # down, and up again after 1/100 of the step
    steps = Steps(ball, np.zeros((1, 3)), np.ones((1, 3)), 0.0)
    assert first_zero(steps) == pytest.approx([0.01] * 3, rel=1e-12)


def test_what_falls_off_and_is_finite_is_resolved_in_itself_or_beside_something_larger(steps):
    """Cubic polynomials, twelve coefficients as they are, and an infinite one among the first."""
    cubic, infinite = steps.coefficients.copy(), steps.coefficients.copy()
    cubic[4:] = 0
    infinite[4:], infinite[1, 2] = 0, np.inf
    three = Steps(
        np.concatenate([cubic, steps.coefficients, infinite], axis=2), steps.middle, steps.length, steps.least
    )
    for least, expected in ((0.0, (True, False, False)), (1e12, (True, True, False))):
        assert np.array_equal(three.resolved(least), np.repeat(expected, ELEMENTS))
