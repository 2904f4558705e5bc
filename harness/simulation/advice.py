"""What a user should do about a hard case: the sentence that is said wherever a motion is one."""

from enum import StrEnum


class HardCase(StrEnum):
    """A kind of motion on which a plain method loses its digits."""

    NEARLY_DEPENDENT = "nearly dependent constraints"
    REDUNDANT = "redundant constraints"
    SINGULAR_PASSAGE = "passage through a singular configuration"
    STIFF = "stiffness"
    OVERFLOW = "overflow"
    MASS_RATIO = "large mass ratio"
    LONG_RUN = "long run"
    FREE_CANCELLATION = "cancellation along a free motion"
    VANISHING_LENGTH = "vanishing length"


ADVICE = {
    HardCase.NEARLY_DEPENDENT: (
        "The constraints are nearly dependent: take the orthogonal solve, which keeps the accelerations, "
        "and trust the constraint forces rather than single multipliers."
    ),
    HardCase.REDUNDANT: (
        "The constraints are redundant: leave the robust engine to work; the motion and the constraint forces are "
        "unique, while the multipliers are the ones of smallest norm, so remove constraints to give them a meaning."
    ),
    HardCase.SINGULAR_PASSAGE: (
        "The motion passes a singular configuration: keep the default engine, which hands over to the robust one, "
        "and look at the energy error, which tells whether it left on the right branch."
    ),
    HardCase.STIFF: (
        "The motion is stiff: keep the Taylor engine where its fast oscillation matters, and where it does not, "
        "replace the stiff part by a constraint."
    ),
    HardCase.OVERFLOW: (
        "Numbers come near the end of the range of double precision: divide the constraint by what grows in it, "
        "or choose units in which the control stays moderate."
    ),
    HardCase.MASS_RATIO: (
        "The masses differ by many orders of magnitude: take the orthogonal solve, and quadruple precision where a "
        "light body hangs in line between heavy ones; or leave the light mass out."
    ),
    HardCase.LONG_RUN: (
        "The run is long: keep the projection and the default tolerance, and expect to lose up to one and a half "
        "digits of the phase for every tenfold time, or take quadruple precision."
    ),
    HardCase.FREE_CANCELLATION: (
        "The motion is free: every multiplier is a difference that cancels, so read values below 1e-13 of the forces "
        "as zero, and let `holonom free` prove it."
    ),
    HardCase.VANISHING_LENGTH: (
        "A controlled length goes through zero, where its constraint has no gradient and no reaction can act: "
        "end the run before it, or choose a law that keeps the length away from zero."
    ),
}


def advice(kind: HardCase) -> str:
    """The sentence that says what to do about a hard case.

    Parameters
    ----------
    kind : HardCase

    Returns
    -------
    str
    """
    return ADVICE[kind]
