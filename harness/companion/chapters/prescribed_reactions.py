"""Prescribed reactions: the controls that give the multipliers prescribed values."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from ...figures.curves import Panel, draw_curves
from ...language import gettext
from ...simulation.result import Simulation
from ..chapter import Page
from ..mathematics import description
from ..runs import derived, free, series, simulation
from . import PRESCRIBED_TENSION

SCENES = ("thrown_scene", "steady_scene", "growing_scene")
ORDER = 40
UNTIL, SAMPLES = Fraction(2), 201


RUNS = (
    {"tension": derived(PRESCRIBED_TENSION)}
    | {f"{name} motion": simulation(PRESCRIBED_TENSION, name, UNTIL, SAMPLES) for name in SCENES[1:]}
    | {f"{name} free": free(PRESCRIBED_TENSION, name) for name in SCENES}
    | {f"{name} series": series(PRESCRIBED_TENSION, name, ORDER) for name in SCENES}
)


def page(results: Mapping[str, Any]) -> Page:
    """Return the page that results make.

    Parameters
    ----------
    results : mapping
        Results of the runs by their names.

    Returns
    -------
    Page
        Content and files of the page.
    """
    system = results["tension"].record.system
    return Page(
        {
            "system": system,
            "description": description(system),
            "answers": {name: results[f"{name} free"] for name in SCENES},
            "series": {name: results[f"{name} series"] for name in SCENES},
        },
        figures={"winch": draw_curves(_panels(results), gettext("t (units of the scene)"))},
    )


def _panels(results: Mapping[str, Simulation]) -> list[Panel]:
    """Return panels of the prescribed reaction and of the winch."""
    motions = {name: results[f"{name} motion"] for name in SCENES[1:]}
    labels = {name: gettext("steady") if name == SCENES[1] else gettext("growing") for name in motions}
    return [
        Panel(
            gettext("multiplier λ₁\n(units of the scene)"),
            {labels[name]: (motion.times, motion.multipliers["lambda1"]) for name, motion in motions.items()},
        ),
        Panel(
            gettext("length u of the string\n(units of the scene)"),
            {labels[name]: (motion.times, motion.coordinates["u"]) for name, motion in motions.items()},
        ),
    ]
