"""Linear equations for symbols, kept as residuals: never solved in symbols, only at a point."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import sympy as sp
from mpmath import mp


@dataclass(frozen=True)
class LinearEquations:
    """As many residuals, linear in the unknowns, as there are unknowns."""

    unknowns: tuple[sp.Symbol, ...]
    residuals: tuple[sp.Expr, ...]

    @cached_property
    def coefficients(self) -> list[list[sp.Expr]]:
        """The m x m coefficients of the unknowns, row by row."""
        return [[residual.diff(x) for x in self.unknowns] for residual in self.residuals]

    @cached_property
    def constants(self) -> list[sp.Expr]:
        """The m residuals where every unknown is zero."""
        nothing = dict.fromkeys(self.unknowns, sp.Integer(0))
        return [residual.xreplace(nothing) for residual in self.residuals]

    def solution(self, value: Callable[[sp.Expr], mp.mpf]) -> dict[sp.Symbol, mp.mpf]:
        """Solve for the unknowns at a point, where `value` evaluates an expression.

        Raises
        ------
        ZeroDivisionError
            The coefficients are singular there.
        """
        if not self.unknowns:
            return {}
        matrix = mp.matrix([[value(entry) for entry in row] for row in self.coefficients])
        right = mp.matrix([-value(constant) for constant in self.constants])
        return dict(zip(self.unknowns, mp.lu_solve(matrix, right), strict=True))
