"""A measurement: a method at one setting, its preparation, its run and its error."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction
from typing import Any

import mpmath

from ...structs import entry

State = Sequence[mpmath.mpf]

WORKING_DIGITS = 300  # more than any state has


def relative_error(found: State, true: State) -> float:
    """Return the larger of the relative errors of coordinates and of velocities.

    Both are taken in the maximum norm. If all true values of one kind are zero, their error is absolute.

    Parameters
    ----------
    found : sequence of mpf, shape (2n,)
        Coordinates and velocities.
    true : sequence of mpf, shape (2n,)
        Their true values.

    Returns
    -------
    float
    """
    middle = len(true) // 2
    with mpmath.workdps(WORKING_DIGITS):
        deviations = [a - b for a, b in zip(found, true, strict=True)]
        return max(
            float(_largest(deviations[half]) / (_largest(true[half]) or 1))
            for half in (slice(None, middle), slice(middle, None))
        )


def numbers_of(texts: Iterable[str]) -> State:
    """Return decimal digits as numbers, without rounding.

    Parameters
    ----------
    texts : iterable of str
        Numbers in decimal digits, at most `WORKING_DIGITS`.

    Returns
    -------
    State
    """
    with mpmath.workdps(WORKING_DIGITS):
        return [mpmath.mpf(text) for text in texts]


def doubles(values: Iterable[float]) -> State:
    """Return a state in double precision, digit by digit.

    Parameters
    ----------
    values : iterable of float
        Coordinates and velocities.

    Returns
    -------
    State
    """
    return numbers_of(map(repr, map(float, values)))


def _largest(values: State) -> mpmath.mpf:
    return max(map(abs, values))


EXACT_TIME = "^-?[0-9]+(/[0-9]+)?$"


class Group(StrEnum):
    """The group in which a method is compared."""

    SERIES = "series"
    TAYLOR = "taylor"
    RUNGE_KUTTA = "runge-kutta"
    SOLVER = "solver"
    STABILIZATION = "stabilization"
    SOLVE = "solve"


# from the initial state to the end, and nothing else differs
WHOLE_MOTION = (Group.TAYLOR, Group.RUNGE_KUTTA, Group.SOLVER)


@dataclass(frozen=True)
class Prepared:
    """A method ready to run."""

    run: Callable[[], Any]  # integrates the motion once, from its initial time
    state: Callable[[Any], State]  # from what it returns to coordinates and velocities
    operations: Callable[[], int]  # arithmetic operations of a run, once it is done


@dataclass(frozen=True)
class BenchmarkCase:
    """A method at a setting."""

    group: Group
    # method, setting: for example ``Taylor, double`` and ``tol 1e-12``
    method: str
    setting: str
    time: Fraction  # to which the motion is integrated
    prepare: Callable[[], Prepared]  # compiles what has to be compiled


@dataclass(frozen=True)
class Measurement:
    """The error, time and work of a benchmark case."""

    group: Group = entry("Kind of method or of setting compared.")
    method: str = entry("Name of the method.")
    setting: str = entry("Setting of the method, such as its tolerance.")
    time: Fraction = entry("Time at which the error is measured.", pattern=EXACT_TIME)
    error: float = entry("Relative, in the maximum norm.", exclusiveMinimum=0)
    seconds: float = entry("Run time in seconds.", exclusiveMinimum=0)
    preparation_seconds: float | None = entry(
        "Time of the preparation in seconds; null if it is not measured.", minimum=0
    )
    operations: int = entry("Number of arithmetic operations.", minimum=0)


@dataclass(frozen=True)
class Omission:
    """A benchmark case that was not measured, with the reason."""

    method: str = entry("Name of the method.")
    setting: str = entry("Setting of the method.")
    reason: str = entry("Reason of the omission.")
