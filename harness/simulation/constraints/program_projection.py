"""The projection program at work: the nearest state that keeps the constraints, and how far away it is.

One step of Newton's method for the position, then one for the velocity at the new position, in one function: what is
left of the residuals is of second order in them. Until compiling that pays, NumPy carries the program out, or, where
the program is long, LAPACK solves the same equations from the matrices.
"""

from functools import partial
from typing import Any

import numpy as np

from ...program.heyoka_function import COMPACT_FROM, heyoka_expressions, import_heyoka
from ...program.motion_problem import MotionProblem, computing
from ...program.numpy_function import NumpyFunction
from ...program.precision import Precision
from ..evaluation import OPERATION, CompiledIfItPays, Evaluation, Numbers, as_floats, may_wait, zeros
from ..inputs import Inputs, named_inputs
from ..matrices import MotionMatrices, Vector
from ..parts_of_scipy import lapack

SOLVED, SOLVED_UNKNOWN = 5e-5, 5e-11  # seconds that LAPACK takes for a solve, and for the cube of its unknowns
CALLED = 5e-5  # seconds that NumPy takes for a projection, beside its operations


class ProgramProjection:
    """Projects states in the mass metric, by the pivots of the motion program.

    Parameters
    ----------
    matrices : MotionMatrices
        Of the same motion.
    waits : bool
        Whether to compile it only if that pays.
    """

    def __init__(
        self, problem: MotionProblem, precision: Precision, matrices: MotionMatrices, waits: bool = True
    ) -> None:
        if waits and may_wait(problem, problem.projection, precision):
            build = partial(_compiled_if_it_pays, problem, precision, matrices)
        else:
            build = partial(nearest_state, problem, precision, opt_level=0)
        self._nearest = problem.once(("projection", precision.name), problem.projection, build)
        self._inputs = zeros(precision, 1 + len(problem.state) + len(problem.open_inputs))
        self._moving, self._open = slice(1, 1 + len(problem.state)), slice(1 + len(problem.state), None)
        self._values, self._lasting = Inputs(problem, precision).open_values, not problem.tables
        self._sizes = matrices.nominal.state
        self._inputs[self._open] = self._values(precision.number(problem.start["t"]), "right")

    def project(self, instant: Any, state: Numbers) -> float:
        """Move a state, in place, to the nearest one that keeps the constraints.

        Parameters
        ----------
        state : ndarray, shape (2n,)

        Returns
        -------
        float
            How far, by `distance`.
        """
        self._inputs[0] = instant
        self._inputs[self._moving] = state
        if not self._lasting:
            self._inputs[self._open] = self._values(instant)
        found = self._nearest(self._inputs)
        changed = distance(state, found, self._sizes)
        state[:] = found
        return float(changed)


def _compiled_if_it_pays(problem: MotionProblem, precision: Precision, matrices: MotionMatrices) -> Evaluation:
    """From t and the state to what `nearest_state` says."""
    by_lapack = 2 * _seconds_by_lapack(problem)
    solved = by_lapack < CALLED + 2 * OPERATION * problem.projection.operations
    return CompiledIfItPays(
        lambda: _nearest_by_lapack(matrices) if solved else _nearest_by_numpy(problem),
        lambda: nearest_state(problem, precision, opt_level=0),
        2 * problem.projection.operations,
        by_lapack if solved else CALLED,
        carried_out=0 if solved else None,
    )


def _seconds_by_lapack(problem: MotionProblem) -> float:
    """Of one solve, the matrices included."""
    unknowns = len(problem.coordinates) + len(problem.independent)
    return OPERATION * problem.matrices.operations + SOLVED + SOLVED_UNKNOWN * unknowns**3


def _nearest_by_lapack(matrices: MotionMatrices) -> Evaluation:
    n = matrices.coordinates

    def nearest(inputs: Numbers) -> Numbers:
        state = inputs[1 : 1 + 2 * n].copy()
        for moved, residual in ((slice(n), "residual"), (slice(n, 2 * n), "residual_rate")):
            at = matrices.independent(inputs[0], state)
            g = len(at.jacobian)
            bordered = np.block([[at.mass, at.jacobian.T], [at.jacobian, np.zeros((g, g))]])
            solution, singular = lapack().dgesv(bordered, np.append(np.zeros(n), -getattr(at, residual)))[2:]
            state[moved] += np.nan if singular else solution[:n]
        return state

    return nearest


def _nearest_by_numpy(problem: MotionProblem) -> Evaluation:
    function, n = NumpyFunction(problem.projection), len(problem.coordinates)
    inputs_of = Inputs(problem)
    rows = {name: row for row, name in enumerate(function.outputs)}
    position, velocity = (
        [rows[f"{kind}_correction[{index}]"] for index in range(1, n + 1)] for kind in ("position", "velocity")
    )

    def nearest(inputs: Numbers) -> Numbers:
        given = inputs_of(inputs[0], inputs[1:, None])
        moved = given.copy()
        moved[1 : 1 + n] += function.at_points(given)[position]
        moved[1 + n : 1 + 2 * n] += function.at_points(moved)[velocity]
        return moved[1 : 1 + 2 * n, 0]

    return nearest


def distance(before: Numbers, after: Numbers, sizes: Vector) -> Vector:
    """Length of a change of a state, or of k of them, relative to (s^2 + x^2)^(1/2) of each number x of nominal size s.

    Parameters
    ----------
    before, after : ndarray, shape (2n,) or (2n, k)
    sizes : ndarray, shape (2n,)
    """
    change, numbers = as_floats(after - before), as_floats(before)
    return np.linalg.norm(change.T / np.hypot(sizes, numbers.T), axis=-1)


def nearest_state(problem: MotionProblem, precision: Precision, **options: Any) -> Any:
    """Compile the projection of a state.

    Returns
    -------
    heyoka.cfunc
        From t, the state and what is open to the nearest state that keeps the constraints.
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
