"""A hard case: what makes it hard, the truth, and what each method keeps of it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum

from ...simulation.diagnosis import HardCase, advice


class Extent(StrEnum):
    """How far a case is followed: as far as a test may take, or as far as it is meant."""

    SHORT = "short"
    FULL = "full"


class Outcome(StrEnum):
    """What a method made of a case: ours hold or fail; one that is there for comparison may lose it."""

    HOLDS = "holds"
    FAILS = "fails"
    LOSES = "loses it"


@dataclass(frozen=True)
class Result:
    """What one method keeps of the truth.

    Attributes
    ----------
    digits : float or None
        Decimal digits kept; None where the question is whether, not how much.
    """

    method: str
    quantity: str
    digits: float | None
    verdict: Outcome


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


@dataclass(frozen=True)
class Findings:
    """What was found of a case."""

    results: tuple[Result, ...]
    sweep: Sweep | None = None


@dataclass(frozen=True)
class Case:
    """A hard case of the register.

    Attributes
    ----------
    truth : str
        What the methods are measured against.
    examine : callable
        Measures them.
    """

    name: str
    kind: HardCase
    truth: str
    examine: Callable[[Extent], Findings]


@dataclass(frozen=True)
class CaseReport:
    """A case with what was found."""

    case: Case
    findings: Findings

    @property
    def advice(self) -> str:
        """What a user should do."""
        return advice(self.case.kind)

    @property
    def fails(self) -> bool:
        """Whether a method of ours does not hold what it should."""
        return any(result.verdict is Outcome.FAILS for result in self.findings.results)


def found(*results: Result) -> Findings:
    """Findings without a sweep."""
    return Findings(results)


def ours(method: str, quantity: str, digits: float, needed: float) -> Result:
    """A method of Holonom's, which has to keep so many digits."""
    return Result(method, quantity, digits, Outcome.HOLDS if digits >= needed else Outcome.FAILS)


def theirs(method: str, quantity: str, digits: float, needed: float) -> Result:
    """A method for comparison, which may keep fewer."""
    return Result(method, quantity, digits, Outcome.HOLDS if digits >= needed else Outcome.LOSES)


def required(method: str, quantity: str, holds: bool) -> Result:
    """Something that Holonom does or does not do."""
    return Result(method, quantity, None, Outcome.HOLDS if holds else Outcome.FAILS)
