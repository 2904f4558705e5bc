"""Details of errors that end a motion: a time and the reason, for a catalog."""

from typing import Any

from ..language import Message, translatable

OVERFLOW = translatable("forces or masses have no finite value")
SHORT_STEPS = translatable("steps become too short")


def place_and_reason(t: Any, reason: str) -> Message:
    """Return the time at which a motion ends, and the reason.

    Parameters
    ----------
    t : number
        The time.
    reason : str
        A clause about it, which a catalog may translate.

    Returns
    -------
    Message
    """
    return translatable("%(time)s, where %(reason)s", time=f"{float(t):.10g}", reason=reason)
