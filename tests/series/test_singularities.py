"""Radii of convergence that the equations of motion decide: closed forms of motions with weak singularities."""

import dataclasses
import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

import holonom
from holonom.program.motion_program import Operation
from holonom.series.radius import POLYNOMIAL
from holonom.series.singularities import COMPLEX, MPMATH, _leaves_open, _multiple_zero

ONE = """
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [{force}])$
motion : holonomic_scene(system, initial_state = [x = {x}, dot(x) = {v}])$
"""
TWO = """
system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2, forces = [{x}, {y}])$
motion : holonomic_scene(system, initial_state = [x = 0, dot(x) = 0, y = 0, dot(y) = 1])$
"""
LOCATED = {  # force on a free particle, and the nearest singularity of its motion
    "1/(1 - t) + 1/10^6/(1 - 10*t/9)": 0.9,
    "1/(1 - t) - 1/(1 - 100*t/99)": 0.99,
    "t^40/(1 - t)": 1,
    "exp(t) + 1/10^20/(1 - t)": 1,
    "exp(t) + sqrt(3 - t)/10^12": 3,
    "1/(1 + t^2) + 1/10^9/(1 - 10*t/9)": 0.9,
    "(1 - t)^(1/3)": 1,
    "1/10^8*log(2 + t) + 1/(3 - t)": 2,
    "1/10^9*tan(t) + 1/(2 - t)": math.pi / 2,
    "1/10^9*atan(t) + 1/(2 - t)": 1,
    "1/10^9*asin(t/2) + 1/(3 - t)": 2,
    "1/10^9/(exp(t) - 2) + 1/(1 - t)": math.log(2),
}


def radius(text, order=40, **options):
    return holonom.system(text).series(order=order, **options).radius


@pytest.mark.parametrize("order", [14, 40])
@pytest.mark.parametrize("force", LOCATED)
def test_weak_singularity_of_a_force_sets_the_radius(force, order):
    found = radius(ONE.format(force=force, x=0, v=0), order)
    if found.estimate is None:
        assert order < 40  # few coefficients do not tell whether the motion ends before
    else:
        assert found.located
        assert found.estimate == pytest.approx(LOCATED[force], rel=1e-6)


@pytest.mark.parametrize("precision", ["double", "quadruple"])
def test_weak_singularity_sets_the_radius_of_a_series_by_heyoka(precision):
    found = radius(ONE.format(force="1/(1 - t) + 1/10^6/(1 - 10*t/9)", x=0, v=0), precision=precision)
    assert found.estimate == pytest.approx(0.9, rel=1e-6)


def test_weak_singularity_of_the_state_sets_the_radius():
    """y = t reaches 9/10 before x'' meets t = 1."""
    found = radius(TWO.format(x="1/(1 - t) + 1/10^6/(1 - 10*y/9)", y=0))
    assert found.located
    assert found.estimate == pytest.approx(0.9, rel=1e-6)


def test_weak_singularity_before_a_pole_of_the_motion_sets_the_radius():
    """x = 1/(1 - t)^2 but for a force of 10^-8."""
    found = radius(ONE.format(force="6*x^2 + 1/10^8/(1 - 10*t/9)", x=1, v=2))
    assert found.estimate == pytest.approx(0.9, rel=1e-6)


def test_removable_zero_of_a_divisor_is_no_singularity():
    """y = sin(t): x'' = 0."""
    found = radius(TWO.format(x="(y - sin(t))/(t - 1/2)", y="-y"))
    assert found.estimate is None
    assert not found.located


APPARENT = """
system : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = {a}*dot(x)^2/2 + {b}*dot(y)^2/2,
  potential_energy = {g}*y + {k}*x^2/2, constraints = [y - u*x])$
motion : holonomic_scene(system, control_law = [u = {law}], initial_state = [x = {x}, dot(x) = {v}])$
"""


@pytest.mark.parametrize(
    ("values", "law", "order", "true"),  # true: the zeros of a + b u^2
    [
        ("9/16 21/8 -1/16 1/8 13/16 13/16", "-3/4 + 13/8/(17/16 + t)", 30, 1.0928311),
        ("9/4 29/16 3/8 7/8 11/16 1/2", "3/4/(t - 2)", 45, 2.1102429),
    ],
)
def test_pole_of_a_law_at_which_the_motion_is_regular_was_its_singularity(values, law, order, true):
    """In y the equation of motion is regular where u is infinite, before the radius."""
    found = radius(APPARENT.format(law=law, **dict(zip("abgkxv", values.split(), strict=True))), order=order)
    assert found.estimate == pytest.approx(true, rel=1e-7)


def test_pole_of_the_motion_alone_is_estimated_and_marked():
    found = radius(ONE.format(force="6*x^2", x=1, v=2))
    assert not found.located
    assert found.coefficients == 41
    assert 0 < found.unseen < 1
    assert found.estimate == pytest.approx(1, abs=found.uncertainty)


