"""Verify the programs, power series and controls that Maxima computes of motions.

They are in no record.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from ..description import Description
from .motion_program import ProgramVerdict, ScenePrograms, read_programs, verify_programs
from .motion_series import SceneSeries, read_all_series, verify_series, verify_servo
from .questions import Answers
from .report import CheckResult, EquationVerdict, Item, Place, Verdict, verdict_on
from .time_limit import TimeLimit


@dataclass(frozen=True)
class Motions:
    """The results of Maxima about the motions of a scene file."""

    programs: Sequence[ScenePrograms]
    series: Sequence[SceneSeries]


def read_motions(description: Description, answers: Answers) -> Motions:
    """Read Maxima's answers about a description.

    Parameters
    ----------
    description : Description
        The reference.
    answers : Answers
        Documents or errors.

    Returns
    -------
    Motions

    Raises
    ------
    HolonomError
        An answer is not a document of the expected form.
    """
    return Motions(read_programs(description, answers.programs), read_all_series(description, answers.series))


def motion_verdicts(
    description: Description, motions: Motions, seed: str, seconds: float = math.inf
) -> Iterator[EquationVerdict]:
    """Yield verdicts on motions for a report, undecided after the time limit.

    Parameters
    ----------
    description : Description
        The reference.
    motions : Motions
        The results of Maxima.
    seed : str
        Seed of the random states.
    seconds : float
        Time for all of them.

    Yields
    ------
    EquationVerdict
        Verdict on one part of the programs or on a power series.
    """
    time = TimeLimit(seconds)

    def verify(work: Callable[[], list[ProgramVerdict]], scene: str | None) -> list[ProgramVerdict]:
        return time.result(work, [_out_of_time(scene)])

    for each in motions.programs:
        series = [found for found in motions.series if found.scene == each.scene]
        found = verify(lambda each=each: verify_programs(description, [each], seed), each.scene)
        found += verify(lambda each=each, series=series: verify_series(description, series, [each]), each.scene)
        found += verify(lambda each=each, series=series: verify_servo(description, [each], series), each.scene)
        yield from map(_as_equation_verdict, found)


def verdicts_out_of_time(description: Description) -> list[EquationVerdict]:
    """Return verdicts for motions that Maxima did not finish in time.

    Parameters
    ----------
    description : Description
        The reference.

    Returns
    -------
    list of EquationVerdict
        One for each scene, undecided.
    """
    return [_as_equation_verdict(_out_of_time(scene and scene.name)) for scene in description.scenes or (None,)]


def _out_of_time(scene: str | None) -> ProgramVerdict:
    over = CheckResult(Verdict.UNDECIDED, None, None, "the time limit was reached before")
    return ProgramVerdict(scene, "motion", over)


def _as_equation_verdict(verdict: ProgramVerdict) -> EquationVerdict:
    return verdict_on(Place(0, verdict.scene), Item("motion", "", verdict.part), verdict.found)
