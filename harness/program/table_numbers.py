"""What tables are at instants: their polynomials as arrays, and programs of the time that take them."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .motion_program import Program
from .numpy_function import NumpyFunction
from .table import Table

Numbers = NDArray[np.float64]


class OfTime:
    """A program of the time, and of what tables are then, as a function of the time alone.

    Parameters
    ----------
    program : Program
        Its inputs are ``t`` and, in order, those of the tables.
    """

    def __init__(self, program: Program, tables: Sequence[Table]) -> None:
        self._function, self._tables = NumpyFunction(program), [PiecesOfTable(table) for table in tables]

    def __call__(self, instants: Numbers) -> Numbers:
        """The outputs at instants, shape (outputs, ...)."""
        return self._function([instants, *(row for table in self._tables for row in table.at(instants))])


class PiecesOfTable:
    """The polynomials of a table as an array, shape (5, pieces)."""

    def __init__(self, table: Table) -> None:
        self._numbers = np.array(list(table.rows)).T

    def at(self, instants: Numbers) -> Numbers:
        """The polynomials that count at instants, shape (5, k), at a knot the one that ends there."""
        return self._numbers[:, np.searchsorted(self._numbers[0, 1:], instants)]
