"""Values of what the programs of a motion leave open: of parameters lasting ones, of tables others by the time."""

from typing import Literal

import numpy as np

from ..program.motion_problem import MotionProblem
from ..program.precision import Precision
from ..program.table_numbers import PiecesOfTable
from .evaluation import Numbers, as_floats, zeros


class OpenValues:
    """Values of `MotionProblem.open_inputs`, in the numbers of a precision."""

    def __init__(self, problem: MotionProblem, precision: Precision) -> None:
        lasting = [precision.ratio(problem.values[name]) for name in problem.parameters]
        self._lasting = np.array(lasting) if lasting else zeros(precision, 0)
        self._tables = [
            problem.once(("table", precision.name), table, lambda table=table: PiecesOfTable(table, precision))
            for table in problem.tables
        ]

    def __call__(self, instants: Numbers) -> Numbers:
        """The values at instants, shape (k,), as columns; at a knot those of the polynomial that ends there."""
        lasting = np.repeat(self._lasting[:, None], len(instants), axis=1)
        if not self._tables:
            return lasting
        floats = as_floats(instants)
        return np.concatenate([lasting, *(pieces.at(floats) for pieces in self._tables)])

    def at(self, instant: Numbers) -> Numbers:
        """The same at one instant."""
        return self._at(instant, "left")

    def after(self, instant: Numbers) -> Numbers:
        """The values from an instant on."""
        return self._at(instant, "right")

    def _at(self, instant: Numbers, side: Literal["left", "right"]) -> Numbers:
        if not self._tables:
            return self._lasting
        t = float(instant)
        return np.concatenate([self._lasting, *(pieces.at(t, side) for pieces in self._tables)])


class BesideState:
    """What programs take behind the time and the state where multipliers do not matter: zeros for them, and values."""

    def __init__(self, problem: MotionProblem, precision: Precision) -> None:
        self._values = OpenValues(problem, precision)
        self._precision, self._multipliers = precision, len(problem.multipliers)

    def __call__(self, instants: Numbers) -> Numbers:
        """At instants, shape (k,), as columns."""
        return np.concatenate([zeros(self._precision, self._multipliers, len(instants)), self._values(instants)])
