"""One headless run of Maxima: no prompts, no init files, errors that say where.

This is the only module that knows Maxima is a process. A run has a private directory; `headless.lisp`, loaded before
anything else, makes errors of questions and leaves the ending in a file, for Maxima's exit status says nothing. What
Maxima prints is kept for people and not read, with one exception: the count of Maxima's own test runner.

A scene file is a program, perhaps a stranger's. Unless it is trusted, one process runs it and writes down what it
described, and another one, which never sees the file and begins when the first is gone, derives from that
(`description.lisp`).
"""

import os
import re
import secrets
import shlex
import shutil
import signal
import stat
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from .confined import MIB, Confinement, LimitExceeded, Limits, Sandbox, run_confined, surroundings, walled_in
from .failures import Failure, HolonomError
from .files import near_file, private_directory, shared
from .preloaded import ARGUMENTS, ENVIRONMENT, JOBS, QUIET, preloaded_image, quoted
from .supervisor import doing

LIBRARY = shared("maxima")
DEFAULT_LIMITS = Limits()
NO_SETTINGS: Mapping[str, str] = {}
LAST_LINES = 10  # lines of Maxima's output that an error carries
PASSED_ON = (
    "PATH",
    "LD_LIBRARY_PATH",
    "GCL_GC_PAGE_THRESH",
    "SBCL_HOME",
    "ECLDIR",
    "MAXIMA_PREFIX",
    "MAXIMA_LAYOUT_AUTOTOOLS",
)
BYTE_ORDER_MARK = "\ufeff"
SIGNALS = frozenset(signal.Signals)
SIGNALLED = 128  # a shell adds this to the number of the signal that ended a process

STARTED, FINISHED = "STARTED", "FINISHED"
ENDINGS = {
    "FAULT": Failure.REFUSED,
    "QUESTION": Failure.QUESTION,
    "SYNTAX": Failure.SYNTAX,
    "LISP": Failure.LISP_ERROR,
}

# What may stand in Maxima text, inside a comment (they nest) and outside: a hidden character, a string, a terminator.
IN_COMMENT = re.compile(r"/\*|\*/")
IN_CODE = re.compile(r'/\*|\\.|"(?:[^"\\]|\\.)*"|[;$]', re.DOTALL)


@dataclass(frozen=True)
class Ending:
    """How a run ended before its time, and where."""

    failure: Failure
    place: str
    detail: str = ""


@dataclass(frozen=True)
class Run:
    """One run of Maxima, in a directory of its own."""

    file: Path  # the file that it is about
    directory: Path
    limits: Limits
    settings: Mapping[str, str]
    mark: str  # what only this run can know: the names of what it leaves behind end in it, and the outcome holds it

    def leaves(self, what: str) -> Path:
        """The file that the run is to leave behind."""
        return self.directory / f"{what}-{self.mark}"


def get_ready(file: Path, limits: Limits) -> None:
    """Do beforehand what a run about a file begins with, and what takes ten times as long beside a busy thread.

    Raises as `ask_scene` where the file cannot be read, or Maxima is missing.
    """
    read_maxima_text(file)
    walled_in(limits)
    _image(_maxima())


