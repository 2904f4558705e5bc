"""Every sentence of the chapters that states a result, tied to the run that shows it.

A sentence that is changed on the page, or a run that no longer shows it, fails here.
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
import pages
import pytest
from sympy import Rational, Symbol, simplify

from holonom.free_motion import FreeMotionVerdict
from holonom.series.radius import ENTIRE

T = Symbol("t", real=True)


class Statement(NamedTuple):
    """A sentence, and what the runs of its chapter must show for it."""

    chapter: str
    sentence: str
    shown: Callable[[Mapping[str, Any]], bool]  # of the page's values


def goes_straight_on(found) -> bool:
    """r^2 of a straight line is quadratic in the time."""
    times, lengths = np.array(found["bob"].trajectory.samples, dtype=float).T
    return np.abs(np.diff(lengths**2, 3)).max() < 1e-9


def falls_freely(found) -> bool:
    """u^2 of a thrown body is of the fourth degree in the time."""
    times, lengths = np.array(found["pendulum"].trajectory.samples, dtype=float).T
    return np.abs(np.diff(lengths**2, 5)).max() < 1e-6 * np.abs(lengths**2).max()


def multipliers(motion) -> np.ndarray:
    return np.abs(motion.multipliers["lambda1"])


def slope_of_the_first_multiplier(found) -> bool:
    """lambda1 at the start as a function of u0, differentiated with pencil."""
    u = Symbol("u")
    multiplier = (-3 * u + (1 - u) / 3) / (1 + 2 * u**2)
    return multiplier.diff(u).subs(u, Rational(3, 10)) == Rational(found["slope"])


def step_five(found) -> bool:
    """The multiplier and the acceleration of S = q1 + q2 as the page has them."""
    q, v = (sum(Symbol(name.format(k), real=True) for k in (1, 2)) for name in ("q{}", "dot(q{})"))
    u, rate, acceleration, reaction = (Symbol(name, real=True) for name in ("u", "dot(u)", "ddot(u)", "lambda1"))
    multiplier = found["steps"]["multipliers"].relations[0].right
    first, second, _ = (each.right for each in found["steps"]["driven_accelerations"].relations)
    written = ((acceleration - u) * q + 2 * (rate - u) * v) / (1 + 2 * u**2)
    return simplify(multiplier - written) == 0 and simplify(first + second + q + 2 * v + 2 * u * reaction) == 0


def misprint(found) -> bool:
    """The difference of the multipliers under u0 + t is 2 dot(S)/(1 + 2 u^2)."""
    lacking = 2 * found["S_dot"] / (1 + 2 * found["u"] ** 2)
    return np.abs(found["pushed"].multipliers["lambda1"] - found["printed_along"] - lacking).max() < 1e-9


STATEMENTS = [
    Statement("initial-motion", "is the same number", slope_of_the_first_multiplier),
    Statement(
        "equations-of-motion",
        "no reaction acts along",
        lambda found: np.ptp(found["angular_momentum"]) < 1e-9,
    ),
    Statement(
        "equations-of-motion",
        "The length decreases linearly. Angular velocity and pull rise, the pull most of all.",
        lambda found: all(np.diff(found["motion"].velocities["dot(phi)"]) > 0)
        and all(np.diff(multipliers(found["motion"])) > 0)
        and multipliers(found["motion"])[-1] / multipliers(found["motion"])[0]
        > found["motion"].velocities["dot(phi)"][-1] / found["motion"].velocities["dot(phi)"][0],
    ),
    Statement(
        "free-motion",
        "the multiplier is zero, under",
        lambda found: found["free_law"].motion.verdict is FreeMotionVerdict.FREE
        and multipliers(found["free_motion"]).max() < 1e-9,
    ),
    Statement("free-motion", "The three curves balance to", lambda found: found["error"].max() < 1e-8),
    Statement("free-motion", "of work on the control", lambda found: found["spent"] < 0),
    Statement(
        "initial-motion",
        "Near the initial time each further order is closer to the motion.",
        lambda found: all(np.diff([abs(sums - beginning(found)[-1])[20] for sums in beginning(found)[:-1]]) < 0),
    ),
    Statement("free-motion", "It changes linearly", lambda found: found["free_height"].diff(T, 2).equals(0)),
    Statement(
        "equations-of-motion",
        "the equations become",
        step_five,
    ),
    Statement(
        "free-motion",
        "a critically damped oscillator",
        lambda found: simplify(found["free_sum"].diff(T, 2) + 2 * found["free_sum"].diff(T) + found["free_sum"]) == 0,
    ),
    Statement(
        "worked-example",
        "A numerical integration that does not use this formula begins with",
        lambda found: abs(-100 / 177 - found["multiplier_followed"]) < 1e-9,
    ),
    Statement("worked-example", "which vanishes only where", misprint),
    Statement(
        "radius-of-convergence",
        "The estimate from",
        lambda found: abs(found["alone"].estimate - 0.76811457) < found["alone"].uncertainty
        and not found["alone"].located,
    ),
    Statement(
        "universal-controls",
        "is the only family of such laws",
        lambda found: found["paper"].universal.verdict == "all" and len(found["paper"].universal.laws) == 1,
    ),
    Statement(
        "universal-controls",
        "the multiplier is zero throughout",
        lambda found: [multipliers(found[name]).max() < 1e-9 for name in ("undamped", "light", "critical", "heavy")]
        == [False, False, True, False],
    ),
    Statement("trajectory-control", "It is the distance of a thrown body from the origin.", falls_freely),
    Statement(
        "trajectory-control", "A bob without tension moves in a straight line with constant velocity", goes_straight_on
    ),
    Statement(
        "prescribed-reactions",
        "The multiplier is negative because the string pulls",
        lambda found: all(found[name].multipliers["lambda1"][-1] < 0 for name in ("steady", "growing")),
    ),
    Statement(
        "radius-of-convergence",
        "For the law of its first task this is true.",
        lambda found: found["free"].radius == ENTIRE,
    ),
    Statement(
        "radius-of-convergence",
        "For the law of its second task it is false.",
        lambda found: [errors[-1] < errors[0] for errors in errors_within_and_beyond(found)] == [True, False],
    ),
    Statement(
        "turn-the-knob",
        "the plane lies flat, and the reaction is zero for all",
        lambda found: [dict(law.controls) for law in found["other"].universal.laws] == [{"u": 0}]
        and found["other"].universal.verdict == "all",
    ),
    Statement(
        "turn-the-knob",
        "the reaction is zero, and the control needs no work",
        lambda found: found["paper"].motion.states == "all states" and abs(found["spent"]["exponential"]) < 1e-9,
    ),
]


def beginning(found) -> list:
    return [values for _, values in found["beginning"].values()]


def errors_within_and_beyond(found) -> list:
    """Errors of the partial sums by order, at t = 1/2 and at t = 1."""
    return [[values[k] for _, values in found["errors"].values()] for k in (100, 200)]


@pytest.mark.parametrize("statement", STATEMENTS, ids=lambda each: each.sentence[:40])
def test_a_sentence_is_on_its_page_and_its_run_shows_it(statement, companion, chapter_pages):
    assert statement.sentence in pages.words(companion / "book" / f"{statement.chapter}.html")
    assert statement.shown(chapter_pages[statement.chapter])
