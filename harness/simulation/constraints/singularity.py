"""Where constraints fail: they become dependent, in a singular configuration, or one of them loses its gradient.

In the mass metric and scaled to length one, the constraints' directions have singular values. Of those that redundant
constraints leave, the least vanishes in a singular configuration, in proportion to the way that is left. A constraint
whose gradient itself runs to zero, a length that shrinks to nothing, does not show in it; that shows beside the
gradient at the start.

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
from ...program.sign_pattern import in_numbers
from ...program.table_numbers import OfTime
from ..evaluation import Numbers, as_floats
from ..hard_cases import Instant
from ..matrices import Matrices, MotionMatrices, Vector, start_of
from .directions import DEPENDENT, WeightedConstraints, rank_of, weighted_constraints
from .projection import InconsistentConstraints, settle

PROBE = 1e-4  # of their nominal sizes, the way that the coordinates go to see which constraints stay dependent
NEXT_TO = 3e-4  # of nominal sizes, the way to a singular configuration that is no way
AT_REST = 1e-8  # nominal speed below which the time, not the way, tells how near a singular configuration is
GROWN = 3.0  # times, on this way, that a singular value grows from next to a singular configuration
REACH = 2.0  # steps ahead within which a singular configuration counts as near
SMALL = 0.5  # least singular value above which none is near, however fast it falls
POINTS = 2049  # of a time span at which the controls are looked at
HALVINGS = 60  # of an interval between two of them: down to rounding
ITERATIONS = 5
SHORTLY = 1e-6  # of the way to such an instant
VANISHED = 1e-3  # of its size at the start: what is left of a gradient that runs to zero
DIFFERENCE = 1e-6  # of the nominal sizes of coordinates
NEGLIGIBLE = 1e-6  # of a gradient, or of a residual beside what the gradient makes of the way to the point


def probed(matrices: MotionMatrices, t: float, state: Vector) -> tuple[int, float]:
    """Return how many constraints are independent along the motion, and how near a singular configuration is.

    Constraints that are dependent at a state may be so everywhere, or in a singular configuration; the next state
    tells. A small way on, what was lost to a singular configuration has grown like the way, and what rounding and the
    way's curvature make of redundant constraints like its square.

    Parameters
    ----------
    state : ndarray, shape (2n,)
        It keeps the constraints.

    Returns
    -------
    int
        The rank of J on the constraints.
    float
        Time until the least singular value that counts vanishes, if it goes on so; infinite where it grows, zero so
        near a singular configuration that the state stands for one.
    """
    n, nominal = len(state) // 2, matrices.nominal
    speed = nominal.time * float(np.max(np.abs(state[n:]) / nominal.coordinates, initial=0.0))
    later, way = t + nominal.time * PROBE / max(1.0, speed), PROBE * min(1.0, speed)
    here = singular_values_at(matrices, t, state)
    moved = np.concatenate([state[:n] + (later - t) * state[n:], state[n:]])
    kept_rank = rank_of(singular_values_at(matrices, later, moved), max(way**1.5, DEPENDENT))
    try:
        there = singular_values_at(matrices, later, settle(matrices, later, moved, kept_rank)[0])
    except InconsistentConstraints:
        return rank_of(here), np.inf
    rank = max(rank_of(here), rank_of(there, max(way**1.5, DEPENDENT)))
    until = extrapolated_zero(t, least_of(here, rank), later, least_of(there, rank)) - t
    grown = least_of(there, rank) > GROWN * least_of(here, rank)
    next_to = until / nominal.time * (speed if speed > AT_REST else 1.0) < NEXT_TO
    return rank, 0.0 if grown or next_to else until


def extrapolated_zero(before: float, last: float, now: float, least: float) -> float:
    """Instant at which a singular value vanishes that goes on as between two instants; infinite where it grows."""
    return now + least * (now - before) / (last - least) if last > least else np.inf


def least_of(singular_values: Vector, rank: int) -> float:
    """Return the least singular value that counts; without constraints, one."""
    return float(singular_values[rank - 1]) if rank else 1.0


def singular_values_at(matrices: MotionMatrices, t: float, state: Vector) -> Vector:
    """Singular values of the scaled constraints at a state, the largest first."""
    return _scaled(matrices(t, state), t).singular_values()


def _scaled(at: Matrices, t: float) -> WeightedConstraints:
    if not at.finite:
        raise HolonomError(Failure.NO_WAY_ON, detail=f"{t:.10g}, where numbers overflow")
    return weighted_constraints(at.mass, at.jacobian)


class Watch:
    """Watches the constraints of a motion."""

    def __init__(self, problem: MotionProblem, matrices: MotionMatrices) -> None:
        self._names = [problem.multipliers[beta] for beta in problem.independent]
        self._matrices = matrices
        start = [float(problem.start[name]) for name in problem.state]
        self._scale = self._constraints(float(problem.start["t"]), start).scale
        self._least = 1.0

    def begin(self, t: float, state: Numbers) -> None:
        """Look at the state from which the watch goes on."""
        self._least = self.least(t, state)

    def singular_ahead(self, t: float, state: Numbers) -> bool:
        """Return True if the next steps, if they are like the last one, reach a singular configuration.

        Parameters
        ----------
        t : float
            After the step.
        state : ndarray, shape (2n,)
        """
        last, self._least = self._least, self.least(t, state)
        return self._least < SMALL and self._least < REACH * (last - self._least)

    def least(self, t: float, state: Numbers) -> float:
        """Least singular value of the constraints' directions; one where there is none."""
        return float(self._constraints(t, state).singular_values().min(initial=1.0))

    def vanished(self, t: float, state: Numbers) -> str | None:
        """Return the multiplier whose constraint has lost its gradient, if there is one."""
        left = self._scale / self._constraints(t, state).scale
        return self._names[left.argmin()] if left.min(initial=1.0) < VANISHED else None

    def _constraints(self, t: float, state: Numbers) -> WeightedConstraints:
        return _scaled(self._matrices.independent(float(t), as_floats(state)), float(t))


