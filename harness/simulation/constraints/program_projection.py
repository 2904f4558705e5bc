"""Projection onto the constraints by the projection program, and its distance.

One step of Newton's method for the position and one for the velocity at the new position form one function. The
remaining residuals are of second order. The function is compiled when it is first needed.
"""

from functools import cached_property, partial
from typing import Any

import numpy as np

from ...program.heyoka_function import COMPACT_FROM, heyoka_expressions, import_heyoka
from ...program.motion_problem import MotionProblem, computing
from ...program.precision import Precision
from ..evaluation import Evaluation, Numbers, as_floats, zeros
from ..inputs import Inputs, named_inputs
from ..nominal import Vector, nominal_of


class ProgramProjection:
    """Projects states in the mass metric, by the pivots of the motion program."""

    def __init__(self, problem: MotionProblem, precision: Precision) -> None:
        self._problem, self._precision, self._sizes = problem, precision, nominal_of(problem).state
        self._inputs = zeros(precision, 1 + len(problem.state) + len(problem.open_inputs))
        self._moving, self._open = slice(1, 1 + len(problem.state)), slice(1 + len(problem.state), None)
        self._values, self._lasting = Inputs(problem, precision).open_values, not problem.tables
        self._inputs[self._open] = self._values(precision.number(problem.start["t"]), "right")

    @cached_property
    def nearest(self) -> Evaluation:
        """Return the function from t, the state and open inputs to the nearest state."""
        build = partial(nearest_state, self._problem, self._precision, opt_level=0)
        return self._problem.once(("projection", self._precision.name), self._problem.projection, build)

    def project(self, time: Any, state: Numbers) -> float:
        """Move a state, in place, to the nearest one that satisfies the constraints.

        Parameters
        ----------
        time : number
            Time of the state.
        state : ndarray, shape (2n,)
            Coordinates, then velocities. Changed in place.

        Returns
        -------
        float
            The way that the state has moved, by `distance`.
        """
        self._inputs[0] = time
        self._inputs[self._moving] = state
        if not self._lasting:
            self._inputs[self._open] = self._values(time)
        found = self.nearest(self._inputs)
        changed = distance(state, found, self._sizes)
        state[:] = found
        return float(changed)


def distance(before: Numbers, after: Numbers, sizes: Vector) -> Vector:
    """Return the length of a change of one state or of k states.

    It is relative to (s^2 + x^2)^(1/2) of each number x of nominal size s.

    Parameters
    ----------
    before, after : ndarray, shape (2n,) or (2n, k)
        Coordinates, then velocities.
    sizes : ndarray, shape (2n,)
        Nominal sizes.

    Returns
    -------
    float or ndarray, shape (k,)
        Dimensionless.
    """
    change, numbers = as_floats(after - before), as_floats(before)
    return np.linalg.norm(change.T / np.hypot(sizes, numbers.T), axis=-1)


def nearest_state(problem: MotionProblem, precision: Precision, **options: Any) -> Any:
    """Compile the projection of a state.

    Parameters
    ----------
    problem : MotionProblem
        A motion with a projection program.
    precision : Precision
        Numbers of the function.
    **options : object
        Further options of ``heyoka.cfunc``.

    Returns
    -------
    heyoka.cfunc
        From t, the state and what is open to the nearest state that satisfies the constraints.
    """
    heyoka = import_heyoka()
    variables = {name: heyoka.expression(name) for name in ("t", *problem.state, *problem.open_inputs)}
    t, *rest = variables.values()
    state, open_values = rest[: len(problem.state)], rest[len(problem.state) :]
    inputs = named_inputs(problem, t, state, heyoka.expression(precision.number("0")), open_values)
    velocities = problem.state[len(problem.coordinates) :]
    position = {**inputs, **_corrected(problem, "position_correction", problem.coordinates, inputs, precision)}
    both = {**position, **_corrected(problem, "velocity_correction", velocities, position, precision)}
    return heyoka.cfunc(
        [both[name] for name in problem.state],
        vars=list(variables.values()),
        compact_mode=problem.projection.operations >= COMPACT_FROM,
        **precision.options,
        **options,
    )


def _corrected(
    problem: MotionProblem, correction: str, names: tuple[str, ...], inputs: dict[str, Any], precision: Precision
) -> dict[str, Any]:
    outputs = [f"{correction}[{index}]" for index in range(1, len(names) + 1)]
    found = heyoka_expressions(computing(problem.projection, set(outputs)), inputs, precision.ratio)
    return {name: inputs[name] + found[output] for name, output in zip(names, outputs, strict=True)}
