"""Arithmetic of Taylor polynomials in the time, with the numbers of mpmath.

A polynomial is a tuple of coefficients. Those that it leaves out are zero. A function of one is composed of the
function's own Taylor coefficients (Griewank & Walther, Evaluating Derivatives, chapter 13).
"""

from __future__ import annotations

from itertools import zip_longest

from mpmath import mp

from .irregular_point import IrregularPoint

Polynomial = tuple[mp.mpf, ...]


class Taylor:
    """Polynomials up to an order."""

    def __init__(self, order: int) -> None:
        self.order = order

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
        """Divide by a polynomial that is not zero at the initial time.

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
            The divisor is zero at the initial time.
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
            The power is not analytic at the initial time.
        """
        if exponent == int(exponent) and 0 <= exponent <= self.order + 2:
            found = (mp.one,)
            for _ in range(int(exponent)):
                found = self.multiply(found, x)
            return found
        whole = exponent == int(exponent)
        least = 1 if any(x) else self.order + 1  # x = O(t^least) if x[0] is zero
        if not x[0] and (whole or not any(x)) and exponent * least > self.order:
            return (mp.zero,)
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

    def compose(self, coefficients: Polynomial, x: Polynomial) -> Polynomial:
        """Return a function of a polynomial from the function's Taylor coefficients.

        Parameters
        ----------
        coefficients : Polynomial
            Taylor coefficients of the function about the first coefficient of its argument.
        x : Polynomial
            Argument of the function.

        Returns
        -------
        Polynomial
            Composition up to the order.
        """
        if x[1:] == (mp.one,):
            return coefficients
        found, beyond = coefficients[-1:], (mp.zero, *x[1:])
        for c in reversed(coefficients[:-1]):
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
            Value at the initial time.

        Returns
        -------
        Polynomial
            Integral up to the order.
        """
        return (first, *(c / (k + 1) for k, c in enumerate(x)))[: self.order + 1]
