"""Chapter on controls that make every motion free, eq. (15) of the paper."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from ...figures.curves import Panel, draw_curves
from ...free_motion import FreeMotion
from ...language import gettext
from ...simulation.result import Simulation
from ..chapter import Page
from ..runs import derived, free, simulation
from . import BEAD, CABIN, INITIAL_SCENE, KNOB, PAPER, PENDULUM, SPHERICAL_PENDULUM

OTHERS = {"cabin": CABIN, "pendulum": PENDULUM, "bead": BEAD, "spherical_pendulum": SPHERICAL_PENDULUM}

EXPONENTIAL, DAMPINGS = "exponential_scene", ("0", "1", "2", "3")
UNTIL, SAMPLES = Fraction(4), 201
SCENES = {"paper": INITIAL_SCENE}  # of other files, the last


FILES = {"paper": PAPER, **OTHERS}
RUNS = (
    {name: derived(file) for name, file in FILES.items()}
    | {f"c = {c}": simulation(KNOB, EXPONENTIAL, UNTIL, SAMPLES, (("c", c),)) for c in DAMPINGS}
    | {f"{name} free": free(file, SCENES.get(name)) for name, file in FILES.items()}
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
    answers: dict[str, FreeMotion] = {name: results[f"{name} free"] for name in ("paper", *OTHERS)}
    return Page(
        {
            "answers": answers,
            "titles": {name: results[name].record.system.title for name in answers},
            "others": tuple(OTHERS),
        },
        figures={"dampings": draw_curves([_under_dampings(results)], gettext("t (dimensionless)"))},
    )


def _under_dampings(results: Mapping[str, Simulation]) -> Panel:
    """Return the multiplier under the paper's law, for some dampings."""
    motions = {f"c = {c}": results[f"c = {c}"] for c in DAMPINGS}
    curves = {name: (motion.times, motion.multipliers["lambda1"]) for name, motion in motions.items()}
    return Panel(gettext("multiplier λ₁ (dimensionless)"), curves)
