"""What kinds of hard case a motion is, and what a user should do about each.

Its matrices tell at the start and at the end; what the engines meet on the way, redundant constraints, singular
configurations, vanishing gradients, they tell themselves.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from enum import StrEnum
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..language import gettext, translatable, translated
from .constraints.factorization import factored_constraints, rank_of, weighted_constraints
from .diagnostics import condition
from .matrices import Matrices, MotionMatrices, Vector
from .request import EngineName

if TYPE_CHECKING:
    from .engines.switching import Leg

ILL_CONDITIONED, DEPENDENT = 1e8, 1e20  # condition of G: half of a double's digits lost, and none left
UNEQUAL_MASSES = 1e8  # ratio of the entries on A's diagonal: half of a double's digits
UNSQUARED = 1e150  # numbers whose squares leave the range of a double, or soon will
MANY_STEPS = 10_000
FREE = 1e-13  # constraint forces, in terms of the others
STIFF = 1e5  # squares of frequencies, one in terms of another
AT_REST = 1e-8  # squares of frequencies, in terms of the largest, that differences do not tell from zero
DIFFERENCE = 1e-5  # in coordinates: the cube root of a double's rounding error
LISTED = 3  # legs of the robust engine that are told one by one


class HardCase(StrEnum):
    """A kind of motion on which a plain method loses its digits."""

    NEARLY_DEPENDENT = translatable("nearly dependent constraints")
    REDUNDANT = translatable("redundant constraints")
    SINGULAR_PASSAGE = translatable("passage through a singular configuration")
    STIFF = translatable("stiffness")
    OVERFLOW = translatable("overflow")
    MASS_RATIO = translatable("large mass ratio")
    LONG_RUN = translatable("long run")
    FREE_CANCELLATION = translatable("cancellation along a free motion")
    VANISHING_LENGTH = translatable("vanishing length")


ADVICE = {
    HardCase.NEARLY_DEPENDENT: translatable(
        "The constraints are nearly dependent: take the orthogonal solve, which keeps the accelerations, "
        "and trust the constraint forces rather than single multipliers."
    ),
    HardCase.REDUNDANT: translatable(
        "The constraints are redundant: the motion and the constraint forces are unique, single multipliers are not; "
        "remove constraints to give them a meaning."
    ),
    HardCase.SINGULAR_PASSAGE: translatable(
        "The motion passes a singular configuration: keep the default engine, which hands over to the robust one, "
        "and look at the energy error, which tells whether it left on the right branch."
    ),
    HardCase.STIFF: translatable(
        "The motion is stiff: keep the Taylor engine where its fast oscillation matters, and where it does not, "
        "replace the stiff part by a constraint."
    ),
    HardCase.OVERFLOW: translatable(
        "Numbers come near the end of the range of double precision: divide the constraint by what grows in it, "
        "or choose units in which the control stays moderate."
    ),
    HardCase.MASS_RATIO: translatable(
        "The masses differ by many orders of magnitude: take the orthogonal solve, and quadruple precision where a "
        "light body hangs in line between heavy ones; or leave the light mass out."
    ),
    HardCase.LONG_RUN: translatable(
        "The run is long: keep the projection and the default tolerance, and expect to lose up to one and a half "
        "digits of the phase for every tenfold time, or take quadruple precision."
    ),
    HardCase.FREE_CANCELLATION: translatable(
        "The motion is free: every multiplier is a difference that cancels, so read values below 1e-13 of the forces "
        "as zero, and let `holonom free` prove it."
    ),
    HardCase.VANISHING_LENGTH: translatable(
        "A controlled length goes through zero, where its constraint has no gradient and no reaction can act: "
        "end the run before it, or choose a law that keeps the length away from zero."
    ),
}


class Instant(NamedTuple):
    """A state of a motion."""

    t: float
    state: Vector  # shape (2n,)


def hard_cases(
    matrices: Callable[[float, Vector], Matrices],
    independent: Sequence[int],
    start: Instant,
    end: Instant,
    multipliers: Vector,
    steps: int,
) -> Iterator[HardCase]:
    """The kinds of hard case that a motion is.

    Parameters
    ----------
    matrices : callable
        As `MotionMatrices`.
    independent : sequence of int
        Constraints, from 0, that are not known to follow from the others.
    multipliers : ndarray, shape (g,)
        At the end.
    steps : int
        That the motion took.

    Yields
    ------
    HardCase
        Redundant constraints that the program leaves out, nearly dependent constraints, large mass ratio, overflow,
        free motion, long run, stiffness.
    """
    ends = [matrices(*start), matrices(*end)]
    if len(independent) < len(multipliers):
        yield HardCase.REDUNDANT
    if any(ILL_CONDITIONED < condition(at.under(independent)) < DEPENDENT for at in ends):
        yield HardCase.NEARLY_DEPENDENT
    if any(_mass_ratio(at) > UNEQUAL_MASSES for at in ends):
        yield HardCase.MASS_RATIO
    if any(_largest(at) > UNSQUARED for at in ends):
        yield HardCase.OVERFLOW
    if _free(ends, multipliers):
        yield HardCase.FREE_CANCELLATION
    if steps > MANY_STEPS:
        yield HardCase.LONG_RUN
    if stiffness(matrices, start) > STIFF:
        yield HardCase.STIFF


def dependence(matrices: MotionMatrices, at: Instant) -> str | None:
    """Why no fixed order of pivots can solve the equations of motion at a state, if none can.

    Returns
    -------
    str or None
        A clause; None where the constraints, those apart that are known to follow from others, are independent.
    """
    found = matrices.independent(*at)
    rank = rank_of(weighted_constraints(found.mass, found.jacobian).singular_values())
    g = len(found.jacobian)
    if rank == g:
        return None
    return translatable("of %(g)s constraints only %(rank)s are independent at t = %(t)g", g=g, rank=rank, t=at.t)


def stiffness(matrices: MotionMatrices, at: Instant) -> float:
    """Ratio of the largest to the smallest square of a frequency that small deviations from a motion have.

    Returns
    -------
    float
        From the derivative of the accelerations with respect to the coordinates, along what the constraints leave
        free, in the mass metric.
    """
    here = matrices(*at)
    weighted = weighted_constraints(here.mass, here.jacobian)
    left, values, _ = np.linalg.svd(weighted.directions)
    free = np.linalg.solve(weighted.factor.T, left[:, rank_of(values) :])
    moves = DIFFERENCE * np.concatenate([free, np.zeros_like(free)])
    change = [_accelerations(matrices, at, move) - _accelerations(matrices, at, -move) for move in moves.T]
    if not change:
        return 1.0
    squares = np.abs(np.linalg.eigvals(free.T @ here.mass @ np.array(change).T / (2 * DIFFERENCE)))
    moving = squares[squares > AT_REST * squares.max()]
    return float(moving.max() / moving.min()) if moving.size else 1.0


def _accelerations(matrices: MotionMatrices, at: Instant, move: Vector) -> Vector:
    moved = matrices(at.t, at.state + move)
    weighted = weighted_constraints(moved.mass, moved.jacobian)
    factored = factored_constraints(weighted, rank_of(weighted.singular_values()))
    return factored.accelerations(moved.force, moved.curvature)


def _mass_ratio(at: Matrices) -> float:
    masses = at.mass.diagonal()[at.mass.diagonal() > 0]
    return float(masses.max() / masses.min()) if masses.size else 1.0


def _largest(at: Matrices) -> float:
    return max(float(np.abs(part).max(initial=0.0)) for part in (at.mass, at.force, at.jacobian, at.curvature))


def _free(ends: Sequence[Matrices], multipliers: Vector) -> bool:
    """Whether the constraints make no force to speak of at the end, although there are other forces."""
    forces = max(float(np.abs(at.force).max(initial=0.0)) for at in ends)
    reaction = float(np.abs(ends[-1].jacobian.T @ multipliers).max(initial=0.0))
    return forces > 0 and len(multipliers) > 0 and reaction <= FREE * forces


def advice(kind: HardCase) -> str:
    """The sentence that says what to do about a hard case."""
    return ADVICE[kind]


def engine_text(legs: "Sequence[Leg]") -> str:
    """Who followed the motion when, in one line.

    Returns
    -------
    str
        For instance ``taylor`` or ``taylor, robust 0.31..0.35, taylor``.
    """
    if len(legs) == 1:
        return translated(legs[0].engine)
    robust = [leg for leg in legs if leg.engine is EngineName.ROBUST]
    if len(robust) > LISTED:
        return gettext(
            "%(engine)s, robust %(count)s times from %(start).6g to %(end).6g",
            engine=translated(legs[0].engine),
            count=len(robust),
            start=robust[0].start,
            end=robust[-1].end,
        )
    spans = {leg: f" {leg.start:.6g}..{leg.end:.6g}" for leg in robust}
    return ", ".join(f"{translated(leg.engine)}{spans.get(leg, '')}" for leg in legs)


def remarks(legs: "Sequence[Leg]", cases: Iterable[HardCase]) -> Iterator[str]:
    """What happened on the way, and what to do about the hard cases that the motion is: one sentence each."""
    called = [leg for leg in legs if leg.engine is EngineName.ROBUST and leg.case is not None]
    for leg in called[:LISTED]:
        yield gettext(
            "From t = %(start).6g to %(end).6g the robust engine takes over, because %(reason)s.",
            start=leg.start,
            end=leg.end,
            reason=translated(leg.reason),
        )
    if len(called) > LISTED:
        yield gettext("The robust engine takes over %(count)s times in all.", count=len(called))
    yield from (translated(advice(kind)) for kind in cases)
