"""Failure of constraints: singular configurations and vanishing gradients.

In the mass metric and scaled to length one, the directions of the constraints have singular values. Without those of
redundant constraints, the least one vanishes in a singular configuration, in proportion to the distance. A constraint
whose gradient itself vanishes, such as a length that shrinks to zero, is not detected by it. Its gradient is compared
with the one at the initial time.

A motion that meets such a time exactly, a bob drawn straight up into its hinge, is as smooth there as anywhere else: no
step shrinks, and only the reaction is infinite. So these times are found beforehand: a control vanishes, and there is a
point q with df/dq = 0 that satisfies the constraint f then. Newton's method finds it from the initial state.
"""

from collections.abc import Collection, Iterator
from dataclasses import replace

import numpy as np

from ...failures import ErrorKind, HolonomError
from ...language import translatable
from ...program.motion_problem import MotionProblem
from ...program.motion_program import Name
from ...program.rewriting import computing
from ...program.sign_pattern import program_with_values
from ...program.table_numbers import TimeFunction
from ..evaluation import Evaluation, Numbers, as_floats
from ..matrices import Matrices, MotionMatrices, Vector, start_of
from ..place_and_reason import OVERFLOW, place_and_reason
from .directions import DEPENDENT, WeightedConstraints, rank_of, weighted_constraints
from .projection import InconsistentConstraints, settle

PROBE = 1e-4  # of their nominal sizes, the way that the coordinates go to see which constraints stay dependent
NEXT_TO = 3e-4  # distance to a singular configuration that counts as zero, relative to nominal sizes
AT_REST = 1e-8  # nominal speed below which time, not distance, measures how near a singular configuration is
GROWN = 3.0  # times, on this way, that a singular value grows from next to a singular configuration
REACH = 2.0  # steps ahead within which a singular configuration counts as near
SMALL = 0.5  # least singular value above which none is near, however fast it falls
POINTS = 2049  # of a time span at which the controls are looked at
HALVINGS = 60  # of an interval between two of them: down to rounding
TOUCHED = 1e-9  # of a control at the next of these times: its least size is a zero
ITERATIONS = 5
SHORTLY = 1e-6  # of the way to such a time
VANISHED = 1e-3  # of its size at the initial time: what is left of a gradient that runs to zero
DIFFERENCE = 1e-6  # of the nominal sizes of coordinates
NEGLIGIBLE = 1e-6  # of a gradient, or of a residual relative to the gradient times the distance to the point


def probed(matrices: MotionMatrices, t: float, state: Vector) -> tuple[int, float]:
    """Return the rank of the constraints and the distance to a singular configuration.

    Constraints that are dependent at a state may be dependent everywhere, or only in a singular configuration. The next
    state decides. A small distance further, the singular value of a singular configuration has grown like the distance,
    and the one of redundant constraints, due to rounding and curvature, like its square.

    Parameters
    ----------
    matrices : MotionMatrices
        Matrices of the motion.
    t : float
        Time of the state.
    state : ndarray, shape (2n,)
        It satisfies the constraints.

    Returns
    -------
    int
        The rank of J on the constraints.
    float
        Time until the least singular value that counts vanishes, if it continues so, infinite where it grows, zero so
        near a singular configuration that the state counts as one.
    """
    n, nominal = len(state) // 2, matrices.nominal
    speed = nominal.time * float(np.max(np.abs(state[n:]) / nominal.coordinates, initial=0.0))
    later, way = t + nominal.time * PROBE / max(1.0, speed), PROBE * min(1.0, speed)
    here = singular_values_at(matrices, t, state)
    moved = np.concatenate([state[:n] + (later - t) * state[n:], state[n:]])
    rank_before = rank_of(singular_values_at(matrices, later, moved), max(way**1.5, DEPENDENT))
    try:
        there = singular_values_at(matrices, later, settle(matrices, later, moved, rank_before)[0])
    except InconsistentConstraints:
        return rank_of(here), np.inf
    rank = max(rank_of(here), rank_of(there, max(way**1.5, DEPENDENT)))
    until = extrapolated_zero(t, least_of(here, rank), later, least_of(there, rank)) - t
    grown = least_of(there, rank) > GROWN * least_of(here, rank)
    next_to = until / nominal.time * (speed if speed > AT_REST else 1.0) < NEXT_TO
    return rank, 0.0 if grown or next_to else until


