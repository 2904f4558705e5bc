"""A scene's motion from Maxima: programs of (t, q, dot q), and the initial state.

They come in one JSON document (`maxima/record/motion_problem.mac`). The outputs of each program are defined in
`maxima/program/motion_problem.mac`.
"""

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from ..described import Correction, SystemTitle
from ..documents import ask
from ..failures import ErrorKind, HolonomError
from ..formats import Document, read
from ..language import Message, translatable
from ..sandbox import Limits
from ..schema import FloatText, Names, NumberText
from ..source import Source, source_of
from ..structs import entry, group, structured
from .drawing import Drawing
from .motion_program import LAW_SPAN, ROUNDED, LawSpan, Program
from .request import Request
from .table import Table

if TYPE_CHECKING:
    from ..description import Description

Built = TypeVar("Built")
DOUBLE_DIGITS = 17  # decimal digits that distinguish any two doubles


class Observable(StrEnum):
    """Quantities that a scene may observe."""

    TRAJECTORY = "trajectory"
    MULTIPLIERS = "multipliers"
    CONSTRAINT_FORCES = "constraint_forces"
    CONTROLS = "controls"
    ENERGY = "energy"
    RESIDUALS = "residuals"


class DependsOn(StrEnum):
    """The highest of the quantities that a switching function depends on."""

    TIME = "time"
    CONFIGURATION = "configuration"
    VELOCITY = "velocity"
    REACTION = "reaction"


@dataclass(frozen=True)
class Sign:
    """A sign that a motion depends on."""

    name: str = entry("Name of the sign's input.")
    of: str = entry("The switching function whose sign it is, as Maxima prints it.")
    by: DependsOn = entry("Highest of the quantities on which the expression depends.")


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

    program: Program | None = entry(
        "Of these parameters: coordinates and velocities at the initial time, or values to begin their search with."
    )
    origins: Mapping[str, Origin] | None = entry(
        "Of each: given; solved for from near the guess; or the one solution of linear equations."
    )
    obstruction: Message | None = entry("Why the initial state cannot be adapted to the parameters; null where it can.")


@dataclass(frozen=True)
class InitialData:
    """The origin of the initial state, which is in `MotionProblem.start`."""

    correction: Correction | None = entry(
        "The initial value that had to be corrected most to fit the constraints, and by how much.", None
    )
    moved: Correction | None = entry(
        "The initial value that differs most from initial_guess, and by how much; null without a guess.", None
    )
    given: tuple[str, ...] = entry(
        "The coordinates and velocities whose initial values the scene gives; the others are solved for.", ()
    )
    parametric: ParametricStart | None = entry(
        "The initial state as a function of the open parameters; null where there is none.",
        None,
        key="parametric_start",
    )


@dataclass(frozen=True)
class Servo:
    """The servo-constraints of a motion, whose multipliers are zero."""

    constraints: int = entry(
        "Number of constraints, the last ones, that controls in forces satisfy without a reaction.",
        0,
        key="servo",
        minimum=0,
    )
    matrix: Program | None = entry(
        "Program: servo_matrix[j,i] is what control i adds to the second time derivative of the j-th condition of "
        "the servo-constraints; null without any.",
        None,
        key="servo_matrix",
    )
    relative_degrees: tuple[int, ...] = entry(
        "Of each output that servo-constraints prescribe: which of its time derivatives the controls are in.", ()
    )


@dataclass(frozen=True)
class Release:
    """Constraints that end at the first zero crossing of a condition."""

    of: str = entry("The condition, as Maxima prints it.")
    multipliers: Names = entry("Multipliers of the released constraints.")
    after: "MotionProblem" = entry("The motion without them, at the initial time of the whole.")


@dataclass(frozen=True)
class Ends:
    """Zero crossings that end the motion, or constraints of it."""

    until: tuple[str, ...] = entry(
        "Expressions whose first zero crossing ends the motion; empty where the time span alone does.", ()
    )
    events: Program | None = entry(
        "The program of these expressions, event[1], event[2], ...; null where there are none.", None
    )
    releases: Program | None = entry(
        "The program of the conditions at which constraints end, event[1], event[2], ...; null where none does.", None
    )
    released: tuple[Release, ...] = entry(
        "For each of these conditions the multipliers whose constraints end at its first zero crossing, and the "
        "motion after that.",
        (),
    )


