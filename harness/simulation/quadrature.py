"""Gauss quadrature in any precision, with inner points only or with both ends."""

from collections.abc import Callable, Iterable
from functools import cache
from typing import Any

import numpy as np
from numpy.polynomial.legendre import Legendre, leggauss

from ..program.precision import Precision
from .evaluation import Numbers

POINTS_PER_DIGIT = 10 / 17  # exact over a step to about the order of the Taylor engine
MORE_DIGITS = 14  # in which points and weights are found; a precision has up to 10 beyond its digits

Rule = tuple[Numbers, Numbers]  # points from -1 to 1, and weights
Texts = tuple[list[str], list[str]]  # their decimal digits
Function = Callable[[Any], Any]


def points_for(precision: Precision) -> int:
    """Return the number of inner points that integrate a step to the last digit.

    Parameters
    ----------
    precision : Precision

    Returns
    -------
    int
    """
    return round(POINTS_PER_DIGIT * precision.digits)


def gauss_legendre(n: int, precision: Precision) -> Rule:
    """Return the points and weights of Gauss-Legendre quadrature.

    Parameters
    ----------
    n : int
        Number of points. Polynomials up to degree 2 n - 1 are integrated exactly.
    precision : Precision
        Numbers of the result.

    Returns
    -------
    points, weights : ndarray, shape (n,)
    """
    return _as_numbers(_legendre_rule(n, precision.digits), precision)


def gauss_lobatto(n: int, precision: Precision) -> Rule:
    """Return the points and weights of Gauss-Lobatto quadrature.

    Parameters
    ----------
    n : int
        Number of points, both ends among them. Polynomials up to degree 2 n - 3 are integrated exactly.
    precision : Precision
        Numbers of the result.

    Returns
    -------
    points, weights : ndarray, shape (n,)
    """
    return _as_numbers(_lobatto_rule(n, precision.digits), precision)


def _as_numbers(texts: Texts, precision: Precision) -> Rule:
    points, weights = (np.array(list(map(precision.number, each))) for each in texts)
    return points, weights


@cache
def _legendre_rule(n: int, digits: int) -> Texts:
    """Return the points of Gauss-Legendre quadrature, and the weights.

    These are the roots of P_n, and 2/((1 - x^2) P_n'(x)^2) (Abramowitz & Stegun, 25.4.29).
    """

    def correction(x: Any) -> Any:
        before, value = _legendre(n, x)
        return value * (1 - x**2) / (n * (before - x * value))

    def weight(x: Any) -> Any:
        return 2 * (1 - x**2) / (n * _legendre(n, x)[0]) ** 2

    return _rule(leggauss(n)[0], correction, weight, digits)


@cache
def _lobatto_rule(n: int, digits: int) -> Texts:
    """Return the points of Gauss-Lobatto quadrature, and the weights.

    These are the roots of (1 - x^2) P_(n-1)', and 2/(n (n-1) P_(n-1)(x)^2) (Abramowitz & Stegun, 25.4.32).
    """

    def correction(x: Any) -> Any:
        before, value = _legendre(n - 1, x)
        return (x * value - before) / (n * value)

    def weight(x: Any) -> Any:
        return 2 / (n * (n - 1) * _legendre(n - 1, x)[1] ** 2)

    inner = Legendre.basis(n - 1).deriv().roots()
    return _rule([-1.0, *inner, 1.0], correction, weight, digits)


def _legendre(n: int, x: Any) -> tuple[Any, Any]:
    """Return P_(n-1) and P_n at a place."""
    before, value = x**0, x
    for k in range(2, n + 1):
        before, value = value, ((2 * k - 1) * x * value - (k - 1) * before) / k
    return before, value


def _rule(guesses: Iterable[float], correction: Function, weight: Function, digits: int) -> Texts:
    """Return the roots near to guesses by Newton's method, and their weights."""
    import mpmath

    points, weights = [], []
    with mpmath.workdps(digits + MORE_DIGITS):
        for x in map(mpmath.mpf, guesses):
            moved = mpmath.inf
            while abs(moved) > mpmath.mpf(10) ** (-(digits + MORE_DIGITS) // 2):  # the next is their square
                moved = correction(x)
                x -= moved
            points.append(mpmath.nstr(x, digits + MORE_DIGITS))
            weights.append(mpmath.nstr(weight(x), digits + MORE_DIGITS))
    return points, weights
