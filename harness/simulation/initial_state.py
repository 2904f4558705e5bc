"""Initial states for many parameter values: eqs. (12) and (19) numerically.

Given values are evaluated. The constraints determine the others by Newton's method, with the least corrections in the
mass metric or the only ones, by `maxima/program/parametric_start.mac`. Data of limited digits that violate a constraint
by less than a share of 1e-9 are corrected in the same way. `maxima/general/initial_state.mac` does the same to 60
digits for one motion.
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from math import log10
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..described import Correction
from ..failures import ErrorKind, HolonomError
from ..language import translatable
from ..options import LARGEST_EXPONENT
from ..program.motion_problem import DependsOn, MotionProblem, Origin
from ..program.rewriting import computing
from ..program.sign_pattern import at_start, problem_in
from .constraints.directions import or_one
from .evaluation import Numbers, batch_evaluation
from .inputs import Inputs
from .matrices import BatchMatrices
from .nearest_root import ROUNDING, Linearized, NearestRoots
from .nominal import nominal_of
from .residuals import constraint_residuals, scaled_residual

LIMITED_DIGITS = 1e-9  # share of the largest datum by which data may be corrected, and of coordinates a residual
SOON = 1e-9  # of the first time, or of the nominal time: after it, for functions that vanish there


class FoundStates(NamedTuple):
    """States that motions start from."""

    states: Numbers  # shape (2n, k): coordinates, then velocities
    found: NDArray[np.bool_]  # shape (k,): True if they satisfy the constraints; the other states mean nothing


class InitialStates:
    """The initial states of a problem's motions as a function of the open parameters.

    Signs of time have the value just after the initial time. Other signs do not affect constraints, which would jump.

    Parameters
    ----------
    problem : MotionProblem
        With open parameters.

    Raises
    ------
    HolonomError
        The initial state cannot be adapted to the parameters.
    """

    def __init__(self, problem: MotionProblem) -> None:
        begun = self._problem = at_start(problem)
        self._start = float(begun.start["t"])
        self._of: dict[tuple[float, ...], _StatesInPattern] = {}
        self._in_pattern([1.0] * len(begun.signs))
        self._clocks = {
            index: batch_evaluation(begun, computing(begun.switching, {f"switch[{index + 1}]"}))
            for index, sign in enumerate(begun.signs)
            if sign.by is DependsOn.TIME
        }

    def __call__(self, values: Numbers) -> FoundStates:
        """Return the states for many values of the open parameters, shape (p, k).

        The result of one column of values does not depend on the others.
        """
        if not self._problem.signs:
            return self._in_pattern(())(values)
        signs, k = self._signs(values), values.shape[1]
        states, found = np.full((len(self._problem.state), k), np.nan), np.zeros(k, dtype=bool)
        for pattern in np.unique(signs, axis=1).T:
            here = (signs == pattern[:, None]).all(axis=0)
            states[:, here], found[here] = self._in_pattern(pattern)(values[:, here])
        return FoundStates(states, found)

    def _changes(self, values: Numbers, states: Numbers) -> tuple[Correction | None, Correction | None]:
        """Return the largest correction of a datum of one motion, and way from a guess."""
        return self._in_pattern(self._signs(values)[:, 0]).changes(values, states)

    @cached_property
    def _soon(self) -> float:
        """A time just after the initial one."""
        return self._start + SOON * max(nominal_of(self._problem).time, abs(self._start))

    def _in_pattern(self, pattern: Iterable[float]) -> "_StatesInPattern":
        signs = tuple(map(int, pattern))
        if signs not in self._of:
            named = {sign.name: value for sign, value in zip(self._problem.signs, signs, strict=True)}
            self._of[signs] = _StatesInPattern(problem_in(self._problem, named) if named else self._problem)
        return self._of[signs]

    def _signs(self, values: Numbers) -> Numbers:
        """Return the signs at the initial time, shape (signs, k).

        Each function follows those that it may contain.
        """
        k, problem = values.shape[1], self._problem
        signs, unused, inputs = np.ones((len(problem.signs), k)), np.zeros((len(problem.state), k)), Inputs(problem)
        for index, clock in self._clocks.items():
            now, soon = (
                clock(inputs(time, unused, signs=signs, values=values))[0] for time in (self._start, self._soon)
            )
            has_sign = np.abs(now) * SOON > ROUNDING * np.abs(soon - now)  # relative to its change in this time
            signs[index] = np.where(np.where(has_sign, now, soon) >= 0, 1.0, -1.0)
        return signs


class _StatesInPattern:
    """The initial states of motions with one pattern of signs."""

    def __init__(self, problem: MotionProblem) -> None:
        start = problem.initial.parametric
        if start.obstruction is not None:
            raise HolonomError(ErrorKind.NO_INITIAL_STATE, problem.scene, start.obstruction)
        self._time, self._n = float(problem.start["t"]), len(problem.coordinates)
        self._evaluate = batch_evaluation(problem, start.program)
        self._matrices, self._redundant = BatchMatrices(problem), problem.dependent
        self._nominal = nominal_of(problem)
        needed = np.isin(np.arange(len(problem.multipliers)), problem.independent)
        n = self._n
        present = {name for name in problem.matrices.outputs if name.startswith("J[")}
        touches = np.array(
            [[f"J[{b},{s}]" in present for s in range(1, n + 1)] for b in range(1, len(problem.multipliers) + 1)]
        ).reshape(-1, n)
        self._origins = {name: start.origins[name] for name in problem.state}
        origins = list(self._origins.values())
        self._groups = [
            _Group(half, np.array([origin is Origin.GIVEN for origin in part]), Origin.ONLY in part, touches, needed)
            for half, part in ((0, origins[:n]), (1, origins[n:]))
        ]

    def __call__(self, values: Numbers) -> FoundStates:
        states, found = self._evaluate(values), np.ones(values.shape[1], dtype=bool)
        with np.errstate(all="ignore"):
            for group in self._groups:
                found &= self._corrected(group, states, values)
                if len(group.solved):
                    places = group.solved + group.half * self._n
                    roots = self._roots(states, values, group, group.solved, group.open, group.only)
                    states[places], arrived = roots(states[places], np.arange(len(found)), not group.only)
                    found &= arrived
            at = self._matrices(self._time, states, values)
            for residual in constraint_residuals(at, states, self._nominal).values():
                found &= residual <= LIMITED_DIGITS
        return FoundStates(states, found & np.isfinite(states).all(axis=0))

    def changes(self, values: Numbers, states: Numbers) -> tuple[Correction | None, Correction | None]:
        given, size, now = self._largest_change(Origin.GIVEN, values, states)
        nominal = self._nominal.state[list(self._origins).index(given)] if given else 1.0
        corrected = Correction(given, f"{size:.2g}") if size > ROUNDING * max(nominal, abs(now)) else None
        near, size, _ = self._largest_change(Origin.NEAR, values, states)
        return corrected, Correction(near, f"{size:.3g}") if near else None

    def _largest_change(self, origin: Origin, values: Numbers, states: Numbers) -> tuple[str, float, float]:
        """Return the name, the change and the value of an origin's most changed value."""
        data, state = self._evaluate(values)[:, 0], states[:, 0]
        changes = (
            (name, abs(float(now - before)), float(now))
            for name, before, now in zip(self._origins, data, state, strict=True)
            if self._origins[name] is origin
        )
        return max(changes, key=lambda change: change[1], default=("", 0.0, 0.0))

    def _corrected(self, group: "_Group", states: Numbers, values: Numbers) -> NDArray[np.bool_]:
        """Correct data of limited digits in place. Return True if no more was needed."""
        if not len(group.given) or not len(group.bound):
            return np.ones(states.shape[1], dtype=bool)
        rows, n = group.given + group.half * self._n, self._n
        at, data = self._matrices(self._time, states, values), states[rows]
        residual, moved = (at.residual_rate, states[n:]) if group.half else (at.residual, states[:n])
        sizes = np.split(self._nominal.state, 2)[group.half]
        missed = scaled_residual(residual[group.bound], at.jacobian[group.bound], moved, sizes) > ROUNDING
        some = np.flatnonzero(missed)
        roots = self._roots(states, values, group, group.given, group.bound, only=False)
        states[np.ix_(rows, some)], _ = roots(states[np.ix_(rows, some)], some, nearest=False)
        size = np.max(np.abs(data), axis=0)
        size = np.where(size > 0, size, np.max(self._nominal.state[rows]))
        return np.max(np.abs(states[rows] - data), axis=0) <= LIMITED_DIGITS * size

    def _roots(
        self, states: Numbers, values: Numbers, group: "_Group", unknown: Numbers, rows: Numbers, only: bool
    ) -> NearestRoots:
        """Return the search for numbers of a group that satisfy some of the constraints."""
        places = unknown + group.half * self._n

        def linearize(points: Numbers, elements: NDArray[np.int64]) -> Linearized:
            trial = states[:, elements].copy()
            trial[places] = points
            at = self._matrices(self._time, trial, values[:, elements])
            residual = (at.residual_rate if group.half else at.residual)[rows]
            return Linearized(residual, at.jacobian[np.ix_(rows, unknown)], at.mass[np.ix_(unknown, unknown)])

        def correct(at: Linearized) -> Numbers:
            return least_step(None if only else at.mass, at.jacobian, at.residual, self._redundant)

        return NearestRoots(linearize, correct, self._nominal.state[places])


