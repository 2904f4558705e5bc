"""A pendulum drawn in to its hinge: where its length is zero the motion has to stop, with time, place and reason."""

from collections.abc import Iterator
from math import nan

from mpmath import mpf

from ...failures import Failure, HolonomError
from ...language import translatable
from .case import Extent, Findings, Result, digits_kept, ours, required
from .runs import problem, simulated

FILE, SCENES, UNTIL = "hard/vanishing_length.mac", ("straight_scene", "whirling_scene"), 2
VANISHES = mpf(1)  # the instant at which the length is zero
NEEDED = 6.0  # digits of that instant
ENGINE = "taylor"


def vanishing_length(extent: Extent) -> Findings:
    """Return whether the runs stop, and when, where and why they say that they do."""
    for scene in SCENES:
        yield from results_of(scene)


def results_of(scene: str) -> Iterator[Result]:
    """Yield what the refusal to follow a scene holds."""
    refused = refusal(scene)
    facts = refused.facts if refused else {}
    digits = digits_kept([facts.get("instant", nan)], [VANISHES])
    yield ours(ENGINE, translatable("instant of the stop, %(scene)s", scene=scene), digits, NEEDED)
    yield required(ENGINE, translatable("constraint named"), facts.get("multiplier") == "lambda1")
    given = refused is not None and refused.failure is Failure.NO_GRADIENT
    yield required(ENGINE, translatable("reason given"), given)


def refusal(scene: str) -> HolonomError | None:
    """Return what a run stops with, if it does."""
    try:
        simulated(problem(FILE, scene), UNTIL)
    except HolonomError as error:
        return error
    return None
