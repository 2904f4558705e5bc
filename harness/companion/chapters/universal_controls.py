"""Which controls make every motion free: the question that the paper's equation (15) answers for one example."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...free_motion import FreeMotion
from ..chapter import Chapter, Page
from ..examples import BEAD, CABIN, INITIAL_SCENE, PAPER, PENDULUM, SPHERICAL_PENDULUM
from ..excerpts import excerpt
from ..runs import derived, free

SOURCE = "maxima/free_motion/universal.mac"
FUNCTIONS = ("universal_controls", "laws_of_condition", "laws_under", "solved_conditions")
OTHERS = {"cabin": CABIN, "pendulum": PENDULUM, "bead": BEAD, "spherical_pendulum": SPHERICAL_PENDULUM}

SCENES = {"paper": INITIAL_SCENE}  # of other files, the last


def chapter(root: Path) -> Chapter:
    """The chapter, with the systems under a root."""

    def page(results: Mapping[str, Any]) -> Page:
        answers: dict[str, FreeMotion] = {name: results[f"{name} free"] for name in ("paper", *OTHERS)}
        return Page(
            {
                "answers": answers,
                "titles": {name: results[name].record.system.title for name in answers},
                "others": tuple(OTHERS),
                "excerpts": [excerpt(root, SOURCE, name) for name in FUNCTIONS],
            },
            sources=(SOURCE,),
        )

    files = {"paper": PAPER, **OTHERS}
    return Chapter(
        slug="universal-controls",
        title="Which controls make every motion free",
        aim="The condition (10) for all states at once is a differential equation for the control.",
        template="universal_controls.html",
        runs={name: derived(root / file) for name, file in files.items()}
        | {f"{name} free": free(root / file, SCENES.get(name)) for name, file in files.items()},
        page=page,
    )
