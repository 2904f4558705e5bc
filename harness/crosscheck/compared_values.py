"""Compare values at states with the expected values in 50 digits.

A difference counts if it is confirmed in twice and in three times the digits: in one of them a value whose terms
cancel may come out as zero by luck.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from mpmath import mp

from .digits import DIGITS, WORKING_DIGITS
from .irregular_point import IrregularPoint
from .motion_states import ComparedValue

VANISHED = 2 * DIGITS // 3  # digits by which a difference shrinks in more digits where it is rounding
MULTIPLES = 2, 3  # of the working digits, in which a difference has to be found again

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
        Message for each part with a wrong value.
    regular : bool
        True if all of them are numbers.
    """
    with mp.workdps(WORKING_DIGITS):
        made, regular = _made(compared())
        differences = {i: _difference(value) for i, (_, value) in enumerate(made) if _differs(value, digits)}
    for multiple in MULTIPLES:
        if not differences:
            break
        with mp.workdps(multiple * WORKING_DIGITS):
            again, complete = _made(compared())
            made = again + made[len(again) :] if complete else again  # rounding may hide that a value is missing
            regular = regular and complete
            differences = {
                i: _difference(made[i][1])
                for i, before in differences.items()
                if i < len(made) and _differs(made[i][1], digits) and not _is_rounding(before, made[i][1])
            }
    found: dict[str, str] = {}
    for part, value in (made[i] for i in differences):
        found.setdefault(part, _described(value))
    return found, regular


def differing(compared: Callable[[], Iterator[ComparedValue]], digits: int = DIGITS) -> str:
    """Return the first wrong value, or an empty text.

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


def _difference(value: ComparedValue) -> mp.mpf:
    return abs(value.given - value.true)


def _is_rounding(before: mp.mpf, value: ComparedValue) -> bool:
    return _difference(value) <= before * mp.mpf(10) ** -VANISHED


def _described(value: ComparedValue) -> str:
    return f"{value.quantity}: {mp.nstr(value.given, 12)} where {mp.nstr(value.true, 12)} is so"
