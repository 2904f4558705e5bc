"""The truths of the register satisfy the equations of motion, integrated or differentiated anew with many digits."""

import json

import numpy as np
import pytest
from hard_truths import GRAVITY, HeavyBob, Paper, Sarrus, Springs, certified, period, revolution, swing, truths, turning
from mpmath import cos, exp, mp, mpf, odefun, pi, sin, sqrt

from holonom.benchmark.hard_cases.case import MOST, correct_digits, digits_of_error
from holonom.benchmark.hard_cases.register import REFERENCES
from holonom.benchmark.hard_cases.runs import problem
from holonom.simulation.matrices import MotionMatrices

STEP = mpf("1e-10")
AGREEMENT = mpf("1e-18")
FREQUENCY = sqrt(mpf("9.81"))


def numbers(values) -> list[float]:
    """The numbers of nested lists and mappings, in order."""
    if isinstance(values, int | float):
        return [values]
    return [number for value in (values.values() if isinstance(values, dict) else values) for number in numbers(value)]


def test_reference_values_are_those_of_the_truths():
    computed = json.loads(json.dumps(truths(), default=float))
    assert computed.keys() == REFERENCES.keys()
    for case, values in computed.items():
        assert numbers(REFERENCES[case]) == pytest.approx(numbers(values), rel=1e-14, abs=1e-15), case


@certified
def test_pendulum_in_elliptic_functions_is_the_pendulum_integrated():
    integrated = odefun(lambda t, y: [y[1], -(FREQUENCY**2) * sin(y[0])], 0, [pi / 3, 0], tol=AGREEMENT)
    for t in (mpf(1) / 4, mpf(1)):
        x, depth = swing(pi / 3, FREQUENCY, t)
        assert abs(x - sin(integrated(t)[0])) < AGREEMENT
        assert abs(depth - cos(integrated(t)[0])) < AGREEMENT


@certified
def test_period_brings_the_pendulum_back():
    x, depth = swing(pi / 3, FREQUENCY, period(pi / 3, FREQUENCY))
    assert abs(x - sin(pi / 3)) < AGREEMENT
    assert abs(depth - cos(pi / 3)) < AGREEMENT


@certified
def test_turning_angle_is_the_one_integrated():
    integrated = odefun(lambda t, y: [y[1], FREQUENCY**2 * sin(y[0])], 0, [0, 1], tol=AGREEMENT)
    x, y = turning(FREQUENCY, mpf(1))
    assert abs(x - sin(integrated(1)[0])) < AGREEMENT
    assert abs(y - cos(integrated(1)[0])) < AGREEMENT
    assert abs(turning(FREQUENCY, revolution(FREQUENCY))[0]) < AGREEMENT


def test_turning_angle_is_that_of_the_published_four_bar_linkage():
    """One revolution and the place at t = 10 of the IFToMM benchmark's linkage with N = 1."""
    with mp.workdps(30):
        frequency = sqrt(mpf("9.81") * 2 / (mpf(2) / 3 + 1))
        assert abs(revolution(frequency) - mpf("1.923711817338965851745947")) < mpf("1e-23")
        x, y = turning(frequency, mpf(10))
        assert abs(x - mpf("0.47838505776097055901")) < mpf("1e-19")
        assert abs(y - mpf("0.87815017879120930116")) < mpf("1e-19")


def derivatives(motion, t):
    """Values, first and second derivatives of a list of functions, by central differences."""
    before, now, after = motion(t - STEP), motion(t), motion(t + STEP)
    first = [(b - a) / (2 * STEP) for a, b in zip(before, after, strict=True)]
    second = [(a - 2 * x + b) / STEP**2 for a, x, b in zip(before, now, after, strict=True)]
    return now, first, second


