"""A scene's motion from Maxima: programs of (t, q, dot q), and the initial state.

They come in one JSON document (`maxima/record/motion_problem.mac`). The outputs of each program are defined in
`maxima/program/motion_problem.mac`.
"""

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from ..described import Correction
from ..documents import ask
from ..failures import ErrorKind, HolonomError
from ..formats import Document, nothing_collected, read
from ..language import Message, translatable
from ..sandbox import Limits
from ..source import Source, source_of
from ..structs import group, key, structured
from .motion_program import Program
from .request import Request
from .table import Table

if TYPE_CHECKING:
    from ..description import Description
    from .drawing import Drawing

Built = TypeVar("Built")
DOUBLE_DIGITS = 17  # decimal digits that distinguish any two doubles


class DependsOn(StrEnum):
    """The highest of the quantities that a switching function depends on."""

    TIME = "time"
    CONFIGURATION = "configuration"
    VELOCITY = "velocity"
    REACTION = "reaction"


class Sign(NamedTuple):
    """A sign that a motion depends on."""

    name: str  # its input of the programs
    of: str  # the switching function whose sign it is, as Maxima prints it
    by: DependsOn


class Origin(StrEnum):
    """The origin of an initial value if the parameters change.

    ``GIVEN``: the scene gives it. ``NEAR``: the constraints determine it, near the scene's guess. ``CONTINUED``: they
    determine it, near its value for the scene's parameters. ``ONLY``: they determine it, and contain it linearly.
    """

    GIVEN = "given"
    NEAR = "near"
    CONTINUED = "continued"
    ONLY = "only"


@dataclass(frozen=True)
class ParametricStart:
    """The initial state as a function of its open parameters."""

    # of the open parameters: each coordinate and velocity, or what the search for it begins with
    program: Program | None
    origins: Mapping[str, Origin]
    # why the initial state cannot be adapted to the parameters; there is a program where it can
    obstruction: Message | None


@dataclass(frozen=True)
class InitialData:
    """The origin of the initial state, which is in `MotionProblem.start`."""

    # the given value whose last digits were corrected most to satisfy the constraints, and the correction
    correction: Correction | None = None
    # the initial value that differs most from the scene's guess, and by how much; None without a guess
    moved: Correction | None = None
    given: tuple[str, ...] = ()  # of the state: what the scene gives at the initial time; the rest is found
    parametric: ParametricStart | None = key("parametric_start", None)  # None without open parameters


@dataclass(frozen=True)
class Servo:
    """The servo-constraints of a motion, whose multipliers are zero."""

    constraints: int = key("servo", 0)  # number of them, the last of the constraints
    # ``servo_matrix[j,i]``: coefficient of the i-th control that they find, in the second time derivative of
    # condition j; None without such controls
    matrix: Program | None = key("servo_matrix", None)
    # of each output that they prescribe: which of its time derivatives the controls are in
    relative_degrees: tuple[int, ...] = ()


@dataclass(frozen=True)
class Release:
    """Constraints that end at the first zero crossing of a condition."""

    of: str  # the condition, as Maxima prints it
    multipliers: tuple[str, ...]  # those of the constraints
    after: "MotionProblem"  # the motion without them, at the initial time of the whole


@dataclass(frozen=True)
class Ends:
    """Zero crossings that end the motion, or constraints of it."""

    # expressions whose first zero crossing ends the motion, as Maxima prints them; empty where the time span alone does
    until: tuple[str, ...] = ()
    events: Program | None = None  # ``event[i]``, their values; they may need the multipliers. None without `until`.
    releases: Program | None = None  # ``event[i]``, the conditions of `released`, as `events`; None without any
    released: tuple[Release, ...] = ()


