"""Chapter on accuracy and run time, and on constraint stabilization."""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any

from ...benchmark.work_precision.measurement import WHOLE_MOTION, Group
from ...benchmark.work_precision.study import Plan, Study, study
from ...figures.benchmark import TIMES, draw_study
from ...figures.curves import draw_drift
from ...program.motion_problem import motion_problem
from ...program.request import Request
from ...sandbox import Limits
from ...simulation.request import SimulationRequest, Stabilization
from ...simulation.result import Simulation
from ...simulation.simulate import simulate
from ..chapter import FILES
from ..runs import Run, drawn
from . import INITIAL_SCENE, PAPER, PENDULUM

DOUBLE, QUADRUPLE, FIFTY = (1e-4, 1e-8, 1e-12, 1e-16), (1e-16, 1e-24, 1e-32), (1e-30, 1e-40, 1e-50)
SHORT_PLAN = Plan(
    tolerances={"double": DOUBLE, "quadruple": QUADRUPLE, "50": FIFTY},
    solver_tolerances=DOUBLE[:3],
    orders=(10, 20, 40, 80),
)
SWING, TOLERANCE, UNTIL, SAMPLES = "swing_scene", 1e-6, Fraction(100), 401


def page(results: Mapping[str, Any]) -> dict[str, Any]:
    """Return values of the page.

    Parameters
    ----------
    results : mapping
        Results of the runs by their names.

    Returns
    -------
    dict
        Values by name.
    """
    measured, motions = results["study"], results["drift"]
    return {
        "rows": [each for each in measured.measurements if each.group in WHOLE_MOTION],
        "series": [each for each in measured.measurements if each.group is Group.SERIES],
        "solves": [each for each in measured.measurements if each.group is Group.SOLVE],
        "tolerance": TOLERANCE,
        "worst": {
            method: {"constraints": max(each.residuals["position"]), "energy": max(abs(each.energy["energy_error"]))}
            for method, each in motions.items()
        },
        "pendulum": motions[Stabilization.NONE],
        FILES: {
            "accuracy.svg": drawn(partial(draw_study, measured, panels=TIMES, columns=1)),
            "drift.svg": draw_drift(motions),
        },
    }


def _short_study(file: Path, scene: str) -> Study:
    """Return the study of `holonom accuracy`, with fewer settings."""
    return study(file, Request(scene), Limits(), SHORT_PLAN)


def drifting(file: Path, scene: str) -> dict[Stabilization, Simulation]:
    """Return a motion at a coarse tolerance, with each stabilization method.

    Parameters
    ----------
    file : Path
        Scene file.
    scene : str
        Name of the scene.

    Returns
    -------
    dict of Stabilization to Simulation
        Motions by stabilization.
    """
    problem = replace(motion_problem(file, Request(scene), Limits()), observe=("trajectory", "energy", "residuals"))
    return {
        method: simulate(problem, SimulationRequest(tol=TOLERANCE, stabilization=method, until=UNTIL, samples=SAMPLES))
        for method in Stabilization
    }


RUNS = {"study": Run(_short_study, (PAPER, INITIAL_SCENE)), "drift": Run(drifting, (PENDULUM, SWING))}