def ask_scene(
    scene: Path, writer: str, limits: Limits = DEFAULT_LIMITS, settings: Mapping[str, str] = NO_SETTINGS
) -> str:
    """Ask the library for a document about a scene file.

    Unless the file is trusted, nothing that it does can reach the process that writes the document: that one begins
    when all that the file started has ended, and knows of it the description alone.

    Parameters
    ----------
    scene : Path
        A Maxima file that describes one system and any number of scenes. ``load("holonom.mac")`` in it finds this
        project's library.
    writer : str
        The library's function that writes the document, given the name of the file to write.
    settings : mapping of str to str
        Numbers in Maxima's notation, for what the file leaves open and for parameters.

    Raises
    ------
    HolonomError
        The file is missing, is refused, asks a question, exceeds a limit, or Maxima is missing.
    """
    if limits.sandbox is Sandbox.TRUSTED:
        return run_batch(scene, writer, limits, settings)
    began = time.monotonic()
    with doing("running the scene file"), _new_run(scene, limits, settings) as run:
        printed = _run(run, f"run-scene {_copy(run)} {quoted(run.leaves('description').name)}", writer)
        description = _left_behind(run, "description", printed)
    rest = replace(limits, seconds=limits.seconds - (time.monotonic() - began))
    if rest.seconds <= 0:
        raise HolonomError(Failure.TOO_LONG, scene, detail=f"{limits.seconds:g} s")
    with doing("deriving with Maxima"), _new_run(scene, rest, settings) as run:
        (run.directory / "description").write_bytes(description)
        printed = _run(run, f'run-description "description" {_call(writer, run)}', writer)
        return _document(run, printed)


def run_batch(
    file: Path, writer: str, limits: Limits = DEFAULT_LIMITS, settings: Mapping[str, str] = NO_SETTINGS
) -> str:
    """Run a Maxima file in the open, then one Maxima function that writes a document, perhaps one of the file's.

    Raises as `ask_scene`.

    Parameters
    ----------
    file, writer, limits, settings
        As for `ask_scene`.
    """
    with doing("deriving with Maxima"), _new_run(file, replace(limits, sandbox=Sandbox.TRUSTED), settings) as run:
        printed = _run(run, f"run-file {_copy(run)} {_call(writer, run)}", writer)
        return _document(run, printed)


def run_rtest(rtest: Path) -> int:
    """Run a file in Maxima's own test convention, pairs of input and expected result, with the library loaded.

    Returns
    -------
    int
        The number of tests, every one of them passed. It is counted in the file's text: where Maxima cannot read on
        it prints no summary.

    Raises
    ------
    HolonomError
        A test failed or was not run; carries all that Maxima printed.
    """
    tests, unpaired = divmod(count_statements(rtest.read_text(encoding="utf-8")), 2)
    if unpaired:
        raise HolonomError(Failure.RTEST_UNPAIRED, rtest)
    with _new_run(LIBRARY / "holonom.mac", DEFAULT_LIMITS, NO_SETTINGS) as run:
        shutil.copy(rtest, run.directory)  # for Maxima leaves a list of errors beside the file it tests
        test = quoted(f"(open_namespace(), batch({quoted(rtest.name)}, test))$")
        printed = _run(run, f"run-file {_copy(run)} {test}", test)
    if re.findall(r"(\d+)/(\d+) tests passed", printed) != [(str(tests), str(tests))]:
        raise HolonomError(Failure.RTEST_FAILED, rtest, str(tests), last_lines=tuple(printed.splitlines()))
    return tests


def count_statements(text: str) -> int:
    """Count the statements in Maxima text: terminators, ``;`` or ``$``, outside comments and strings."""
    return sum(1 for _ in statement_ends(text))


def statement_ends(text: str, position: int = 0) -> Iterator[int]:
    """Yield where statements end in Maxima text: the positions just past a terminator, ``;`` or ``$``."""
    depth = 0
    while match := (IN_COMMENT if depth else IN_CODE).search(text, position):
        position = match.end()
        depth += {"/*": 1, "*/": -1}.get(match[0], 0)
        if match[0] in (";", "$"):
            yield position


@contextmanager
def _new_run(file: Path, limits: Limits, settings: Mapping[str, str]) -> Iterator[Run]:
    with private_directory() as directory:
        yield Run(file, directory, limits, settings, secrets.token_hex(16))


def _copy(run: Run) -> str:
    """The name of a copy of the run's file, as Lisp text; every path and every line end can be read in the copy."""
    (run.directory / "file.mac").write_bytes(read_maxima_text(run.file).encode())
    return '"file.mac"'


