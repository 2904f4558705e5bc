"""Move states onto the constraint manifold by Newton's method.

The working precision is higher than the stated one.
"""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp
from mpmath import mp

from .evaluation import Steps
from .irregular_point import IrregularPoint

SPARE_DIGITS = 10
"""Of those that are carried, digits to which residuals need not vanish."""

NEWTON_STEPS = 60
"""Steps of Newton's method towards the manifold; quadratic convergence needs a dozen from nearby."""

State = dict[sp.Symbol, mp.mpf]


def moved_onto(state: State, unknowns: Sequence[sp.Symbol], residuals: Steps, jacobian: Steps) -> None:
    """Move the unknowns of a state, by shortest steps, to a zero of the residuals.

    Parameters
    ----------
    state : dict of Symbol to mpf
        Changed in place.
    unknowns : sequence of Symbol, shape (n,)
        Symbols of the state to move.
    residuals : Steps
        Of g expressions.
    jacobian : Steps
        Of g rows of n expressions: derivatives of the residuals with respect to the unknowns.

    Raises
    ------
    IrregularPoint
        Newton's method does not get there, or a value is not real.
    ZeroDivisionError
        The residuals' gradients are dependent on the way.
    """
    n = len(unknowns)
    for _ in range(NEWTON_STEPS):
        right = residuals.real_at(state)
        size = max(abs(number) for number in state.values())
        if max(map(abs, right), default=mp.zero) <= mp.mpf(10) ** (SPARE_DIGITS - mp.dps) * max(1, size):
            return
        entries = jacobian.real_at(state)
        rows = mp.matrix([entries[k : k + n] for k in range(0, len(entries), n)])
        move = rows.T * mp.lu_solve(rows * rows.T, mp.matrix(right))
        for unknown, by in zip(unknowns, move, strict=True):
            state[unknown] -= by
    raise IrregularPoint
