"""What is computed of motions and is in no record, asked of Maxima and judged: programs, power series, controls."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from ..description import Description
from ..source import Source
from .motion_program import ProgramVerdict, ScenePrograms, ask_programs, judge_programs
from .motion_series import SceneSeries, ask_series, judge_series, judge_servo
from .report import EquationVerdict, Verdict
from .time_limit import TimeLimit
from .verdict import Judgement


@dataclass(frozen=True)
class Motions:
    """What Maxima wrote of the motions of a scene file."""

    programs: Sequence[ScenePrograms]
    series: Sequence[SceneSeries]


def ask_motions(source: Source, settings: Mapping[str, str]) -> Motions:
    """Ask Maxima for the programs and the power series of all scenes."""
    return Motions(ask_programs(source, settings), ask_series(source, settings))


def motion_verdicts(
    description: Description, motions: Motions, seed: str, seconds: float = math.inf
) -> Iterator[EquationVerdict]:
    """Verdicts for a report; undecided where the time is over before.

    Parameters
    ----------
    description : Description
        What is so.
    motions : Motions
        What Maxima wrote.
    seed : str
        Draws the states.
    seconds : float
        Time for all of them.
    """
    time = TimeLimit(seconds)

    def judged(work: Callable[[], list[ProgramVerdict]], scene: str | None) -> list[ProgramVerdict]:
        over = Judgement(Verdict.UNDECIDED, None, None, "the time limit was reached before")
        return time.result(work, [ProgramVerdict(scene, "motion", over)])

    for each in motions.programs:
        series = [found for found in motions.series if found.scene == each.scene]
        found = judged(lambda each=each: judge_programs(description, [each], seed), each.scene)
        found += judged(lambda each=each, series=series: judge_series(description, series, [each]), each.scene)
        found += judged(lambda each=each, series=series: judge_servo(description, [each], series), each.scene)
        for verdict in found:
            it = verdict.found
            what = ("motion", "", verdict.part, 0, verdict.scene)
            yield EquationVerdict(*what, it.verdict, it.digits, it.points, it.detail)