def read_maxima_text(file: Path) -> str:
    """Read a Maxima file, with or without a byte order mark, its lines ended in any way; with line feeds then.

    Raises
    ------
    HolonomError
        There is no such file, it is no regular one, it cannot be read, or it is not UTF-8.
    """
    try:
        if not stat.S_ISREG(file.stat().st_mode):
            raise HolonomError(Failure.FILE_UNREADABLE, file, "it is no regular file")
        content = file.read_bytes()
    except FileNotFoundError:
        raise HolonomError(Failure.FILE_MISSING, file, near_file(file)) from None
    except OSError as error:
        raise HolonomError(Failure.FILE_UNREADABLE, file, error.strerror or str(error)) from None
    try:
        text = content.decode()
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise HolonomError(Failure.NOT_UTF8, f"{file}:{line}", f"0x{content[error.start]:02x}") from None
    if "\0" in text:
        raise HolonomError(Failure.FILE_UNREADABLE, file, "it holds null characters and is no text")
    return text.removeprefix(BYTE_ORDER_MARK).replace("\r\n", "\n").replace("\r", "\n")


def _call(writer: str, run: Run) -> str:
    """Maxima text that writes the document, as Lisp text."""
    return quoted(f"{writer}({quoted(run.leaves('document').name)})$")


def _run(run: Run, start: str, writer: str) -> str:
    """Do what `start` says; return what Maxima printed."""
    maxima = _maxima()
    outcome = run.leaves("outcome")
    preparation = f"(holonom_print : false, {_set(run.settings)})$"
    arguments = [quoted(each) for each in (run.file.resolve(), LIBRARY, preparation, outcome.name, run.mark)]
    confinement = _confinement(run, Path(maxima))
    image = _image(maxima)
    program = [maxima] if image is None else [str(image), *ARGUMENTS]
    known = () if image else JOBS
    parts = [*(each.read_text(encoding="utf-8") for each in known), f"({start} '({' '.join(arguments)}))\n"]
    (run.directory / "job.lisp").write_bytes(os.fsencode("(in-package :maxima)\n" + "\n".join(parts)))
    command = [*program, *QUIET, "--preload-lisp=job.lisp"]
    output = bytearray()
    try:
        status = run_confined(command, confinement, output)
    except LimitExceeded as exceeded:
        ending = Ending(exceeded.failure, str(run.file), exceeded.detail)
    except OSError as error:
        ending = Ending(Failure.NOT_MAXIMA, maxima, error.strerror or str(error))
    else:
        ending = _read_ending(run, maxima, status)
    printed = output.decode(errors="replace")
    if ending is None:
        return printed
    raise HolonomError(
        ending.failure,
        ending.place,
        ending.detail,
        last_lines=_last_lines(printed),
        command=_repeating_command(run.file, f'{writer}("document")$', run.settings),
    )


def _maxima() -> str:
    if (found := shutil.which("maxima")) is None:
        raise HolonomError(Failure.MAXIMA_MISSING)
    return found


def _image(maxima: str) -> Path | None:
    return preloaded_image(maxima, LIBRARY, frozenset(_passed_on().items()))


def _passed_on() -> dict[str, str]:
    return {name: os.environ[name] for name in PASSED_ON if name in os.environ}


def _confinement(run: Run, maxima: Path) -> Confinement:
    """A private directory for all that Maxima keeps, English messages, and nothing else of this machine's settings."""
    directory = str(run.directory)
    environment = ENVIRONMENT | _passed_on()
    environment |= {
        "HOME": directory,
        "TMPDIR": directory,
        "MAXIMA_USERDIR": directory,
        "MAXIMA_TEMPDIR": directory,
        "LC_ALL": "C",
        # GCL collects garbage in earnest from about a fifth of this share of the machine's memory on (measured), well
        # under the limit: what garbage there is depends on the limit then, and not on the machine.
        "GCL_MEM_MULTIPLE": f"{run.limits.memory_mib * MIB / _memory_of_the_machine():.6f}",
        # So large a share of its memory GCL allocates between two collections of garbage. With its own twentieth it
        # collects more than a hundred times while it writes the program of a thousand bodies, with this a few times in
        # the same memory. With a fifth, 24 derivatives of a gamma function take 3.7 GiB, with this 1.3 (measured).
        "GCL_GC_ALLOC_MIN": "0.13",
    }
    readable = (*surroundings(maxima), LIBRARY, _own_folder(run.file))
    return Confinement(run.directory, environment, readable, run.limits)


