"""What is said of motions: who followed one, what happened on the way, and what to do about each kind of hard case."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from .language import gettext, translatable, translated
from .simulation.engines.registry import FALLBACK
from .simulation.hard_cases import HardCase

if TYPE_CHECKING:
    from .simulation.engines.fallback import EngineSegment
    from .simulation.result import Report

LISTED = 3  # legs of the robust engine that are told one by one
ADVICE = {
    HardCase.NEARLY_DEPENDENT: translatable(
        "The constraints are nearly dependent: take the orthogonal solve, which keeps the accelerations, "
        "and trust the constraint forces rather than single multipliers."
    ),
    HardCase.REDUNDANT: translatable(
        "The constraints are redundant: the motion and the constraint forces are unique, single multipliers and "
        "reactions are not; remove constraints to give them a meaning."
    ),
    HardCase.SINGULAR_PASSAGE: translatable(
        "The motion passes a singular configuration: keep the default engine, which hands over to the robust one, "
        "and look at the energy error, which tells whether it left on the right branch."
    ),
    HardCase.STIFF: translatable(
        "The motion is stiff: keep the Taylor engine where its fast oscillation matters; where it does not, replace "
        "the stiff part by a constraint, or, where it is damped, take the robust engine, which has a method for that."
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
        "At the instants that were kept the constraints exert no force: every multiplier is a difference that cancels, "
        "so read values below 1e-13 of the forces as zero, and let `holonom free` tell whether the motion is free."
    ),
    HardCase.VANISHING_LENGTH: translatable(
        "A controlled length goes through zero, where its constraint has no gradient and no reaction can act: "
        "end the run before it, or choose a law that keeps the length away from zero."
    ),
}


def advice(kind: HardCase) -> str:
    """Return the sentence that says what to do about a hard case."""
    return ADVICE[kind]


def engine_text(legs: "Sequence[EngineSegment]") -> str:
    """Who followed the motion when, in one line, for instance ``taylor`` or ``taylor, robust 0.31..0.35, taylor``."""
    if len(legs) == 1:
        return translated(legs[0].engine)
    robust = [leg for leg in legs if leg.engine == FALLBACK]
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


def remarks(report: "Report") -> Iterator[str]:
    """Yield what happened on the way, and what to do about the hard cases that the motion is: one sentence each."""
    called = [leg for leg in report.legs if leg.engine == FALLBACK and leg.case is not None]
    for leg in called[:LISTED]:
        yield gettext(
            "From t = %(start).6g to %(end).6g the robust engine takes over, because %(reason)s.",
            start=leg.start,
            end=leg.end,
            reason=translated(leg.reason),
        )
    if len(called) > LISTED:
        yield gettext("The robust engine takes over %(count)s times in all.", count=len(called))
    if report.unresolved is not None:
        yield unresolved(report.unresolved)
    yield from (translated(advice(kind)) for kind in report.cases)
    if report.undetermined:
        yield gettext("Outputs that are not unique: %(names)s.", names=", ".join(report.undetermined))


def unresolved(start: float) -> str:
    """Return the sentence that says from when on jumps in time may be passed over."""
    return gettext(
        "From t = %(start).6g a function of the time changes too often to be looked at ahead: a jump is not found.",
        start=start,
    )
