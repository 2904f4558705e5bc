"""Chapter on the control for one trajectory."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ...figures.curves import Panel, draw_curves
from ...free_motion import FreeMotion
from ...language import gettext
from ..chapter import Page
from ..runs import derived, free
from . import BEAD, BOB, CABIN, INITIAL_SCENE, PAPER, PENDULUM, SPHERICAL_PENDULUM

FILES = {
    "paper": PAPER,
    "pendulum": PENDULUM,
    "cabin": CABIN,
    "bob": BOB,
    "bead": BEAD,
    "spherical_pendulum": SPHERICAL_PENDULUM,
}

SCENES = {"paper": INITIAL_SCENE}  # of other files, the last


RUNS = {name: derived(file) for name, file in FILES.items()} | {
    f"{name} free": free(file, SCENES.get(name)) for name, file in FILES.items()
}


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
    return Page(
        {
            "answers": {name: results[f"{name} free"].trajectory for name in FILES},
            "titles": {name: results[name].record.system.title for name in FILES},
        },
        figures={"strings": draw_curves([_lengths(results)], gettext("t (units of the scene)"))},
    )


def _lengths(results: Mapping[str, FreeMotion]) -> Panel:
    """Return the lengths of two strings that never pull."""
    shown = {gettext("pendulum: thrown, and falling"): "pendulum", gettext("bob on the table: straight on"): "bob"}
    curves = {
        label: np.array(results[f"{name} free"].trajectory.samples, dtype=float).T for label, name in shown.items()
    }
    return Panel(
        gettext("length u of the string\n(units of the scene)"),
        {label: (each[0], each[1]) for label, each in curves.items()},
    )
