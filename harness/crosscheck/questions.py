"""Ask Maxima for the programs and power series of motions, in one run.

The module imports nothing of SymPy, so that SymPy is loaded while Maxima runs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from ..description import DescribedScene, Description
from ..documents import Question, ask_all
from ..expression.functions import FUNCTIONS
from ..failures import HolonomError
from ..formats import Document
from ..program.request import Solve
from ..source import Source
from .digits import WORKING_DIGITS

ORDER = 7  # of power series
EXACT_UP_TO = 12  # coordinates: exact coefficients of a ring of 21 take five times as long as rounded ones
ROUNDED = 30  # digits, as users get them
MOST_COORDINATES = 100  # of a power series: Maxima takes a minute for that of 512 bodies

Answer = str | HolonomError
SceneAndSolve = tuple[str | None, Solve]


class Answers(NamedTuple):
    """Documents, or the reasons why there are none."""

    programs: Mapping[SceneAndSolve, Answer]  # empty where none are requested
    series: Mapping[str, Answer]


def ask_for_check(source: Source, settings: Mapping[str, str]) -> Answers:
    """Ask Maxima for all documents of a check about motions.

    Parameters
    ----------
    source : Source
        The scene file.
    settings : mapping of str to str
        Values of open names.

    Returns
    -------
    Answers
        A document, or the error in its place, for each question.

    Raises
    ------
    HolonomError
        As `holonom.documents.ask_all`.
    """
    description = source.description(settings)
    programs, series = _programs(description), _series(description)
    answers = iter(ask_all([*programs.values(), *series.values()], source, settings))
    return Answers({each: next(answers) for each in programs}, {each: next(answers) for each in series})


def holds_special_functions(description: Description) -> bool:
    """Return True if a description has a special function of the time.

    Maxima takes minutes to evaluate one in 50 digits.

    Parameters
    ----------
    description : Description

    Returns
    -------
    bool
    """
    return any(f'"{each.head}"' in description.text for each in FUNCTIONS if each.special)


def is_closed(description: Description, scene: DescribedScene | None) -> bool:
    """Return True if there is a motion without open names.

    Parameters
    ----------
    description : Description
    scene : DescribedScene or None
        One of its scenes, or None for the system.

    Returns
    -------
    bool
    """
    if scene is None:
        return False
    free = [name for name in description.system.controls if name not in scene.control_law]
    found = scene.prescribed_reactions or scene.servo_trees
    return (not free or bool(found)) and set(description.system.parameters) <= set(scene.parameter_values)


def _programs(description: Description) -> dict[SceneAndSolve, Question]:
    """Return the questions for all scenes, or for the system if there is none."""
    if holds_special_functions(description):
        return {}
    scenes: Sequence[DescribedScene | None] = description.scenes or (None,)
    return {(scene and scene.name, solve): _program(description, scene, solve) for scene in scenes for solve in Solve}


def _program(description: Description, scene: DescribedScene | None, solve: Solve) -> Question:
    name = scene and scene.name
    if is_closed(description, scene):
        return Question(Document.MOTION_PROBLEM, (name, solve, WORKING_DIGITS, (), ()))
    return Question(Document.PROGRAM, (name, solve))


def _series(description: Description) -> dict[str, Question]:
    coordinates = len(description.system.coordinates)
    if holds_special_functions(description) or coordinates > MOST_COORDINATES:
        return {}
    digits = "automatic" if coordinates <= EXACT_UP_TO else ROUNDED
    return {
        scene.name: Question(Document.MOTION_SERIES, (scene.name, ORDER, digits, None)) for scene in description.scenes
    }
