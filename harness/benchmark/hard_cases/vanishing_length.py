"""A pendulum drawn in to its hinge.

If its length is zero, the motion has to stop with time, constraint and reason.
"""

from collections.abc import Iterator
from math import nan

from mpmath import mpf

from ...failures import ErrorKind, HolonomError
from ...language import translatable
from .case import Extent, Findings, Result, correct_digits, holonom_result, required
from .runs import problem, simulated

FILE, SCENES, UNTIL = "hard/vanishing_length.mac", ("straight_scene", "whirling_scene"), 2
VANISHES = mpf(1)  # the time at which the length is zero
NEEDED = 6.0  # digits of that time
ENGINE = "taylor"


def vanishing_length(extent: Extent) -> Findings:
    """Yield the results for the stop of each motion: its time, constraint and reason.

    Parameters
    ----------
    extent : Extent
        Without effect. The motions are short.

    Yields
    ------
    Result or Sweep
        Digits of the time of the stop, or whether constraint and reason are named.
    """
    for scene in SCENES:
        yield from results_of(scene)


def results_of(scene: str) -> Iterator[Result]:
    """Yield the results for the error that ends a scene's simulation.

    Parameters
    ----------
    scene : str
        Name of the scene.

    Yields
    ------
    Result
        Digits of the time of the stop, or whether constraint and reason are named.
    """
    refused = refusal(scene)
    facts = refused.facts if refused else {}
    digits = correct_digits([facts.get("time", nan)], [VANISHES])
    yield holonom_result(ENGINE, translatable("time of the stop, %(scene)s", scene=scene), digits, NEEDED)
    yield required(ENGINE, translatable("constraint named"), facts.get("multiplier") == "lambda1")
    given = refused is not None and refused.kind is ErrorKind.NO_GRADIENT
    yield required(ENGINE, translatable("reason given"), given)


def refusal(scene: str) -> HolonomError | None:
    """Return the error that ends a simulation, if there is one.

    Parameters
    ----------
    scene : str
        Name of the scene.

    Returns
    -------
    HolonomError or None
        None if the simulation reaches its end.
    """
    try:
        simulated(problem(FILE, scene), UNTIL)
    except HolonomError as error:
        return error
    return None
