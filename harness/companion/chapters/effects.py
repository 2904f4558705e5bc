"""Chapter on effects: the named terms of a system, and their costs."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...figures.motion import draw_with_and_without
from ...program.effects import MeasuredCosts, scene_costs
from ...program.request import Request
from ...record import Record
from ...sandbox import Limits
from ..chapter import Page, Run
from ..runs import derived, simulation
from . import SPHERICAL_PENDULUM

SPARING, LAVISH = "swinging_scene", "shaken_scene"
TURNING, STILL = "foucault_scene", "still_scene"
SAMPLES = 1801


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
            "system": results["pendulum"].record.system,
            "titles": _titles(results["pendulum"].record),
            "called": {name: _called(results["pendulum"].record, name) for name in (SPARING, LAVISH)},
        },
        figures={"foucault": draw_with_and_without(results["turning"], results["still"], "x", "y")},
    )


def _costs(file: Path, scene: str) -> MeasuredCosts:
    """Return the costs of the effects of a scene, as `holonom effects` reports them."""
    return scene_costs(file, Request(scene), Limits())


def _titles(record: Record) -> dict[str, str]:
    """Title of each scene by its name."""
    return {scene.name: scene.title for scene in record.scenes}


def _called(record: Record, name: str) -> tuple[str, ...]:
    """Return the effects that a scene calls for."""
    return next(scene.effects for scene in record.scenes if scene.name == name)


RUNS = {
    "pendulum": derived(SPHERICAL_PENDULUM),
    "sparing": Run(_costs, (SPHERICAL_PENDULUM, SPARING)),
    "lavish": Run(_costs, (SPHERICAL_PENDULUM, LAVISH)),
    "turning": simulation(SPHERICAL_PENDULUM, TURNING, None, SAMPLES),
    "still": simulation(SPHERICAL_PENDULUM, STILL, None, SAMPLES),
}
