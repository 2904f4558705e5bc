"""The report of a cross-check: one verdict an equation, and their counts."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import NamedTuple

from ..language import translatable
from ..record import LeftOut
from ..shown import Shown
from ..structs import computed, entry, group, with_attributes


class Verdict(StrEnum):
    """Verdicts on an equation after comparison with the independent evaluation."""

    PROVED = translatable("proved")
    """The difference is identically zero."""
    AGREES = translatable("agrees")
    """The difference vanishes, to the digits stated, at the random points stated, and where exp, sin and the like have
    values independent of their arguments."""
    SAMPLED = translatable("agrees at points")
    """The difference vanishes, to the digits stated, at the random points stated, and nothing more is known."""
    DISAGREES = translatable("disagrees")
    """The difference does not vanish, or the equation is not there."""
    UNDECIDED = translatable("undecided")
    """Too few random points were found at which both sides have values."""
    NOTHING = translatable("nothing to check")
    """The equation states nothing of this system."""
    LEFT_OUT = translatable("left out")
    """The equation was not made, for a reason that the record states."""


class CheckResult(NamedTuple):
    """A verdict, the digits and points that support it, and the difference found."""

    verdict: Verdict
    digits: int | None
    points: int | None
    detail: str = ""


class Item(NamedTuple):
    """An equation: its id, the equation number and its name."""

    id: str
    number: str
    name: str


OPINION = Item("lagranges_method", "2", translatable("Lagrange's equations (SymPy LagrangesMethod)"))


class Place(NamedTuple):
    """The place of a verdict: a derivation and a scene of it or none.

    The derivation is given by its place in the record.
    """

    derivation: int
    scene: str | None = None


@dataclass(frozen=True)
class EquationVerdict:
    """The verdict on one equation of the record."""

    id: str = entry("As in the record, empty where the equation was not made.")
    number: str = entry("The equation number; several equations may share one.")
    name: str = entry("Name of the equation.")
    derivation: int = entry("The derivation that the equation belongs to: its place in the record.", minimum=0)
    scene: str | None = entry(
        "The scene that the equation belongs to; null where it is the system's.", key="scene_name"
    )
    verdict: Verdict = entry("Result of the comparison.")
    digits: int | None = entry("Significant digits to which both sides agree; null where nothing was evaluated.")
    points: int | None = entry("Random points at which they were compared; null where nothing was evaluated.")
    detail: str = entry(
        "For a disagreement the relation, the difference and the point; for what is undecided the reason; else empty."
    )
    is_recorded: bool = True  # whether the record holds the equation
    left_out: LeftOut | None = None  # why the equation was not made


def verdict_on(
    place: Place, item: Item, found: CheckResult, is_recorded: bool = True, left_out: LeftOut | None = None
) -> EquationVerdict:
    """Return the result for an equation as a verdict of a report.

    Parameters
    ----------
    place : Place
        Derivation and scene of the equation.
    item : Item
        The equation.
    found : CheckResult
        Result of the comparison.
    is_recorded : bool
        True if the record holds the equation.
    left_out : LeftOut or None
        Reason why the equation was not made.

    Returns
    -------
    EquationVerdict
    """
    return EquationVerdict(
        **item._asdict(), **place._asdict(), **found._asdict(), is_recorded=is_recorded, left_out=left_out
    )


@with_attributes
@dataclass(frozen=True, repr=False)
class CheckReport(Shown):
    """Verdicts on all equations of a record, in the record's order."""

    verdicts: tuple[EquationVerdict, ...] = entry(
        "The verdict on each equation, in the record's order.", key="equations"
    )
    seed: str = entry("Draws the same random points again, as `--seed`.")

    def with_verdicts(self, verdicts: Iterable[EquationVerdict]) -> "CheckReport":
        """Return the report with further verdicts.

        Parameters
        ----------
        verdicts : iterable of EquationVerdict
            Further verdicts, for the end.

        Returns
        -------
        CheckReport
        """
        return replace(self, verdicts=(*self.verdicts, *verdicts))

    @property
    @computed("Equations that the record holds.", "made", minimum=0)
    def _made(self) -> int:
        return len(self.verdicts) - self._left_out

    @property
    @computed("Equations that were not made.", "left_out", minimum=0)
    def _left_out(self) -> int:
        return self.count(Verdict.LEFT_OUT)

    @property
    @computed("Equations whose difference is shown to be identically zero.", "proved", minimum=0)
    def _proved(self) -> int:
        return self.count(Verdict.PROVED)

    @property
    @computed("Equations that are proved or agree, those that agree at points alone among them.", "agreed", minimum=0)
    def _agreed(self) -> int:
        return self.count(Verdict.PROVED, Verdict.AGREES, Verdict.SAMPLED)

    @property
    @computed(
        "Equations of which it is not known whether they agree: too few points with values on both sides, a side of a "
        "branch that no point reached, or a time limit.",
        "undecided",
        minimum=0,
    )
    def _undecided(self) -> int:
        return self.count(Verdict.UNDECIDED)

    @property
    @computed("Number of equations that disagree or are missing.", minimum=0)
    def disagreements(self) -> int:
        """Number of equations that disagree or are missing."""
        return self.count(Verdict.DISAGREES)

    def count(self, *verdicts: Verdict) -> int:
        """Return the number of equations with one of these verdicts.

        Parameters
        ----------
        *verdicts : Verdict
            Verdicts to count.

        Returns
        -------
        int
        """
        return sum(found.verdict in verdicts for found in self.verdicts)


@dataclass(frozen=True)
class CheckedFile:
    """Verdicts on the equations of a scene file."""

    scene: str = entry("The scene file.")
    report: CheckReport = group()