@pytest.mark.parametrize(("force", "proved"), [("1", True), ("(1 - t^2)/(1 - t)", True), ("x", False), ("t^60", False)])
def test_polynomial_is_found_if_the_equations_are_satisfied_by_it(force, proved):
    """x'' = x from rest at zero stays there, from x = 1 it is cosh(t); of t^60 the coefficients to order 40 vanish."""
    motion = holonom.system(ONE.format(force=force, x=int(force == "x"), v=0)).series(order=40)
    assert motion.polynomial == proved
    assert motion.radius.estimate is None


def test_polynomial_motion_with_reactions_is_proved():
    """A bead on a moving plane: z = t^2, and its multiplier is constant."""
    motion = holonom.system("""
system : holonomic_system(coordinates = [x, z], controls = [u], kinetic_energy = (dot(x)^2 + dot(z)^2)/2,
  potential_energy = 10*z, constraints = [z - u])$
lift : holonomic_scene(system, control_law = [u = t^2], initial_state = [x = 0, dot(x) = 1])$""").series(order=20)
    assert motion.polynomial


def test_few_coefficients_and_a_located_singularity_give_an_upper_bound_alone():
    """x = 1/(1 - t)^2 nearly: t = 5 is beyond its pole."""
    found = radius(ONE.format(force="6*x^2 + 1/(5 - t)/1000", x=1, v=2), order=8)
    assert found.estimate is None


CURVE = """
system : holonomic_system(coordinates = [x, y], kinetic_energy = dot(x)^2/2 + dot(x)*dot(y)/2 + dot(y)^2,
  forces = [0, -2*sqrt(y + 2) + 1/(3 - t)], constraints = [y - exp(x)])$
slide : holonomic_scene(system, initial_state = [x = 2, y = exp(2), dot(x) = -1/2, dot(y) = -exp(2)/2])$
"""


HIDDEN = """
system : holonomic_system(coordinates = [x, y], kinetic_energy = (t + 2)*dot(x)^2/2 + dot(y)^2/2,
  forces = [1/(2*(x^2 + 1)) - t, -2/(3 - t)])$
motion : holonomic_scene(system, initial_state = [x = 1/2, y = 1/3, dot(x) = -1/2, dot(y) = 0])$
"""


def position_at(end, start, acceleration):
    """x at a complex time, by an integration along the ray to it."""

    def rates(s, state):
        return end * np.array([state[1], acceleration(s * end, *state)])

    return solve_ivp(rates, (0, 1), np.array(start, complex), method="DOP853", rtol=1e-11, atol=1e-11).y[0, -1]


def on_curve(t, x, v):
    e = np.exp(x)
    return ((1 / (3 - t) - 2 * np.sqrt(e + 2)) * e - (e + 4 * e**2) / 2 * v**2) / (1 + e + 2 * e**2)


def with_growing_mass(t, x, v):
    return (1 / (2 * (x**2 + 1)) - t - v) / (t + 2)


@pytest.mark.parametrize("order", [18, 20, 40])
def test_a_root_test_that_a_singularity_of_the_equations_agrees_with_was_taken_for_it(order):
    """The motion ends at t = 1.4713 + 0.2232 i, where the mass along the curve vanishes, before the pole at t = 3."""
    end = 1.4713087 + 0.2232381j
    e = np.exp(position_at(0.9999 * end, (2, -1 / 2), on_curve))
    assert abs(1 + e + 2 * e**2) < 0.03  # as the power 2/3 of what is left: 118 at the start
    found = radius(CURVE, order=order)
    assert found.estimate is None or abs(found.estimate - abs(end)) <= found.uncertainty


@pytest.mark.parametrize("order", [20, 40, 50, 60])
def test_the_radius_of_one_coordinate_was_that_of_another_whose_series_decides_nothing(order):
    """x^2 = -1 at a distance of 1.695, before the zero of the mass at t = -2; y ends at t = 3."""
    end = -0.94430 + 1.40808j
    assert abs(1 + position_at(0.9999 * end, (1 / 2, -1 / 2), with_growing_mass) ** 2) < 0.03
    found = radius(HIDDEN, order=order)
    assert found.estimate is None or abs(found.estimate - abs(end)) <= found.uncertainty + 1e-4


@pytest.mark.parametrize(
    ("force", "distance"), [("1/(1 + t^2)^3", 1), ("1/expand((1 + t^2)^3)", 1), ("1/expand((7/3 - t)^4)", 7 / 3)]
)
def test_a_multiple_zero_of_a_divisor_was_off_by_a_thousand_times_its_error(force, distance):
    found = radius(ONE.format(force=force, x=1, v=0))
    assert found.located
    assert found.uncertainty < 1e-6
    assert found.estimate == pytest.approx(distance, abs=found.uncertainty)
    assert {round(abs(place), 9) for place in found.singularities} == {round(distance, 9)}
    assert len(found.singularities) == 1 + ("t^2" in force)