@dataclass(frozen=True)
class MotionProblem:
    """The data of a motion to be simulated.

    Every program takes t, the coordinates, the velocities, the multipliers, the signs, the open parameters and what
    the tables are at t, in this order. That of the outputs the accelerations, too.
    """

    # system, source: title of the system, and where it comes from
    system: str
    source: str
    scene: str
    title: str
    time_span: tuple[str, str] | None  # first and last time, as decimal digits; None where the scene names none
    observe: tuple[str, ...]  # what the scene observes: trajectory, multipliers, constraint_forces, energy, residuals
    # coordinates, multipliers: names, n and g of them
    coordinates: tuple[str, ...]
    multipliers: tuple[str, ...]
    # the time, coordinates and velocities at the initial time, as decimal digits; the time alone where a parameter
    # without a value decides about the others
    start: Mapping[str, str]
    initial: InitialData = group()
    ends: Ends = group()
    servo: Servo = group()
    obstruction: Message | None  # why no order of pivots solves the equations of motion; None where one does
    # ``ddot(q)``, the multipliers by name and, where the scene observes them, ``Lambda[s]``; None with an obstruction
    motion: Program | None
    # ``position_correction[s]`` and ``velocity_correction[s]``: to the nearest state, in the mass metric, that meets
    # constraints, up to second order in the residuals; None with an obstruction
    projection: Program | None
    # ``A[s,k]`` and ``J[beta,s]`` where they are not zero by structure, ``h[s]``, ``c[beta]``, ``residual[beta]``,
    # ``residual_rate[beta]``, indices from 1: A a - J^T lambda = h, J a = -c
    matrices: Program
    # ``energy``, the energy function, and ``power``, its time derivative along the motion; they need the multipliers
    energy: Program
    drawing: "Drawing | None"  # the drawing of the system, or None
    # the last time at which the drives have values, where tables or special functions give them
    law_end: str | None = None
    written_out: tuple[str, ...] = ()  # special functions of the time, which programs hold as sums of polynomials
    # the controls, by name, ``ddot(u)`` of those that servo-constraints move; None if they are not observed
    controls: Program | None = None
    # what the scene observes under names of its own; ``ddot(q)`` are inputs, behind the multipliers. None without any
    outputs: Program | None = None
    reacting: tuple[str, ...] = ()  # multipliers that forces contain
    signs: tuple[Sign, ...] = ()  # of the functions whose changes of sign switch the motion; empty where it is analytic
    # ``switch[i]``, the functions, with what decides how the motion passes their zeros, ``switch_rate[i]``,
    # ``drive[i]`` and ``grip[i]``, and ``momentum[s]``; ``regular`` where forces contain multipliers,
    # positive where they are determined. None without signs and without such forces
    switching: Program | None = None
    tables: tuple[Table, ...] = ()  # of the law, each of more polynomials than one
    parameters: tuple[str, ...] = ()  # those that stay open
    # their values in this motion; some may be missing if none is integrated
    values: Mapping[str, Fraction] = field(default_factory=dict)
    # sizes with which quantities are compared, by name, ``t`` for the time: those that the scene gives
    nominal: Mapping[str, float] = field(default_factory=dict)
    joints: Mapping[str, str] = field(default_factory=dict)  # as `Description.joints`
    joint_shapes: Mapping[str, Sequence[int]] = field(default_factory=dict)  # as `Description.joint_shapes`
    _compiled: dict[Hashable, list[tuple[object, Any]]] = field(default_factory=dict, compare=False, repr=False)

    def once(self, what: Hashable, part: object, build: "Callable[[], Built]") -> "Built":
        """Return the result of `build` for a part, cached for all values of open inputs.

        Without open inputs, nothing is cached.

        Parameters
        ----------
        what : Hashable
            Distinguishes the results for one part.
        part : object
            Object that the result depends on, in most cases a program.
        build : callable
            Function without arguments that makes the result.

        Returns
        -------
        object
            The result of `build`.
        """
        if not self.open_inputs:
            return build()
        known = self._compiled.setdefault(what, [])
        for of, built in known:
            if of is part:
                return built
        known.append((part, build()))
        return known[-1][1]

    def __getstate__(self) -> dict[str, Any]:
        """Return the state for another process, without compiled functions."""
        return {**vars(self), "_compiled": {}}

    @property
    def open_inputs(self) -> tuple[str, ...]:
        """Names of the open parameters and of the inputs of tables.

        They follow the time, the state, the multipliers and the signs.
        """
        return (*self.parameters, *(name for table in self.tables for name in table.inputs))

    @property
    def numbers(self) -> tuple[float, ...]:
        """Values of the open parameters, in double precision."""
        return tuple(float(self.values[name]) for name in self.parameters)

    @property
    def independent(self) -> tuple[int, ...]:
        """Independent constraints, counted from 0."""
        redundant = self.motion.redundant if self.motion else ()
        return tuple(beta for beta, multiplier in enumerate(self.multipliers) if multiplier not in redundant)

    @property
    def dependent(self) -> bool:
        """True if constraints may be dependent."""
        return self.obstruction is not None or len(self.independent) < len(self.multipliers)

    @property
    def state(self) -> tuple[str, ...]:
        """Names of the coordinates, then of the velocities."""
        return (*self.coordinates, *(f"dot({name})" for name in self.coordinates))

    @property
    def reactions(self) -> tuple[str, ...]:
        """Names of the multipliers that are not zero by being those of servo-constraints."""
        return self.multipliers[: len(self.multipliers) - self.servo.constraints]


def require_signs_known(problem: MotionProblem) -> None:
    """Reject a motion whose signs are still open.

    Parameters
    ----------
    problem : MotionProblem
        The motion.

    Raises
    ------
    HolonomError
        The motion depends on a sign.
    """
    if problem.signs:
        raise HolonomError(ErrorKind.NOT_ANALYTIC, problem.scene, problem.signs[0].of)


