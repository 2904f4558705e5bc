"""Errors: every kind with its message and hints, and the package's one exception."""

import os
from collections.abc import Callable, Collection
from enum import Enum
from pathlib import Path
from string import Formatter
from typing import Any

from .hidden import visible

ARGUMENTS = dict.fromkeys(("--time-limit", "--memory-limit", "--sandbox"), "limits") | {
    "--dask": "scheduler",
    "--sensitivity": "sensitivities",
}
"""Options with other names in Python."""


INPUT, MACHINE = 2, 3  # exit statuses: bad input, and a machine that lacks something


class ErrorKind(Enum):
    """Kinds of errors: a reason, then hints, with placeholders such as {detail}.

    Option names in the braces of a hint, such as {--until}, become arguments in Python. The exit status of a command is
    2, or `MACHINE` if that comes first.
    """

    def __init__(self, first: str | int, *more: str) -> None:
        self.status = first if isinstance(first, int) else INPUT
        self.reason, *self.hints = more if isinstance(first, int) else (first, *more)

    FILE_MISSING = ("file not found{detail}", "give the path of a scene, for example examples/paper/paper.mac")
    FILE_UNREADABLE = ("the file cannot be read: {detail}", "give the path of a readable Maxima file")
    FILE_CHANGED = ("the file has changed since its first use", "load it again")
    TOO_MUCH_BESIDE = (
        "{detail} that end in .mac, .lisp or .csv are in the folder of the scene",
        "put the scene and the files that it reads into a folder of their own",
    )
    NOT_UTF8 = ("the file is not UTF-8 text: byte {detail}", "save the file as UTF-8")
    NOT_MAXIMA = (
        MACHINE,
        "Maxima does not start: {detail}",
        "put a working Maxima first in PATH",
        "free space for temporary files",
        "lift a limit on memory",
    )
    OUTPUT_TRUNCATED = (
        MACHINE,
        "Maxima's output is incomplete: its {detail}",
        "free space for temporary files and try again",
    )
    KILLED = (MACHINE, "Maxima was ended by {detail}", "check the memory of the machine and try again")
    NO_PRIVATE_DIRECTORY = (
        MACHINE,
        "cannot create a directory for temporary files: {detail}",
        "set TMPDIR to a writable directory",
        "free space",
    )
    NO_SANDBOX = (
        MACHINE,
        "bubblewrap is missing or not permitted",
        "install the package `bubblewrap`",
        "allow it to create user namespaces",
        "run the scene without {--sandbox}",
    )
    SANDBOX_FAILED = (
        MACHINE,
        "the sandbox failed: {detail}",
        "try again when the machine is less busy or has more processes and descriptors",
        "run it with {--trust}",
    )
    MAXIMA_MISSING = (
        MACHINE,
        "Maxima is not installed",
        "run `make`",
        "install the package `maxima` of your distribution",
    )
    REFUSED = "{detail}"
    QUESTION = (
        "Maxima asks a question that a batch run cannot answer: {detail}",
        "add an assumption to the scene file, for example assume(m > 0)",
    )
    SYNTAX = (
        "Maxima cannot read this: {detail}",
        "end each statement with $, close brackets and quotes, and write commas between entries and * between factors",
    )
    COMMENT_NOT_CLOSED = ("a comment is not closed", "write */ after it, once for each /* in it")
    LISP_ERROR = "Maxima ended with a Lisp error: {detail}"
    ENDED_EARLY = ("Maxima ended before the file did", "remove the statement that ends it, for example quit()")
    NOTHING_WRITTEN = (
        "the file describes no system",
        "load holonom.mac and assign a holonomic_system(...)",
    )
    TOO_LONG = ("Maxima took longer than {detail}", "reduce the problem", "raise {--time-limit}")
    COMMAND_TOO_LONG = ("the command took longer than {detail}", "reduce the problem", "raise {--time-limit}")
    COMMAND_CRASHED = (MACHINE, "ended by {detail}; perhaps for lack of memory", "reduce the problem")
    TOO_LARGE = ("Maxima took more memory than {detail}", "reduce the problem", "raise {--memory-limit}")
    TOO_MANY_PROCESSES = ("the scene started more than {detail} processes", "start fewer")
    TOO_MUCH_TEXT = ("Maxima printed more than {detail}", "print less")
    FILE_TOO_LARGE = ("the file is larger than {detail}", "shorten the description", "read data from tables")
    NAME_TOO_LONG = ("the name {detail}... has more than 200 characters", "shorten it")
    TOO_MANY_SCENES = ("the file describes {detail} scenes; at most 1000 are allowed", "split it into several files")
    DESCRIPTION_TOO_LARGE = ("the description is longer than {detail}", "shorten it")
    HIDDEN_CHARACTER = (
        "a title or a source contains the character {detail}, which hides or reverses text",
        "remove it",
    )
    NOT_SETTABLE = (
        "unknown parameter {detail}",
        "set variables of the scene file with `holonom describe`",
    )
    NOT_A_DOCUMENT = ("not a document {detail}", "create it again with this version of holonom")
    NOT_A_RECORD = ("this is not a derivation record: {detail}", "create it again with `holonom derive`")
    NOT_AN_EXPRESSION = "{detail} is not an expression that a derivation record can hold"
    UNWRITABLE = ("the output cannot be written: {detail}", "choose another path")
    DISK_FULL = (MACHINE, "the output cannot be written: {detail}", "free some space and try again")
    COMPILER_UNUSABLE = (MACHINE, "the C compiler cannot be run: {detail}", "set CC to a working compiler")
    OUTPUT_TAKEN = ("the output would overwrite {detail}", "choose another name")
    UNRELATED_FILE = (
        "the file exists",
        "choose another name",
        "overwrite it with {--force}",
    )
    UNRELATED_IN_MAXIMA = (
        "Maxima's user directory contains a file that Holonom did not create: {detail}",
        "move it",
        "set MAXIMA_USERDIR to another directory",
    )
    NOT_A_COMPANION = (
        "the directory contains other files than a companion",
        "choose a new directory",
        "name one that `holonom companion` made",
    )
    DEFINITION_MISSING = ("the file does not define {detail}", "the companion shows how each step is derived there")
    NOT_A_SETTING = ("invalid setting '{detail}'", "write NAME=VALUE with a number, for example N=64 or u0=3/10")
    NOT_A_PARAMETER = ("'{detail}' cannot name a parameter", "separate names by commas, for example m,g")
    NO_NAME_IN_TEXT = (
        "the form {detail} contains the values of the scene and takes neither a name nor parameters",
        "remove {--name} and {--parameters}",
        "use c, fmu, matlab, or python with {--module}",
    )
    NO_SUCH_MODULE = (
        "unknown module {detail}",
        "use {--module} numpy, jax or casadi with python",
    )
    NO_TABLES = (
        "tables in control laws are not supported by {detail}",
        "use numpy, jax, matlab or c",
        "give the law as a formula",
    )
    NOT_A_FILE = ("C and FMI output needs a destination", "use -o DIR for C, -o FILE.fmu for FMI")
    NOT_A_CHOICE = "invalid value {detail}"
    NOT_A_TIME = (
        "invalid time '{detail}'",
        "write a number such as 0.75 or 3/4, within the range of double precision",
    )
    NOT_IN_RANGE = "the value is out of range: {detail}"
    NO_SUCH_SCENE = "unknown scene {detail}"
    TOO_MANY_SAMPLES = (
        "{detail}",
        "reduce the number of samples",
        "write CSV or Parquet only",
        "raise {--memory-limit}",
    )
    DISK_TOO_SMALL = ("{detail}", "reduce the number of samples", "write to another disk")
    TOO_MANY_STEPS = ("{detail}", "end earlier with {--until}", "use longer steps")
    NOT_A_STEP = ("invalid step length {detail}", "give a number greater than 0 with {--max-step}")
    MEMORY_TOO_SMALL = ("{detail}", "reduce the digits or the order")
    SETTING_TOO_LARGE = ("{detail} is outside the range of double precision", "set a number of moderate size")
    NUMBER_TOO_LARGE = (
        "a number of the motion exceeds the range of double precision",
        "describe the system in units in which its numbers are smaller",
    )
    NOT_A_SCENE_NAME = ("{detail} cannot be the name of a scene", "give the name that the scene is assigned to")
    NOT_A_PROGRAM = ("this is not a motion program: {detail}", "create it again with `holonom program`")
    NOT_AN_IDENTIFIER = (
        "{detail} cannot name a function in C and Python",
        "use letters, digits and underscores, a letter first",
    )
    NAME_TAKEN = ("{detail} has another meaning in the code", "give another name with {--name}")
    INPUT_MISSING = ("no value for {detail}", "give every control a law and every parameter a value")
    COMPILER_MISSING = (
        MACHINE,
        "no C compiler is installed",
        "install one, for example the package `gcc` of your distribution",
        "set CC to a compiler",
    )
    BROWSER_MISSING = (
        "no browser that prints is installed",
        "install one, for example the package `chromium` of your distribution",
    )
    NOT_PRINTED = "the browser did not print the book: {detail}"
    COMPILER_REFUSED = "the C compiler cannot compile the motion program: {detail}"
    EXTRA_MISSING = (MACHINE, "this needs {package}, which is not installed", "run `pip install '{named}'`")
    BEYOND_RADIUS = ("{detail}", "choose an earlier time", "continue the motion with {--until}")
    ORDER_TOO_HIGH = ("{detail}", "use a lower order", "use {--digits}")
    NOT_A_PRECISION = ("{detail}", "use another precision", "use {--digits}, for Maxima's numbers")
    NO_CONTINUATION = ("{detail}", "choose an earlier time")
    NO_SUCH_FORMAT = ("unsupported file format", "use {detail}")
    NO_CURVE = ("the motion has no samples of {detail}", "observe the quantity, or choose another curve")
    NOT_FILMED = (
        "the motion cannot be filmed: {detail}",
        "observe the trajectory, use {--samples}, and give the system a drawing",
    )
    NO_FFMPEG = ("ffmpeg, which writes .mp4, is not installed", "install it, or use .svg, .html or .gif")
    NO_INITIAL_STATE = "no consistent initial state for these parameters: {detail}"
    NOTHING_VARIES = ("no parameter varies", "name one with {--grid}, {--list} or {--sample}")
    NOT_AN_AXIS = "{detail}"
    MALFORMED_AXIS = ("{detail}", "write for example {example}")
    NOT_AN_OUTPUT = ("{detail}", "keep for example final, x, at(x,2), max(abs(lambda1)), zero(y), radius, free")
    NOT_PLOTTED = "this cannot be drawn: {detail}"
    OTHER_SWEEP = ("the folder contains another sweep: {detail}", "choose another folder")
    UNRELATED_FOLDER = ("the folder contains other files than a sweep", "choose a new folder")
    FOLDER_TAKEN = ("another command is using this folder", "wait until it ends")
    NOTHING_TO_RESUME = ("no sweep to resume", "remove {--resume} to start one")
    WORKERS_LOST = (
        MACHINE,
        "the workers are gone: {detail}",
        "run the same command again; finished rows are not computed again",
    )
    NOT_A_SCHEDULER = (
        "invalid address of a Dask scheduler: {detail}",
        "write for example {--dask} tcp://127.0.0.1:8786",
    )
    WORKER_ENDED = (
        MACHINE,
        "a worker process was killed",
        "check the memory of the machine and run the same command again",
    )
    NO_END = ("the scene has no time span", "add time_span", "pass the final time with {--until}")
    NO_COMMON_END = (
        "the scene ends at an event (until), but methods are compared at one time",
        "pass that time with {--until}",
    )
    NOT_AFTER_START = ("the final time is not after the initial time: {detail}", "pass a later one with {--until}")
    NO_EVENT_VALUE = (
        "an expression in 'until' has no real, finite value: {detail}",
        "use an expression that has values along the whole motion",
    )
    SERIES_SWITCHED = (
        "the series is valid while {detail} keeps its sign, which may change before the requested time",
        "use `holonom simulate`, which locates sign changes",
    )
    LAW_ENDS = (
        "a control law ends at t = {detail}, with its table or, for special functions, with the time span",
        "end the motion there or before, with {--until}",
        "give a longer table or time span",
    )
    SPECIAL_EXPANDED = (
        "{detail} is a special function, which programs approximate by a polynomial too coarse for a series",
        "use `holonom series` without {--precision}: Maxima expands it to any digits",
    )
    SERIES_VARIED = (
        "heyoka's power series have no derivatives by parameters",
        "leave {--precision} or {--sensitivity} out",
    )
    NO_PIVOTS = ("the motion program cannot be solved: {detail}", "use {--engine} auto or robust")
    RUNGE_KUTTA_IS_DOUBLE = (
        "the Runge-Kutta engine computes in double precision, not {detail}",
        "use {--engine} auto or taylor for more digits",
    )
    REACTING = (
        "forces contain multipliers, {detail}",
        "use {--engine} auto, without derivatives, and independent constraints",
    )
    ROBUST_IS_DOUBLE = (
        "the robust engine is needed, which computes in double precision: {detail}",
        "remove {--precision}",
        "make the constraints independent",
    )
    TOLERANCE_OUT_OF_RANGE = (
        "{detail}",
        "use another tolerance",
        "use the Taylor engine for more digits with {--precision}",
    )
    NO_MOTION_PROGRAM = ("no motion program to measure: {detail}", "make the constraints independent")
    NOT_ANALYTIC = (
        "the motion is not analytic where {detail} changes its sign",
        "use `holonom simulate`, which locates sign changes",
    )
    NO_LAW = ("a control has no control_law, as where servo_constraints find it", "give every control a control_law")
    NEVER_AT_REST = (
        "equilibria need equations of motion that do not contain the time",
        "choose effects and constraints without it",
    )
    ORIENTATION_CHANGES = (
        "orientation {detail} is zero at a place where the constraints hold",
        "remove it from orientations, or choose an expression whose sign no motion changes",
    )
    NOT_A_CONTROL = ("unknown control {detail}", "name a control of the system")
    NO_SUCH_EQUILIBRIUM = ("no equilibrium {detail} was found", "use one that `holonom equilibria` lists")
    TWO_STATES = ("a time and an equilibrium exclude each other", "pass one of {--at} and {--equilibrium}")
    NOT_REACHED = ("the motion does not reach t = {time:.10g}: {detail}", "choose another time")
    NOT_LINEARIZED = (
        "the constraints lose rank at t = {time:.10g}: there is no tangent space to linearise in",
        "choose another time",
    )
    NO_DERIVATIVES = (
        "the equations of motion or outputs have no derivatives at t = {time:.10g}",
        "choose another time",
        "write the forces and outputs so that they have derivatives there",
    )
    METHOD_GAVE_UP = ("{detail}", "use a larger tolerance", "use another method")
    NOT_LINEARIZED_ALONG = (
        "small deviations change too fast to be integrated: their error is estimated as {detail}",
        "choose an earlier end with {--until}",
    )
    MASS_INDEFINITE = (
        "the kinetic energy is negative for some velocities, so it does not measure distances from the constraints",
        "correct a mass of the wrong sign",
        "use `holonom series`",
    )
    MASS_SINGULAR = (
        "the mass matrix is singular along a direction that the constraints leave free",
        "give every coordinate a mass or a constraint",
    )
    INCONSISTENT = (
        "the constraints cannot all be satisfied at t = {detail}",
        "end the motion earlier",
        "remove the constraint that contradicts the others",
    )
    NO_GRADIENT = (
        "the motion cannot be continued beyond t = {time:.10g}, where the gradient of the constraint of {multiplier} "
        "vanishes and no reaction can act",
        "end the motion earlier",
        "choose a law that keeps the length away from zero",
    )
    NO_SENSITIVITY = (
        "these derivatives of the motion cannot be found: {detail}",
        "name parameters, coordinates or velocities with {--sensitivity}",
        "remove it",
    )
    NO_WAY_ON = ("the motion cannot be continued beyond t = {detail}", "end it earlier")


