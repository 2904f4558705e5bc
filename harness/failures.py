"""Errors: every kind with its message and hints, and the package's one exception."""

from collections.abc import Callable, Collection, Iterable, Iterator
from enum import Enum
from pathlib import Path
from string import Formatter
from typing import Any

from .hidden import visible

LIMITS = frozenset({"--time-limit", "--memory-limit", "--sandbox"})  # options that are one argument in Python


INPUT, MACHINE = 2, 3  # exit statuses: bad input, and a machine that lacks something


class ErrorKind(Enum):
    """Kinds of errors: a reason, then hints, with placeholders such as {detail}.

    Option names in the braces of a hint, such as {--until}, become arguments in Python. The exit status of a command is
    2, or `MACHINE` if that comes first.
    """

    def __init__(self, first: str | int, *more: str) -> None:
        self.status = first if isinstance(first, int) else INPUT
        self.reason, *self.hints = more if isinstance(first, int) else (first, *more)

    FILE_MISSING = ("there is no such file{detail}", "give the path of a scene, for instance examples/paper/paper.mac")
    FILE_UNREADABLE = ("the file cannot be read: {detail}", "give the path of a readable Maxima file")
    TOO_MUCH_BESIDE = (
        "{detail} that end in .mac, .lisp or .csv are beside the scene",
        "put the scene and the files that it reads into a folder of their own",
    )
    NOT_UTF8 = ("the file is not UTF-8 text: byte {detail}", "save it as UTF-8")
    NOT_MAXIMA = (
        MACHINE,
        "this does not run as Maxima: {detail}",
        "put a Maxima that works first in PATH, free space for temporary files",
        "lift a limit on memory",
    )
    OUTPUT_TRUNCATED = (
        MACHINE,
        "what Maxima left behind is not whole: its {detail}",
        "free space for temporary files, and run it again",
    )
    KILLED = (MACHINE, "Maxima was ended by {detail}", "see what ends it, perhaps a lack of memory, and run it again")
    NO_PRIVATE_DIRECTORY = (
        MACHINE,
        "no directory for temporary files can be made: {detail}",
        "name one that can be written in the variable TMPDIR",
        "free space",
    )
    NO_SANDBOX = (
        MACHINE,
        "bubblewrap is missing or forbidden here",
        "install the package `bubblewrap`",
        "allow it to make user namespaces",
        "run the scene without {--sandbox}",
    )
    SANDBOX_FAILED = (
        MACHINE,
        "the sandbox failed: {detail}",
        "run it again when the machine is less busy or has more processes and descriptors",
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
        "answer it in the file, for instance by assume(...)",
    )
    SYNTAX = "Maxima cannot read this: {detail}"
    LISP_ERROR = "Maxima broke off with a Lisp error: {detail}"
    ENDED_EARLY = ("Maxima ended before the file did", "remove what ends it, for instance quit()")
    NOTHING_WRITTEN = (
        "the file describes no system",
        "load holonom.mac and assign a holonomic_system(...)",
    )
    TOO_LONG = ("Maxima took longer than {detail}", "ask for less", "raise {--time-limit}")
    TOO_LARGE = ("Maxima took more memory than {detail}", "ask for less", "raise {--memory-limit}")
    TOO_MANY_PROCESSES = ("the scene started more than {detail} processes", "start fewer")
    TOO_MUCH_TEXT = ("Maxima printed more than {detail}", "print less")
    FILE_TOO_LARGE = ("the file is larger than {detail}", "describe less", "read data from tables")
    NAME_TOO_LONG = ("the name {detail}... has more than 200 letters", "give it a shorter one")
    TOO_MANY_SCENES = ("the file describes {detail} scenes, and 1000 are the most", "put them into several files")
    DESCRIPTION_TOO_LARGE = ("the description is longer than {detail}", "describe less")
    HIDDEN_CHARACTER = (
        "a title or a source holds the character {detail}, which hides or reverses text",
        "leave it out",
    )
    NOT_SETTABLE = (
        "{detail} is no parameter of this description",
        "set what else the scene file leaves open where it is described, with `holonom describe`",
    )
    NOT_A_DOCUMENT = ("this is no document {detail}", "write it anew with this version of holonom")
    NOT_A_RECORD = ("this is not a derivation record: {detail}", "derive it anew with `holonom derive`")
    NOT_AN_EXPRESSION = "{detail} is not an expression that a derivation record can hold"
    UNWRITABLE = ("the output cannot be written: {detail}", "give a file in a directory that can be written")
    DISK_FULL = (MACHINE, "the output cannot be written: {detail}", "free space, and run it again")
    COMPILER_UNUSABLE = (MACHINE, "the C compiler cannot be run: {detail}", "name one that works in the variable CC")
    OUTPUT_TAKEN = ("this output would take the place of {detail}", "give it a name of its own")
    UNRELATED_FILE = (
        "there is a file of that name, which is not replaced unasked",
        "give another name",
        "replace it with {--force}",
    )
    UNRELATED_IN_MAXIMA = (
        "Maxima's user directory has a file that Holonom did not put there: {detail}",
        "move it away",
        "name another directory in the variable MAXIMA_USERDIR",
    )
    NOT_A_COMPANION = (
        "the directory holds other things than a companion",
        "give the name of a new directory",
        "name one that `holonom companion` made",
    )
    DEFINITION_MISSING = ("the file does not define {detail}", "the companion shows how each step is derived there")
    NOT_A_SETTING = ("{detail} sets nothing", "write NAME=VALUE with a number, for instance N=64 or u0=3/10")
    NOT_A_PARAMETER = ("{detail} cannot be the name of a parameter", "give names with commas between them, such as m,g")
    NO_NAME_IN_TEXT = (
        "the form {detail} has the scene's values, and no names of its own",
        "leave {--name} and {--parameters} out",
        "write it as c, fmu or matlab, or as python with {--module}",
    )
    NO_SUCH_MODULE = (
        "there is no module {detail}",
        "{--module} goes with python, and is numpy, jax or casadi",
    )
    NO_TABLES = (
        "the control law has a table, which the expressions of {detail} do not hold",
        "write it for numpy, jax, matlab or c",
        "give the law as a formula",
    )
    NOT_A_FILE = ("this form is no text for the terminal", "say where it goes: -o DIR for C, -o FILE.fmu for FMI")
    NOT_A_CHOICE = "there is no {detail}"
    NOT_A_TIME = (
        "invalid time '{detail}'",
        "write a number such as 0.75 or 3/4, of a size that a double can have",
    )
    NOT_IN_RANGE = "the value is out of range: {detail}"
    NO_SUCH_SCENE = "there is no scene {detail}"
    TOO_MANY_SAMPLES = ("{detail}", "ask for fewer, for a file in CSV or Parquet alone", "raise {--memory-limit}")
    DISK_TOO_SMALL = ("{detail}", "ask for fewer", "write to another disk")
    TOO_MANY_STEPS = ("{detail}", "ask for an earlier end with {--until}", "take longer steps")
    NOT_A_STEP = ("{detail} is no length of a step", "give a number greater than 0 with {--max-step}")
    MEMORY_TOO_SMALL = ("{detail}", "ask for fewer digits or a lower order")
    SETTING_TOO_LARGE = ("{detail} is beyond what a double holds", "set a smaller number", "set one less close to zero")
    NUMBER_TOO_LARGE = (
        "a number of the motion is larger than a double can be",
        "describe the system in units in which its numbers are smaller",
    )
    NOT_A_SCENE_NAME = ("{detail} cannot be the name of a scene", "give the name that the scene is assigned to")
    NOT_A_PROGRAM = ("this is not a motion program: {detail}", "write it anew with `holonom program`")
    NOT_AN_IDENTIFIER = ("{detail} cannot name a function in C and Python", "use letters, digits and underscores")
    INPUT_MISSING = ("nothing is given for {detail}", "give the controls a law and the parameters their values")
    COMPILER_MISSING = (
        MACHINE,
        "no C compiler is installed",
        "install one, for instance the package `gcc` of your distribution",
        "name one in the variable CC",
    )
    BROWSER_MISSING = (
        "no browser is installed that prints",
        "install one, for instance the package `chromium` of your distribution",
    )
    NOT_PRINTED = "the browser did not print the book: {detail}"
    COMPILER_REFUSED = "the C compiler refused the motion program: {detail}"
    EXTRA_MISSING = (MACHINE, "this needs {detail}")
    BEYOND_RADIUS = ("{detail}", "ask for an earlier time", "continue the motion with {--until}")
    ORDER_TOO_HIGH = ("{detail}", "ask for a lower order", "ask for digits")
    NOT_A_PRECISION = ("{detail}", "take another one", "ask for {--digits}, which Maxima computes with")
    NO_CONTINUATION = ("{detail}", "ask for an earlier time")
    NO_SUCH_FORMAT = ("unsupported file format", "use {detail}")
    NO_CURVE = ("the motion has no samples of {detail}", "observe the quantity, or choose another curve")
    NOT_FILMED = (
        "the motion cannot be filmed: {detail}",
        "observe the trajectory, take {--samples}, and give the system a drawing, which bodies and joints have",
    )
    NO_FFMPEG = ("ffmpeg, which writes .mp4, is not installed", "install it, or take .svg, .html or .gif")
    NO_INITIAL_STATE = "the start does not follow these parameters: {detail}"
    NOTHING_VARIES = ("no parameter varies", "name one with {--grid}, {--list} or {--sample}")
    NOT_AN_AXIS = (
        "{detail}",
        "write for instance {--grid} m=50:500:1000, {--list} m=1,2,5 or {--sample} 'm=normal(100,5)' {--size} 1000",
    )
    NOT_KEPT = ("{detail}", "keep for instance final, x, at(x,2), max(abs(lambda1)), zero(y), radius, free")
    NOT_PLOTTED = "this cannot be drawn: {detail}"
    OTHER_SWEEP = ("the folder holds another sweep: {detail}", "give another folder")
    UNRELATED_FOLDER = ("the folder holds other things than a sweep", "give the name of a new folder")
    FOLDER_TAKEN = ("another command is at work in this folder", "wait until it ends")
    NOTHING_TO_RESUME = ("there is no sweep to resume", "leave {--resume} out to begin one")
    WORKERS_LOST = (MACHINE, "the workers are gone: {detail}", "run the same command again; what is finished stays")
    NOT_A_SCHEDULER = (
        "{detail} is no address of a Dask scheduler",
        "write for instance {--dask} tcp://127.0.0.1:8786",
    )
    WORKER_ENDED = (
        MACHINE,
        "a process that computes was ended",
        "see what ends it, perhaps a lack of memory, and run the same command again",
    )
    NO_END = ("the scene has no time span", "add time_span", "pass the final time with {--until}")
    NO_COMMON_END = (
        "the scene ends where an expression of its until vanishes, and methods are compared at one time",
        "say which with {--until}",
    )
    NOT_AFTER_START = ("the last time is not after the start: {detail}", "give a later one with {--until}")
    NO_EVENT_VALUE = (
        "an expression in 'until' has no real, finite value: {detail}",
        "give one that has values along the whole motion",
    )
    SERIES_SWITCHED = (
        "where {detail} changes its sign the motion is another than the series, perhaps before the time asked for",
        "take holonom simulate, which steps to such times",
    )
    LAW_ENDS = (
        "the drives end at t = {detail}, with a table or, of special functions, with the scene's time span",
        "let the motion end there or before, with {--until}",
        "give a longer table or time span",
    )
    SPECIAL_EXPANDED = (
        "{detail} is a special function, which programs hold as a polynomial with other derivatives of high order",
        "take `holonom series` without {--precision}: Maxima expands it to any digits",
    )
    NO_PIVOTS = ("the motion program cannot be solved: {detail}", "take {--engine} auto or robust")
    RUNGE_KUTTA_IS_DOUBLE = (
        "the Runge-Kutta engine computes in double precision, not {detail}",
        "take {--engine} auto or taylor for more digits",
    )
    REACTING = (
        "forces contain multipliers, {detail}",
        "follow the motion with {--engine} auto, without derivatives, where its constraints are independent",
    )
    ROBUST_IS_DOUBLE = (
        "this takes the robust engine, which computes in double precision: {detail}",
        "leave {--precision} out",
        "make the constraints independent",
    )
    TOLERANCE_UNHELD = (
        "{detail}",
        "ask for another tolerance",
        "take the Taylor engine for more digits with {--precision}",
    )
    NO_MOTION_PROGRAM = ("there is no motion program to measure: {detail}", "take constraints that are independent")
    NOT_ANALYTIC = (
        "the motion is not analytic where {detail} changes its sign",
        "follow it with `holonom simulate`, which steps to such times",
    )
    NO_LAW = ("a control has no law", "give every control a control_law")
    NEVER_AT_REST = (
        "the equations of motion contain the time, and equilibria are looked for where they do not",
        "choose effects and constraints without it",
    )
    NOT_A_CONTROL = ("{detail} is no control of the system", "name one of its controls")
    NO_SUCH_EQUILIBRIUM = ("no equilibrium {detail} was found", "take one that `holonom equilibria` names")
    TWO_STATES = ("a time and an equilibrium exclude one another", "give one of {--at} and {--equilibrium}")
    NOT_REACHED = ("the motion does not lead to t = {time:.10g}: {detail}", "choose another time")
    NOT_LINEARIZED = (
        "the constraints lose rank at t = {time:.10g}: there is no tangent space to linearise in",
        "choose another time",
    )
    METHOD_GAVE_UP = ("{detail}", "ask for a larger tolerance", "take another method")
    MASS_INDEFINITE = (
        "the kinetic energy is negative for some velocities, and it measures how far a state is from the constraints",
        "look for a mass of the wrong sign",
        "take the power series, which measures nothing",
    )
    MASS_SINGULAR = (
        "the mass matrix is singular along a direction that the constraints leave free",
        "give every coordinate a mass or a constraint",
    )
    INCONSISTENT = (
        "the constraints cannot all be satisfied at t = {detail}",
        "end the run before",
        "remove the constraint that contradicts the others",
    )
    NO_GRADIENT = (
        "the motion cannot be followed beyond t = {time:.10g}, where the gradient of the constraint of {multiplier} "
        "vanishes and no reaction can act",
        "end the run before it",
        "choose a law that keeps the length away from zero",
    )
    NO_SENSITIVITY = (
        "these derivatives of the motion cannot be found: {detail}",
        "name parameters, coordinates or velocities with {--sensitivity}",
        "leave it out",
    )
    NO_WAY_ON = ("the motion cannot be followed beyond t = {detail}", "end the run before it")


