"""Compare values at states with the expected values in 50 digits.

A difference counts if it is confirmed in twice the digits.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from mpmath import mp

from .digits import DIGITS, WORKING_DIGITS
from .irregular_point import IrregularPoint
from .motion_states import ComparedValue

VANISHED = 2 * DIGITS // 3  # digits by which a difference shrinks in twice the digits where it is rounding

Parts = Iterator[tuple[str, ComparedValue]]  # each value with the part of the programs that makes it


def first_differences(compared: Callable[[], Parts], digits: int = DIGITS) -> tuple[dict[str, str], bool]:
    """Return the first wrong value of each part at a state, and whether it is regular.

    Parameters
    ----------
    compared : callable
        Function that makes the values in the working precision, each with its part of the programs.
    digits : int
        Digits in which given and expected numbers have to agree.

    Returns
    -------
    differences : dict of str to str
        Message for each part with a wrong value, which is confirmed in twice the digits.
    regular : bool
        True if all of them are numbers.
    """
    with mp.workdps(WORKING_DIGITS):
        made, regular = _made(compared())
        suspected = {i: abs(each.given - each.true) for i, (_, each) in enumerate(made) if _differs(each, digits)}
    if not suspected:
        return {}, regular
    found: dict[str, str] = {}
    with mp.workdps(2 * WORKING_DIGITS):
        again, still = _made(compared())
        for place, before in suspected.items():
            if place >= len(again) and not still:
                continue  # rounding hid that a value is missing at this state
            part, value = again[place] if place < len(again) else made[place]
            rounding = abs(value.given - value.true) <= before * mp.mpf(10) ** -VANISHED
            if _differs(value, digits) and not rounding:
                found.setdefault(part, _described(value))
    return found, regular and still


def differing(compared: Callable[[], Iterator[ComparedValue]], digits: int = DIGITS) -> str:
    """Return the first wrong value, confirmed in twice the digits, or an empty text.

    Parameters
    ----------
    compared : callable
        Function that makes the values in the working precision.
    digits : int
        Digits in which given and expected numbers have to agree.

    Returns
    -------
    str

    Raises
    ------
    IrregularPoint
        A value is missing, and none before it is wrong.
    """
    found, regular = first_differences(lambda: (("", each) for each in compared()), digits)
    if not (found or regular):
        raise IrregularPoint
    return found.get("", "")


def _made(compared: Parts) -> tuple[list[tuple[str, ComparedValue]], bool]:
    """Return the values at a state, and True if all are numbers.

    They end before the first one without a value.
    """
    made: list[tuple[str, ComparedValue]] = []
    try:
        for each in compared:
            made.append(each)
    except (IrregularPoint, ZeroDivisionError, OverflowError):
        return made, False
    return made, True


def _differs(value: ComparedValue, digits: int) -> bool:
    size = max(value.size, abs(value.given), abs(value.true))
    return abs(value.given - value.true) > mp.mpf(10) ** -digits * size


def _described(value: ComparedValue) -> str:
    return f"{value.quantity}: {mp.nstr(value.given, 12)} where {mp.nstr(value.true, 12)} is so"
