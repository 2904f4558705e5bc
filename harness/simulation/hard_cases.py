"""Kinds of hard case of a motion.

The matrices at the initial and the final time show them. The engines report others on the way: redundant constraints,
singular configurations and vanishing gradients.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property

import numpy as np

from ..language import translatable
from ..program.motion_problem import MotionProblem
from .constraints.directions import Matrix, rank_of, weighted_constraints
from .constraints.factorization import DependentConstraints
from .matrices import Matrices, MotionMatrices, Vector
from .residuals import condition

ILL_CONDITIONED, DEPENDENT = 1e8, 1e20  # condition of G: half of a double's digits lost, and none left
SMALL = 1e-3  # of the largest coordinate, as it is and in the mass metric
UNEQUAL_MASSES = 1e8  # ratio of the entries on A's diagonal: half of a double's digits
SINGULAR_MASS = 1e-8  # least eigenvalue of a mass matrix with a diagonal of ones, of one that is singular
ROUNDED_MASS = 1e-13  # of the largest mass: rounding
UNSQUARED = 1e150  # numbers whose squares leave the range of a double, or soon will
MANY_STEPS = 10_000
FREE = 1e-13  # constraint forces, in terms of the others
STIFF = 1e5  # squares of frequencies, one in terms of another
AT_REST = 1e-8  # squares of frequencies, relative to the largest, that differences do not distinguish from zero
DIFFERENCE = 1e-5  # of nominal coordinates and velocities: the cube root of a double's rounding error
DECAYED = 4.0  # times the length of a step, a rate of decay: what follows such a decay may take longer steps
AT_ONCE = 256  # states that are evaluated at a time


class Difficulty(StrEnum):
    """A kind of motion on which a plain method loses its digits."""

    NEARLY_DEPENDENT = translatable("nearly dependent constraints")
    REDUNDANT = translatable("redundant constraints")
    SINGULAR_CONFIGURATION = translatable("motion through a singular configuration")
    STIFF = translatable("stiffness")
    OVERFLOW = translatable("overflow")
    MASS_RATIO = translatable("large mass ratio")
    LONG_RUN = translatable("long run")
    FREE_CANCELLATION = translatable("cancellation along a free motion")
    VANISHING_LENGTH = translatable("vanishing length")


@dataclass(frozen=True)
class MotionState:
    """A state of a motion, with the matrices of its mode."""

    matrices: MotionMatrices
    t: float
    state: Vector  # shape (2n,)

    @cached_property
    def here(self) -> Matrices:
        """The matrices at the state."""
        return self.matrices(self.t, self.state)


def hard_cases(
    independent: Sequence[int], start: MotionState, end: MotionState, multipliers: Vector, steps: int
) -> Iterator[Difficulty]:
    """Yield the kinds of hard case that a motion is.

    Parameters
    ----------
    independent : sequence of int
        Constraints, from 0, that are not known to follow from the others.
    start, end : MotionState
        First and last state of the motion.
    multipliers : ndarray, shape (g,)
        Their largest sizes at the recorded times.
    steps : int
        Number of steps of the motion.

    Yields
    ------
    Difficulty
        Redundant constraints that the program leaves out, nearly dependent constraints, large mass ratio, overflow,
        free motion, long run, stiffness.
    """
    ends = [start.here, end.here]
    if len(independent) < len(multipliers):
        yield Difficulty.REDUNDANT
    if any(ILL_CONDITIONED < condition(at.under(independent)) < DEPENDENT for at in ends):
        yield Difficulty.NEARLY_DEPENDENT
    sizes = start.matrices.nominal.coordinates
    if any(_mass_ratio(at, sizes) > UNEQUAL_MASSES for at in ends):
        yield Difficulty.MASS_RATIO
    if any(_largest(at) > UNSQUARED for at in ends):
        yield Difficulty.OVERFLOW
    if _free(ends, multipliers, sizes):
        yield Difficulty.FREE_CANCELLATION
    if steps > MANY_STEPS:
        yield Difficulty.LONG_RUN
    if _stiffness(start) > STIFF or _is_slowed(start, end, steps):
        yield Difficulty.STIFF


def dependence(problem: MotionProblem, at: MotionState) -> str | None:
    """Return the reason why no fixed order of pivots solves the equations, if any.

    Constraints that are known to be dependent are not counted.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    at : MotionState
        State at which the rank is determined.

    Returns
    -------
    str or None
        A clause.
    """
    found = at.here.under(problem.independent)
    rank = rank_of(weighted_constraints(found.mass, found.jacobian).singular_values())
    g = len(found.jacobian)
    if rank == g:
        return None
    return translatable("of %(g)s constraints only %(rank)s are independent at t = %(t)g", g=g, rank=rank, t=at.t)


def _stiffness(at: MotionState) -> float:
    """Return the ratio of the largest to the smallest squared frequency.

    The frequencies are those of small deviations from the motion: from the derivative of the accelerations with respect
    to the coordinates, along what the constraints leave free, in the mass metric.
    """
    change = _free_changes(at)
    if change is None:
        return 1.0
    squares = np.abs(np.linalg.eigvals(change))
    moving = squares[squares > AT_REST * squares.max()]
    return float(moving.max() / moving.min()) if moving.size else 1.0


def _fastest_decay(at: MotionState) -> float:
    """Return the largest decay rate of small deviations that exceeds their frequency.

    It is per unit of time, and zero if none does. It follows from the derivatives of the accelerations with respect to
    coordinates and velocities.
    """
    change = _free_changes(at, velocities=True)
    if change is None:
        return 0.0
    one = np.eye(len(change))
    exponents = np.linalg.eigvals(np.block([[0 * one, one], [change]]))
    return float(-exponents.real[-exponents.real >= np.abs(exponents.imag)].min(initial=0.0))


def _is_slowed(start: MotionState, end: MotionState, steps: int) -> bool:
    """Return True if many steps were limited by a decay that has ended long before."""
    return steps > MANY_STEPS and _fastest_decay(end) * (end.t - start.t) > DECAYED * steps


def _free_changes(at: MotionState, velocities: bool = False) -> Matrix | None:
    """Return finite derivatives of accelerations in the free directions F, or None.

    They are those along the same directions of the coordinates, then of the velocities. As J F = 0, the derivative of
    A a - J^T lambda = h gives F^T A da = F^T d(h - A a + J^T lambda), a and lambda unchanged on the right.
    """
    factored = DependentConstraints(at.here.mass, at.here.jacobian)
    free = factored.free_directions()
    if not free.size:
        return None
    moves = np.kron(np.eye(2)[:, : 1 + velocities], free)
    found = factored.unknowns(at.here.force, at.here.curvature)
    lengths = DIFFERENCE / np.max(np.abs(moves) / at.matrices.nominal.state[:, None], axis=0)
    steps = (lengths * moves).T
    changes = [
        at.matrices.unbalanced(at.t, at.state + some, *found) - at.matrices.unbalanced(at.t, at.state - some, *found)
        for some in np.array_split(steps, -(-len(steps) // AT_ONCE))
    ]
    change = free.T @ np.concatenate(changes, axis=1) / (2 * lengths)
    return change if np.isfinite(change).all() else None


def _mass_ratio(at: Matrices, sizes: Vector) -> float:
    """Return the ratio of the largest to the smallest mass, in units of nominal sizes.

    If the mass matrix is singular, masses of the free directions are taken. Euler parameters near (1, 0, 0, 0) have a
    small entry on the diagonal, but not a small mass. Nor has a coordinate that is small initially.
    """
    lengths = sizes * np.sqrt(np.abs(at.mass.diagonal()))
    small = (sizes < SMALL * sizes.max(initial=0.0)) & (lengths < SMALL * lengths.max(initial=0.0)) & (lengths > 0)
    sizes = np.where(small, sizes * lengths.max(initial=0.0) / np.where(small, lengths, 1.0), sizes)
    mass = at.mass * sizes[:, None] * sizes
    masses = mass.diagonal()[mass.diagonal() > 0]
    if masses.size == len(mass):
        scaled = mass / np.sqrt(masses[:, None] * masses)
        if not np.isfinite(scaled).all() or np.linalg.eigvalsh(scaled)[0] > SINGULAR_MASS:
            return float(masses.max() / masses.min())
    if not at.finite:
        return 1.0
    left, values, _ = np.linalg.svd((at.jacobian * sizes).T)
    free = left[:, rank_of(values) if values.size else 0 :]
    masses = np.linalg.eigvalsh(free.T @ mass @ free)
    masses = masses[masses > ROUNDED_MASS * masses.max(initial=0.0)]
    return float(masses.max() / masses.min()) if masses.size else 1.0


def _largest(at: Matrices) -> float:
    return max(float(np.abs(part).max(initial=0.0)) for part in (at.mass, at.force, at.jacobian, at.curvature))


def _free(ends: Sequence[Matrices], multipliers: Vector, sizes: Vector) -> bool:
    """Return True if the constraint forces are negligible, although others act.

    Their work along the nominal sizes is compared. Gradients that grow do not multiply earlier rounding errors.
    """
    forces = max(float((np.abs(at.force) * sizes).max(initial=0.0)) for at in ends)
    reaction = min(float((np.abs(at.jacobian * sizes).T @ multipliers).max(initial=0.0)) for at in ends)
    return 0 < forces < np.inf and len(multipliers) > 0 and reaction <= FREE * forces