class _Group:
    """Coordinates or velocities: the given ones, and the constraints of the others.

    Parameters
    ----------
    half : int
        0 for coordinates, 1 for velocities.
    given : ndarray of bool, shape (n,)
    only : bool
        Whether the others are the only solution of linear equations.
    touches : ndarray of bool, shape (g, n)
        Where J is not zero by structure.
    needed : ndarray of bool, shape (g,)
        False for redundant constraints: their gradients depend on the others at a root, but not at a guess.
    """

    def __init__(
        self, half: int, given: NDArray[np.bool_], only: bool, touches: NDArray[np.bool_], needed: NDArray[np.bool_]
    ) -> None:
        self.half, self.only = half, only
        self.given, self.solved = np.flatnonzero(given), np.flatnonzero(~given)
        open_ = touches[:, ~given].any(axis=1)
        self.open, self.bound = np.flatnonzero(open_ & needed), np.flatnonzero(~open_)


def at_values(problem: MotionProblem, values: Mapping[str, Fraction]) -> MotionProblem:
    """Return the motion for other parameter values, its start in double precision.

    Parameters
    ----------
    problem : MotionProblem
        With open parameters.
    values : mapping of str to Fraction
        By name. Missing parameters keep their values.

    Returns
    -------
    MotionProblem

    Raises
    ------
    HolonomError
        The initial state cannot be adapted to the parameters, or not to one that is known to be the only one. There is
        none for these values. A value exceeds a double.
    """
    if Origin.CONTINUED in problem.initial.parametric.origins.values():
        reason = translatable(
            "no closed form gives it for all values of the parameters; put near values into initial_guess"
        )
        raise HolonomError(ErrorKind.NO_INITIAL_STATE, problem.scene, reason)
    complete = {name: values.get(name, problem.values.get(name)) for name in problem.parameters}
    for name, value in complete.items():
        above, below = value.as_integer_ratio()
        if above and not abs(log10(abs(above)) - log10(below)) < LARGEST_EXPONENT:
            raise HolonomError(ErrorKind.SETTING_TOO_LARGE, detail=name)
    numbers = np.array([[float(complete[name])] for name in problem.parameters])
    initial_states = InitialStates(problem)
    starts = initial_states(numbers)
    if not starts.found[0]:
        raise HolonomError(
            ErrorKind.NO_INITIAL_STATE, problem.scene, translatable("no state satisfies the constraints")
        )
    found = started(problem, complete, starts.states[:, 0])
    correction, moved = initial_states._changes(numbers, starts.states)
    initial = replace(problem.initial, correction=correction, moved=moved or problem.initial.moved)
    return replace(found, initial=initial)


