"""What a report says in words: who followed the motion when, and what to do about a hard case."""

from collections.abc import Iterable, Iterator, Sequence

from .advice import HardCase, advice
from .engines.switching import Leg
from .request import Engine

LISTED = 3  # legs of the robust engine that are told one by one


def engine_text(legs: Sequence[Leg]) -> str:
    """Who followed the motion when, in one line.

    Parameters
    ----------
    legs : sequence of Leg

    Returns
    -------
    str
        For instance ``taylor`` or ``taylor, robust 0.31..0.35, taylor``.
    """
    if len(legs) == 1:
        return str(legs[0].engine)
    robust = [leg for leg in legs if leg.engine is Engine.ROBUST]
    if len(robust) > LISTED:
        return f"{legs[0].engine}, robust {len(robust)} times from {robust[0].start:.6g} to {robust[-1].end:.6g}"
    spans = {leg: f" {leg.start:.6g}..{leg.end:.6g}" for leg in robust}
    return ", ".join(f"{leg.engine}{spans.get(leg, '')}" for leg in legs)


def remarks(legs: Sequence[Leg], cases: Iterable[HardCase]) -> Iterator[str]:
    """What happened on the way, and what to do about it: one sentence each.

    Parameters
    ----------
    legs : sequence of Leg
    cases : iterable of HardCase
        What else the motion is known to be.

    Yields
    ------
    str
    """
    called = [leg for leg in legs if leg.engine is Engine.ROBUST and leg.case is not None]
    for leg in called[:LISTED]:
        yield f"From t = {leg.start:.6g} to {leg.end:.6g} the robust engine takes over, because {leg.reason}."
    if len(called) > LISTED:
        yield f"The robust engine takes over {len(called)} times in all."
    yield from map(advice, dict.fromkeys([*(leg.case for leg in called), *cases]))