ALIASES = {"failure": "kind", "said": "reason", "sentence": "message"}  # names in version 0.1, until 1.1


class HolonomWarning(UserWarning):
    """A statement of a scene file that has no effect."""


class HolonomError(Exception):
    """The one exception of the package.

    Parameters
    ----------
    kind : ErrorKind
        Kind of the error, with its reason and hints.
    place : str or Path
        A file, with the line of the statement if it is known (``scene.mac:12``).
    detail : str
        Text for ``{detail}`` in the reason and the hints.
    option : str
        Option that the error is about, such as ``--until``, an argument in Python.
    refusal : str or None
        Id of an error of the library in Maxima, a row of ``maxima/refusals.mac``.
    last_lines : tuple of str
        Last lines that Maxima printed.
    command : str
        Shell command that repeats the error with Maxima alone.
    **facts : object
        Values of the other placeholders.

    Examples
    --------
    >>> import holonom
    >>> try:
    ...     holonom.load("nowhere.mac")
    ... except holonom.HolonomError as error:
    ...     print(error.reason, error.kind.status)
    file not found 2
    """

    def __init__(
        self,
        kind: ErrorKind,
        place: str | Path = "",
        detail: str = "",
        *,
        option: str = "",
        refusal: str | None = None,
        last_lines: tuple[str, ...] = (),
        command: str = "",
        **facts: Any,
    ) -> None:
        super().__init__(kind, place, detail)
        self.kind = kind
        self.place = str(place)
        self.detail = detail
        self.option = option
        self.refusal = refusal
        self.last_lines = last_lines
        self.command = command
        self.facts = facts

    def __str__(self) -> str:
        """Return the message for Python: arguments for options, a path from here."""
        try:
            here = f"{Path.cwd()}{os.sep}"
        except FileNotFoundError:
            here = ""
        return self._message(argument).removeprefix(here)

    def __getattr__(self, name: str) -> Any:
        if name in ALIASES:
            return getattr(self, ALIASES[name])
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")

    def message(self, options: Collection[str] | None = None) -> str:
        """Return the message of the command line: the place, the reason, the hints.

        Parameters
        ----------
        options : collection of str or None
            Options of the command, such as ``--until``. Hints that name other options are left out.

        Returns
        -------
        str
            One line, without a line break at its end.
        """
        return self._message(str, options)

    @property
    def reason(self) -> str:
        """Description of the error, without the place and the hints."""
        return self.kind.reason.format(detail=self.detail, **self.facts)

    def _hints(self, spelt: Callable[[str], str], options: Collection[str] | None) -> list[str]:
        """Return the hints that name no other options, each option as it is spelt."""
        facts = {"detail": self.detail, **self.facts}
        named = {
            hint: {name for _, name, *_ in Formatter().parse(hint) if name and name not in facts}
            for hint in self.kind.hints
        }
        return [
            hint.format(**facts, **{name: spelt(name) for name in names})
            for hint, names in named.items()
            if options is None or names <= set(options)
        ]

    def _message(self, spelt: Callable[[str], str], options: Collection[str] | None = None) -> str:
        located = ": ".join(filter(None, (self.place, self.option and spelt(self.option), self.reason)))
        *first, last = self._hints(spelt, options) or [""]
        todo = ", or ".join(filter(None, (", ".join(first), last)))
        return visible(" ".join(f"{part.rstrip('.')}." for part in (located, todo[:1].upper() + todo[1:]) if part))


def argument(option: str) -> str:
    """Return the argument in Python that is an option on the command line.

    Parameters
    ----------
    option : str
        Such as ``--until``.

    Returns
    -------
    str
        Such as ``until``.
    """
    return ARGUMENTS.get(option) or option.removeprefix("--").replace("-", "_")