def started(problem: MotionProblem, values: Mapping[str, Fraction], state: Numbers) -> MotionProblem:
    """Return the motion for parameter values, from a state for them.

    Parameters
    ----------
    problem : MotionProblem
        With open parameters.
    values : mapping of str to Fraction
        Of all open parameters.
    state : ndarray, shape (2n,)
        Coordinates, then velocities.

    Returns
    -------
    MotionProblem
    """
    texts = {name: repr(float(number)) for name, number in zip(problem.state, state, strict=True)}
    return replace(problem, values=dict(values), start={"t": problem.start["t"], **texts})


def least_step(mass: Numbers | None, jacobian: Numbers, residual: Numbers, redundant: bool) -> Numbers:
    """Return the least correction in the metric, or the only one.

    Parameters
    ----------
    mass : ndarray, shape (u, u, k), or None
        Metric of the u unknowns, or None if the correction is the only one.
    jacobian : ndarray, shape (b, u, k)
        Derivatives of b constraints by the unknowns.
    residual : ndarray, shape (b, k)
        Values of these constraints.
    redundant : bool
        True if constraints may depend on one another.

    Returns
    -------
    ndarray, shape (u, k)
        NaN for a singular system.
    """
    b, u, elements = jacobian.shape
    with np.errstate(invalid="ignore"):  # nan for what is not finite
        lengths = np.sqrt(np.abs(np.diagonal(mass)).T) if mass is not None else _largest_shares(jacobian)
        columns = _units_near(lengths)
        rows = _lengths(jacobian / columns)
        jacobian, right = jacobian / columns / rows, -(residual / rows[:, 0]).T
    if mass is None:
        matrix = np.moveaxis(jacobian, 2, 0)
    else:
        matrix = np.zeros((elements, u + b, u + b))
        matrix[:, :u, :u] = np.moveaxis(mass / columns[:, None] / columns, 2, 0)
        matrix[:, :u, u:] = -np.moveaxis(jacobian, 2, 0).swapaxes(1, 2)
        matrix[:, u:, :u] = np.moveaxis(jacobian, 2, 0)
        right = np.concatenate([np.zeros((elements, u)), right], axis=1)
    return _solution(matrix, right, redundant and mass is not None)[:, :u].T / columns


