"""Runs of chapters other than commands."""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

from ..benchmark.hard_cases.case import CaseReport, Extent, examined
from ..benchmark.hard_cases.register import REGISTER
from ..benchmark.work_precision.study import Plan, Study, study
from ..program.model import Model, scene_model
from ..program.motion_problem import motion_problem
from ..program.motion_program import Program
from ..program.request import Request
from ..sandbox import Limits
from ..simulation.request import SimulationRequest, Stabilization
from ..simulation.result import Simulation
from ..simulation.simulate import simulate
from . import EXAMPLES, INITIAL_SCENE, PAPER, PENDULUM, TILTED_PLANE, table
from .convergence import find_radii
from .motions import motion
from .runs import Run

LAWS = {"linear": "linear_scene", "exponential": "exponential_scene", "swinging": "swinging_scene"}
OPEN = ("u0", "k", "c")
OF_LAW = {"linear": (), "exponential": ("kappa",), "swinging": ("omega",)}  # parameters of one law alone

DOUBLE, QUADRUPLE, FIFTY = (1e-4, 1e-8, 1e-12, 1e-16), (1e-16, 1e-24, 1e-32), (1e-30, 1e-40, 1e-50)
SHORT_PLAN = Plan(
    tolerances={"double": DOUBLE, "quadruple": QUADRUPLE, "50": FIFTY},
    solver_tolerances=DOUBLE[:3],
    orders=(10, 20, 40, 80),
)
SWING, COARSE, UNTIL, SAMPLES = "swing_scene", 1e-6, Fraction(100), 401

EXHIBITS = table("gallery")["exhibit"]


def models(file: Path) -> dict[str, Model]:
    """Return the scenes of the control page as models whose parameters are open.

    Parameters
    ----------
    file : Path
        Scene file.

    Returns
    -------
    dict of str to Model
        Models by control law.
    """
    return {law: scene_model(file, Request(scene), [*OPEN, *OF_LAW[law]], Limits()) for law, scene in LAWS.items()}


def _drawing_of(file: Path, scene: str) -> tuple[tuple[str, ...], Program]:
    """Return the shapes of a system's drawing, and the program of their numbers."""
    drawing = motion_problem(file, Request(scene), Limits()).drawing
    return tuple(map(str, drawing.shapes)), drawing.program


def _short_study(file: Path, scene: str) -> Study:
    """Return the study of ``holonom accuracy``, with fewer settings."""
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
        method: simulate(problem, SimulationRequest(tol=COARSE, stabilization=method, until=UNTIL, samples=SAMPLES))
        for method in Stabilization
    }


def _short_report(name: str) -> CaseReport:
    """Return the short report on a hard case."""
    return examined(next(case for case in REGISTER if case.name == name), Extent.SHORT)


def _exhibit(file: str, scene: str | None = None, until: str | None = None, **shown: str) -> Run:
    return Run(motion, (EXAMPLES.parent / file, scene, until and Fraction(until)))


FURTHER_RUNS: Mapping[str, Mapping[str, Run]] = {
    "gallery": {each["name"]: _exhibit(**each) for each in EXHIBITS},
    "hard-cases": {case.name: Run(_short_report, (case.name,)) for case in REGISTER},
    "radius-of-convergence": {"radii": Run(find_radii)},
    "turn-the-knob": {
        "models": Run(models, (TILTED_PLANE,)),
        "drawing": Run(_drawing_of, (TILTED_PLANE, LAWS["linear"])),
    },
    "work-precision": {
        "study": Run(_short_study, (PAPER, INITIAL_SCENE)),
        "drift": Run(drifting, (PENDULUM, SWING)),
    },
}
"""Runs by the names of their results, by page."""
