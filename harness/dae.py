"""The equations of motion as a differential-algebraic system F(t, y, y') = 0.

With r the left side of Lagrange's equations less the right one, and y = (q, v, lambda),

    index 3    q' - v = 0,  r(t, q, v, v', lambda) = 0,  f(t, q) = 0
    index 2    the same with df/dt for f
    index 1    the same with d2f/dt2, v' its accelerations, for f
    ggl        q' - v - J^T mu = 0,  r = 0,  df/dt = 0,  f = 0,  y = (q, v, lambda, mu): index 2 without drift

(Gear, Leimkuhler & Gupta, J. Comput. Appl. Math. 12 (1985) 77, and Brenan, Campbell & Petzold, chapter 6).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .program.motion_problem import MotionProblem, require_analytic, require_law_at, require_laws
from .program.request import Index
from .stability.linear_equations import LinearEquations, Point
from .stability.linearization import motion_at, state_at

Floats = NDArray[np.float64]


CONSTRAINT_FORM = {Index.THREE: "constraint", Index.TWO: "rate", Index.ONE: "acceleration", Index.GGL: "rate"}


@dataclass(frozen=True, repr=False)
class Dae:
    """F(t, y, y') = 0 of a motion, and its Jacobian.

    The control law and the parameters are put in. Multipliers of constraints that follow from the others are left out.

    Parameters
    ----------
    problem : MotionProblem
    equations : LinearEquations
        Of the same scene.
    index : Index

    Raises
    ------
    HolonomError
        The motion is not analytic.

    Examples
    --------
    >>> import holonom
    >>> dae = holonom.load("examples/pendulum.mac").dae(index=1)
    >>> dae.names
    ('x', 'y', 'dot(x)', 'dot(y)', 'lambda1')
    >>> bool(abs(dae.residual(dae.t0, dae.y0, dae.yp0)).max() < 1e-14)
    True
    """

    problem: MotionProblem
    equations: LinearEquations
    index: Index

    def __post_init__(self) -> None:
        require_analytic(self.problem)
        require_laws(self.problem)

    def __repr__(self) -> str:
        return f"<Dae of index {self.index} of {', '.join(self.names)} from t = {self.t0:g}>"

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the components of y."""
        multipliers = [self.equations.multipliers[beta] for beta in self._independent]
        return (*self.problem.state, *multipliers, *(f"mu{k}" for k in range(1, self._added + 1)))

    @property
    def t0(self) -> float:
        """The initial time."""
        return self._start.t

    @property
    def y0(self) -> Floats:
        """The initial y, consistent."""
        return np.concatenate([self._start.state, self._start.multipliers[self._independent], np.zeros(self._added)])

    @property
    def yp0(self) -> Floats:
        """The consistent initial y', with zeros for the algebraic components."""
        velocities, others = self._start.state[self._n :], np.zeros(len(self._independent) + self._added)
        return np.concatenate([velocities, self._start.accelerations, others])

    @cached_property
    def _start(self) -> Point:
        return motion_at(self.problem, self.equations, *state_at(self.problem, None))

    @property
    def algebraic(self) -> NDArray[np.bool_]:
        """True for algebraic components, whose derivatives do not enter.

        Beyond index 1 solvers should leave them out of their error test.
        """
        return np.arange(len(self.names)) >= 2 * self._n

    def residual(self, t: float, y: ArrayLike, yp: ArrayLike) -> Floats:
        """Return the residual F(t, y, y').

        Parameters
        ----------
        t : float
            Time, in the scene's unit.
        y : array_like, shape (N,)
            Components in the order of `names`.
        yp : array_like, shape (N,)
            Their time derivatives.

        Returns
        -------
        ndarray, shape (N,)
        """
        (q, v, _, mu), (q_rate, *_), here = self._evaluated(t, y, yp)
        rows = [q_rate - v, here["equation"], here[CONSTRAINT_FORM[self.index]]]
        if self.index is Index.GGL:
            rows[0] = rows[0] - here["constraint_by_q"].T @ mu
            rows.append(here["constraint"])
        return np.concatenate(rows)

    def jacobian(self, t: float, y: ArrayLike, yp: ArrayLike, factor: float = 0.0) -> Floats:
        """Return dF/dy + factor*dF/dy', as IDA and DASSL take it.

        Parameters
        ----------
        t : float
            Time, in the scene's unit.
        y : array_like, shape (N,)
            Components in the order of `names`.
        yp : array_like, shape (N,)
            Their time derivatives.
        factor : float
            Factor of dF/dy', per unit of time.

        Returns
        -------
        ndarray, shape (N, N)
        """
        (*_, mu), _, here = self._evaluated(t, y, yp)
        n, g, h = self._n, len(self._independent), self._added
        J, form = here["constraint_by_q"], CONSTRAINT_FORM[self.index]
        parts = [
            [factor * np.eye(n), -np.eye(n), np.zeros((n, g))],
            [here["equation_by_q"], here["equation_by_v"] + factor * here["equation_by_a"], -J.T],
            [here[f"{form}_by_q"], here[f"{form}_by_v"] + factor * here[f"{form}_by_a"], np.zeros((g, g))],
        ]
        if h:
            parts[0][0] = parts[0][0] - self._curvature(t, y, yp, mu)
            parts = [[*row, np.zeros((len(row[0]), h))] for row in parts]
            parts[0][-1] = -J.T
            parts.append([J, np.zeros((h, n + g + h))])
        return np.block(parts)

    def _curvature(self, t: float, y: ArrayLike, yp: ArrayLike, mu: Floats) -> Floats:
        """Return d(J^T mu)/dq.

        The multipliers enter the equations of motion by -J^T lambda alone.
        """
        found = []
        for multipliers in (np.zeros_like(mu), mu):
            changed = np.array(y, dtype=float)
            changed[2 * self._n : 2 * self._n + len(mu)] = multipliers
            found.append(self._evaluated(t, changed, yp)[2]["equation_by_q"])
        return found[0] - found[1]

    @property
    def _n(self) -> int:
        return len(self.equations.coordinates)

    @property
    def _independent(self) -> list[int]:
        return list(self.problem.independent)

    @property
    def _added(self) -> int:
        """Number of multipliers mu."""
        return len(self._independent) if self.index is Index.GGL else 0

    def _evaluated(
        self, t: float, y: ArrayLike, yp: ArrayLike
    ) -> tuple[list[Floats], list[Floats], Mapping[str, Floats]]:
        """Return the parts q, v, lambda, mu of y and of y', and the evaluated equations.

        The gradients of the equations are included.
        """
        require_law_at(self.problem, t)
        ends = np.cumsum([self._n, self._n, len(self._independent)])
        parts, rates = (np.split(np.asarray(each, dtype=float), ends) for each in (y, yp))
        multipliers = np.zeros(len(self.equations.multipliers))
        multipliers[self._independent] = parts[2]
        state = np.concatenate(parts[:2])
        point = Point(t, state, rates[1], multipliers, self.equations.controls_at(t))
        return parts, rates, self.equations.at(point, self._independent)
