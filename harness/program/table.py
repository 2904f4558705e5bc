"""Tables that a law is given by: of thousands of cubic polynomials one counts at an instant.

Programs have the letters of such a polynomial among their inputs, t_k and the coefficients of powers of t - t_k
(`maxima/table.mac`); its numbers are data, and found by the time.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .motion_program import Program
from .numpy_function import NumpyFunction
from .precision import Precision

Piece = tuple[str, str, str, str, str]  # t_k, c0, c1, c2, c3, exact or in decimal digits


@dataclass(frozen=True)
class Table:
    """The polynomials of one table, in order; the last one reaches to the table's end."""

    inputs: tuple[str, ...]  # names of the five numbers of a polynomial in programs
    pieces: tuple[Piece, ...]

    @cached_property
    def knots(self) -> tuple[Fraction, ...]:
        """The instants at which one polynomial follows on another."""
        return tuple(Fraction(piece[0]) for piece in self.pieces[1:])

    @property
    def first(self) -> Mapping[str, Fraction]:
        """The first polynomial."""
        return dict(zip(self.inputs, map(Fraction, self.pieces[0]), strict=True))

    def numbers_in(self, precision: Precision) -> NDArray[Any]:
        """All polynomials, shape (5, pieces), in numbers of a precision."""
        begins = [precision.ratio(Fraction(piece[0])) for piece in self.pieces]
        rows = ([precision.number(piece[place]) for piece in self.pieces] for place in range(1, len(self.inputs)))
        return np.array([begins, *rows])

    def at(self, instants: NDArray[np.float64]) -> NDArray[np.float64]:
        """The polynomials that count at instants, shape (5, k), at a knot the one that ends there."""
        return self.numbers[:, np.searchsorted(self.numbers[0, 1:], instants)]

    @cached_property
    def numbers(self) -> NDArray[np.float64]:
        """All polynomials, shape (5, pieces)."""
        return np.array([[float(Fraction(piece[0])), *map(float, piece[1:])] for piece in self.pieces]).T


class OfTime:
    """A program of the time, and of what tables are then, as a function of the time alone.

    Parameters
    ----------
    program : Program
        Its inputs are ``t`` and, in order, those of the tables.
    """

    def __init__(self, program: Program, tables: Sequence[Table]) -> None:
        self._function, self._tables = NumpyFunction(program), tables

    def __call__(self, instants: NDArray[np.float64]) -> NDArray[np.float64]:
        """The outputs at instants, shape (outputs, ...)."""
        return self._function([instants, *(row for table in self._tables for row in table.at(instants))])


def read_tables(document: Sequence[Mapping[str, Any]]) -> tuple[Table, ...]:
    """The tables of a document of Maxima."""
    return tuple(Table(tuple(table["inputs"]), tuple(map(tuple, table["pieces"]))) for table in document)
