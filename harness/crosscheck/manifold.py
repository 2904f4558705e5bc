"""Move states onto the constraint manifold by Newton's method.

The working precision is higher than the stated one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import sympy as sp
from mpmath import mp

from .evaluation import Steps
from .irregular_point import IrregularPoint
from .ranks import Row, least_solution
from .system import gradient

SPARE_DIGITS = 15
"""Of those that are carried, digits to which the last step need not vanish."""

NEWTON_STEPS = 60
"""Steps of Newton's method towards the manifold; quadratic convergence needs a dozen from nearby."""

State = dict[sp.Symbol, mp.mpf]


def _sparse_gradient(expression: sp.Expr, places: Mapping[sp.Symbol, int]) -> dict[int, sp.Expr]:
    present = sorted(expression.free_symbols & places.keys(), key=places.get)
    return dict(zip(map(places.get, present), gradient(expression, present), strict=True))


class Gradients:
    """Derivatives of expressions by some symbols, as sparse rows."""

    def __init__(self, expressions: Sequence[sp.Expr], symbols: Sequence[sp.Symbol]) -> None:
        places = {symbol: k for k, symbol in enumerate(symbols)}
        rows = [_sparse_gradient(each, places) for each in expressions]
        self.symbols = symbols
        self._places = [(i, k) for i, row in enumerate(rows) for k in row]
        self._steps = Steps([entry for row in rows for entry in row.values()])
        self._length = len(rows)

    def at(self, state: State) -> list[Row]:
        """Return one row for each expression.

        Parameters
        ----------
        state : dict of Symbol to mpf
            Values of all symbols in the expressions.

        Returns
        -------
        list of Row

        Raises
        ------
        IrregularPoint
            A derivative has no real value.
        """
        rows: list[Row] = [{} for _ in range(self._length)]
        for (i, k), value in zip(self._places, self._steps.real_at(state), strict=True):
            if value:
                rows[i][k] = value
        return rows


def moved_onto(state: State, residuals: Steps, gradients: Gradients) -> None:
    """Move a state, by shortest steps, to a zero of the residuals.

    Parameters
    ----------
    state : dict of Symbol to mpf
        Changed in place.
    residuals : Steps
        Of g expressions.
    gradients : Gradients
        Of the residuals, by the symbols to move.

    Raises
    ------
    IrregularPoint
        Newton's method does not get there, or a value is not real.
    """
    for _ in range(NEWTON_STEPS):
        step = least_solution(gradients.at(state), residuals.real_at(state))
        for place, by in step.items():
            state[gradients.symbols[place]] -= by
        if max(map(abs, step.values()), default=mp.zero) <= mp.mpf(10) ** (SPARE_DIGITS - mp.dps) * _size(
            state, gradients
        ):
            if left_over(state, residuals, gradients):
                break
            return
    raise IrregularPoint


def left_over(state: State, residuals: Steps, gradients: Gradients) -> set[int]:
    """Return places of residuals that do not vanish to half of the digits carried.

    Parameters
    ----------
    state : dict of Symbol to mpf
        Values of all symbols.
    residuals : Steps
        Of g expressions.
    gradients : Gradients
        Of the residuals.

    Returns
    -------
    set of int

    Raises
    ------
    IrregularPoint
        A value is not real.
    """
    tolerance = mp.mpf(10) ** -(mp.dps // 2) * _size(state, gradients)
    slopes = [1 + max(map(abs, row.values()), default=mp.zero) for row in gradients.at(state)]
    values = residuals.real_at(state)
    return {i for i, (value, slope) in enumerate(zip(values, slopes, strict=True)) if abs(value) > tolerance * slope}


def _size(state: State, gradients: Gradients) -> mp.mpf:
    return 1 + max((abs(state[x]) for x in gradients.symbols), default=mp.zero)
