"""The textbook companion: static pages whose results come from runs.

The head of a page lists the runs that it needs, and values and figures that are computed from their results. Numbers,
equations and verdicts on the pages come from the runs, and the Maxima lines from the source files, at every build.
"""

import tomllib
from pathlib import Path
from typing import Any

from ..files import shared

TEMPLATES = Path(__file__).with_name("templates")
EXAMPLES = shared("examples")
PAPER, BEAD, PENDULUM = EXAMPLES / "paper/paper.mac", EXAMPLES / "bead.mac", EXAMPLES / "pendulum.mac"
TILTED_PLANE = EXAMPLES / "paper/knob.mac"
FREE_SCENE, INITIAL_SCENE = "free_motion_scene", "initial_motion_scene"


def table(name: str) -> dict[str, Any]:
    """Return the table of that name among the templates.

    Parameters
    ----------
    name : str
        Name of the table's file without its ending.

    Returns
    -------
    dict
        Content of the table.
    """
    return tomllib.loads((TEMPLATES / f"{name}.toml").read_text(encoding="utf-8"))
