"""Instants at which a constraint may lose its gradient because a length that a control gives goes through zero.

A motion that meets such an instant exactly, a bob drawn straight up into its hinge, is as smooth there as anywhere
else: no step shrinks, and only the reaction is infinite. So these instants are found beforehand: a control changes its
sign, and there is a point q with df/dq = 0 that keeps the constraint f then. Newton's method finds it from the start.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...failures import Failure, HolonomError
from ...program.motion_problem import MotionProblem, computing
from ...program.motion_program import Name
from ...program.numpy_function import NumpyFunction
from ..advice import HardCase, advice
from ..hard_cases import Instant
from ..matrices import MotionMatrices, Vector, start_of

POINTS = 2049  # of a time span at which the controls are looked at
HALVINGS = 60  # of an interval between two of them: down to rounding
ITERATIONS = 5
SHORTLY = 1e-6  # of the way to such an instant
VANISHED = 1e-3  # of its size at the start: what is left of a gradient that runs to zero
DIFFERENCE = 1e-6  # of coordinates
NEGLIGIBLE = 1e-6  # of a gradient, or of a residual beside what the gradient makes of the way to the point


def vanishing_instants(problem: MotionProblem, matrices: MotionMatrices, end: float) -> list[float]:
    """Instants before the end of a motion at which the gradient of a constraint may vanish.

    Parameters
    ----------
    problem : MotionProblem
    matrices : MotionMatrices
    end : float

    Returns
    -------
    list of float
        In order.
    """
    start, state = start_of(problem)
    instants = zeros_of_controls(problem, start, end)
    constraints = range(len(problem.multipliers)) if instants else ()
    return sorted({t for beta in constraints for t in _without_gradient(matrices, instants, state, beta)})


def require_gradient(problem: MotionProblem, matrices: MotionMatrices, t: float, at: Instant) -> None:
    """Refuse to go on where a constraint is about to lose its gradient.

    Parameters
    ----------
    problem : MotionProblem
    matrices : MotionMatrices
    t : float
        An instant at which one may.
    at : Instant
        The motion shortly before it.

    Raises
    ------
    HolonomError
        One has lost all but a thousandth of its gradient.
    """
    left, whole = (np.linalg.norm(matrices(*when).jacobian, axis=1) for when in (at, start_of(problem)))
    lost = np.flatnonzero(left < VANISHED * whole)
    if len(lost):
        raise no_gradient(t, problem.multipliers[lost[0]])


def shortly_before(t: float, start: float) -> float:
    """An instant just before another, where the equations of motion are still regular."""
    return t - SHORTLY * (t - start)


def no_gradient(t: float, multiplier: str) -> HolonomError:
    """The refusal to follow a motion to where the gradient of a constraint vanishes."""
    place = f"{t:.10g}, where the gradient of the constraint of {multiplier} vanishes"
    return HolonomError(Failure.NO_WAY_THROUGH, detail=f"{place}: {advice(HardCase.VANISHING_LENGTH)}")


def zeros_of_controls(problem: MotionProblem, start: float, end: float) -> list[float]:
    """Instants inside a time span at which a control changes its sign.

    Parameters
    ----------
    problem : MotionProblem
    start, end : float

    Returns
    -------
    list of float
        In order.
    """
    assigned = {name for name, _ in problem.matrices.assignments}
    laws = {name: Name(name) for name in assigned if f"dot({name})" in assigned}
    if not laws:
        return []
    law = computing(replace(problem.matrices, inputs=("t",), outputs=laws), laws)
    values, grid = NumpyFunction(law), np.linspace(start, end, POINTS)
    signs = np.sign(values([grid]))
    controls, places = np.nonzero(signs[:, :-1] * signs[:, 1:] < 0)
    left, right = grid[places], grid[places + 1]
    for _ in range(HALVINGS):
        middle = (left + right) / 2
        same = np.sign(values([middle])[controls, np.arange(len(places))]) == signs[controls, places]
        left, right = np.where(same, middle, left), np.where(same, right, middle)
    touched = grid[1:-1][np.any(signs[:, 1:-1] == 0, axis=0)]
    return sorted({*map(float, right), *map(float, touched)})


def _without_gradient(matrices: MotionMatrices, instants: list[float], state: Vector, beta: int) -> Iterator[float]:
    """Those of the instants at which a constraint is kept by a point where it has no gradient."""
    first = matrices(instants[0], state)
    size, n = np.linalg.norm(first.jacobian[beta]), len(state) // 2
    point = state
    for t in instants:
        point = _critical_point(matrices, t, point, beta, NEGLIGIBLE * size)
        if point is None:
            return
        way = np.linalg.norm((point - state)[:n])
        if abs(matrices(t, point).residual[beta]) <= NEGLIGIBLE * size * way:
            yield t


def _critical_point(matrices: MotionMatrices, t: float, state: Vector, beta: int, negligible: float) -> Vector | None:
    """A state where a constraint has no gradient, by Newton's method; None where it finds none."""
    n, point = len(state) // 2, state.copy()
    moves = DIFFERENCE * np.eye(n, 2 * n)
    for _ in range(ITERATIONS):
        gradient = matrices(t, point).jacobian[beta]
        if np.linalg.norm(gradient) <= negligible:
            return point
        hessian = [(matrices(t, point + d).jacobian - matrices(t, point - d).jacobian)[beta] for d in moves]
        point[:n] -= np.linalg.lstsq(np.array(hessian) / (2 * DIFFERENCE), gradient, rcond=NEGLIGIBLE)[0]
    return None
