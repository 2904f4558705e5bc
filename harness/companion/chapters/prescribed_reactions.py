"""Prescribed reactions: the constraints push as hard as they are told to, and the controls see to it."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..chapter import Chapter, Page
from ..description import description
from ..examples import PRESCRIBED_TENSION
from ..excerpts import excerpt
from ..runs import derived, free, series

SOURCE = "maxima/free_motion/prescribed_reactions.mac"
FUNCTIONS = ("released_system", "controls_under_reactions")
SCENES = ("thrown_scene", "steady_scene", "growing_scene")
ORDER = 40


def chapter(root: Path) -> Chapter:
    """The chapter, with the systems under a root."""
    file = root / PRESCRIBED_TENSION

    def page(results: Mapping[str, Any]) -> Page:
        system = results["tension"].record.system
        return Page(
            {
                "system": system,
                "description": description(system),
                "scene_lines": excerpt(root, PRESCRIBED_TENSION, SCENES[1]),
                "answers": {name: results[f"{name} free"] for name in SCENES},
                "series": {name: results[f"{name} series"] for name in SCENES},
                "excerpts": [excerpt(root, SOURCE, name) for name in FUNCTIONS],
            },
            sources=(SOURCE, PRESCRIBED_TENSION),
        )

    return Chapter(
        slug="prescribed-reactions",
        title="Prescribed reactions",
        aim="Free motion asks for reactions that are zero; one may as well ask for any other.",
        template="prescribed_reactions.html",
        runs={"tension": derived(file)}
        | {f"{name} free": free(file, name) for name in SCENES}
        | {f"{name} series": series(file, name, ORDER) for name in SCENES},
        page=page,
    )
