"""Gauss quadrature is exact for polynomials up to its degree, in each precision, and not beyond."""

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss

from holonom.program.precision import read_precision
from holonom.simulation.quadrature import gauss_legendre, gauss_lobatto, points_for

PRECISIONS = ("double", "extended", "quadruple", "50")


@pytest.mark.parametrize("name", PRECISIONS)
@pytest.mark.parametrize(
    ("rule", "degree"), [(gauss_legendre, lambda n: 2 * n - 1), (gauss_lobatto, lambda n: 2 * n - 3)]
)
def test_powers_are_integrated_to_the_degree_of_a_rule(rule, degree, name):
    precision = read_precision(name)
    n, two = points_for(precision), precision.number("2")
    points, weights = rule(n, precision)
    errors = [float(abs((weights * points**k).sum() - two / (k + 1) * (k % 2 == 0))) for k in range(degree(n) + 2)]
    assert max(errors[:-1]) <= 8 * float(precision.rounding)
    assert errors[-1] > 1e3 * float(precision.rounding)
    assert (float(points[0]) == -1) == (rule is gauss_lobatto)


@pytest.mark.parametrize("n", [2, 3, 10, 17])
def test_double_precision_agrees_with_numpy(n):
    points, weights = gauss_legendre(n, read_precision("double"))
    assert np.allclose([points, weights], leggauss(n), rtol=1e-15, atol=1e-15)


def test_simpson_is_lobatto_with_three_points():
    points, weights = gauss_lobatto(3, read_precision("double"))
    assert np.allclose([points, weights], [[-1, 0, 1], [1 / 3, 4 / 3, 1 / 3]], rtol=0, atol=1e-15)