def vanishing_instants(problem: MotionProblem, matrices: MotionMatrices, end: float) -> list[float]:
    """Instants before the end of a motion at which the gradient of a constraint may vanish, in order."""
    start, state = start_of(problem)
    instants = zeros_of_controls(problem, start, end)
    constraints = range(len(problem.multipliers)) if instants else ()
    return sorted({t for beta in constraints for t in _without_gradient(matrices, instants, state, beta)})


def require_gradient(problem: MotionProblem, t: float, at: Instant) -> None:
    """Refuse to go on to an instant at which a constraint may lose its gradient, when it has just before."""
    left, whole = (
        np.linalg.norm(at.matrices(*when).jacobian, axis=1) for when in ((at.t, at.state), start_of(problem))
    )
    lost = np.flatnonzero(left < VANISHED * whole)
    if len(lost):
        raise no_gradient(t, problem.multipliers[lost[0]])


def shortly_before(t: float, start: float) -> float:
    """Return an instant just before another, where the equations of motion are still regular."""
    return t - SHORTLY * (t - start)


def no_gradient(t: float, multiplier: str) -> HolonomError:
    """Return the refusal to follow a motion to where the gradient of a constraint vanishes."""
    return HolonomError(Failure.NO_GRADIENT, instant=float(t), multiplier=multiplier)


def no_controls(t: float) -> HolonomError:
    """Return the refusal to follow a motion to where servo-constraints leave their controls without values."""
    reason = "the controls move what servo-constraints prescribe in fewer directions"
    return HolonomError(Failure.NO_WAY_ON, detail=f"{t:.10g}, where {reason}")


def zeros_of_controls(problem: MotionProblem, start: float, end: float) -> list[float]:
    """Instants inside a time span at which a control changes its sign, in order."""
    matrices = in_numbers(problem, problem.matrices)
    assigned = {name for name, _ in matrices.assignments}
    laws = {name: Name(name) for name in assigned if f"dot({name})" in assigned}
    if not laws:
        return []
    of_tables = (name for table in problem.tables for name in table.inputs)
    law = computing(replace(matrices, inputs=("t", *of_tables), outputs=laws), laws)
    values, grid = OfTime(law, problem.tables), np.linspace(start, end, POINTS)
    signs = np.sign(values(grid))
    controls, places = np.nonzero(signs[:, :-1] * signs[:, 1:] < 0)
    left, right = grid[places], grid[places + 1]
    for _ in range(HALVINGS):
        middle = (left + right) / 2
        same = np.sign(values(middle)[controls, np.arange(len(places))]) == signs[controls, places]
        left, right = np.where(same, middle, left), np.where(same, right, middle)
    zero = signs == 0
    touched = grid[1:-1][np.any(zero[:, 1:-1] & ~(zero[:, :-2] & zero[:, 2:]), axis=0)]  # a control may stay zero
    return sorted({*map(float, right), *map(float, touched)})


def _without_gradient(matrices: MotionMatrices, instants: list[float], state: Vector, beta: int) -> Iterator[float]:
    """Yield those of the instants at which a constraint is kept by a point where it has no gradient."""
    first, sizes = matrices(instants[0], state), matrices.nominal.coordinates
    size, n = np.linalg.norm(first.jacobian[beta] * sizes), len(state) // 2
    point = state
    for t in instants:
        point = _critical_point(matrices, t, point, beta, NEGLIGIBLE * size)
        if point is None:
            return
        way = np.linalg.norm((point - state)[:n] / sizes)
        if abs(matrices(t, point).residual[beta]) <= NEGLIGIBLE * size * way:
            yield t


def _critical_point(matrices: MotionMatrices, t: float, state: Vector, beta: int, negligible: float) -> Vector | None:
    """Return a state where a constraint has no gradient, by Newton's method; None where it finds none."""
    n, point, sizes = len(state) // 2, state.copy(), matrices.nominal.coordinates
    moves = DIFFERENCE * np.diag(matrices.nominal.state)[:n]
    for _ in range(ITERATIONS):
        gradient = matrices(t, point).jacobian[beta] * sizes
        if np.linalg.norm(gradient) <= negligible:
            return point
        hessian = [(matrices(t, point + d).jacobian - matrices(t, point - d).jacobian)[beta] * sizes for d in moves]
        point[:n] -= sizes * np.linalg.lstsq(np.array(hessian) / (2 * DIFFERENCE), gradient, rcond=NEGLIGIBLE)[0]
    return None
