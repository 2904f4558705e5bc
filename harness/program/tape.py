"""Assignments of a program that is being written."""

from collections.abc import Iterable
from fractions import Fraction

from .motion_program import Atom, Call, Expression, Name, Operation
from .rewriting import ONE, ZERO, folded


class Tape:
    """Assignments of a new program, each operation once.

    Parameters
    ----------
    taken : set of str
        Names that the assignments do not get.
    """

    def __init__(self, taken: set[str]) -> None:
        self._known: dict[Call, Name] = {}
        self._symbol = "v"
        while any(name.startswith(self._symbol) for name in taken):
            self._symbol += "v"

    def __call__(self, operation: Operation, *arguments: Atom) -> Atom:
        """Return the value of an operation.

        Parameters
        ----------
        operation : Operation
        *arguments : Atom

        Returns
        -------
        Atom
            A number, an argument, or the name of the assignment.
        """
        match folded(operation, list(arguments)):
            case Call() as call:
                return self._known.setdefault(call, Name(f"{self._symbol}{len(self._known) + 1}"))
            case atom:
                return atom

    @property
    def assignments(self) -> tuple[tuple[str, Expression], ...]:
        """The assignments so far."""
        return tuple((name.text, call) for call, name in self._known.items())

    def product(self, *factors: Atom) -> Atom:
        """Return a product.

        Parameters
        ----------
        *factors : Atom
            At least one.

        Returns
        -------
        Atom
        """
        return factors[0] if len(factors) == 1 else self(Operation.MULTIPLY, *factors)

    def sum(self, terms: Iterable[Atom]) -> Atom:
        """Return a sum.

        Parameters
        ----------
        terms : iterable of Atom
            At least one.

        Returns
        -------
        Atom
        """
        first, *rest = terms
        return self(Operation.ADD, first, *rest) if rest else first

    def quotient(self, a: Atom, b: Atom) -> Atom:
        """Return a/b.

        Parameters
        ----------
        a, b : Atom

        Returns
        -------
        Atom
        """
        return self(Operation.DIVIDE, a, b)

    def power(self, base: Atom, exponent: Fraction) -> Atom:
        """Return a power.

        Parameters
        ----------
        base : Atom
        exponent : Fraction

        Returns
        -------
        Atom
        """
        if exponent in (ZERO, ONE):
            return base if exponent else ONE
        return self(Operation.POWER, base, exponent)