def _memory_of_the_machine() -> int:
    return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")


def _own_folder(file: Path) -> Path:
    """The folder that a file may read; the file alone where that would be the user's home directory, or more."""
    folder = file.resolve().parent
    return file.resolve() if Path.home().resolve().is_relative_to(folder) else folder


def _read_ending(run: Run, maxima: str, status: int) -> Ending | None:
    """The ending that `headless.lisp` wrote; None when the run is finished."""
    lines = (_read_left(run.leaves("outcome"), run.limits) or b"").decode(errors="replace").split("\n")
    if lines == [""]:
        return Ending(Failure.NOT_MAXIMA, maxima, f"exit status {status}")
    if len(lines) < 7 or [lines[0], *lines[-2:]] != [run.mark, run.mark, ""]:
        return Ending(Failure.TORN, str(run.file), "outcome")
    kind, running, line, message = lines[1], lines[2], lines[3], " ".join(lines[4:-2])
    if kind == FINISHED:
        return None
    if kind == STARTED:
        return _unfinished(run, status)
    if kind not in ENDINGS or not line.isdigit():
        return Ending(Failure.TORN, str(run.file), "outcome")
    own = running in (str(run.file.resolve()), str((run.directory / "file.mac").resolve()))
    shown = str(run.file) if own else running
    place = shown if line == "0" else f"{shown}:{line}"
    return Ending(ENDINGS[kind], place, " ".join(message.split()) or "it does not say which")


def _unfinished(run: Run, status: int) -> Ending:
    """The ending of a run that did not come to its end: it ended itself, or was ended by a signal."""
    number = -status if status < 0 else status - SIGNALLED
    if number not in SIGNALS:
        return Ending(Failure.ENDED_EARLY, str(run.file))
    return Ending(Failure.KILLED, str(run.file), signal.Signals(number).name)


def _document(run: Run, printed: str) -> str:
    text = _left_behind(run, "document", printed).decode(errors="replace")
    if not text.endswith("\n"):
        raise HolonomError(Failure.TORN, run.file, "document", last_lines=_last_lines(printed))
    return text


def _left_behind(run: Run, what: str, printed: str) -> bytes:
    content = _read_left(run.leaves(what), run.limits)
    if content is None:
        raise HolonomError(Failure.NOTHING_WRITTEN, run.file, last_lines=_last_lines(printed))
    return content


def _read_left(path: Path, limits: Limits) -> bytes | None:
    """What a process left in a regular file, or None; a link is not followed, nor a pipe waited for."""
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        return None
    found = os.fstat(descriptor)
    if not stat.S_ISREG(found.st_mode) or found.st_size > limits.file_mib * MIB:
        os.close(descriptor)
        return None
    with open(descriptor, "rb") as file:
        return file.read()


def _last_lines(printed: str) -> tuple[str, ...]:
    return tuple(line for line in printed.splitlines() if line.strip())[-LAST_LINES:]


def _set(settings: Mapping[str, str]) -> str:
    """A Maxima assignment of the settings."""
    return f"settings : [{', '.join(f'{name} = {value}' for name, value in settings.items())}]"


def _repeating_command(file: Path, call: str, settings: Mapping[str, str]) -> str:
    """A shell command that repeats a run with Maxima alone."""
    search = f"file_search_maxima : cons({quoted(LIBRARY / '$$$.mac')}, file_search_maxima)$"
    statements = f"{_set(settings)}$ {search} batch({quoted(file.resolve())})$ {call}"
    return f"maxima --init=/dev/null --batch-string={shlex.quote(statements)} </dev/null"
