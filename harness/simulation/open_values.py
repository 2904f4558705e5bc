"""Values of what the programs of a motion leave open: of parameters lasting ones, of tables others by the time."""

from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..program.motion_problem import MotionProblem
from ..program.precision import Precision
from ..program.table import Table
from .evaluation import Numbers, as_floats, zeros


class _Polynomials(NamedTuple):
    """Those of a table."""

    knots: NDArray[np.float64]  # instants at which one follows on another
    numbers: Numbers  # shape (5, knots + 1)


class OpenValues:
    """Values of `MotionProblem.open_inputs`, in the numbers of a precision."""

    def __init__(self, problem: MotionProblem, precision: Precision) -> None:
        lasting = [precision.ratio(problem.values[name]) for name in problem.parameters]
        self._lasting = np.array(lasting) if lasting else zeros(precision, 0)
        self._tables = [
            problem.once(("table", precision.name), table, lambda table=table: _polynomials(table, precision))
            for table in problem.tables
        ]

    def __call__(self, instants: Numbers) -> Numbers:
        """The values at instants, shape (k,), as columns; at a knot those of the polynomial that ends there."""
        lasting = np.repeat(self._lasting[:, None], len(instants), axis=1)
        if not self._tables:
            return lasting
        floats = as_floats(instants)
        found = (numbers[:, np.searchsorted(knots, floats)] for knots, numbers in self._tables)
        return np.concatenate([lasting, *found])

    def at(self, instant: Numbers) -> Numbers:
        """The same at one instant."""
        return self._at(instant, "left")

    def after(self, instant: Numbers) -> Numbers:
        """The values from an instant on."""
        return self._at(instant, "right")

    def _at(self, instant: Numbers, side: str) -> Numbers:
        if not self._tables:
            return self._lasting
        t = float(instant)
        found = (numbers[:, knots.searchsorted(t, side)] for knots, numbers in self._tables)
        return np.concatenate([self._lasting, *found])


class BesideState:
    """What programs take behind the time and the state where multipliers do not matter: zeros for them, and values."""

    def __init__(self, problem: MotionProblem, precision: Precision) -> None:
        self._values = OpenValues(problem, precision)
        self._precision, self._multipliers = precision, len(problem.multipliers)

    def __call__(self, instants: Numbers) -> Numbers:
        """At instants, shape (k,), as columns."""
        return np.concatenate([zeros(self._precision, self._multipliers, len(instants)), self._values(instants)])


def _polynomials(table: Table, precision: Precision) -> _Polynomials:
    begins = [precision.ratio(Fraction(piece[0])) for piece in table.pieces]
    rows = ([precision.number(piece[place]) for piece in table.pieces] for place in range(1, len(table.inputs)))
    numbers = np.array([begins, *rows])
    return _Polynomials(as_floats(numbers[0, 1:]), numbers)
