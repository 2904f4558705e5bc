"""A hard case: what makes it hard, the truth, and how many decimal digits of it each method keeps."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum

import mpmath
from mpmath import mp, mpf

from ...language import translatable
from ...simulation.hard_cases import HardCase

MOST = 16.0  # digits of a double
TRUTH_DIGITS = 40  # that a truth is computed with

certified = mp.workdps(TRUTH_DIGITS)
"""Decorates what computes a truth; as a context, what its constants are made in."""


class Extent(StrEnum):
    """How far a case is followed: as far as a test may take, or as far as it is meant."""

    SHORT = "short"
    FULL = "full"


class Outcome(StrEnum):
    """What a method made of a case: ours hold or fail; one that is there for comparison may lose it."""

    HOLDS = translatable("holds")
    FAILS = translatable("fails")
    LOSES = translatable("loses it")


@dataclass(frozen=True)
class Result:
    """What one method keeps of the truth; no digits where the question is whether, not how much."""

    method: str
    quantity: str
    digits: float | None
    outcome: Outcome


@dataclass(frozen=True)
class Sweep:
    """Digits kept as the case becomes harder.

    Attributes
    ----------
    variable : str
        What makes it harder, as an axis says it.
    digits : mapping of str to tuple of float
        By method, one number for each value.
    """

    variable: str
    values: tuple[float, ...]
    digits: Mapping[str, tuple[float, ...]]


Findings = Iterator[Result | Sweep]


@dataclass(frozen=True)
class Case:
    """A hard case of the register: its truth in words, and what measures the methods against it."""

    name: str
    kind: HardCase
    truth: str
    examine: Callable[[Extent], Findings]


@dataclass(frozen=True)
class CaseReport:
    """A case with what was found."""

    case: Case
    results: tuple[Result, ...]
    sweep: Sweep | None

    @property
    def fails(self) -> bool:
        """Whether a method of ours does not hold what it should."""
        return any(result.outcome is Outcome.FAILS for result in self.results)


def examined(case: Case, extent: Extent) -> CaseReport:
    """Return a case with what is found of it."""
    found = list(case.examine(extent))
    sweep = next((each for each in found if isinstance(each, Sweep)), None)
    return CaseReport(case, tuple(each for each in found if isinstance(each, Result)), sweep)


def ours(method: str, quantity: str, digits: float, needed: float) -> Result:
    """Return a method of Holonom's, which has to keep so many digits."""
    return Result(method, quantity, digits, Outcome.HOLDS if digits >= needed else Outcome.FAILS)


def theirs(method: str, quantity: str, digits: float, needed: float) -> Result:
    """Return a method for comparison, which may keep fewer."""
    return Result(method, quantity, digits, Outcome.HOLDS if digits >= needed else Outcome.LOSES)


def required(method: str, quantity: str, holds: bool) -> Result:
    """Something that Holonom does or does not do."""
    return Result(method, quantity, None, Outcome.HOLDS if holds else Outcome.FAILS)


def digits_kept(computed: Iterable[float], truth: Iterable[mpf], scale: float | mpf | None = None) -> float:
    """Decimal digits that numbers keep of the truth, the worst of them counting: from 0, also for no number, to 16.

    An error is relative to the scale; without it, to the largest of the true numbers.
    """
    pairs = [(mpf(float(value)), exact) for value, exact in zip(computed, truth, strict=True)]
    if not all(mpmath.isfinite(value) for value, _ in pairs):
        return 0.0
    return digits_of_error(max(abs(value - exact) for value, exact in pairs), scale or max(abs(x) for _, x in pairs))


def digits_of_error(error: float | mpf, scale: float | mpf) -> float:
    """Decimal digits that an error leaves of a number of that scale, from 0 to 16."""
    if not mpmath.isfinite(error):
        return 0.0
    return float(min(MOST, max(0.0, -mpmath.log10(error / scale)))) if error else MOST