def extrapolated_zero(before: float, last: float, now: float, least: float) -> float:
    """Return the time of the zero of a singular value, extrapolated from two times.

    Parameters
    ----------
    before : float
        The earlier time.
    last : float
        Singular value at the earlier time.
    now : float
        The later time.
    least : float
        Singular value at the later time.

    Returns
    -------
    float
        Infinite if the value grows.
    """
    return now + least * (now - before) / (last - least) if last > least else np.inf


def least_of(singular_values: Vector, rank: int) -> float:
    """Return the smallest relevant singular value, one without constraints.

    Parameters
    ----------
    singular_values : ndarray
        The largest first.
    rank : int
        How many of them count.

    Returns
    -------
    float
    """
    return float(singular_values[rank - 1]) if rank else 1.0


def singular_values_at(matrices: MotionMatrices, t: float, state: Vector) -> Vector:
    """Return the singular values of the scaled constraints at a state.

    Parameters
    ----------
    matrices : MotionMatrices
        Matrices of the motion.
    t : float
        Time of the state.
    state : ndarray, shape (2n,)
        Coordinates, then velocities.

    Returns
    -------
    ndarray
        The largest first.
    """
    return _scaled(matrices(t, state), t).singular_values()


def _scaled(at: Matrices, t: float) -> WeightedConstraints:
    if not at.finite:
        raise HolonomError(ErrorKind.NO_WAY_ON, detail=place_and_reason(t, OVERFLOW))
    return weighted_constraints(at.mass, at.jacobian)


class Watch:
    """Watches the constraints of a motion.

    Attributes
    ----------
    chosen_alone : bool
        Whether the constraints that the program solves are the only ones that the last step brought nearer to
        dependence, while all of them together keep their rank.
    """

    def __init__(self, problem: MotionProblem, matrices: MotionMatrices) -> None:
        self._names = [problem.multipliers[beta] for beta in problem.independent]
        self._redundant = len(self._names) < len(problem.multipliers)
        self._matrices = matrices
        self._scale = self._constraints(*start_of(problem)).scale
        self._least = self._least_of_all = 1.0
        self.chosen_alone = False

    def begin(self, t: float, state: Numbers) -> None:
        """Record the state from which the search continues.

        Parameters
        ----------
        t : float
            Time of the state.
        state : ndarray, shape (2n,)
            Coordinates, then velocities.
        """
        self._least = self.least(t, state)
        self._least_of_all = self._of_all(t, state)

    def singular_ahead(self, t: float, state: Numbers) -> bool:
        """Return True if the next steps will reach a singular configuration.

        They are taken to be like the last one.

        Parameters
        ----------
        t : float
            Time after the step.
        state : ndarray, shape (2n,)
            State after the step.

        Returns
        -------
        bool
        """
        last, self._least = self._least, self.least(t, state)
        last_of_all, self._least_of_all = self._least_of_all, self._of_all(t, state)
        self.chosen_alone = self._redundant and not _vanishes(last_of_all, self._least_of_all)
        return _vanishes(last, self._least)

    def least(self, t: float, state: Numbers) -> float:
        """Return the least singular value of the constraints' directions.

        Parameters
        ----------
        t : float
            Time of the state.
        state : ndarray, shape (2n,)
            Coordinates, then velocities.

        Returns
        -------
        float
            One without constraints.
        """
        return float(self._constraints(t, state).singular_values().min(initial=1.0))

    def _of_all(self, t: float, state: Numbers) -> float:
        """Return the least relevant singular value of all constraints."""
        if not self._redundant:
            return self._least
        return least_of(singular_values_at(self._matrices, float(t), as_floats(state)), len(self._names))

    def vanished(self, t: float, state: Numbers) -> str | None:
        """Return the multiplier whose constraint has lost its gradient, if there is one.

        Parameters
        ----------
        t : float
            Time of the state.
        state : ndarray, shape (2n,)
            Coordinates, then velocities.

        Returns
        -------
        str or None
            Name of the multiplier.
        """
        left = self._scale / self._constraints(t, state).scale
        return self._names[left.argmin()] if left.min(initial=1.0) < VANISHED else None

    def _constraints(self, t: float, state: Numbers) -> WeightedConstraints:
        return _scaled(self._matrices.independent(float(t), as_floats(state)), float(t))


