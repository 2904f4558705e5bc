"""States moved onto the constraint manifold by Newton's method, at a working precision beyond the one stated."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import sympy as sp
from mpmath import mp

from .irregular_point import IrregularPoint
from .points import Valuation

SPARE_DIGITS = 10
"""Of those that are carried, digits to which residuals need not vanish."""

NEWTON_STEPS = 60
"""Steps of Newton's method towards the manifold; quadratic convergence needs a dozen from nearby."""

State = dict[sp.Symbol, mp.mpf]


def moved_onto(
    state: State, unknowns: Sequence[sp.Symbol], residuals: Sequence[sp.Expr], jacobian: Sequence[Sequence[sp.Expr]]
) -> None:
    """Move the unknowns of a state, by the shortest steps, to where the residuals vanish.

    Parameters
    ----------
    state : dict of Symbol to mpf
        Changed in place.
    unknowns : sequence of n Symbols
    residuals : sequence of g Exprs
    jacobian : g rows of n Exprs
        Derivatives of the residuals with respect to the unknowns.

    Raises
    ------
    IrregularPoint
        Newton's method does not get there.
    ZeroDivisionError
        The residuals' gradients are dependent on the way.
    """
    if not residuals:
        return
    for _ in range(NEWTON_STEPS):
        value = valuation(state)
        right = mp.matrix([value(residual) for residual in residuals])
        size = max(abs(number) for number in state.values())
        if max(map(abs, right)) <= mp.mpf(10) ** (SPARE_DIGITS - mp.dps) * max(1, size):
            return
        rows = mp.matrix([[value(entry) for entry in row] for row in jacobian])
        move = rows.T * mp.lu_solve(rows * rows.T, right)
        for unknown, by in zip(unknowns, move, strict=True):
            state[unknown] -= by
    raise IrregularPoint


def valuation(state: Mapping[sp.Symbol, mp.mpf]) -> Valuation:
    """Values of expressions at a state."""
    value = Valuation({})
    for symbol, number in state.items():
        value.define(symbol, number)
    return value
