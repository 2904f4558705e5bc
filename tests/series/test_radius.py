"""The end of a power series, told from its coefficients: the truth lies within the uncertainty, at every order."""

import math

import mpmath
import numpy as np
import pytest
from paper_series import paper_by_hand

from holonom.series.radius import COMPLEX_PAIR, REAL_TIME, Radius, estimate_radii, estimate_radius

ORDERS = (*range(8, 30), 32, 36, 40, 45, 50, 60, 80, 100, 120, 160)
HIGHEST = max(ORDERS)
DIGITS = 60
STARTS = [((1, "0.5"), (2, "-0.3333")), (("2.3333", -2), ("-0.2", "1.5"))]


def factorials_reciprocal(ratio=1):
    return [mpmath.mpf(ratio) ** n / mpmath.factorial(n) for n in range(HIGHEST + 1)]


def branch_point(z, exponent):
    """Coefficients of (1 - t/z)^exponent, with its complex conjugate where it is not real."""
    row = [mpmath.mpc(1)]
    for n in range(1, HIGHEST + 1):
        row.append(row[-1] * (n - 1 - exponent) / (n * mpmath.mpc(z)))
    return [c.real for c in row]


def product(a, b):
    return [mpmath.fsum(a[k] * b[n - k] for k in range(n + 1)) for n in range(len(a))]


def gaussian():
    return [0 if n % 2 else 1 / mpmath.factorial(n // 2) for n in range(HIGHEST + 1)]


def airy():
    row = [mpmath.airyai(0), mpmath.airyai(0, derivative=1), mpmath.mpf(0)]
    for n in range(1, HIGHEST - 1):
        row.append(row[n - 1] / ((n + 2) * (n + 1)))
    return row


def weierstrass():
    """ddot(x) = 6 x^2 from x = 1, dot(x) = 2: x = 1/(1 - t)^2."""
    row = [mpmath.mpf(1), mpmath.mpf(2)]
    for n in range(HIGHEST - 1):
        row.append(6 * mpmath.fsum(row[k] * row[n - k] for k in range(n + 1)) / ((n + 1) * (n + 2)))
    return row


def estimates(rows, orders=ORDERS):
    with mpmath.workdps(DIGITS):
        return {order: estimate_radius([row[: order + 1] for row in rows]) for order in orders}


def require_truth_inside(rows, true, orders=ORDERS):
    """No order shows too much: none that the motion is entire, none a radius that excludes the true one."""
    for order, radius in estimates(rows, orders).items():
        if radius.estimate is None:
            assert radius.note.startswith("unknown"), order
        else:
            assert abs(radius.estimate - true) <= radius.uncertainty, order


@pytest.mark.parametrize("start", STARTS, ids=["the paper's start", "another start"])
@pytest.mark.parametrize(
    "quarters", [pytest.param(i, marks=[] if i in (-8, -3, 0, 1, 6) else [pytest.mark.long]) for i in range(-8, 9)]
)
def test_radius_of_the_paper_is_inside_its_uncertainty_at_every_order(quarters, start):
    """Truth: the zeros of 1 + 2 (u0 + t)^2, a complex pair."""
    with mpmath.workdps(DIGITS):
        u0 = mpmath.mpf(quarters) / 4
        q1, q2 = ([mpmath.mpf(x) for x in pair] for pair in start)
        rows = paper_by_hand(HIGHEST, u0, q1, q2).values()
    require_truth_inside(rows, math.sqrt(float(u0) ** 2 + 0.5))


@pytest.mark.parametrize("exponent", [-2, -1, -0.5, 0.5, 1.5])
@pytest.mark.parametrize("z", [3, -0.01, 2j, 1 + 1j, -1 + 0.2j, 0.1 + 2j])
def test_radius_of_a_branch_point_is_inside_its_uncertainty_at_every_order(z, exponent):
    with mpmath.workdps(DIGITS):
        row = branch_point(z, exponent)
    require_truth_inside([row], abs(z))
    places = estimates([row], [40])[40].singularities
    assert min(abs(place - z) for place in places) < 1e-6 * abs(z)
    assert min(abs(place - z.conjugate()) for place in places) < 1e-6 * abs(z)


@pytest.mark.parametrize("z", [3, 1 + 1j, -1 + 0.2j])
def test_an_entire_factor_does_not_hide_a_singularity(z):
    with mpmath.workdps(DIGITS):
        row = product(factorials_reciprocal(), branch_point(z, -0.5))
    require_truth_inside([row], abs(z), ORDERS[::4])


def test_a_farther_singularity_does_not_hide_a_nearer_one():
    with mpmath.workdps(DIGITS):
        near, far = branch_point(1 + 1j, -1), branch_point(1.3 - 1.3j, -0.5)
    require_truth_inside([[a + b for a, b in zip(near, far, strict=True)]], math.sqrt(2))


@pytest.mark.parametrize(
    ("near", "exponent", "far", "pole"),
    [
        (0.267 + 0.964j, 0.5, 0.276 + 0.992j, -1),
        (0.955 + 0.296j, 0.5, 1.029 + 0.209j, -2),
        (-0.857 + 0.516j, 1.5, -0.994 + 0.47j, -1),
        (0.267 + 0.964j, 0.5, 0.373 + 0.96j, -2),
    ],
)
def test_a_stronger_singularity_just_behind_a_weaker_one_was_taken_for_it(near, exponent, far, pole):
    """Fits that agreed to 1e-4 showed the farther one."""
    with mpmath.workdps(DIGITS):
        row = [a + b for a, b in zip(branch_point(near, exponent), branch_point(far, pole), strict=True)]
    require_truth_inside([row], abs(near), (24, 30, 40, 60))


def test_radius_of_a_double_pole_of_a_nonlinear_motion():
    with mpmath.workdps(DIGITS):
        row = weierstrass()
    require_truth_inside([row], 1)
    assert estimates([row], [40])[40].estimate == pytest.approx(1, rel=1e-9)


@pytest.mark.parametrize("row", [factorials_reciprocal, lambda: factorials_reciprocal(5), gaussian, airy])
def test_an_entire_function_is_given_no_radius_at_any_order(row):
    with mpmath.workdps(DIGITS):
        coefficients = row()
    found = estimates([coefficients])
    assert all(radius.estimate is None for radius in found.values())
    assert all("entire" in radius.note for order, radius in found.items() if order >= 60)


@pytest.mark.parametrize(
    ("coefficient", "true"),
    [
        (lambda n: mpmath.mpf(3) ** -n, 3.0),
        (lambda n: mpmath.binomial(mpmath.mpf(1) / 2, n) / mpmath.mpf(2) ** n, 2.0),
        (lambda n: mpmath.mpf(0) if n % 2 else mpmath.mpf(5) ** -n, 5.0),
        (lambda n: mpmath.mpf(n % 2) / (n + 1) * mpmath.mpf(4) ** -n, 4.0),
    ],
    ids=["pole", "square root", "even", "odd logarithm"],
)
def test_radius_of_known_functions(coefficient, true):
    radius = estimate_radius([[coefficient(n) for n in range(41)]])
    assert abs(radius.estimate - true) <= radius.uncertainty <= 1e-2 * true


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ([mpmath.mpf(1)] * 5 + [mpmath.mpf(0)] * 20, "polynomial"),
        ([1 / mpmath.factorial(n) for n in range(30)], "entire"),
        ([mpmath.mpf(1)] * 5, "unknown"),
    ],
)
def test_where_there_is_no_radius_words_say_why(row, said):
    radius = estimate_radius([row])
    assert radius.estimate is None
    assert said in radius.note