def _vanishes(last: float, least: float) -> bool:
    """Return True if a singular value will vanish within the next steps."""
    return least < SMALL and least < REACH * (last - least)


def laws_of(problem: MotionProblem) -> tuple[str, ...]:
    """Return the controls whose laws are in the programs, in order.

    Parameters
    ----------
    problem : MotionProblem
        The motion, without numbers for its signs: a rate that is a number then is no longer in its programs.

    Returns
    -------
    tuple of str
    """
    assigned = {name for name, _ in problem.matrices.assignments}
    return tuple(name for name, _ in problem.matrices.assignments if f"dot({name})" in assigned)


class VanishingGradients:
    """The times at which the gradient of a constraint may vanish.

    Parameters
    ----------
    problem : MotionProblem
        The motion, whose start gives the size of each gradient.
    matrices : MotionMatrices
        Matrices of the same motion.
    controls : collection of str
        As for `zeros_of_controls`.
    end : float
        Last time of the search, which begins with the motion.

    Attributes
    ----------
    times, stops : list of float
        These times in order, and those just before them, with regular equations of motion.
    """

    def __init__(self, problem: MotionProblem, matrices: MotionMatrices, controls: Collection[str], end: float) -> None:
        self._problem, self._matrices, (start, state) = problem, matrices, start_of(problem)
        zeros = zeros_of_controls(problem, controls, start, end)
        constraints = range(len(problem.multipliers)) if zeros else ()
        self.times = sorted({t for beta in constraints for t in _without_gradient(matrices, zeros, state, beta)})
        self.stops = [t - SHORTLY * (t - start) for t in self.times]

    def require(self, stop: float, state: Vector) -> None:
        """Reject a state at one of the stops at which a constraint loses its gradient.

        Parameters
        ----------
        stop : float
            Time of the state.
        state : ndarray, shape (2n,)
            Coordinates, then velocities.

        Raises
        ------
        HolonomError
            A gradient has vanished.
        """
        sizes = self._matrices.nominal.coordinates
        left, whole = (
            np.linalg.norm(self._matrices(*at).jacobian * sizes, axis=1)
            for at in ((stop, state), start_of(self._problem))
        )
        lost = np.flatnonzero(left < VANISHED * whole)
        if len(lost):
            time = self.times[self.stops.index(stop)]
            raise HolonomError(ErrorKind.NO_GRADIENT, time=time, multiplier=self._problem.multipliers[lost[0]])


def no_controls(t: float) -> HolonomError:
    """Return the error for a time at which servo-constraints determine no controls.

    Parameters
    ----------
    t : float
        The time.

    Returns
    -------
    HolonomError
    """
    reason = translatable("the controls move what servo-constraints prescribe in fewer directions")
    return HolonomError(ErrorKind.NO_WAY_ON, detail=place_and_reason(t, reason))


