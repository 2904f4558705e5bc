"""A scene's motion as Maxima hands it over: programs of (t, q, dot q) alone, and the state that it starts from.

One JSON document from Maxima, `maxima/record/motion_problem.mac`; `maxima/program/motion_problem.mac` says what each
program computes.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ..confined import Limits
from ..documents import Document, ask, read
from ..failures import Failure, HolonomError
from .motion_program import Program, count_operations, names_in, program_of
from .request import Request

if TYPE_CHECKING:
    from .drawing import Drawing

DOUBLE_DIGITS = 17  # decimal digits that tell any two doubles apart


class By(StrEnum):
    """What a switching function is of, the highest of these."""

    TIME = "time"
    CONFIGURATION = "configuration"
    VELOCITY = "velocity"


class Sign(NamedTuple):
    """A sign that a motion depends on.

    Attributes
    ----------
    name : str
        The input of the programs that stands for it.
    of : str
        The switching function whose sign it is, as Maxima prints it.
    by : By
    """

    name: str
    of: str
    by: By


@dataclass(frozen=True)
class MotionProblem:
    """A motion to follow.

    Every program takes t, the coordinates, the velocities, the multipliers and the signs, in this order.

    Attributes
    ----------
    system, source : str
        Title of the system, and where it comes from.
    scene, title : str
    time_span : (str, str) or None
        First and last instant, as decimal digits; None where the scene names none.
    observe : tuple of str
        What the scene observes: trajectory, multipliers, constraint_forces, energy, residuals.
    coordinates, multipliers : tuple of str
        Their names: n and g of them.
    start : mapping of str to str
        The time, coordinates and velocities at the start, as decimal digits.
    correction : (str, str) or None
        The given value that missed the constraints in its last digits and was corrected most, and by how much.
    obstacle : str or None
        Why no order of pivots solves the equations of motion; None where one does.
    motion : Program or None
        ``ddot(q)``, the multipliers by name and, where the scene observes them, ``Lambda[s]``; None with an obstacle.
    projection : Program or None
        ``position_correction[s]`` and ``velocity_correction[s]``: to the nearest state, in the mass metric, that
        keeps the constraints, up to second order in the residuals; None with an obstacle.
    matrices : Program
        ``A[s,k]`` and ``J[beta,s]`` where they are not zero by structure, ``h[s]``, ``c[beta]``,
        ``residual[beta]``, ``residual_rate[beta]``, indices from 1: A a - J^T lambda = h, J a = -c.
    energy : Program
        ``energy``, the energy function, and ``power``, its rate along the motion; they need the multipliers.
    drawing : Drawing or None
        How the system looks; None where it does not say.
    signs : tuple of Sign
        Of the functions whose changes of sign switch the motion; empty where it is analytic.
    switching : Program or None
        ``switch[i]``, the functions, with what decides how the motion passes their zeros, ``switch_rate[i]``,
        ``drive[i]`` and ``grip[i]``, and ``momentum[s]``; None without signs.
    """

    system: str
    source: str
    scene: str
    title: str
    time_span: tuple[str, str] | None
    observe: tuple[str, ...]
    coordinates: tuple[str, ...]
    multipliers: tuple[str, ...]
    start: Mapping[str, str]
    correction: tuple[str, str] | None
    obstacle: str | None
    motion: Program | None
    projection: Program | None
    matrices: Program
    energy: Program
    drawing: "Drawing | None"
    signs: tuple[Sign, ...] = ()
    switching: Program | None = None

    @property
    def state(self) -> tuple[str, ...]:
        """Names of the coordinates, then of the velocities."""
        return (*self.coordinates, *(f"dot({name})" for name in self.coordinates))


def require_analytic(problem: MotionProblem) -> None:
    """Refuse a motion whose signs are still open to whoever follows one analytic motion alone.

    Raises
    ------
    HolonomError
    """
    if problem.signs:
        raise HolonomError(Failure.NOT_ANALYTIC, problem.scene, problem.signs[0].of)


def motion_problem(file: Path, request: Request, limits: Limits, digits: int = DOUBLE_DIGITS) -> MotionProblem:
    """Ask Maxima for the motion of a scene.

    Parameters
    ----------
    file : Path
        The scene file.
    request : Request
    limits : Limits
        What Maxima may take.
    digits : int
        Significant digits of the initial state.

    Returns
    -------
    MotionProblem

    Raises
    ------
    HolonomError
        As `holonom.maxima.ask_scene`; the file has no scene, a control no law, a parameter no value.
    """
    return read_problem(problem_document(file, request, limits, digits))


def problem_document(file: Path, request: Request, limits: Limits, digits: int = DOUBLE_DIGITS) -> str:
    """The document of a scene's motion, as Maxima writes it.

    Parameters
    ----------
    file, request, limits, digits
        As for `motion_problem`.

    Returns
    -------
    str
        JSON text, for `read_problem`.

    Raises
    ------
    HolonomError
        As `motion_problem`.
    """
    asked = (request.scene, request.solve, digits)
    return ask(Document.MOTION_PROBLEM, file, *asked, settings=request.settings, limits=limits)


def read_problem(text: str) -> MotionProblem:
    """Read the document of a motion problem.

    Parameters
    ----------
    text : str
        JSON, as Maxima writes it.

    Returns
    -------
    MotionProblem

    Raises
    ------
    HolonomError
        It is no such document, or one of its programs is no program.
    """
    document = read(Document.MOTION_PROBLEM, text)
    span = document["time_span"]
    return MotionProblem(
        system=document["system"]["title"],
        source=document["system"]["source"],
        scene=document["scene"],
        title=document["title"],
        time_span=span and tuple(span),
        observe=tuple(document["observe"]),
        coordinates=tuple(document["coordinates"]),
        multipliers=tuple(document["multipliers"]),
        start=document["start"],
        correction=(correction := document["correction"]) and (correction["name"], correction["size"]),
        obstacle=document["obstacle"],
        motion=_optional(document["motion"]),
        projection=_optional(document["projection"]),
        matrices=program_of(document["matrices"]),
        energy=program_of(document["energy"]),
        drawing=_drawing(document["drawing"]),
        signs=tuple(Sign(sign["name"], sign["of"], By(sign["by"])) for sign in document["signs"]),
        switching=_optional(document["switching"]),
    )


def computing(program: Program, wanted: Collection[str]) -> Program:
    """The part of a program that some of its outputs need.

    Parameters
    ----------
    program : Program
    wanted : collection of str
        Outputs to keep.

    Returns
    -------
    Program
        With the same inputs.
    """
    outputs = {name: value for name, value in program.outputs.items() if name in wanted}
    needed = set().union(*map(names_in, outputs.values()))
    kept = []
    for name, expression in reversed(program.assignments):
        if name in needed:
            kept.append((name, expression))
            needed |= names_in(expression)
    part = replace(program, outputs=outputs, assignments=tuple(reversed(kept)))
    return replace(part, operations=count_operations(part))


def _optional(document: Any) -> Program | None:
    return None if document is None else program_of(document)


def _drawing(document: Any) -> "Drawing | None":
    if document is None:
        return None
    from .drawing import Drawing, Shape

    return Drawing(tuple(map(Shape, document["shapes"])), program_of(document["program"]))
