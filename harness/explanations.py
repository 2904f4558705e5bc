"""Explanations of motions: engines, events, and advice for hard cases."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from .language import gettext, translatable, translated
from .simulation.engines.registry import FALLBACK
from .simulation.hard_cases import Difficulty

if TYPE_CHECKING:
    from .simulation.engines.fallback import EngineSegment
    from .simulation.result import Report

LISTED = 3  # segments of the robust engine that are listed one by one
ADVICE = {
    Difficulty.NEARLY_DEPENDENT: translatable(
        "The constraints are nearly dependent: take the orthogonal solve, which keeps the accelerations, "
        "and trust the constraint forces rather than single multipliers."
    ),
    Difficulty.REDUNDANT: translatable(
        "The constraints are redundant: the motion and the constraint forces are unique, single multipliers and "
        "reactions are not; remove constraints to give them a meaning."
    ),
    Difficulty.SINGULAR_CONFIGURATION: translatable(
        "The motion passes a singular configuration: keep the default engine, which hands over to the robust one, "
        "and check the energy error, which is small if it left on the right branch."
    ),
    Difficulty.STIFF: translatable(
        "The motion is stiff: keep the Taylor engine where its fast oscillation matters; where it does not, replace "
        "the stiff part by a constraint, or, where it is damped, take the robust engine, which has a method for that."
    ),
    Difficulty.OVERFLOW: translatable(
        "Numbers come near the end of the range of double precision: divide the constraint by what grows in it, "
        "or choose units in which the control stays moderate."
    ),
    Difficulty.MASS_RATIO: translatable(
        "The masses differ by many orders of magnitude: take the orthogonal solve, and quadruple precision where a "
        "light body hangs in line between heavy ones; or leave the light mass out."
    ),
    Difficulty.LONG_RUN: translatable(
        "The run is long: keep the projection and the default tolerance, and expect to lose up to one and a half "
        "digits of the phase for every tenfold time, or take quadruple precision."
    ),
    Difficulty.FREE_CANCELLATION: translatable(
        "At the recorded times the constraints exert no force: every multiplier is a difference that cancels, "
        "so read values below 1e-13 of the forces as zero, and use `holonom free` to decide whether the motion is free."
    ),
    Difficulty.VANISHING_LENGTH: translatable(
        "A controlled length goes through zero, where its constraint has no gradient and no reaction can act: "
        "end the run before it, or choose a law that keeps the length away from zero."
    ),
}


def advice(kind: Difficulty) -> str:
    """Return the advice for a hard case.

    Parameters
    ----------
    kind : Difficulty
        Kind of hard case.

    Returns
    -------
    str
    """
    return ADVICE[kind]


def engine_text(segments: "Sequence[EngineSegment]") -> str:
    """Return the engines of a motion and their times, in one line.

    Examples are ``taylor`` and ``taylor, robust 0.31..0.35, taylor``.

    Parameters
    ----------
    segments : sequence of EngineSegment
        At least one, in order.

    Returns
    -------
    str
    """
    if len(segments) == 1:
        return translated(segments[0].engine)
    robust = [segment for segment in segments if segment.engine == FALLBACK]
    if len(robust) > LISTED:
        return gettext(
            "%(engine)s, robust %(count)s times from %(start).6g to %(end).6g",
            engine=translated(segments[0].engine),
            count=len(robust),
            start=robust[0].start,
            end=robust[-1].end,
        )
    spans = {segment: f" {segment.start:.6g}..{segment.end:.6g}" for segment in robust}
    return ", ".join(f"{translated(segment.engine)}{spans.get(segment, '')}" for segment in segments)


def notes(report: "Report") -> Iterator[str]:
    """Yield the events of a motion and the advice for its hard cases.

    Parameters
    ----------
    report : Report
        Report of the motion.

    Yields
    ------
    str
        One message.
    """
    called = [segment for segment in report.segments if segment.engine == FALLBACK and segment.reason]
    for segment in called[:LISTED]:
        yield gettext(
            "From t = %(start).6g to %(end).6g the robust engine takes over, because %(reason)s.",
            start=segment.start,
            end=segment.end,
            reason=translated(segment.reason),
        )
    if len(called) > LISTED:
        yield gettext("The robust engine takes over %(count)s times in all.", count=len(called))
    if report.unresolved is not None:
        yield unresolved(report.unresolved)
    yield from (translated(advice(kind)) for kind in report.cases)
    if report.undetermined:
        yield gettext("Outputs that are not unique: %(names)s.", names=", ".join(report.undetermined))


def unresolved(start: float) -> str:
    """Return the note on the time after which discontinuities may be missed.

    Parameters
    ----------
    start : float
        The time, in the scene's unit.

    Returns
    -------
    str
    """
    return gettext(
        "From t = %(start).6g a function of the time changes too often to be looked at ahead: a jump is not found.",
        start=start,
    )
