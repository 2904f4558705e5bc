"""Pictures of a motion: the system drawn as it moves, where it says how it looks, and its curves."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from pathlib import Path

from ..confined import Limits
from ..figures.drawing import animation, film_of, strip
from ..figures.motion import draw_motion
from ..program.motion_problem import motion_problem
from ..program.request import Request
from ..program.sign_pattern import drawing_at_any_time
from ..simulation.request import SimulationRequest
from ..simulation.result import Report
from ..simulation.simulate import simulate
from .chapter import Run
from .runs import DEFAULT_LIMITS, NO_SETTINGS, Refusal, Settings, drawn, names_of_scenes, or_refusal

SAMPLES = 1801
SHOWN = ("trajectory", "multipliers")


@dataclass(frozen=True)
class MovingPicture:
    """A drawing in motion.

    Attributes
    ----------
    moving, still : str
        SVG: an animation, and a strip of positions.
    start, end : float
        Its first and last instant.
    pace : float
        Time of the motion that passes in a second of the animation.
    """

    moving: str
    still: str
    start: float
    end: float
    pace: float


@dataclass(frozen=True)
class Motion:
    """A scene's motion in pictures.

    Attributes
    ----------
    system, source, title : str
        Title of the system, where it comes from, and title of the scene.
    film : MovingPicture or None
        None where the system does not say how it looks.
    curves : str
        SVG: coordinates and multipliers against the time.
    report : Report
        How well the motion was followed.
    """

    system: str
    source: str
    title: str
    film: MovingPicture | None
    curves: str
    report: Report


def motion(file: Path, scene: str | None = None, until: Fraction | None = None) -> Run:
    """The pictures of a scene's motion, through its time span or to an instant: a `Motion`."""
    return Run(follow, (file, scene, until, NO_SETTINGS, DEFAULT_LIMITS))


def motions(file: Path, settings: Settings, limits: Limits) -> Run:
    """The pictures of all motions of a file: by scene a `Motion`, or the `Refusal` that takes its place."""
    return Run(follow_all, (file, settings, limits))


def follow_all(file: Path, settings: Settings, limits: Limits) -> dict[str, Motion | Refusal]:
    """Follow and draw every scene of a file."""
    names = names_of_scenes(file, settings, limits)
    return {name: or_refusal(follow, file, name, None, settings, limits) for name in names}


def follow(file: Path, scene: str | None, until: Fraction | None, settings: Settings, limits: Limits) -> Motion:
    """Follow a motion and draw it.

    Parameters
    ----------
    file : Path
    scene : str or None
        Without a name, the last one of the file.
    until : Fraction or None
        Without it, the end of the scene's time span.
    settings : tuple of (str, str)
    limits : Limits
        What Maxima may take.

    Raises
    ------
    HolonomError
        The motion has no end, or cannot be followed to it.
    """
    problem = replace(motion_problem(file, Request(scene, settings=dict(settings)), limits), observe=SHOWN)
    simulation = simulate(problem, SimulationRequest(until=until, samples=SAMPLES))
    shown = film_of(simulation, drawing_at_any_time(problem)) if problem.drawing else None
    return Motion(
        problem.system,
        problem.source,
        problem.title,
        shown and MovingPicture(animation(shown), strip(shown), *map(float, shown.instants[[0, -1]]), shown.pace),
        drawn(partial(draw_motion, replace(simulation, velocities={}))),
        simulation.report,
    )


def figures_of(motions: Iterable[tuple[str, Motion]]) -> dict[str, str]:
    """The SVG files of motions, whose names each begin with the motion's own."""
    files: dict[str, str] = {}
    for name, found in motions:
        files[f"{name}-curves"] = found.curves
        if found.film:
            files |= {f"{name}-moving": found.film.moving, f"{name}-still": found.film.still}
    return files
