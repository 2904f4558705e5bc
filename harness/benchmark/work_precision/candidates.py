"""Who is measured: a method at one setting, what it takes to prepare it, and how it is run."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction
from typing import Any

from .errors import State


class Group(StrEnum):
    """What a method is compared with."""

    SERIES = "series"
    TAYLOR = "taylor"
    RUNGE_KUTTA = "runge-kutta"
    SOLVER = "solver"
    DRIFT = "drift"
    SOLVE = "solve"


WHOLE_MOTION = (Group.TAYLOR, Group.RUNGE_KUTTA, Group.SOLVER)  # from the start to the end, and nothing else differs


@dataclass(frozen=True)
class Prepared:
    """A method ready to run.

    Attributes
    ----------
    run : callable
        Follows the motion once, from its start.
    state : callable
        From what it returns to coordinates and velocities.
    operations : callable
        Arithmetic operations of a run, once it is done.
    """

    run: Callable[[], Any]
    state: Callable[[Any], State]
    operations: Callable[[], int]


@dataclass(frozen=True)
class Candidate:
    """A method at a setting.

    Attributes
    ----------
    method, setting : str
        For instance ``Taylor, double`` and ``tol 1e-12``.
    instant : Fraction
        To which the motion is followed.
    prepare : callable
        Compiles what has to be compiled.
    """

    group: Group
    method: str
    setting: str
    instant: Fraction
    prepare: Callable[[], Prepared]


@dataclass(frozen=True)
class Measurement:
    """What a candidate achieved.

    Attributes
    ----------
    error : float
        As `holonom.benchmark.work_precision.errors.relative_error` defines it.
    seconds : float
        Of the shortest run.
    preparation_seconds : float or None
        Compiling and the like; None where nothing is prepared apart.
    """

    group: Group
    method: str
    setting: str
    instant: Fraction
    error: float
    seconds: float
    preparation_seconds: float | None
    operations: int


@dataclass(frozen=True)
class Omission:
    """What was not measured, and why."""

    method: str
    setting: str
    reason: str
