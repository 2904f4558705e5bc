"""The projection program at work: the nearest state that keeps the constraints, and how far away it is.

One step of Newton's method for the position, then one for the velocity at the new position, compiled into one function:
what is left of the residuals is of second order in them.
"""

from typing import Any

import numpy as np

from harness.motion.heyoka_function import COMPACT_FROM, heyoka_expressions, import_heyoka
from harness.motion.precision import Precision
from harness.motion.problem import MotionProblem, computing
from harness.simulation.evaluation import Numbers, zeros


class ConstraintKeeper:
    """Projects states in the mass metric, by the pivots of the motion program.

    Parameters
    ----------
    problem : MotionProblem
        Without an obstacle.
    precision : Precision
    """

    def __init__(self, problem: MotionProblem, precision: Precision) -> None:
        self._nearest = _nearest_state(problem, precision)
        self._inputs = zeros(precision, 1 + len(problem.state))
        self._one = precision.number("1")

    def project(self, instant: Any, state: Numbers) -> None:
        """Move a state, in place, to the nearest one that keeps the constraints.

        Parameters
        ----------
        instant : number
        state : ndarray, shape (2n,)
        """
        self._inputs[0] = instant
        self._inputs[1:] = state
        self._nearest(self._inputs, outputs=state)

    def project_if(self, instant: Any, state: Numbers, allowed: float) -> bool:
        """Project a state if it is far from the constraints, and say so.

        Parameters
        ----------
        instant : number
        state : ndarray, shape (2n,)
        allowed : float
            Change of a coordinate or a velocity, relative to it where it is larger than one, that may stay undone.

        Returns
        -------
        bool
        """
        before = state.copy()
        self.project(instant, state)
        change = np.abs(state - before) / np.maximum(np.abs(before), self._one)
        far = not float(np.max(change)) <= allowed
        if not far:
            state[:] = before
        return far


def _nearest_state(problem: MotionProblem, precision: Precision) -> Any:
    """Function of t and the state to the projected state, compiled by heyoka."""
    heyoka = import_heyoka()
    variables = {name: heyoka.expression(name) for name in ("t", *problem.state)}
    inputs = {**variables, **dict.fromkeys(problem.multipliers, heyoka.expression(precision.number("0")))}
    velocities = problem.state[len(problem.coordinates) :]
    position = {**inputs, **_corrected(problem, "position_correction", problem.coordinates, inputs, precision)}
    both = {**position, **_corrected(problem, "velocity_correction", velocities, position, precision)}
    return heyoka.cfunc(
        [both[name] for name in problem.state],
        vars=list(variables.values()),
        compact_mode=problem.projection.operations >= COMPACT_FROM,
        opt_level=0,
        **precision.options,
    )


def _corrected(
    problem: MotionProblem, correction: str, names: tuple[str, ...], inputs: dict[str, Any], precision: Precision
) -> dict[str, Any]:
    outputs = [f"{correction}[{index}]" for index in range(1, len(names) + 1)]
    found = heyoka_expressions(computing(problem.projection, set(outputs)), inputs, precision.ratio)
    return {name: inputs[name] + found[output] for name, output in zip(names, outputs, strict=True)}
