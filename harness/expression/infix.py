"""Formulas in the common syntax of C and Python, with minimal parentheses."""

from enum import IntEnum
from typing import NamedTuple


class Rank(IntEnum):
    """Precedence of the parts of a formula."""

    SUM = 0
    PRODUCT = 1
    SIGNED = 2
    POWER = 3
    ATOM = 4


class Formula(NamedTuple):
    """Text and how tightly it holds together."""

    text: str
    rank: Rank

    def within(self, rank: Rank) -> str:
        """Return the text as part of a formula that needs at least this rank.

        Parameters
        ----------
        rank : Rank
            Lowest rank that needs no parentheses.

        Returns
        -------
        str
            The text, in parentheses if its rank is lower.
        """
        return self.text if self.rank >= rank else f"({self.text})"


def atom(text: str) -> Formula:
    """Return a name or a number without a sign.

    Parameters
    ----------
    text : str
        Name or number without a sign.

    Returns
    -------
    Formula
    """
    return Formula(text, Rank.ATOM)


def signed(text: str) -> Formula:
    """Return a number, perhaps with a minus sign.

    Parameters
    ----------
    text : str
        Number.

    Returns
    -------
    Formula
    """
    return Formula(text, Rank.SIGNED if text.startswith("-") else Rank.ATOM)


def call(function: str, *arguments: Formula) -> Formula:
    """Return a function call.

    Parameters
    ----------
    function : str
        Name of the function.
    *arguments : Formula
        Its arguments.

    Returns
    -------
    Formula
    """
    return atom(f"{function}({', '.join(argument.text for argument in arguments)})")


def add(first: Formula, *others: Formula) -> Formula:
    """Return a sum, from left to right.

    Parameters
    ----------
    first : Formula
        First term.
    *others : Formula
        Further terms, in order.

    Returns
    -------
    Formula
    """
    return Formula(" + ".join([first.text, *(term.within(Rank.PRODUCT) for term in others)]), Rank.SUM)


def subtract(a: Formula, b: Formula) -> Formula:
    """Return a difference.

    Parameters
    ----------
    a, b : Formula
        Minuend and subtrahend.

    Returns
    -------
    Formula
    """
    return Formula(f"{a.text} - {b.within(Rank.PRODUCT)}", Rank.SUM)


def multiply(first: Formula, *others: Formula) -> Formula:
    """Return a product, from left to right.

    Parameters
    ----------
    first : Formula
        First factor.
    *others : Formula
        Further factors, in order.

    Returns
    -------
    Formula
    """
    factors = [first.within(Rank.PRODUCT), *(factor.within(Rank.SIGNED) for factor in others)]
    return Formula("*".join(factors), Rank.PRODUCT)


def divide(a: Formula, b: Formula) -> Formula:
    """Return a quotient.

    Parameters
    ----------
    a, b : Formula
        Dividend and divisor.

    Returns
    -------
    Formula
    """
    return Formula(f"{a.within(Rank.PRODUCT)}/{b.within(Rank.SIGNED)}", Rank.PRODUCT)


def negate(a: Formula) -> Formula:
    """Return a change of sign.

    Parameters
    ----------
    a : Formula
        Formula whose sign changes.

    Returns
    -------
    Formula
    """
    return Formula(f"-{a.within(Rank.POWER)}", Rank.SIGNED)
