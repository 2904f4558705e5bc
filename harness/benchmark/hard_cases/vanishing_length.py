"""A pendulum drawn in to its hinge: where its length is zero the motion has to stop, with time, place and reason."""

import re
from collections.abc import Iterator
from math import nan

from mpmath import mpf

from ...failures import HolonomError
from ...language import translatable
from ...simulation.diagnosis import HardCase, advice
from .case import Extent, Findings, Result, digits_kept, ours, required
from .runs import problem, simulated

FILE, SCENES, UNTIL = "hard/vanishing_length.mac", ("straight_scene", "whirling_scene"), 2
VANISHES = mpf(1)  # the instant at which the length is zero
NEEDED = 6.0  # digits of that instant
INSTANT = re.compile(r"t = (\d+\.?\d*)")
ENGINE = "taylor"


def vanishing_length(extent: Extent) -> Findings:
    """Whether the runs stop, and when, where and why they say that they do."""
    for scene in SCENES:
        yield from results_of(scene)


def results_of(scene: str) -> Iterator[Result]:
    """What the refusal to follow a scene says."""
    said = refusal(scene)
    instants = [float(instant) for instant in INSTANT.findall(said)] or [nan]
    yield ours(
        ENGINE, translatable("instant of the stop, %(scene)s", scene=scene), digits_kept(instants, [VANISHES]), NEEDED
    )
    yield required(ENGINE, translatable("constraint named"), "the constraint of lambda1" in said)
    yield required(ENGINE, translatable("reason given"), advice(HardCase.VANISHING_LENGTH) in said)


def refusal(scene: str) -> str:
    """The sentence with which a run stops; empty where it does not."""
    try:
        simulated(problem(FILE, scene), UNTIL)
    except HolonomError as error:
        return str(error)
    return ""