def _largest_shares(jacobian: Numbers) -> Numbers:
    """Return the largest shares of unknowns in gradients, shape (u, k)."""
    return np.max(np.abs(jacobian) / _lengths(jacobian), axis=0, initial=0.0)


def _lengths(jacobian: Numbers) -> Numbers:
    return _units_near(np.linalg.norm(jacobian, axis=1, keepdims=True))


def _units_near(sizes: Numbers) -> Numbers:
    """Return powers of two, by which numbers are divided exactly, one for zero."""
    return 2.0 ** np.round(np.log2(or_one(sizes)))


def _solution(matrices: Numbers, rights: Numbers, redundant: bool) -> Numbers:
    """Return solutions of linear systems, each independent of the others.

    It is nan for a singular system.
    """
    if redundant or matrices.shape[1] != matrices.shape[2]:
        return np.array([_least(matrix, right, redundant) for matrix, right in zip(matrices, rights, strict=True)])
    try:
        return np.linalg.solve(matrices, rights[:, :, None])[:, :, 0]
    except np.linalg.LinAlgError:  # one of them is singular
        return np.array([_regular(matrix, right) for matrix, right in zip(matrices, rights, strict=True)])


def _regular(matrix: Numbers, right: Numbers) -> Numbers:
    try:
        return np.linalg.solve(matrix, right)
    except np.linalg.LinAlgError:
        return np.full(len(right), np.nan)


def _least(matrix: Numbers, right: Numbers, redundant: bool) -> Numbers:
    """Return the least-squares solution, nan if it must be unique and is not."""
    if not (np.isfinite(matrix).all() and np.isfinite(right).all()):
        return np.full(matrix.shape[1], np.nan)
    found, _, rank, _ = np.linalg.lstsq(matrix, right, rcond=None)
    return found if redundant or rank == matrix.shape[1] else np.full(matrix.shape[1], np.nan)
