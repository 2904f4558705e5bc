"""Chapter on effects: the named terms of a system, and their costs."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ...benchmark.machine import this_machine
from ...figures.motion import draw_with_and_without
from ...program.effects import MeasuredCosts, scene_costs
from ...program.request import Request
from ...record import Record
from ...sandbox import Limits
from ...simulation.result import Simulation
from ..chapter import Page, Run
from ..excerpts import excerpt
from ..runs import derived, simulation
from . import SPHERICAL_PENDULUM

SPARING, LAVISH = "swinging_scene", "shaken_scene"
TURNING, STILL = "foucault_scene", "still_scene"
SAMPLES = 1801


def runs(root: Path) -> dict[str, Run]:
    """Return the runs of the chapter.

    Parameters
    ----------
    root : Path
        Root of the repository.

    Returns
    -------
    dict of str to Run
        Runs by name.
    """
    file = root / SPHERICAL_PENDULUM
    return {
        "pendulum": derived(file),
        "sparing": Run(_costs, (file, SPARING)),
        "lavish": Run(_costs, (file, LAVISH)),
        "turning": simulation(file, TURNING, None, SAMPLES),
        "still": simulation(file, STILL, None, SAMPLES),
    }


def page(root: Path, results: Mapping[str, Any]) -> Page:
    """Return the page that results make.

    Parameters
    ----------
    root : Path
        Root of the repository.
    results : mapping
        Results of the runs by their names.

    Returns
    -------
    Page
        Content and files of the page.
    """
    turning, still = results["turning"], results["still"]
    return Page(
        {
            "system": results["pendulum"].record.system,
            "sparing": results["sparing"],
            "lavish": results["lavish"],
            "titles": _titles(results["pendulum"].record),
            "called": {name: _called(results["pendulum"].record, name) for name in (SPARING, LAVISH)},
            "machine": this_machine(()),
            "turning": turning,
            "still": still,
            "turned": (time := turning_point(turning))[1],
            "expected": -float(_rate_of_the_frame(results["pendulum"].record)) * time[0],
            "time": time[0],
            "system_lines": excerpt(root, SPHERICAL_PENDULUM, "system"),
            "scene_lines": excerpt(root, SPHERICAL_PENDULUM, SPARING),
        },
        figures={"foucault": draw_with_and_without(turning, still, "x", "y")},
        sources=(SPHERICAL_PENDULUM,),
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


def _rate_of_the_frame(record: Record) -> Any:
    """Return the rate at which the frame of the Foucault pendulum turns."""
    return next(scene.parameter_values["Omega"] for scene in record.scenes if scene.name == TURNING)


def turning_point(motion: Simulation) -> tuple[float, float]:
    """Return the last turning time on the initial side, and the angle from the start.

    Parameters
    ----------
    motion : Simulation
        Simulated motion.

    Returns
    -------
    tuple of float
        Time and angle in radians.
    """
    x, y = motion.coordinates["x"], motion.coordinates["y"]
    away = np.hypot(x, y)
    turns = np.flatnonzero((away[1:-1] >= away[:-2]) & (away[1:-1] > away[2:]) & (x[1:-1] * x[0] > 0)) + 1
    return float(motion.times[turns[-1]]), float(np.arctan2(y[turns[-1]], x[turns[-1]]) - np.arctan2(y[0], x[0]))