@dataclass(frozen=True)
class MotionProblem:
    """The data of a motion to be simulated.

    Every program takes t, the coordinates, the velocities, the multipliers, the signs, the open parameters and what
    the tables are at t, in this order. That of the outputs the accelerations, too.
    """

    system: SystemTitle = entry("The system.")
    scene: str = entry("Name that the scene is assigned to.")
    title: str = entry("Title of the scene.")
    time_span: tuple[NumberText, NumberText] | None = entry(
        "First and last time, as decimal digits; null where the scene names none."
    )
    observe: tuple[Observable, ...] = entry("Observed quantities of the scene.")
    coordinates: Names = entry("The n coordinates.")
    multipliers: Names = entry("The g multipliers, one for each constraint.")
    start: Mapping[str, NumberText] | None = entry(
        "t, coordinates and velocities at the initial time, as decimal digits; null if they depend on a parameter "
        "without value."
    )
    initial: InitialData = group()
    ends: Ends = group()
    servo: Servo = group()
    obstruction: Message | None = entry("Why no order of pivots solves the equations of motion; null where one does.")
    motion: Program | None = entry(
        "Program: ddot(q), the multipliers by name and, where the scene observes them, Lambda[s]; "
        "null with an obstruction."
    )
    projection: Program | None = entry(
        "Program: position_correction[s] and velocity_correction[s], to the nearest state in the mass metric "
        "that meets the constraints, up to second order in the residuals; null with an obstruction."
    )
    matrices: Program = entry(
        "Program: A[s,k] and J[b,s] where they are not zero by structure, h[s], c[b], residual[b], residual_rate[b]: "
        "A a - J^T lambda = h, J a = -c."
    )
    energy: Program = entry(
        "Program of the multipliers, too: energy, the energy function, and power, its time derivative along the motion."
    )
    drawing: Drawing | None = entry("Drawing of the system, or null.")
    response: Program | None = entry(
        "Program, where derivatives of the motion are requested: ddot(q) and the multipliers, then change_of_a[s] and "
        "change_of_lambda[b], their changes with h and c: A a - J^T lambda = h, J a = -c with the last n + g inputs in "
        "place of h and c. null with an obstruction, or where forces contain multipliers.",
        None,
    )
    law_span: LawSpan | None = entry(LAW_SPAN, None)
    written_out: Names = entry(
        "Special functions of the time, which the programs hold as sums of Chebyshev polynomials.", ()
    )
    controls: Program | None = entry(
        "The program of the controls, by name; null where the scene does not observe them.", None
    )
    outputs: Program | None = entry(
        "The program of the outputs that the scene names, whose inputs have ddot(q) behind the multipliers; null "
        "without any.",
        None,
    )
    reacting: Names = entry("Multipliers that forces contain.", ())
    signs: tuple[Sign, ...] = entry(
        "Inputs of every program after the multipliers: the signs of the functions that switch the motion; empty "
        "where it is analytic.",
        (),
    )
    switching: Program | None = entry(
        "Program: switch[i], the functions, with what decides how the motion passes their zeros, switch_rate[i], "
        "drive[i], size[i] and reaction[i] by amounts of friction, and momentum[s]; regular where other forces contain "
        "multipliers, positive where these are unique; null without signs and without such forces.",
        None,
    )
    tables: tuple[Table, ...] = entry(
        "Tables of the law: names of a polynomial's t_k, c0, c1, c2, c3 among the inputs, and the polynomials in "
        "order, c0 + c1 tau + c2 tau^2 + c3 tau^3 with tau = t - t_k.",
        (),
    )
    parameters: Names = entry("Inputs of every program after the signs: the parameters that stay open.", ())
    values: Mapping[str, Fraction] = entry("Values that the scene gives to these; some may be missing.", dict)
    nominal: Mapping[str, FloatText] = entry(
        "Sizes of coordinates, velocities and the time t that the scene gives.", dict
    )
    joints: Mapping[str, str] = field(default_factory=dict)  # as `Description.joints`
    joint_shapes: Mapping[str, Sequence[int]] = field(default_factory=dict)  # as `Description.joint_shapes`
    recorded: Program | None = field(default=None)  # quantities that a sweep records along the motion
    _compiled: dict[Hashable, list[tuple[object, Any]]] = field(default_factory=dict, compare=False, repr=False)

    @staticmethod
    def of_document(document: Mapping[str, Any]) -> "MotionProblem":
        """Read the document of a motion, or of one that follows a release.

        Parameters
        ----------
        document : mapping
            Decoded JSON.

        Returns
        -------
        MotionProblem
            With the initial time alone where a parameter without a value decides about the initial state.
        """
        problem = structured(MotionProblem, document)
        span, drawing = problem.time_span, problem.drawing
        return replace(
            problem,
            start=problem.start or {"t": span[0] if span else "0"},
            drawing=drawing and replace(drawing, tables=problem.tables),
        )

    @property
    def places(self) -> dict[str, int]:
        """Numbers of the signs by their names, as in the outputs of ``switching``."""
        return {sign.name: place for place, sign in enumerate(self.signs, 1)}

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
    def accelerations(self) -> tuple[str, ...]:
        """Names of the accelerations."""
        return tuple(f"ddot({name})" for name in self.coordinates)

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


def require_law_at(problem: MotionProblem, t: float) -> None:
    """Reject a time after the end of a law, unless rounding puts it there.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    t : float
        Time, in the scene's unit.

    Raises
    ------
    HolonomError
        A law has no values there.
    """
    if problem.law_span is not None:
        end, start = float(problem.law_span[1]), float(problem.start["t"])
        if t - end > ROUNDED * (end - start):
            raise HolonomError(ErrorKind.LAW_ENDS, detail=f"{end:.10g}")


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
        As `holonom.documents.ask`, or the file has no scene, a control no law, a parameter no value.
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
    further = ("response",) if request.derivatives else ()
    asked = (request.scene, request.solve, digits, tuple(open_parameters), further)
    return ask(Document.MOTION_PROBLEM, file, *asked, settings=request.settings, limits=limits)


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
    problem = read(Document.MOTION_PROBLEM, text, MotionProblem)
    if description is None:
        return problem
    return replace(problem, joints=description.joints, joint_shapes=description.joint_shapes)