def zeros_of_controls(problem: MotionProblem, controls: Collection[str], start: float, end: float) -> list[float]:
    """Return the times of zeros of a control inside a time span, in order.

    Parameters
    ----------
    problem : MotionProblem
        The motion, whose controls are functions of the time.
    controls : collection of str
        Names of the controls, as `laws_of`. Those without an assignment are numbers.
    start : float
        First time of the search.
    end : float
        Last time of the search.

    Returns
    -------
    list of float
    """
    assigned = {name for name, _ in problem.matrices.assignments}
    laws = {name: Name(name) for name in controls if name in assigned}
    if not laws:
        return []
    of_tables = (name for table in problem.tables for name in table.inputs)
    law = program_with_values(problem, computing(replace(problem.matrices, outputs=laws), laws))
    law = replace(law, inputs=("t", *of_tables))
    function, grid = TimeFunction(law, problem.tables), np.linspace(start, end, POINTS)
    values = function(grid)
    zero = values == 0
    sampled = grid[1:-1][np.any(zero[:, 1:-1] & ~(zero[:, :-2] & zero[:, 2:]), axis=0)]  # a control may stay zero
    found = *_sign_changes(function, grid, values), *_touched(function, grid, values), *sampled
    return sorted({float(t) for t in found})


def _sign_changes(function: Evaluation, grid: Vector, values: Numbers) -> Vector:
    """Return the times between samples at which values change their sign."""
    signs = np.sign(values)
    controls, places = np.nonzero(signs[:, :-1] * signs[:, 1:] < 0)
    left, right = grid[places], grid[places + 1]
    for _ in range(HALVINGS if len(places) else 0):
        middle = (left + right) / 2
        same = np.sign(function(middle)[controls, np.arange(len(places))]) == signs[controls, places]
        left, right = np.where(same, middle, left), np.where(same, right, middle)
    return right


def _touched(function: Evaluation, grid: Vector, values: Numbers) -> Vector:
    """Return the times between samples of one sign at which values touch zero.

    The least size is found by taking thirds.
    """
    before, size, after = (np.abs(values[:, first : first + POINTS - 2]) for first in range(3))
    changes = np.sign(values[:, :-1]) != np.sign(values[:, 1:])
    largest = np.maximum(before, after)
    least = (size <= np.minimum(before, after)) & (size < largest)
    controls, places = np.nonzero(least & ~changes[:, :-1] & ~changes[:, 1:])
    left, right, row = grid[places], grid[places + 2], np.arange(len(places))
    for _ in range(HALVINGS if len(places) else 0):
        third = (right - left) / 3
        low, high = (np.abs(function(t)[controls, row]) for t in (left + third, right - third))
        left, right = np.where(low > high, left + third, left), np.where(low > high, right, right - third)
    return right[np.abs(function(right)[controls, row]) <= TOUCHED * largest[controls, places]]


def _without_gradient(matrices: MotionMatrices, times: list[float], state: Vector, beta: int) -> Iterator[float]:
    """Yield the times at which a point without gradient satisfies a constraint."""
    first, sizes = matrices(times[0], state), matrices.nominal.coordinates
    size, n = np.linalg.norm(first.jacobian[beta] * sizes), len(state) // 2
    point = state
    for t in times:
        point = _critical_point(matrices, t, point, beta, NEGLIGIBLE * size)
        if point is None:
            return
        way = np.linalg.norm((point - state)[:n] / sizes)
        if abs(matrices(t, point).residual[beta]) <= NEGLIGIBLE * size * way:
            yield t


def _critical_point(matrices: MotionMatrices, t: float, state: Vector, beta: int, negligible: float) -> Vector | None:
    """Return a state without a gradient of a constraint, found by Newton's method.

    None if the method fails.
    """
    n, point, sizes = len(state) // 2, state.copy(), matrices.nominal.coordinates
    moves = DIFFERENCE * np.diag(matrices.nominal.state)[:n]
    for _ in range(ITERATIONS):
        gradient = matrices(t, point).jacobian[beta] * sizes
        if np.linalg.norm(gradient) <= negligible:
            return point
        hessian = [(matrices(t, point + d).jacobian - matrices(t, point - d).jacobian)[beta] * sizes for d in moves]
        point[:n] -= sizes * np.linalg.lstsq(np.array(hessian) / (2 * DIFFERENCE), gradient, rcond=NEGLIGIBLE)[0]
    return None
