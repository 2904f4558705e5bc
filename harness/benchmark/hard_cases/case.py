"""A hard case: its difficulty, its reference solution and each method's digits."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike

from ...explanations import advice
from ...language import translatable
from ...simulation.hard_cases import Difficulty
from ...structs import computed, entry, group

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

    method: str = entry("Name of the method.")
    quantity: str = entry("Quantity that is compared.")
    digits: float | None = entry("Correct decimal digits; null for a question of yes or no.", minimum=0, maximum=16)
    outcome: Outcome = entry("A method that is there for comparison may lose it.")


@dataclass(frozen=True)
class Sweep:
    """Correct digits as a case becomes harder."""

    variable: str = entry("Label of the parameter that makes it harder, as on an axis.")
    values: tuple[float, ...] = entry("Values of that parameter.")
    digits: Mapping[str, tuple[float, ...]] = entry("By method, one number for each value.")


Findings = Iterator[Result | Sweep]


@dataclass(frozen=True)
class Case:
    """A hard case of the test set: its reference solution and its measurement."""

    name: str = entry("Name of the case.", key="case")
    kind: Difficulty = entry("Difficulty of the case.")
    truth: str = entry("Reference of the comparison.")
    examine: Callable[[Extent], Findings]

    @property
    @computed("What to do in a case of this kind.")
    def advice(self) -> str:
        """Advice for cases of this kind."""
        return advice(self.kind)


@dataclass(frozen=True)
class CaseReport:
    """A hard case with its results."""

    case: Case = group()
    results: tuple[Result, ...] = entry("Results of the methods.")
    sweep: Sweep | None = entry("Correct digits as the case becomes harder; null for a single case.")

    @property
    @computed("A method of Holonom's does not hold what it should; the exit status is then 1.")
    def fails(self) -> bool:
        """True if a method of Holonom fails a requirement."""
        return any(result.outcome is Outcome.FAILS for result in self.results)


@dataclass(frozen=True)
class CaseReports:
    """Correct digits of each method in the hard cases."""

    cases: tuple[CaseReport, ...] = entry("The register's cases, in its order.")


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


def graded(method: str, quantity: str, digits: float, needed: float, compared: bool = False) -> Result:
    """Return the result of a method with its number of correct digits.

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
    compared : bool
        True if the method is there for comparison, and may have fewer.

    Returns
    -------
    Result
    """
    missed = Outcome.LOSES if compared else Outcome.FAILS
    return Result(method, quantity, digits, Outcome.HOLDS if digits >= needed else missed)


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