@pytest.mark.parametrize(("angle", "note"), [(0.0, REAL_TIME), (1.0, COMPLEX_PAIR), (math.pi, REAL_TIME)])
def test_a_pair_of_singularities_is_told_from_one_at_a_real_time(angle, note):
    radius = estimate_radius([[mpmath.mpf(math.cos(angle * n)) * mpmath.mpf(1.5) ** -n for n in range(40)]])
    assert radius.note == note
    assert radius.estimate == pytest.approx(1.5, abs=radius.uncertainty + 1e-9)


def test_many_series_at_once_have_the_radii_of_each_to_the_last_bit():
    n = np.arange(41)
    kinds = [
        lambda z: z**-n,  # a pole
        lambda z: np.cos(n * z) * 1.5**-n,  # a complex pair
        lambda z: (n % 2) * z**-n,  # odd powers alone
        lambda z: np.array([z**k / math.factorial(k) for k in n]),  # entire
        lambda z: np.where(n < 5, z, 0.0),  # a polynomial
        lambda z: np.where(n % 7 == 5, z**-n, 0.0),  # gaps as wide as no recurrence knows
        lambda z: 1e-100 * z ** -(8 * n),
    ]
    motions = np.array([[kind(z), z**-n / (n + 1)] for kind in kinds for z in (0.7, 1.3, 2.1)])
    found = estimate_radii(np.moveaxis(motions, 0, 2))
    assert found == [estimate_radius([list(map(mpmath.mpf, row)) for row in motion]) for motion in motions]
    assert found[1].estimate == pytest.approx(1.3, rel=1e-9)
    alone = np.moveaxis(motions[:, :1], 0, 2)
    assert [radius.estimate is None for radius in estimate_radii(alone)[9:15]] == [True] * 6


@pytest.mark.parametrize(
    ("estimate", "uncertainty", "shown"),
    [
        (0.92313086, 0.29, "0.9"),
        (14.2, 9.0, "1e+01"),
        (0.959279812, 7e-8, "0.9592798"),
        (0.768114574787, 0.0, "0.76811457"),
    ],
)
def test_no_more_digits_are_shown_than_are_certain(estimate, uncertainty, shown):
    assert Radius(estimate, uncertainty, (), "").shown == shown
