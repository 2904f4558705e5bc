"""The equations of motion as f(t, y), for anyone's integrator."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..failures import ErrorKind, HolonomError
from .motion_problem import MotionProblem, require_analytic, require_law_at
from .numpy_function import NumpyFunction
from .rewriting import computing


@dataclass(frozen=True, repr=False)
class RightHandSide:
    """The function f(t, y) of dy/dt = f(t, y).

    The state y contains the coordinates, then the velocities. Arrays of states have them as columns.
    """

    problem: MotionProblem

    def __post_init__(self) -> None:
        if self.problem.motion is None:
            raise HolonomError(ErrorKind.NO_PIVOTS, detail=self.problem.obstruction)
        require_analytic(self.problem)

    def __repr__(self) -> str:
        return f"<RightHandSide of {', '.join(self.names)} from t = {self.t0:g}>"

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the components of y."""
        return self.problem.state

    @property
    def t0(self) -> float:
        """The initial time."""
        return float(self.problem.start["t"])

    @property
    def y0(self) -> NDArray[np.float64]:
        """The initial state."""
        return np.array([float(self.problem.start[name]) for name in self.names])

    @cached_property
    def _accelerations(self) -> NumpyFunction:
        program = computing(self.problem.motion, self.problem.accelerations)
        return NumpyFunction(replace(program, inputs=("t", *self.names)))

    def __call__(self, t: float, y: ArrayLike) -> NDArray[np.float64]:
        """Return the velocities and accelerations.

        Parameters
        ----------
        t : float or ndarray
            The time, or that of each state.
        y : array_like, shape (2n,) or (2n, points)
            The state.

        Returns
        -------
        ndarray
            The time derivatives, in the shape of y.

        Raises
        ------
        ValueError
            y has another number of components.
        """
        state = np.asarray(y, dtype=float)
        if state.ndim == 0 or len(state) != len(self.names):
            raise ValueError(f"shape ({len(self.names)},) or ({len(self.names)}, points) needed, not {state.shape}")
        times = np.broadcast_to(np.asarray(t, dtype=float), state.shape[1:])
        require_law_at(self.problem, times.max(initial=self.t0))
        return np.concatenate([state[len(state) // 2 :], self._accelerations([times, *state])])
