"""Derivatives of the initial state by parameters and initial values.

They are the derivative of eqs. (12) and (19). Given values have given derivatives. The differentiated constraints
determine the others: J d = -r, with d least in the mass metric if it is not unique.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from ..failures import ErrorKind, HolonomError
from ..language import translatable
from ..program.differentiation import derivative_name, differentiated
from ..program.motion_problem import MotionProblem
from ..program.numpy_function import NumpyFunction
from .constraints.directions import or_one
from .evaluation import Numbers
from .initial_state import least_step
from .matrices import Matrices, MotionMatrices, start_of
from .variation import Variation, size_of

CONSISTENT = 1e-9  # residual of a differentiated constraint: of its terms, if all values move as far as one does
RESIDUALS = "residual", "residual_rate"


class ConstraintVariation:
    """Derivatives of f and df/dt by the state and the directions.

    Parameters
    ----------
    problem : MotionProblem
        Without signs.
    """

    def __init__(self, problem: MotionProblem, directions: Sequence[str]) -> None:
        self._g = len(problem.multipliers)
        outputs = [f"{name}[{beta}]" for name in RESIDUALS for beta in range(1, self._g + 1)]
        self._variation = Variation(problem, problem.matrices, outputs, directions) if outputs else None

    def __call__(self, t: float, state: Numbers, moves: Numbers) -> tuple[Numbers, Numbers]:
        """Return the changes of f and of df/dt, each of shape (g, p).

        The moves have shape (2n, p).
        """
        if self._variation is None:
            return (np.zeros((0, moves.shape[1])),) * 2
        found = self._variation(np.array([t]), state[:, None], moves[:, :, None])[:, :, 0]
        return found[: self._g], found[self._g :]


def initial_tangents(problem: MotionProblem, analytic: MotionProblem, directions: Sequence[str]) -> Numbers:
    """Return the derivatives of the initial state in directions.

    Parameters
    ----------
    problem, analytic : MotionProblem
        The motion, and the same one without signs, as it begins.
    directions : sequence of str
        Parameters, by their `size_of`. Coordinates and velocities, whose initial values move by one.

    Returns
    -------
    ndarray, shape (2n, p)

    Raises
    ------
    HolonomError
        The initial state cannot be adapted to the parameters.
    """
    t, state = start_of(problem)
    n = len(problem.coordinates)
    constraints, matrices = ConstraintVariation(analytic, directions), MotionMatrices(analytic)
    here, moves = matrices(t, state), _data(problem, directions)
    for half, sizes in enumerate(np.split(matrices.nominal.state, 2)):
        for k, name in enumerate(directions):
            column = moves[half * n :][:n, k]
            for free in _free(problem, half, name):
                _require_unique(problem, here, sizes, free, name)
                missed = constraints(t, state, moves)[half][:, k]
                column[free] += _least(here, missed, free)
                largest = sizes * np.max(np.abs(column) / sizes)
                terms = np.abs(here.jacobian) @ largest + np.abs(missed)
                if (np.abs(constraints(t, state, moves)[half][:, k]) <= CONSISTENT * terms).all():
                    break
            else:
                reason = translatable("the constraints do not let the initial values follow %(name)s", name=name)
                raise HolonomError(ErrorKind.NO_INITIAL_STATE, problem.scene, reason)
    return moves


def _data(problem: MotionProblem, directions: Sequence[str]) -> Numbers:
    """Return derivatives of the given values and of the guesses, shape (2n, p)."""
    moves = np.zeros((len(problem.state), len(directions)))
    for k, name in enumerate(directions):
        if name in problem.state:
            moves[problem.state.index(name), k] = 1.0
    start = problem.initial.parametric
    parameters = [name for name in directions if name in problem.parameters]
    if not parameters:
        return moves
    if start.obstruction is not None:
        raise HolonomError(ErrorKind.NO_INITIAL_STATE, problem.scene, start.obstruction)
    seeds = {name: {name: size_of(problem, name)} for name in parameters}
    program = differentiated(start.program, seeds)
    found = dict(zip(program.outputs, NumpyFunction(program)(problem.numbers), strict=True))
    for name in parameters:
        moves[:, directions.index(name)] = [found[derivative_name(each, name)] for each in problem.state]
    return moves


def _free(problem: MotionProblem, half: int, direction: str) -> Iterator[NDArray[np.int64]]:
    """Yield places in a half of the state that the constraints may change.

    First they are the values that the scene does not give. If these are not enough for an initial value, they are all
    but this value.
    """
    n = len(problem.coordinates)
    others = [(s, name) for s, name in enumerate(problem.state[half * n :][:n]) if name != direction]
    yield np.array([s for s, name in others if name not in problem.initial.given], dtype=int)
    if direction in problem.state:
        yield np.array([s for s, _ in others], dtype=int)


def _require_unique(
    problem: MotionProblem, at: Matrices, sizes: Numbers, free: NDArray[np.int64], direction: str
) -> None:
    """Reject an initial state that is the nearest of many to an inconsistent guess.

    It moves with the curvature of the constraints, too.
    """
    if direction in problem.state or problem.initial.moved is None or float(problem.initial.moved[1]) == 0:
        return
    jacobian = (at.jacobian * sizes)[:, free]
    if np.linalg.matrix_rank(jacobian / or_one(np.linalg.norm(jacobian, axis=1))[:, None]) < len(free):
        reason = translatable("it is the nearest of many to initial_guess; give more of it in initial_state")
        raise HolonomError(ErrorKind.NO_INITIAL_STATE, problem.scene, reason)


def _least(at: Matrices, missed: Numbers, free: NDArray[np.int64]) -> Numbers:
    """Return the least move of some places that corrects residuals of shape (g,).

    It is least in the mass metric.
    """
    touched = np.flatnonzero((at.jacobian[:, free] != 0).any(axis=1))
    if not len(touched):
        return np.zeros(len(free))
    mass, jacobian = at.mass[np.ix_(free, free)], at.jacobian[np.ix_(touched, free)]
    redundant = bool(np.linalg.matrix_rank(jacobian) < len(touched))  # as where more is given than is needed
    return least_step(mass[..., None], jacobian[..., None], missed[touched, None], redundant)[:, 0]
