"""Which controls make every motion free: the question that the paper's equation (15) answers for one example."""

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

from ...figures.curves import Panel, draw_curves
from ...free_motion import FreeMotion
from ...language import gettext, translatable
from ...simulation.result import Simulation
from ..chapter import Chapter, Page
from ..examples import BEAD, CABIN, INITIAL_SCENE, KNOB, PAPER, PENDULUM, SPHERICAL_PENDULUM
from ..excerpts import excerpt
from ..runs import derived, free, simulation

SOURCE = "maxima/free_motion/universal.mac"
FUNCTIONS = ("universal_controls", "laws_of_condition", "laws_under", "solved_conditions")
OTHERS = {"cabin": CABIN, "pendulum": PENDULUM, "bead": BEAD, "spherical_pendulum": SPHERICAL_PENDULUM}

EXPONENTIAL, DAMPINGS = "exponential_scene", ("0", "1", "2", "3")
UNTIL, SAMPLES = Fraction(4), 201
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
            figures={"dampings": draw_curves([under_dampings(results)], gettext("t (dimensionless)"))},
            sources=(SOURCE,),
        )

    files = {"paper": PAPER, **OTHERS}
    return Chapter(
        slug="universal-controls",
        title=translatable("Which controls make every motion free"),
        aim=translatable("The condition (10) for all states at once is a differential equation for the control."),
        template="universal_controls.html",
        runs={name: derived(root / file) for name, file in files.items()}
        | {f"c = {c}": simulation(root / KNOB, EXPONENTIAL, UNTIL, SAMPLES, (("c", c),)) for c in DAMPINGS}
        | {f"{name} free": free(root / file, SCENES.get(name)) for name, file in files.items()},
        page=page,
    )


def under_dampings(results: Mapping[str, Simulation]) -> Panel:
    """The multiplier under the paper's law, for some dampings."""
    motions = {f"c = {c}": results[f"c = {c}"] for c in DAMPINGS}
    curves = {name: (motion.instants, motion.multipliers["lambda1"]) for name, motion in motions.items()}
    return Panel(gettext("multiplier λ₁ (dimensionless)"), curves)
