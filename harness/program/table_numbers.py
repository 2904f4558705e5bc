"""Values of tables at given times, and programs of time that use them."""

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .motion_program import Program
from .numpy_function import NumpyFunction
from .precision import Precision, read_precision
from .table import Table

Numbers = NDArray[Any]


class TimeFunction:
    """A program of time and the values of tables, as a function of time alone.

    Parameters
    ----------
    program : Program
        Its inputs are ``t`` and, in order, those of the tables.
    """

    def __init__(self, program: Program, tables: Sequence[Table]) -> None:
        self._function, self._tables = NumpyFunction(program), pieces_of_tables(tables)

    def __call__(self, times: Numbers) -> Numbers:
        """Return the outputs at times, shape (outputs, ...)."""
        return self._function([times, *(row for table in self._tables for row in table.at(times))])


class PiecesOfTable:
    """The polynomials of a table, in the numbers of a precision."""

    def __init__(self, table: Table, precision: Precision) -> None:
        begins = [precision.ratio(t) for t in table.begins]
        rows = ([precision.number(piece[place]) for piece in table.pieces] for place in range(1, len(table.inputs)))
        self._numbers = np.array([begins, *rows])  # shape (5, polynomials)
        self._knots = np.array([float(t) for t in begins[1:]])

    def at(self, times: Numbers, side: Literal["left", "right"] = "left") -> Numbers:
        """Return the polynomials at times in double precision.

        At a knot this is the polynomial that ends there. On its right side, the one that begins.

        Parameters
        ----------
        times : float or ndarray, shape (k,)
            Times in the scene's unit.
        side : {"left", "right"}
            Polynomial to take at a knot.

        Returns
        -------
        ndarray, shape (5,) or (5, k)
            Time at which the polynomial begins, then its four coefficients.
        """
        return self._numbers[:, self._knots.searchsorted(times, side)]


def pieces_of_tables(tables: Sequence[Table]) -> list[PiecesOfTable]:
    """Return the polynomials of each table in double precision.

    Parameters
    ----------
    tables : sequence of Table
        Tables of a law.

    Returns
    -------
    list of PiecesOfTable
    """
    return [PiecesOfTable(table, read_precision("double")) for table in tables]
