"""Prescribed reactions: the constraints push as hard as they are told to, and the controls see to it."""

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

from ...figures.curves import Panel, draw_curves
from ...language import gettext
from ...simulation.result import Simulation
from ..chapter import Page, Run
from ..excerpts import excerpt
from ..mathematics import description
from ..runs import derived, free, series, simulation
from . import LEVEL_LOAD, PRESCRIBED_TENSION

SOURCE = "maxima/control/prescribed_reactions.mac"
FUNCTIONS = ("released_system", "controls_under_reactions")
SCENES = ("thrown_scene", "steady_scene", "growing_scene")
ORDER = 40
UNTIL, SAMPLES = Fraction(2), 201


def runs(root: Path) -> dict[str, Run]:
    """Return what the chapter needs."""
    file = root / PRESCRIBED_TENSION
    return (
        {"tension": derived(file)}
        | {f"{name} motion": simulation(file, name, UNTIL, SAMPLES) for name in SCENES[1:]}
        | {f"{name} free": free(file, name) for name in SCENES}
        | {f"{name} series": series(file, name, ORDER) for name in SCENES}
    )


def page(root: Path, results: Mapping[str, Any]) -> Page:
    """Return the page that results make."""
    system = results["tension"].record.system
    return Page(
        {
            "system": system,
            "description": description(system),
            "scene_lines": excerpt(root, PRESCRIBED_TENSION, SCENES[1]),
            "level_lines": excerpt(root, LEVEL_LOAD, "swing_scene"),
            "answers": {name: results[f"{name} free"] for name in SCENES},
            "series": {name: results[f"{name} series"] for name in SCENES},
            "excerpts": [excerpt(root, SOURCE, name) for name in FUNCTIONS],
        },
        figures={"winch": draw_curves(panels(results), gettext("t (units of the scene)"))},
        sources=(SOURCE, PRESCRIBED_TENSION, LEVEL_LOAD),
    )


def panels(results: Mapping[str, Simulation]) -> list[Panel]:
    """Return what is prescribed, and what the winch does."""
    motions = {name: results[f"{name} motion"] for name in SCENES[1:]}
    labels = {name: gettext("steady") if name == SCENES[1] else gettext("growing") for name in motions}
    return [
        Panel(
            gettext("multiplier λ₁\n(units of the scene)"),
            {labels[name]: (motion.instants, motion.multipliers["lambda1"]) for name, motion in motions.items()},
        ),
        Panel(
            gettext("length u of the string\n(units of the scene)"),
            {labels[name]: (motion.instants, motion.coordinates["u"]) for name, motion in motions.items()},
        ),
    ]
