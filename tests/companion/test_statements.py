"""Every sentence of the chapters that states a result, tied to the run that shows it.

A sentence that is changed on the page, or a run that no longer shows it, fails here.
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
import pages
import pytest
from sympy import Rational, Symbol, simplify

from holonom.companion.chapters import (
    equations_of_motion,
    free_motion,
    initial_motion,
    prescribed_reactions,
    radius_of_convergence,
    trajectory_control,
    turn_the_knob,
    universal_controls,
    worked_example,
)
from holonom.companion.paper import chapters_of_the_paper
from holonom.free_motion import FreeMotionVerdict
from holonom.series.radius import ENTIRE

T = Symbol("t", real=True)


class Statement(NamedTuple):
    """A sentence, and what the runs of its chapter must show for it."""

    chapter: Any
    sentence: str
    shown: Callable[[Mapping[str, Any], Mapping[str, Any]], bool]  # of the runs' results and the page's content


def goes_straight_on(found, content) -> bool:
    """r^2 of a straight line is quadratic in the time."""
    times, lengths = np.array(found["bob free"].trajectory.samples, dtype=float).T
    return np.abs(np.diff(lengths**2, 3)).max() < 1e-9


def falls_freely(found, content) -> bool:
    """u^2 of a thrown body is of the fourth degree in the time."""
    times, lengths = np.array(found["pendulum free"].trajectory.samples, dtype=float).T
    return np.abs(np.diff(lengths**2, 5)).max() < 1e-6 * np.abs(lengths**2).max()


def multipliers(motion) -> np.ndarray:
    return np.abs(motion.multipliers["lambda1"])


def slope_of_the_first_multiplier(found, content) -> bool:
    """lambda1 at the start as a function of u0, differentiated with pencil."""
    u = Symbol("u")
    multiplier = (-3 * u + (1 - u) / 3) / (1 + 2 * u**2)
    return multiplier.diff(u).subs(u, Rational(3, 10)) == Rational(content["slope"])


STATEMENTS = [
    Statement(initial_motion, "is the same number", slope_of_the_first_multiplier),
    Statement(
        equations_of_motion,
        "no reaction acts along",
        lambda found, content: np.ptp(equations_of_motion.momentum(found["motion"])) < 1e-9,
    ),
    Statement(
        equations_of_motion,
        "The length decreases linearly. Angular velocity and pull rise, the pull most of all.",
        lambda found, content: all(np.diff(found["motion"].velocities["dot(phi)"]) > 0)
        and all(np.diff(multipliers(found["motion"])) > 0)
        and multipliers(found["motion"])[-1] / multipliers(found["motion"])[0]
        > found["motion"].velocities["dot(phi)"][-1] / found["motion"].velocities["dot(phi)"][0],
    ),
    Statement(
        free_motion,
        "the multiplier is zero, under",
        lambda found, content: found["free_law"].motion.verdict is FreeMotionVerdict.FREE
        and multipliers(found["unpushed"]).max() < 1e-9,
    ),
    Statement(free_motion, "The three curves balance to", lambda found, content: content["balance"].error < 1e-8),
    Statement(free_motion, "of work on the control", lambda found, content: content["spent"] < 0),
    Statement(
        initial_motion,
        "Near the initial time each further order is closer to the motion.",
        lambda found, content: all(
            np.diff([abs(sums - beginning(found)[-1])[20] for sums in beginning(found)[:-1]]) < 0
        ),
    ),
    Statement(free_motion, "It changes linearly", lambda found, content: content["free_height"].diff(T, 2).equals(0)),
    Statement(
        equations_of_motion,
        "the equations become",
        lambda found, content: not {"q1", "q2"} & {str(each) for each in content["multiplier_in_sum"].free_symbols},
    ),
    Statement(
        free_motion,
        "a critically damped oscillator",
        lambda found, content: simplify(
            content["free_sum"].diff(T, 2) + 2 * content["free_sum"].diff(T) + content["free_sum"]
        )
        == 0,
    ),
    Statement(
        worked_example,
        "A numerical integration that does not use this formula begins with",
        lambda found, content: abs(content["multiplier_at_start"] - content["multiplier_followed"]) < 1e-9,
    ),
    Statement(
        universal_controls,
        "is the only family of such laws",
        lambda found, content: found["paper free"].universal.verdict == "all"
        and len(found["paper free"].universal.laws) == 1,
    ),
    Statement(
        universal_controls,
        "the multiplier is zero throughout",
        lambda found, content: {c: multipliers(found[f"c = {c}"]).max() < 1e-9 for c in universal_controls.DAMPINGS}
        == {c: c == "2" for c in universal_controls.DAMPINGS},
    ),
    Statement(trajectory_control, "It is the distance of a thrown body from the origin.", falls_freely),
    Statement(
        trajectory_control, "A bob without tension moves in a straight line with constant velocity", goes_straight_on
    ),
    Statement(
        prescribed_reactions,
        "The multiplier is negative because the string pulls",
        lambda found, content: all(
            found[f"{name} motion"].multipliers["lambda1"][-1] < 0 for name in prescribed_reactions.SCENES[1:]
        ),
    ),
    Statement(
        radius_of_convergence,
        "For the law of its first task this is true.",
        lambda found, content: found["free"].radius == ENTIRE,
    ),
    Statement(
        radius_of_convergence,
        "For the law of its second task it is false.",
        lambda found, content: [errors[-1] < errors[0] for errors in content["confronted"].values()] == [True, False],
    ),
    Statement(
        turn_the_knob,
        "the plane lies flat, and the reaction is zero with any forces",
        lambda found, content: [dict(law.controls) for law in found["other"].universal.laws] == [{"u": 0}]
        and found["other"].universal.verdict == "all",
    ),
    Statement(
        turn_the_knob,
        "the reaction is zero, and the control needs no work",
        lambda found, content: found["free"].motion.states == "all states"
        and abs(content["spent"]["exponential"]) < 1e-9,
    ),
]


def beginning(found) -> list:
    return [values for _, values in initial_motion.beginning(found["expanded"]).curves.values()]


@pytest.fixture(scope="module")
def contents(results, chapter_pages):
    """Results of the runs and content of the page, of each chapter that states something."""
    made = {}
    for module in {statement.chapter for statement in STATEMENTS}:
        slug = module.__name__.rpartition(".")[2].replace("_", "-")
        chapter = chapters_of_the_paper()[slug]
        found = {name: results[run] for name, run in chapter.runs.items()}
        made[module] = (slug, found, chapter_pages[slug].content)
    return made


@pytest.mark.parametrize("statement", STATEMENTS, ids=lambda each: each.sentence[:40])
def test_a_sentence_is_on_its_page_and_its_run_shows_it(statement, companion, contents):
    slug, found, content = contents[statement.chapter]
    assert statement.sentence in pages.words(companion / "book" / f"{slug}.html")
    assert statement.shown(found, content)
