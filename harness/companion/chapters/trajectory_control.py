"""The control for one trajectory: a constraint that goes where the free system goes."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ...figures.curves import Panel, draw_curves
from ...free_motion import FreeMotion
from ...language import gettext
from ..chapter import Page, Run
from ..excerpts import excerpt
from ..runs import derived, free
from . import BEAD, BOB, CABIN, INITIAL_SCENE, PAPER, PENDULUM, SPHERICAL_PENDULUM

SOURCE = "maxima/free_motion/trajectory.mac"
FUNCTIONS = ("trajectory_control", "law_along", "solved_along", "freed_scene")
FILES = {
    "paper": PAPER,
    "pendulum": PENDULUM,
    "cabin": CABIN,
    "bob": BOB,
    "bead": BEAD,
    "spherical_pendulum": SPHERICAL_PENDULUM,
}

SCENES = {"paper": INITIAL_SCENE}  # of other files, the last


def runs(root: Path) -> dict[str, Run]:
    """Return what the chapter needs."""
    return {name: derived(root / file) for name, file in FILES.items()} | {
        f"{name} free": free(root / file, SCENES.get(name)) for name, file in FILES.items()
    }


def page(root: Path, results: Mapping[str, Any]) -> Page:
    """Return the page that results make."""
    return Page(
        {
            "answers": {name: results[f"{name} free"].trajectory for name in FILES},
            "titles": {name: results[name].record.system.title for name in FILES},
            "excerpts": [excerpt(root, SOURCE, name) for name in FUNCTIONS],
        },
        figures={"strings": draw_curves([lengths(results)], gettext("t (units of the scene)"))},
        sources=(SOURCE,),
    )


def lengths(results: Mapping[str, FreeMotion]) -> Panel:
    """Return the lengths of two strings that never pull."""
    shown = {gettext("pendulum: thrown, and falling"): "pendulum", gettext("bob on the table: straight on"): "bob"}
    curves = {
        label: np.array(results[f"{name} free"].trajectory.samples, dtype=float).T for label, name in shown.items()
    }
    return Panel(
        gettext("length u of the string\n(units of the scene)"),
        {label: (each[0], each[1]) for label, each in curves.items()},
    )
