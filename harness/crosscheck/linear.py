"""Linear equations in symbols as residuals, solved only at a point."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property

import sympy as sp
from mpmath import mp

from .evaluation import Number, Steps, Values
from .rounding import BoundedValues, Result, bounded, negative, solution


@dataclass(frozen=True)
class LinearEquations:
    """Residuals that are linear in equally many unknowns."""

    unknowns: tuple[sp.Symbol, ...]
    residuals: tuple[sp.Expr, ...]

    @cached_property
    def coefficients(self) -> list[list[sp.Expr]]:
        """The m x m coefficients of the unknowns, row by row."""
        return [[residual.diff(x) for x in self.unknowns] for residual in self.residuals]

    @cached_property
    def constants(self) -> list[sp.Expr]:
        """The m residuals with every unknown zero."""
        nothing = dict.fromkeys(self.unknowns, sp.Integer(0))
        return [residual.xreplace(nothing) for residual in self.residuals]

    @cached_property
    def _steps(self) -> Steps:
        return Steps([*(entry for row in self.coefficients for entry in row), *self.constants])

    def solution(self, values: Values, real: bool = False) -> dict[sp.Symbol, Number | None]:
        """Return the solution at a point, None for each unknown if there is no solution.

        Parameters
        ----------
        values : Values
            Values of the other symbols.
        real : bool
            If True, complex values count as missing.

        Returns
        -------
        dict of Symbol to Number or None
            Value of each unknown.
        """
        order = len(self.unknowns)
        found = self._steps.at(values, real) if order else []
        if order and None not in found:
            rows = [found[i * order : (i + 1) * order] for i in range(order)]
            with suppress(ZeroDivisionError, TypeError):  # which mpmath raises for a column of zeros
                solution = mp.lu_solve(mp.matrix(rows), -mp.matrix(found[order * order :]))
                return dict(zip(self.unknowns, solution, strict=True))
        return dict.fromkeys(self.unknowns)

    def bounded_solution(self, values: BoundedValues) -> dict[sp.Symbol, Result]:
        """Return the solution at a point with bounds on its rounding errors.

        Parameters
        ----------
        values : BoundedValues
            Values of the other symbols.

        Returns
        -------
        dict of Symbol to Result
            Value of each unknown.
        """
        order = len(self.unknowns)
        found = bounded(self._steps, values)
        rows = [found[i * order : (i + 1) * order] for i in range(order)]
        right = list(map(negative, found[order * order :]))
        return dict(zip(self.unknowns, solution(rows, right), strict=True))