def test_a_function_without_slope_has_no_multiple_zero():
    """Newton's method cannot begin at a place where the derivatives vanish."""
    assert _multiple_zero(lambda z: (mpmath.mpf(1),), 1j) is None
    assert _multiple_zero(lambda z: (z * z - 4,), 2) == 2


BY_MPMATH = {
    Operation.ADD: (3, lambda *terms: mpmath.fsum(terms)),
    Operation.MULTIPLY: (3, lambda *factors: mpmath.fprod(factors)),
    Operation.SUBTRACT: (2, lambda a, b: a - b),
    Operation.DIVIDE: (2, lambda a, b: a / b),
    Operation.NEGATE: (1, lambda a: -a),
    Operation.POWER: (2, mpmath.power),
    Operation.SIGN: (1, lambda a: 1),
    Operation.EXP: (1, mpmath.exp),
    Operation.LN: (1, mpmath.log),
    Operation.SQRT: (1, mpmath.sqrt),
    Operation.TANH: (1, mpmath.tanh),
    Operation.ERF: (1, mpmath.erf),
    Operation.ARCTAN2: (2, lambda y, x: mpmath.atan(y / x)),
}


@pytest.mark.parametrize("operation", BY_MPMATH)
@pytest.mark.parametrize("z", [(0.3, 1.5, 0.25), (0.5 - 0.25j, 1.25 + 0.5j, 1j)])
def test_operations_go_on_into_the_complex_plane(operation, z):
    count, function = BY_MPMATH[operation]
    for arithmetic, number in ((COMPLEX, complex), (MPMATH, mpmath.mpmathify)):
        found = arithmetic.operations[operation](*map(number, z[:count]))
        assert abs(complex(found) - complex(function(*z[:count]))) < 1e-13


@pytest.mark.parametrize("exponent", [Fraction(3), Fraction(-2), Fraction(1, 3), Fraction(-5, 2)])
def test_powers_go_on_into_the_complex_plane(exponent):
    z = 0.5 - 0.25j
    for arithmetic, number in ((COMPLEX, complex), (MPMATH, mpmath.mpmathify)):
        assert complex(arithmetic.power(number(z), exponent)) == pytest.approx(z ** float(exponent), rel=1e-14)
        assert complex(arithmetic.number(exponent)) == pytest.approx(float(exponent), rel=1e-15)


def test_the_error_of_a_logarithmic_singularity_follows_from_a_shorter_series():
    """x'' = -x^2 - x + 1 - 4/(x + 2) reaches x = -2 at -T, T by the energy. Zeros of the series converge slowly."""

    def work(x):
        return -(x**3) / 3 - x**2 / 2 + x - 4 * np.log(x + 2)

    exact, _ = quad(lambda x: 1 / np.sqrt(1 + 2 * (work(x) - work(2))), -2, 2)
    found = radius(ONE.format(force="-x^2 - x + 1 - 4/(x + 2)", x=2, v=1), order=60)
    assert found.estimate == pytest.approx(exact, abs=found.uncertainty)
    assert 0 < found.uncertainty < 0.01 * exact


@pytest.mark.parametrize(("distance", "is_open"), [(0.5, False), (0.59, False), (0.61, True), (2.0, True)])
def test_a_coarse_estimate_leaves_singularities_open_beyond_its_least_radius(distance, is_open):
    coarse = dataclasses.replace(POLYNOMIAL, estimate=1.0, uncertainty=0.4)
    assert _leaves_open(coarse, distance) is is_open
    assert not _leaves_open(dataclasses.replace(coarse, uncertainty=0.1), distance)


def test_a_quotient_by_zero_has_no_value():
    assert mpmath.isnan(MPMATH.operations[Operation.DIVIDE](mpmath.mpf(1), mpmath.mpf(0)))


@pytest.mark.long
@pytest.mark.parametrize(("law", "order"), [("1 + t^2", 6), ("exp(t/2)", 20), ("cos(t)", 20)])
def test_a_divisor_that_is_one_by_an_identity_has_no_zero(law, order):
    """Far from the real axis sin^2 + cos^2 cancels to zero: a division by it ended in an internal error."""
    scene = holonom.system(f"""
      system : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
        constraints = [y*cos(u) - x*sin(u)])$
      turned : holonomic_scene(system, control_law = [u = {law}], initial_state = [x = 1/2, dot(x) = 1/3])$""")
    radius = scene.series(order=order).radius
    assert radius.estimate is None or radius.estimate > 1
