"""Claims at states compared with what is so, in 50 digits; a difference counts if it is there in twice the digits."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from mpmath import mp

from .digits import DIGITS, WORKING_DIGITS
from .irregular_point import IrregularPoint
from .motion_states import Claim

VANISHED = 2 * DIGITS // 3  # digits by which a difference shrinks in twice the digits where it is rounding

Parts = Iterator[tuple[str, Claim]]  # each claim with the part of the programs that makes it


def first_differences(claims: Callable[[int], Parts], attempt: int) -> tuple[dict[str, str], bool]:
    """Return the first claim of each part that is not so at a state, found in twice the digits once more.

    If it is regular.
    """
    with mp.workdps(WORKING_DIGITS):
        made, regular = _made(claims(attempt))
        suspected = {place: abs(each.given - each.true) for place, (_, each) in enumerate(made) if _differs(each)}
    if not suspected:
        return {}, regular
    found: dict[str, str] = {}
    with mp.workdps(2 * WORKING_DIGITS):
        again, still = _made(claims(attempt))
        for place, before in suspected.items():
            if place >= len(again) and not still:
                continue  # rounding hid that a value is missing at this state
            part, claim = again[place] if place < len(again) else made[place]
            rounding = abs(claim.given - claim.true) <= before * mp.mpf(10) ** -VANISHED
            if _differs(claim) and not rounding:
                found.setdefault(part, _told(claim))
    return found, regular and still


def differing(claims: Callable[[], Iterator[Claim]], digits: int = DIGITS) -> str:
    """Return the first claim that is not so, found in twice the digits once more; empty where all are."""
    with mp.workdps(WORKING_DIGITS):
        suspected = {
            place: abs(each.given - each.true) for place, each in enumerate(claims()) if _differs(each, digits)
        }
    if not suspected:
        return ""
    with mp.workdps(2 * WORKING_DIGITS):
        for place, claim in enumerate(claims()):
            before = suspected.get(place)
            if before is None or abs(claim.given - claim.true) <= before * mp.mpf(10) ** -VANISHED:
                continue
            if _differs(claim, digits):
                return _told(claim)
    return ""


def _made(claims: Parts) -> tuple[list[tuple[str, Claim]], bool]:
    """Return the claims at a state, up to where something has no value; whether all have."""
    made: list[tuple[str, Claim]] = []
    try:
        for each in claims:
            made.append(each)
    except (IrregularPoint, ZeroDivisionError, OverflowError):
        return made, False
    return made, True


def _differs(claim: Claim, digits: int = DIGITS) -> bool:
    size = max(claim.size, abs(claim.given), abs(claim.true))
    return abs(claim.given - claim.true) > mp.mpf(10) ** -digits * size


def _told(claim: Claim) -> str:
    return f"{claim.quantity}: {mp.nstr(claim.given, 12)} where {mp.nstr(claim.true, 12)} is so"