def require_analytic(problem: MotionProblem) -> None:
    """Reject a motion that is not analytic everywhere.

    Parameters
    ----------
    problem : MotionProblem
        The motion.

    Raises
    ------
    HolonomError
        The motion depends on a sign or a table, ends constraints, or has forces that contain multipliers.
    """
    require_signs_known(problem)
    if problem.reacting:
        raise HolonomError(
            ErrorKind.REACTING, problem.scene, detail=translatable("and the motion is not integrated by switching")
        )
    if problem.ends.released:
        raise HolonomError(ErrorKind.NOT_ANALYTIC, problem.scene, problem.ends.released[0].of)
    if problem.tables:
        knot = min(table.knots[0] for table in problem.tables)
        raise HolonomError(ErrorKind.NOT_ANALYTIC, problem.scene, function_of_knot(knot))


def require_laws(problem: MotionProblem) -> None:
    """Reject a motion whose controls follow servo-constraints.

    Parameters
    ----------
    problem : MotionProblem
        The motion.

    Raises
    ------
    HolonomError
        A control has no law.
    """
    if problem.servo.constraints:
        raise HolonomError(ErrorKind.NO_LAW, problem.scene)


def function_of_knot(knot: Fraction) -> str:
    """Return the function of time that changes its sign at a knot, as text of Maxima.

    Parameters
    ----------
    knot : Fraction
        Time at which the function is zero, in the scene's unit.

    Returns
    -------
    str
        Such as ``t-1/2``.
    """
    return f"t{'+' if knot < 0 else '-'}{abs(knot)}" if knot else "t"


def require_expandable(problem: MotionProblem) -> None:
    """Reject a motion with programs that lack higher derivatives of the drives.

    Parameters
    ----------
    problem : MotionProblem
        The motion.

    Raises
    ------
    HolonomError
        Special functions of the time are written out as sums of polynomials.
    """
    if problem.written_out:
        raise HolonomError(ErrorKind.SPECIAL_EXPANDED, problem.scene, problem.written_out[0])


def motion_problem(
    file: Source | Path,
    request: Request,
    limits: Limits,
    digits: int = DOUBLE_DIGITS,
    open_parameters: Sequence[str] = (),
) -> MotionProblem:
    """Ask Maxima for the motion of a scene.

    Parameters
    ----------
    file : Source or Path
        Scene file.
    request : Request
        Scene, solve and settings.
    limits : Limits
        Limits of each run of Maxima.
    digits : int
        Significant digits of the initial state.
    open_parameters : sequence of str
        Parameters that are inputs of the programs, whether they have values or not. Names of others do no harm.

    Returns
    -------
    MotionProblem

    Raises
    ------
    HolonomError
        As `holonom.maxima.ask_scene`, or the file has no scene, a control no law, a parameter no value.
    """
    source = source_of(file, limits)
    document = problem_document(source, request, limits, digits, open_parameters)
    return read_problem(document, source.description(request.settings))


def problem_document(
    file: Source | Path,
    request: Request,
    limits: Limits,
    digits: int = DOUBLE_DIGITS,
    open_parameters: Sequence[str] = (),
) -> str:
    """Return Maxima's document of a scene's motion for `read_problem`.

    Parameters
    ----------
    file : Source or Path
        Scene file.
    request : Request
        Scene, solve and settings.
    limits : Limits
        Limits of each run of Maxima.
    digits : int
        Significant digits of the initial state.
    open_parameters : sequence of str
        Parameters that are inputs of the programs. Names of other quantities are ignored.

    Returns
    -------
    str
        JSON document.

    Raises
    ------
    HolonomError
        As `motion_problem`.
    """
    asked = (request.scene, request.solve, digits, tuple(open_parameters))
    return ask(Document.MOTION_PROBLEM, file, *asked, settings=request.settings, limits=limits)


@nothing_collected()
def read_problem(text: str, description: "Description | None" = None) -> MotionProblem:
    """Read the document of a motion problem.

    Parameters
    ----------
    text : str
        JSON document of `problem_document`.
    description : Description or None
        Names the joints of multipliers, and their shapes.

    Returns
    -------
    MotionProblem

    Raises
    ------
    HolonomError
        It is not such a document, or one of its programs is invalid.
    """
    problem = _problem(read(Document.MOTION_PROBLEM, text))
    if description is None:
        return problem
    return replace(problem, joints=description.joints, joint_shapes=description.joint_shapes)


def _problem(document: Mapping[str, Any]) -> MotionProblem:
    system, span, drawing = document["system"], document["time_span"], document["drawing"]
    start = document["parametric_start"]
    released = (
        Release(each["of"], tuple(each["multipliers"]), _problem(each["after"]))
        for each in document.get("released", ())
    )
    problem = structured(
        MotionProblem,
        document,
        system=system["title"],
        source=system["source"],
        start=document["start"] or {"t": span[0] if span else "0"},
        initial=structured(
            InitialData,
            document,
            parametric=start and structured(ParametricStart, start | {"origins": start["origins"] or {}}),
        ),
        ends=structured(Ends, document, released=tuple(released)),
        drawing=None,
    )
    if drawing is None:
        return problem
    from .drawing import Drawing

    return replace(problem, drawing=structured(Drawing, drawing, tables=problem.tables))
