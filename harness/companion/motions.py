"""A motion and the drawing of its system, of which pages make pictures."""

from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path

from ..figures.drawing import Film, film_of
from ..program.motion_problem import motion_problem
from ..program.request import Request
from ..program.sign_pattern import drawing_at_any_time
from ..sandbox import Limits
from ..simulation.request import SimulationRequest
from ..simulation.result import Simulation
from ..simulation.simulate import simulate
from .runs import DEFAULT_LIMITS, NO_SETTINGS, Settings

SAMPLES = 1801
SHOWN = ("trajectory", "multipliers")


@dataclass(frozen=True)
class Motion:
    """A scene's motion, of which pictures are made."""

    # of the system, where that comes from, and of the scene
    system: str
    source: str
    title: str
    film: Film | None  # None if the system has no drawing
    simulation: Simulation  # coordinates and multipliers


def motion(
    file: Path,
    scene: str | None = None,
    until: Fraction | None = None,
    settings: Settings = NO_SETTINGS,
    limits: Limits = DEFAULT_LIMITS,
) -> Motion:
    """Simulate a scene to a time, by default to the end of its time span.

    Parameters
    ----------
    file : Path
        Scene file.
    scene : str or None
        Name of the scene.
    until : Fraction or None
        Last time, or None for that of the scene.
    settings : Settings
        Values of parameters.
    limits : Limits
        Limits of Maxima's runs.

    Returns
    -------
    Motion
        The motion and its pictures.

    Raises
    ------
    HolonomError
        The motion has no end, or cannot be continued to it.
    """
    problem = replace(motion_problem(file, Request(scene, settings=dict(settings)), limits), observe=SHOWN)
    simulation = simulate(problem, SimulationRequest(until=until, samples=SAMPLES))
    film = film_of(simulation, drawing_at_any_time(problem)) if problem.drawing else None
    system = problem.system
    return Motion(system.title, system.source or "", problem.title, film, replace(simulation, velocities={}))