ALIASES = {"failure": "kind", "said": "reason", "sentence": "message"}  # names in version 0.1, kept until 1.1


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
    there is no such file 2
    """

    def __init__(
        self,
        kind: ErrorKind,
        place: str | Path = "",
        detail: str = "",
        *,
        refusal: str | None = None,
        last_lines: tuple[str, ...] = (),
        command: str = "",
        **facts: Any,
    ) -> None:
        super().__init__(kind, place, detail)
        self.kind = kind
        self.place = str(place)
        self.detail = detail
        self.refusal = refusal
        self.last_lines = last_lines
        self.command = command
        self.facts = facts

    def __str__(self) -> str:
        """Return the message with options spelt as arguments in Python."""
        return self._message(self._hints(_argument))

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
        return self._message(self._hints(str, options))

    @property
    def reason(self) -> str:
        """Description of the error, without the place and the hints."""
        return self.kind.reason.format(detail=self.detail, **self.facts)

    def _hints(self, spelt: Callable[[str], str], options: Collection[str] | None = None) -> Iterator[str]:
        """Yield the hints that name no other options, each option as it is spelt."""
        facts = {"detail": self.detail, **self.facts}
        for hint in self.kind.hints:
            named = {name for _, name, *_ in Formatter().parse(hint) if name and name not in facts}
            if options is None or named <= set(options):
                yield hint.format(**facts, **{name: spelt(name) for name in named})

    def _message(self, hints: Iterable[str]) -> str:
        located = f"{self.place}: {self.reason}" if self.place else self.reason
        todo = ", or ".join(hints)
        return visible(" ".join(f"{part.rstrip('.')}." for part in (located, todo[:1].upper() + todo[1:]) if part))


def _argument(option: str) -> str:
    """Return the argument in Python that is an option on the command line."""
    return "limits" if option in LIMITS else option.removeprefix("--").replace("-", "_")
