"""Inputs of a motion's programs, in their order.

They are t, the state, multipliers, signs, open parameters and tables.
"""

from collections.abc import Sequence
from functools import cached_property
from typing import Any, Literal

import numpy as np

from ..program.heyoka_function import import_heyoka
from ..program.motion_problem import MotionProblem
from ..program.precision import Precision, read_precision
from ..program.table_numbers import PiecesOfTable
from .evaluation import Numbers, as_floats, zeros


def named_inputs(
    problem: MotionProblem, t: Any, state: Sequence[Any], zero: Any, open_values: Sequence[Any]
) -> dict[str, Any]:
    """Return the inputs of a motion's programs by name, as terms of another language.

    Multipliers are zero.

    Parameters
    ----------
    problem : MotionProblem
        The motion, which gives the names.
    t : term
        The time.
    state : sequence of term, shape (2n,)
        Coordinates, then velocities.
    zero : term
        The number zero.
    open_values : sequence of term
        The open inputs, in their order.

    Returns
    -------
    dict of str to term
    """
    names = "t", *problem.state, *problem.multipliers, *problem.open_inputs
    return dict(zip(names, (t, *state, *[zero] * len(problem.multipliers), *open_values), strict=True))


def heyoka_inputs(problem: MotionProblem, zero: Any = 0.0) -> dict[str, Any]:
    """Return the inputs for heyoka's integrators by name.

    The open inputs are heyoka's parameters.

    Parameters
    ----------
    problem : MotionProblem
        The motion, which gives the names.
    zero : number
        Zero in the numbers of the integrator.

    Returns
    -------
    dict of str to expression
    """
    heyoka = import_heyoka()
    variables, count = map(heyoka.expression, problem.state), len(problem.open_inputs)
    return named_inputs(problem, heyoka.time, variables, heyoka.expression(zero), [heyoka.par[k] for k in range(count)])


class Inputs:
    """Inputs of the programs of a motion, in the numbers of a precision."""

    def __init__(self, problem: MotionProblem, precision: Precision | None = None) -> None:
        self._problem, self._precision = problem, precision or read_precision("double")
        self._state = slice(1, 1 + len(problem.state))
        self._multipliers = slice(self._state.stop, self._state.stop + len(problem.multipliers))
        self._open = len(problem.open_inputs)

    def __call__(
        self,
        times: Any,
        states: Numbers,
        multipliers: Numbers | None = None,
        signs: Sequence[Any] = (),
        values: Numbers | None = None,
        accelerations: Numbers | None = None,
    ) -> Numbers:
        """Return the inputs at one state or at k states.

        Parameters
        ----------
        times : number or ndarray, shape (k,)
        states : ndarray, shape (2n,) or (2n, k)
        multipliers : ndarray, shape (g, k), or None
            None for zeros.
        signs : sequence
            One number, or k, for each sign that the program takes.
        values : ndarray, shape (p, k), or None
            Of the open parameters of k motions, or None for those of the problem.
        accelerations : ndarray, shape (n, k), or None
            None for a program that takes none.

        Returns
        -------
        ndarray, shape (inputs,) or (inputs, k)
        """
        signs = signs if accelerations is None else (*accelerations, *signs)
        behind = self._multipliers.stop + len(signs)
        found = zeros(self._precision, behind + self._open, *states.shape[1:])
        found[0], found[self._state] = times, states
        if multipliers is not None:
            found[self._multipliers] = multipliers
        for place, sign in enumerate(signs, start=self._multipliers.stop):
            found[place] = sign
        found[behind:].T[...] = (self.open_values(times) if values is None else values).T
        return found

    def open_values(self, times: Any, side: Literal["left", "right"] = "left") -> Numbers:
        """Return the open parameters and the values of tables at times.

        Parameters
        ----------
        times : number or ndarray, shape (k,)
            Times of the states.
        side : str
            ``left`` for the polynomial that ends at a knot, ``right`` for the one that begins there.

        Returns
        -------
        ndarray, shape (p,) or, with tables, (p, k)
            Open parameters, then polynomials of tables.
        """
        if not self._tables:
            return self._lasting
        floats = as_floats(times)
        lasting = np.repeat(self._lasting[:, None], len(floats), axis=1) if floats.ndim else self._lasting
        return np.concatenate([lasting, *(pieces.at(floats, side) for pieces in self._tables)])

    @cached_property
    def _lasting(self) -> Numbers:
        values = [self._precision.ratio(self._problem.values[name]) for name in self._problem.parameters]
        return np.array(values) if values else zeros(self._precision, 0)

    @cached_property
    def _tables(self) -> list[PiecesOfTable]:
        return [
            self._problem.once(
                ("table", self._precision.name), table, lambda table=table: PiecesOfTable(table, self._precision)
            )
            for table in self._problem.tables
        ]
