"""Signs of functions of the time behind a time at which they vanish.

There sign(g) and |g| have one form for a while, whatever the state. The first term of the Taylor series of g in the
time shows the sign.
"""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from .normal_form import is_identically_zero

MOST_FLAT = 12
"""Derivatives of a function that may vanish where its sign is found."""


def form_behind(expression: sp.Expr, meanings: Mapping[sp.Symbol, sp.Expr], time: sp.Symbol, start: sp.Expr) -> sp.Expr:
    """Return an expression in the form that it has shortly after a time.

    Parameters
    ----------
    expression : Expr
        Expression of the time and of other symbols.
    meanings : mapping of Symbol to Expr
        Functions of the time that some of these are.
    time : Symbol
        The time.
    start : Expr
        The time after which the form is wanted.

    Returns
    -------
    Expr
        Functions that do not vanish at that time for all values of the other symbols are as they were.
    """

    def replaced(part: sp.Expr) -> sp.Expr:
        s = _sign_behind(part.args[0].xreplace(meanings), time, start)
        return part if s is None else s if isinstance(part, sp.sign) else s * part.args[0]

    return expression.replace(lambda part: isinstance(part, sp.sign | sp.Abs), replaced)


def _sign_behind(g: sp.Expr, time: sp.Symbol, start: sp.Expr) -> sp.Expr | None:
    """Return the sign behind a zero, nan if unknown, None without a zero."""
    if time not in g.free_symbols:
        return None
    for order in range(MOST_FLAT + 1):
        value = g.xreplace({time: start})
        if not is_identically_zero([value]):
            return sp.sign(value) if order else None
        g = g.diff(time)
    return sp.nan
