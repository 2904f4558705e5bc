"""Arithmetic of Taylor polynomials in the time, with the numbers of mpmath.

A polynomial is a tuple of coefficients; those that it leaves out are zero. A function of one is composed of the
function's own Taylor coefficients (Griewank & Walther, Evaluating Derivatives, chapter 13).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import zip_longest

from mpmath import mp

from .irregular_point import IrregularPoint

Polynomial = tuple[mp.mpf, ...]
Coefficients = Callable[[mp.mpf, int], Sequence[mp.mpf]]  # of a function at a number, up to an order


class Taylor:
    """Polynomials up to an order."""

    def __init__(self, order: int) -> None:
        self.order = order

    def constant(self, number: mp.mpf | int) -> Polynomial:
        """Return a number as a polynomial.

        Parameters
        ----------
        number : mpf or int
            The number.

        Returns
        -------
        Polynomial
        """
        return (mp.mpf(number),)

    def add(self, *terms: Polynomial) -> Polynomial:
        """Add polynomials.

        Parameters
        ----------
        *terms : Polynomial
            Polynomials to add.

        Returns
        -------
        Polynomial
        """
        return tuple(mp.fsum(column) for column in zip_longest(*terms, fillvalue=mp.zero))

    def scale(self, factor: mp.mpf | int, x: Polynomial) -> Polynomial:
        """Multiply a polynomial by a number.

        Parameters
        ----------
        factor : mpf or int
            The number.
        x : Polynomial

        Returns
        -------
        Polynomial
        """
        return tuple(factor * c for c in x)

    def multiply(self, x: Polynomial, y: Polynomial) -> Polynomial:
        """Multiply two polynomials.

        Parameters
        ----------
        x, y : Polynomial
            Factors.

        Returns
        -------
        Polynomial
            Product up to the order.
        """
        if len(x) == 1 or len(y) == 1:
            (factor,), other = (x, y) if len(x) == 1 else (y, x)
            return self.scale(factor, other)
        size = min(len(x) + len(y) - 2, self.order) + 1
        return tuple(
            mp.fsum(x[j] * y[k - j] for j in range(max(0, k - len(y) + 1), min(k + 1, len(x)))) for k in range(size)
        )

    def divide(self, x: Polynomial, y: Polynomial) -> Polynomial:
        """Divide by a polynomial that is not zero at the start.

        Parameters
        ----------
        x, y : Polynomial
            Dividend and divisor.

        Returns
        -------
        Polynomial
            Quotient up to the order.

        Raises
        ------
        IrregularPoint
            The divisor is zero at the start.
        """
        if not y[0]:
            raise IrregularPoint
        if len(y) == 1:
            return self.scale(1 / y[0], x)
        found: list[mp.mpf] = []
        for k in range(self.order + 1):
            left = x[k] if k < len(x) else mp.zero
            found.append((left - mp.fsum(y[j] * found[k - j] for j in range(1, min(k + 1, len(y))))) / y[0])
        return tuple(found)

    def power(self, x: Polynomial, exponent: mp.mpf) -> Polynomial:
        """Raise a polynomial to a constant power.

        Parameters
        ----------
        x : Polynomial
            The base.
        exponent : mpf
            The power.

        Returns
        -------
        Polynomial
            Power up to the order.

        Raises
        ------
        IrregularPoint
            The power is not analytic at the start.
        """
        if exponent == int(exponent) and 0 <= exponent <= self.order + 2:
            found = (mp.one,)
            for _ in range(int(exponent)):
                found = self.multiply(found, x)
            return found
        whole = exponent == int(exponent)
        if not x[0] or (x[0] < 0 and not whole):
            raise IrregularPoint
        first = x[0] ** int(exponent) if whole else mp.power(x[0], exponent)
        if len(x) == 1:
            return (first,)
        found = [first]  # x y' = exponent x' y
        for k in range(1, self.order + 1):
            terms = ((exponent * j - (k - j)) * x[j] * found[k - j] for j in range(1, min(k + 1, len(x))))
            found.append(mp.fsum(terms) / (k * x[0]))
        return tuple(found)

    def compose(self, coefficients: Coefficients, x: Polynomial) -> Polynomial:
        """Return a function of a polynomial from the function's Taylor coefficients.

        Parameters
        ----------
        coefficients : Coefficients
            Taylor coefficients of the function, at a number and up to an order.
        x : Polynomial
            Argument of the function.

        Returns
        -------
        Polynomial
            Composition up to the order.
        """
        own = coefficients(x[0], 0 if len(x) == 1 else self.order)
        found, beyond = (own[-1],), (mp.zero, *x[1:])
        for c in reversed(own[:-1]):
            found = self.add(self.multiply(found, beyond), (c,))
        return found

    def rate(self, x: Polynomial) -> Polynomial:
        """Differentiate a polynomial by the time.

        Parameters
        ----------
        x : Polynomial

        Returns
        -------
        Polynomial
        """
        return tuple(k * c for k, c in enumerate(x))[1:] or (mp.zero,)

    def integral(self, x: Polynomial, first: mp.mpf) -> Polynomial:
        """Integrate a polynomial over the time, from a first value.

        Parameters
        ----------
        x : Polynomial
        first : mpf
            Value at the start.

        Returns
        -------
        Polynomial
            Integral up to the order.
        """
        return (first, *(c / (k + 1) for k, c in enumerate(x)))[: self.order + 1]


# ---- Taylor coefficients of functions ----


def exponential(x: mp.mpf, order: int) -> list[mp.mpf]:
    """Return Taylor coefficients of the exponential.

    Parameters
    ----------
    x : mpf
        Number to expand about.
    order : int
        Highest order.

    Returns
    -------
    list of mpf, shape (order + 1,)
    """
    return [mp.exp(x) / mp.factorial(k) for k in range(order + 1)]


def logarithm(x: mp.mpf, order: int) -> list[mp.mpf]:
    """Return Taylor coefficients of the logarithm.

    Parameters
    ----------
    x : mpf
        Number to expand about.
    order : int
        Highest order.

    Returns
    -------
    list of mpf, shape (order + 1,)

    Raises
    ------
    IrregularPoint
        The number is not positive.
    """
    if x <= 0:
        raise IrregularPoint
    return [mp.log(x), *(-1 / (k * (-x) ** k) for k in range(1, order + 1))]


def cyclic(values: Sequence[mp.mpf], order: int) -> list[mp.mpf]:
    """Return Taylor coefficients of a function whose derivatives repeat in turn.

    Parameters
    ----------
    values : sequence of mpf
        Values of the function and its derivatives, one period.
    order : int
        Highest order.

    Returns
    -------
    list of mpf, shape (order + 1,)
    """
    return [values[k % len(values)] / mp.factorial(k) for k in range(order + 1)]


def integrated(first: Callable[[mp.mpf], mp.mpf], slope: Callable[[Taylor, Polynomial], Polynomial]) -> Coefficients:
    """Return Taylor coefficients of a function with this value and derivative.

    Parameters
    ----------
    first : callable
        Value of the function at a number.
    slope : callable
        Derivative of the function, as a function of its argument.

    Returns
    -------
    Coefficients
        Function of a number and an order.
    """

    def coefficients(x: mp.mpf, order: int) -> Polynomial:
        taylor = Taylor(order)
        return taylor.integral(slope(taylor, (x, mp.one)), _real(first(x)))

    return coefficients


def solving(first: Callable[[mp.mpf], mp.mpf], slope: Callable[[Taylor, Polynomial], Polynomial]) -> Coefficients:
    """Return Taylor coefficients of a function that solves y' = slope(y).

    Parameters
    ----------
    first : callable
        Value of the function at a number.
    slope : callable
        Derivative of the function, as a function of its value.

    Returns
    -------
    Coefficients
        Function of a number and an order.
    """

    def coefficients(x: mp.mpf, order: int) -> Polynomial:
        found = (_real(first(x)),)
        for k in range(1, order + 1):
            taylor = Taylor(k)
            found = taylor.integral(slope(taylor, found), found[0])
        return found

    return coefficients


def differentiated(function: Callable[[mp.mpf], mp.mpf]) -> Coefficients:
    """Return Taylor coefficients of any function, by finite differences.

    Parameters
    ----------
    function : callable
        Function of a number.

    Returns
    -------
    Coefficients
        Function of a number and an order.
    """
    return lambda x, order: list(map(_real, mp.taylor(function, x, order)))


def _real(number: mp.mpf | mp.mpc) -> mp.mpf:
    if isinstance(number, mp.mpf) and mp.isfinite(number):
        return number
    raise IrregularPoint


def _root(taylor: Taylor, x: Polynomial, a: int, b: int, exponent: mp.mpf | int) -> Polynomial:
    """Return (a + b x^2)^exponent."""
    return taylor.power(taylor.add((mp.mpf(a),), taylor.scale(b, taylor.multiply(x, x))), mp.mpf(exponent))


HALF = mp.mpf(-1) / 2
COEFFICIENTS: dict[str, Coefficients] = {
    "Exp": exponential,
    "Ln": logarithm,
    "Sin": lambda x, order: cyclic((mp.sin(x), mp.cos(x), -mp.sin(x), -mp.cos(x)), order),
    "Cos": lambda x, order: cyclic((mp.cos(x), -mp.sin(x), -mp.cos(x), mp.sin(x)), order),
    "Sinh": lambda x, order: cyclic((mp.sinh(x), mp.cosh(x)), order),
    "Cosh": lambda x, order: cyclic((mp.cosh(x), mp.sinh(x)), order),
    "Tan": solving(mp.tan, lambda taylor, y: _root(taylor, y, 1, 1, 1)),
    "Tanh": solving(mp.tanh, lambda taylor, y: _root(taylor, y, 1, -1, 1)),
    "Cot": solving(mp.cot, lambda taylor, y: _root(taylor, y, -1, -1, 1)),
    "Coth": solving(mp.coth, lambda taylor, y: _root(taylor, y, 1, -1, 1)),
    "Arcsin": integrated(mp.asin, lambda taylor, x: _root(taylor, x, 1, -1, HALF)),
    "Arccos": integrated(mp.acos, lambda taylor, x: taylor.scale(-1, _root(taylor, x, 1, -1, HALF))),
    "Arctan": integrated(mp.atan, lambda taylor, x: _root(taylor, x, 1, 1, -1)),
    "Arsinh": integrated(mp.asinh, lambda taylor, x: _root(taylor, x, 1, 1, HALF)),
    "Arcosh": integrated(mp.acosh, lambda taylor, x: _root(taylor, x, -1, 1, HALF)),
    "Artanh": integrated(mp.atanh, lambda taylor, x: _root(taylor, x, 1, -1, -1)),
    "Erf": integrated(
        mp.erf,
        lambda taylor, x: taylor.scale(
            2 / mp.sqrt(mp.pi), taylor.compose(exponential, taylor.scale(-1, taylor.multiply(x, x)))
        ),
    ),
}
OTHERS = {
    "Sec": mp.sec,
    "Csc": mp.csc,
    "Sech": mp.sech,
    "Csch": mp.csch,
    "Arcsec": mp.asec,
    "Arccsc": mp.acsc,
    "Arccot": mp.acot,
    "Arsech": mp.asech,
    "Arcsch": mp.acsch,
    "Arcoth": mp.acoth,
    "Erfc": mp.erfc,
    "Gamma": mp.gamma,
    "AiryAi": mp.airyai,
    "AiryBi": mp.airybi,
    "AiryAiPrime": lambda x: mp.airyai(x, derivative=1),
    "AiryBiPrime": lambda x: mp.airybi(x, derivative=1),
}
COEFFICIENTS |= {head: differentiated(function) for head, function in OTHERS.items()}
OF_A_NUMBER = {  # of a constant and a function of the time
    "BesselJ": mp.besselj,
    "BesselY": mp.bessely,
    "BesselI": mp.besseli,
    "BesselK": mp.besselk,
    "PolyGamma": mp.polygamma,
}
ELLIPTIC = {"JacobiSn": "sn", "JacobiCn": "cn", "JacobiDn": "dn"}  # of a function of the time and a constant
SPECIAL = frozenset({"Erfc", "Gamma", "AiryAi", "AiryBi", "AiryAiPrime", "AiryBiPrime", *OF_A_NUMBER, *ELLIPTIC})