@certified
@pytest.mark.parametrize("t", [0, 1, 4])
def test_paper_motion_is_free(t):
    (q1, q2, q3), (v1, v2, v3), (a1, a2, a3) = derivatives(Paper.coordinates, mpf(t))
    assert abs(a1 + q1 + q2) < AGREEMENT
    assert abs(a2 + 2 * (v1 + v2)) < AGREEMENT
    assert abs(a3) < AGREEMENT
    assert abs(q3 - Paper.U0 * exp(t) * (q1 + q2)) < AGREEMENT
    assert all(abs(v - w) < AGREEMENT for v, w in zip((v1, v2, v3), Paper.velocities(mpf(t)), strict=True))
    assert all(abs(a - F) < AGREEMENT for a, F in zip((a1, a2), Paper.forces(mpf(t)), strict=True))


@certified
def test_stiff_spring_obeys_its_equations_of_motion():
    (x1, x2, x3), _, (a1, a2, a3) = derivatives(Springs.coordinates, mpf(1) / 7)
    pull = Springs.STIFF * (x3 - x2 - Springs.REST)
    assert abs(a1 + a2 + Springs.SOFT * x1 - pull) < mpf("1e-9") * abs(pull)
    assert abs(a3 + pull) < mpf("1e-9") * abs(pull)
    assert abs(pull) > 1


def test_sarrus_linkage_is_its_reduced_equation_integrated():
    with mp.workdps(25):
        g = GRAVITY

        def rates(t, y):
            c, s = cos(y[0]), sin(y[0])
            return [y[1], (6 * c * s * y[1] ** 2 - 4 * g * c) / (1 + 6 * c**2)]

        integrated = odefun(rates, 0, [Sarrus.START, 0], tol=AGREEMENT)
        assert abs(Sarrus.fallen(Sarrus.UNTIL) - integrated(Sarrus.UNTIL)[0]) < AGREEMENT


def test_sarrus_linkage_keeps_the_constraints_of_its_scene_with_forces_along_their_gradients():
    phi = mpf(7) / 10
    motion = problem(Sarrus.FILE)
    places = np.array(Sarrus.coordinates(phi), dtype=float)
    at = MotionMatrices(motion)(0.0, np.concatenate([places, np.zeros_like(places)]))
    forces = np.array(Sarrus.constraint_forces(phi), dtype=float)
    unmet = forces - at.jacobian.T @ np.linalg.pinv(at.jacobian.T, 1e-8) @ forces
    assert np.max(np.abs(at.residual)) < 1e-14
    assert np.max(np.abs(unmet)) < 1e-12 * np.max(np.abs(forces))


def test_heavy_bob_keeps_its_rods():
    """The certified accelerations satisfy the constraints, differentiated twice by hand."""
    state = HeavyBob.hanging(-0.6, 1e-3)
    a1x, a1y, a2x, a2y = HeavyBob.accelerations(state)
    x1, y1, x2, y2, vx1, vy1, vx2, vy2 = map(mpf, state)
    assert abs(x1 * a1x + y1 * a1y + vx1**2 + vy1**2) < mpf("1e-12") * abs(a1x)
    along = (x2 - x1) * (a2x - a1x) + (y2 - y1) * (a2y - a1y) + (vx2 - vx1) ** 2 + (vy2 - vy1) ** 2
    assert abs(along) < mpf("1e-12") * abs(a1x)


@pytest.mark.parametrize("digits", [1, 7, 15])
def test_digits_are_counted_against_the_scale(digits):
    truth = [4.0, -8.0]
    assert correct_digits([4.0, -8.0 * (1 + 10.0**-digits)], truth) == pytest.approx(digits, abs=0.1)
    assert digits_of_error(3 * 10.0**-digits, 3) == pytest.approx(digits)


@pytest.mark.parametrize(("computed", "digits"), [([1.0], MOST), ([np.nan], 0), ([np.inf], 0), ([3.0], 0)])
def test_digits_end_at_those_of_a_double_and_at_none(computed, digits):
    assert correct_digits(computed, [1.0]) == digits
