"""A hard case: its difficulty, its reference solution and each method's digits."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike

from ...language import translatable
from ...simulation.hard_cases import Difficulty

MOST = 16.0  # digits of a double


class Extent(StrEnum):
    """The time span of a case: short for a test, or full."""

    SHORT = "short"
    FULL = "full"


class Outcome(StrEnum):
    """The outcome of a method. A comparison method may lose digits, Holonom may not."""

    HOLDS = translatable("holds")
    FAILS = translatable("fails")
    LOSES = translatable("loses it")


@dataclass(frozen=True)
class Result:
    """The correct digits of one method, or none if the result is only yes or no."""

    method: str
    quantity: str
    digits: float | None
    outcome: Outcome


@dataclass(frozen=True)
class Sweep:
    """Correct digits as a case becomes harder.

    Attributes
    ----------
    variable : str
        Label of the parameter that makes it harder, as on an axis.
    digits : mapping of str to tuple of float
        By method, one number for each value.
    """

    variable: str
    values: tuple[float, ...]
    digits: Mapping[str, tuple[float, ...]]


Findings = Iterator[Result | Sweep]


@dataclass(frozen=True)
class Case:
    """A hard case of the test set: its reference solution and its measurement."""

    name: str
    kind: Difficulty
    truth: str
    examine: Callable[[Extent], Findings]


@dataclass(frozen=True)
class CaseReport:
    """A hard case with its results."""

    case: Case
    results: tuple[Result, ...]
    sweep: Sweep | None

    @property
    def fails(self) -> bool:
        """True if a method of Holonom fails a requirement."""
        return any(result.outcome is Outcome.FAILS for result in self.results)


def examined(case: Case, extent: Extent) -> CaseReport:
    """Measure a case and return its results.

    Parameters
    ----------
    case : Case
    extent : Extent
        Time span of its motions.

    Returns
    -------
    CaseReport
        The case with its results.
    """
    found = list(case.examine(extent))
    sweep = next((each for each in found if isinstance(each, Sweep)), None)
    return CaseReport(case, tuple(each for each in found if isinstance(each, Result)), sweep)


def holonom_result(method: str, quantity: str, digits: float, needed: float) -> Result:
    """Return a method of Holonom's, with its required number of correct digits.

    Parameters
    ----------
    method : str
        Name of the method.
    quantity : str
        Name of the quantity.
    digits : float
        Correct decimal digits, from 0 to 16.
    needed : float
        Required number of correct digits.

    Returns
    -------
    Result
        `Outcome.HOLDS` or `Outcome.FAILS`.
    """
    return Result(method, quantity, digits, Outcome.HOLDS if digits >= needed else Outcome.FAILS)


def reference_result(method: str, quantity: str, digits: float, needed: float) -> Result:
    """Return a method for comparison, which may have fewer.

    Parameters
    ----------
    method : str
        Name of the method.
    quantity : str
        Name of the quantity.
    digits : float
        Correct decimal digits, from 0 to 16.
    needed : float
        Number of correct digits required of a method of Holonom.

    Returns
    -------
    Result
        `Outcome.HOLDS` or `Outcome.LOSES`.
    """
    return Result(method, quantity, digits, Outcome.HOLDS if digits >= needed else Outcome.LOSES)


def required(method: str, quantity: str, holds: bool) -> Result:
    """Return the result of a requirement without digits.

    Parameters
    ----------
    method : str
        Name of the method.
    quantity : str
        The requirement.
    holds : bool
        True if Holonom meets it.

    Returns
    -------
    Result
        `Outcome.HOLDS` or `Outcome.FAILS`.
    """
    return Result(method, quantity, None, Outcome.HOLDS if holds else Outcome.FAILS)


def correct_digits(computed: ArrayLike, truth: ArrayLike, scale: float | None = None) -> float:
    """Return the correct decimal digits of the worst number, from 0 to 16.

    An error is relative to the scale. Without it, to the largest of the true numbers. Numbers that are not finite have
    0 digits.

    Parameters
    ----------
    computed : array_like of float, shape (n,)
        Computed numbers.
    truth : array_like of float, shape (n,)
        True numbers.
    scale : float or None
        Size to which errors are relative.

    Returns
    -------
    float
    """
    error = np.max(np.abs(np.subtract(computed, truth)))
    return digits_of_error(error, scale or np.max(np.abs(truth)))


def digits_of_error(error: float, scale: float) -> float:
    """Return the decimal digits that an error leaves of a number, from 0 to 16.

    Parameters
    ----------
    error : float
        Absolute error, not negative.
    scale : float
        Size of the number.

    Returns
    -------
    float
    """
    if not np.isfinite(error):
        return 0.0
    return float(np.clip(-np.log10(error / scale), 0.0, MOST)) if error else MOST
