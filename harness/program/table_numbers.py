"""What tables are at instants: their polynomials as arrays, and programs of the time that take them."""

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .motion_program import Program
from .numpy_function import NumpyFunction
from .precision import Precision, read_precision
from .table import Table

Numbers = NDArray[Any]


class OfTime:
    """A program of the time, and of what tables are then, as a function of the time alone.

    Parameters
    ----------
    program : Program
        Its inputs are ``t`` and, in order, those of the tables.
    """

    def __init__(self, program: Program, tables: Sequence[Table]) -> None:
        self._function, self._tables = NumpyFunction(program), pieces_of_tables(tables)

    def __call__(self, instants: Numbers) -> Numbers:
        """Return the outputs at instants, shape (outputs, ...)."""
        return self._function([instants, *(row for table in self._tables for row in table.at(instants))])


class PiecesOfTable:
    """The polynomials of a table, in the numbers of a precision."""

    def __init__(self, table: Table, precision: Precision) -> None:
        begins = [precision.ratio(t) for t in table.begins]
        rows = ([precision.number(piece[place]) for piece in table.pieces] for place in range(1, len(table.inputs)))
        self._numbers = np.array([begins, *rows])  # shape (5, pieces)
        self._knots = np.array([float(t) for t in begins[1:]])

    def at(self, instants: Numbers, side: Literal["left", "right"] = "left") -> Numbers:
        """Return the polynomials that count at instants in double precision, shape (5, k); one for one instant.

        At a knot it is the one that ends there, on its right side the one that begins.
        """
        return self._numbers[:, self._knots.searchsorted(instants, side)]


def pieces_of_tables(tables: Sequence[Table]) -> list[PiecesOfTable]:
    """Return those of each table, in double precision."""
    return [PiecesOfTable(table, read_precision("double")) for table in tables]
