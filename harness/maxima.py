"""One headless run of Maxima: no prompts, no init files, located errors.

This is the only module that handles Maxima as a process. A run has a private directory. `headless.lisp`, loaded
first, turns questions into errors and writes the ending to a file, because Maxima's exit status is not reliable. The
output of Maxima is recorded for people and not parsed, with one exception: the count of Maxima's own test runner.

A scene file is a program, perhaps an untrusted one. One process runs it and writes its description. Other processes,
which start after the first has ended and never see the file, derive from that description.
"""

import json
import os
import re
import shlex
import shutil
import signal
import stat
from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

from .failures import ErrorKind, HolonomError
from .files import near_file, shared
from .hidden import visible_line
from .language import Message, translatable
from .preloaded import ARGUMENTS, ENVIRONMENT, JOBS, QUIET, preloaded_image, quoted, remove_if_broken, share_of_memory
from .sandbox import MIB, LimitExceeded, Limits, Place, Sandbox, is_isolated, run_process, surroundings
from .scene_files import opened_scene_files
from .supervisor import doing
from .temporary import private_directory

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
LARGEST = 64 * MIB  # bytes of a scene file, and of the description that it leaves
SHOWN = 40  # characters of a name that is rejected
# A string, or a name of more than 200 characters, some perhaps behind a backslash.
LONG_NAME = re.compile(r'"(?:[^"\\]|\\.)*+"?|(?<![\w\\])(?P<name>(?:[^\W\d]|\\.)(?:\w|%|\\.){200,})', re.DOTALL)
BYTE_ORDER_MARK = "\ufeff"
SIGNALS = frozenset(signal.Signals)
SIGNALLED = 128  # a shell adds this to the number of the signal that ended a process

OUTCOME, DOCUMENT = "outcome", "document"  # what a run leaves behind
LONGEST_OUTCOME = MIB  # bytes
REFUSAL = re.compile(r"\w*")
STARTED, FINISHED = "STARTED", "FINISHED"
ENDINGS = {
    "FAULT": ErrorKind.REFUSED,
    "QUESTION": ErrorKind.QUESTION,
    "SYNTAX": ErrorKind.SYNTAX,
    "LISP": ErrorKind.LISP_ERROR,
}

# What may stand in Maxima text, inside a comment (they nest) and outside: a hidden character, a string, a terminator.
IN_COMMENT = re.compile(r"/\*|\*/")
IN_CODE = re.compile(r'/\*|\\.|"(?:[^"\\]|\\.)*"|[;$]', re.DOTALL)


@dataclass(frozen=True)
class Ending:
    """The way and the place in which a run ended early."""

    kind: ErrorKind
    place: str
    detail: str = ""
    refusal: str | None = None  # its id in maxima/refusals.mac


@dataclass(frozen=True)
class Run:
    """One run of Maxima, in a directory of its own."""

    file: Path  # the file that it is about
    directory: Path
    limits: Limits
    settings: Mapping[str, str] | None
    mark: str  # what only this run can know: the names of what it leaves behind end in it, and the outcome holds it
    reads_files: bool  # True if it gets the files that the scene names, and those in its folder
    left_behind: tuple[str, ...]

    def leaves(self, what: str) -> Path:
        """Return the file that the run must leave.

        Parameters
        ----------
        what : str
            ``outcome``, ``document`` or another name that the run leaves.

        Returns
        -------
        Path
        """
        return self.directory / f"{what}-{self.mark}"


class Ended(NamedTuple):
    """A run that is over, or one part of it, with its early ending and output."""

    ending: Ending | None
    printed: str

    def require_finished(self, run: Run, writer: str) -> None:
        """Raise if the run ended early.

        Parameters
        ----------
        run : Run
            The run, for the command that repeats it.
        writer : str
            Maxima's function that was to write the document.

        Raises
        ------
        HolonomError
            The run ended early.
        """
        if self.ending is None:
            return
        command = "" if run.settings is None else _repeating_command(run.file, f'{writer}("document")$', run.settings)
        raise HolonomError(
            self.ending.kind,
            self.ending.place,
            self.ending.detail,
            refusal=self.ending.refusal,
            last_lines=_last_lines(self.printed),
            command=command,
        )


def get_ready(file: Path, limits: Limits) -> None:
    """Do the first steps of a run about a file beforehand.

    They would take ten times as long next to a busy thread.

    Parameters
    ----------
    file : Path
        Scene file.
    limits : Limits
        Limits of the run.

    Raises
    ------
    HolonomError
        The file cannot be read, or Maxima is missing.
    """
    read_maxima_text(file)
    is_isolated(limits)
    _image(_maxima())


def run_scene(file: Path, limits: Limits, settings: Mapping[str, str], document: str) -> str:
    """Run a scene file, and return its description.

    Parameters
    ----------
    file : Path
        A Maxima file that describes one system and any number of scenes. ``load("holonom.mac")`` in it finds this
        project's library.
    limits : Limits
        Limits of the run, and its sandbox.
    settings : mapping of str to str
        Numbers in Maxima's notation, for what the file leaves open and for parameters.
    document : str
        Name of the document, for the command that repeats the run.

    Returns
    -------
    str
        JSON text.

    Raises
    ------
    HolonomError
        The file is missing or invalid, asks a question, exceeds a limit, or Maxima is missing.
    """
    with doing("running the scene file"), _new_run(file, limits, settings) as run:
        left = run.leaves(DOCUMENT)
        ended = _run(run, f"run-scene {_copy(run)} {quoted(left.name)}")
        if ended.ending is None and left.is_file() and left.stat().st_size > LARGEST:
            raise HolonomError(ErrorKind.DESCRIPTION_TOO_LARGE, file, f"{LARGEST // MIB} MiB")
        return _finished_document(run, ended, f"write_{document}")


def run_description(
    text: str, file: Path, writers: Sequence[str], limits: Limits, settings: Mapping[str, str] | None
) -> list[str | HolonomError]:
    """Derive documents from a description in one process, without its file.

    Parameters
    ----------
    text : str
        The description.
    file : Path
        The file of the description, for messages.
    writers : sequence of str
        For each document the library's function that writes it, given the name of the file to write.
    limits : Limits
        Limits of the run, and its sandbox.
    settings : mapping of str to str, or None
        The settings of the file's run, for the command that repeats the run, or None if no file was run.

    Returns
    -------
    list of str or HolonomError
        The documents, or the errors: the description is rejected, a limit is exceeded. Documents written before a
        limit is exceeded are included.

    Raises
    ------
    HolonomError
        Maxima is missing.
    """
    left = [(f"{OUTCOME}{k}", f"{DOCUMENT}{k}") for k in range(len(writers))]
    left_behind = (OUTCOME, *chain.from_iterable(left))
    with doing("deriving with Maxima"), _new_run(file, limits, settings, False, left_behind) as run:
        (run.directory / "description").write_text(text, encoding="utf-8")
        calls = [
            f"({_call(writer, run, document)} {quoted(run.leaves(outcome).name)})"
            for writer, (outcome, document) in zip(writers, left, strict=True)
        ]
        ended = _run(run, f'run-description "description" \'({" ".join(calls)})')
        return [_written(run, ended, writer, *names) for writer, names in zip(writers, left, strict=True)]


def _written(run: Run, ended: Ended, writer: str, outcome: str, document: str) -> str | HolonomError:
    """Return one document of a run, or its error."""
    broken_off = ended.ending or Ending(ErrorKind.OUTPUT_TRUNCATED, str(run.file), OUTCOME)
    own = Ended(_read_ending(run, outcome, broken_off), ended.printed)
    try:
        return _finished_document(run, own, writer, document)
    except HolonomError as error:
        return error


def run_batch(
    file: Path, writer: str, limits: Limits = DEFAULT_LIMITS, settings: Mapping[str, str] = NO_SETTINGS
) -> str:
    """Run a Maxima file outside the sandbox, then one function that writes a document.

    The function may be one of the file's.

    Parameters
    ----------
    file : Path
        As for `run_scene`.
    writer : str
        As for `run_description`.
    limits, settings : Limits, mapping of str to str
        As for `run_scene`.

    Returns
    -------
    str
        The document.

    Raises
    ------
    HolonomError
        As `run_scene`.
    """
    with doing("deriving with Maxima"), _new_run(file, replace(limits, sandbox=Sandbox.TRUSTED), settings) as run:
        return _finished_document(run, _run(run, f"run-file {_copy(run)} {_call(writer, run)}"), writer)


def statement_ends(text: str, position: int = 0) -> Iterator[int]:
    """Yield the positions after the terminators of statements in Maxima text.

    Terminators are ``;`` and ``$``.

    Parameters
    ----------
    text : str
        Maxima text.
    position : int
        Place outside of comments at which the search begins.

    Yields
    ------
    int
    """
    for match, _ in _tokens(text, position):
        if match[0] in (";", "$"):
            yield match.end()


def _tokens(text: str, position: int = 0) -> Iterator[tuple[re.Match[str], int]]:
    """Yield delimiters of Maxima text, each with the depth of comments after it."""
    depth = 0
    while match := (IN_COMMENT if depth else IN_CODE).search(text, position):
        position = match.end()
        depth += {"/*": 1, "*/": -1}.get(match[0], 0)
        yield match, depth


@contextmanager
def _new_run(
    file: Path,
    limits: Limits,
    settings: Mapping[str, str] | None,
    reads_files: bool = True,
    left_behind: tuple[str, ...] = (OUTCOME, DOCUMENT),
) -> Iterator[Run]:
    with private_directory() as directory:
        yield Run(file, directory, limits, settings, os.urandom(16).hex(), reads_files, left_behind)


def _copy(run: Run) -> str:
    """Return the name of a copy of the run's file, as Lisp text.

    Every path and every line end can be read in the copy.
    """
    text = read_maxima_text(run.file)
    _require_short_names(text, run.file)
    _require_closed_comments(text, run.file)
    (run.directory / "file.mac").write_bytes(text.encode())
    return '"file.mac"'


def limited(opened: BinaryIO, file: Path | str) -> bytes:
    """Read a file up to the size limit of scene files.

    Parameters
    ----------
    opened : BinaryIO
        File open for reading.
    file : Path or str
        Its name, for messages.

    Returns
    -------
    bytes

    Raises
    ------
    HolonomError
        It is larger.
    """
    content = opened.read(LARGEST + 1)
    if len(content) > LARGEST:
        raise HolonomError(ErrorKind.FILE_TOO_LARGE, file, f"{LARGEST // MIB} MiB")
    return content


def _require_short_names(text: str, file: Path) -> None:
    """Raise for names that Maxima's reader would take minutes for.

    Its time grows as the square of their length.
    """
    for found in LONG_NAME.finditer(text):
        if found["name"]:
            line = text.count("\n", 0, found.start()) + 1
            raise HolonomError(ErrorKind.NAME_TOO_LONG, f"{file}:{line}", found["name"][:SHOWN])


def _require_closed_comments(text: str, file: Path) -> None:
    """Raise for a comment without end: Maxima would skip the statements after it."""
    begun, inside = 0, 0
    for match, depth in _tokens(text):
        if depth > inside == 0:
            begun = match.start()
        inside = depth
    if inside:
        line = text.count("\n", 0, begun) + 1
        raise HolonomError(ErrorKind.COMMENT_NOT_CLOSED, f"{file}:{line}")


def read_maxima_text(file: Path) -> str:
    """Read a Maxima file, with all line ends converted to line feeds.

    A byte order mark is removed.

    Parameters
    ----------
    file : Path
        A file in UTF-8.

    Returns
    -------
    str

    Raises
    ------
    HolonomError
        There is no such file, it is not a regular one, it is too large, it cannot be read, or it is not UTF-8.
    """
    try:
        if not stat.S_ISREG(file.stat().st_mode):
            raise HolonomError(ErrorKind.FILE_UNREADABLE, file, translatable("not a regular file"))
        with file.open("rb") as opened:
            content = limited(opened, file)
    except FileNotFoundError:
        raise HolonomError(ErrorKind.FILE_MISSING, file, near_file(file)) from None
    except OSError as error:
        raise HolonomError(ErrorKind.FILE_UNREADABLE, file, error.strerror or str(error)) from None
    try:
        text = content.decode()
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise HolonomError(ErrorKind.NOT_UTF8, f"{file}:{line}", f"0x{content[error.start]:02x}") from None
    if "\0" in text:
        raise HolonomError(ErrorKind.FILE_UNREADABLE, file, translatable("it contains null characters"))
    return text.removeprefix(BYTE_ORDER_MARK).replace("\r\n", "\n").replace("\r", "\n")


def _call(writer: str, run: Run, document: str = DOCUMENT) -> str:
    """Return Maxima text that writes a document, as Lisp text."""
    return quoted(f"{writer}({quoted(run.leaves(document).name)})$")


def _run(run: Run, start: str) -> Ended:
    """Execute the steps of `start`."""
    maxima = _maxima()
    image = _image(maxima)
    output = bytearray()
    with _files(run) as copies:
        place = _place(run, Path(maxima), copies)
        ending = _attempt(run, start, maxima, image, place, output)
        if ending is not None and ending.kind is ErrorKind.NOT_MAXIMA and image:  # broken, or removed by another one
            remove_if_broken(image, place)
            ending = _attempt(run, start, maxima, None, place, output)
    return Ended(ending, output.decode(errors="replace"))


def _files(run: Run) -> AbstractContextManager[Mapping[Path, int]]:
    """Return the opened files that the run gets copies of."""
    if run.reads_files and is_isolated(run.limits):
        return opened_scene_files(run.file, run.limits.allow)
    return nullcontext({})


def _attempt(run: Run, start: str, maxima: str, image: Path | None, place: Place, output: bytearray) -> Ending | None:
    """Run Maxima, or an image of it. Return its early ending, if any."""
    preparation = f"(holonom_print : false, {_set(run.settings or NO_SETTINGS)})$"
    facts = (run.file.resolve(), LIBRARY, preparation, run.leaves(OUTCOME).name, run.mark)
    known = [] if image else [each.read_text(encoding="utf-8") for each in JOBS]
    job = "\n".join(["(in-package :maxima)", *known, f"({start} '({' '.join(map(quoted, facts))}))\n"])
    (run.directory / "job.lisp").write_bytes(os.fsencode(job))
    program = [maxima] if image is None else [str(image), *ARGUMENTS]
    try:
        status = run_process([*program, *QUIET, "--preload-lisp=job.lisp"], place, output)
    except LimitExceeded as exceeded:
        return Ending(exceeded.kind, str(run.file), exceeded.detail)
    except OSError as error:
        return Ending(ErrorKind.NOT_MAXIMA, maxima, error.strerror or str(error))
    begun = _read_left(run.leaves(OUTCOME), LONGEST_OUTCOME)
    not_begun = Ending(ErrorKind.NOT_MAXIMA, maxima, f"exit status {status}")
    return _read_ending(run, OUTCOME, _unfinished(run, status) if begun else not_begun)


def _maxima() -> str:
    if (found := shutil.which("maxima")) is None:
        raise HolonomError(ErrorKind.MAXIMA_MISSING)
    return found


def _image(maxima: str) -> Path | None:
    return preloaded_image(maxima, LIBRARY, frozenset(_passed_on().items()))


def _passed_on() -> dict[str, str]:
    return {name: os.environ[name] for name in PASSED_ON if name in os.environ}


def _place(run: Run, maxima: Path, copies: Mapping[Path, int]) -> Place:
    """Return a private directory and an environment without local settings.

    Maxima's messages are in English.
    """
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
        "GCL_MEM_MULTIPLE": share_of_memory(run.limits.memory_mib),
        # So large a share of its memory GCL allocates between two collections of garbage. With its own twentieth it
        # collects more than a hundred times while it writes the program of a thousand bodies, with this a few times in
        # the same memory. With a fifth, 24 derivatives of a gamma function take 3.7 GiB, with this 1.3 (measured).
        "GCL_GC_ALLOC_MIN": "0.13",
    }
    outputs = [run.leaves(what) for what in run.left_behind]
    for each in outputs:
        each.touch()
    return Place(run.directory, environment, run.limits, (*surroundings(maxima), LIBRARY), copies, outputs)


def _read_ending(run: Run, what: str, broken_off: Ending) -> Ending | None:
    """Return the ending that `headless.lisp` wrote, or None for finished parts."""
    lines = (_read_left(run.leaves(what), LONGEST_OUTCOME) or b"").decode(errors="replace").split("\n")
    if lines == [""]:
        return broken_off
    if len(lines) < 8 or [lines[0], *lines[-2:]] != [run.mark, run.mark, ""]:
        return Ending(ErrorKind.OUTPUT_TRUNCATED, str(run.file), OUTCOME)
    kind, running, line, refusal, message = *lines[1:5], " ".join(lines[5:-2])
    if kind in (FINISHED, STARTED):
        return None if kind == FINISHED else broken_off
    if kind not in ENDINGS or not line.isdigit() or not REFUSAL.fullmatch(refusal):
        return Ending(ErrorKind.OUTPUT_TRUNCATED, str(run.file), OUTCOME)
    # `headless.lisp` makes one line of a name
    own = running in (str(each.resolve()).replace("\n", " ") for each in (run.file, run.directory / "file.mac"))
    shown = str(run.file) if own else visible_line(running)
    place = shown if line == "0" else f"{shown}:{line}"
    try:
        detail = Message.of_document(_one_line(json.loads(message))) if refusal else _one_line(message).strip()
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return Ending(ErrorKind.OUTPUT_TRUNCATED, str(run.file), OUTCOME)
    return Ending(ENDINGS[kind], place, detail or translatable("it gives no message"), refusal or None)


def _one_line(content: Any) -> Any:
    """Return a message or its parts, each on one line without hidden characters."""
    if isinstance(content, dict):
        return {name: _one_line(part) for name, part in content.items()}
    return visible_line(re.sub(r"\s+", " ", content))


def _unfinished(run: Run, status: int) -> Ending:
    """Return the ending of an incomplete run, by itself or by a signal."""
    number = -status if status < 0 else status - SIGNALLED
    if number not in SIGNALS:
        return Ending(ErrorKind.ENDED_EARLY, str(run.file))
    return Ending(ErrorKind.KILLED, str(run.file), signal.Signals(number).name)


def _finished_document(run: Run, ended: Ended, writer: str, document: str = DOCUMENT) -> str:
    """Return the document of a run, or raise if the run is incomplete."""
    ended.require_finished(run, writer)
    last_lines = _last_lines(ended.printed)
    content = _read_left(run.leaves(document), run.limits.file_mib * MIB)
    if not content:
        raise HolonomError(ErrorKind.NOTHING_WRITTEN, run.file, last_lines=last_lines)
    if not content.endswith(b"\n"):
        raise HolonomError(ErrorKind.OUTPUT_TRUNCATED, run.file, DOCUMENT, last_lines=last_lines)
    return content.decode(errors="replace")


def _read_left(path: Path, most: int) -> bytes | None:
    """Return the content of a regular file that a process left, or None.

    Links and pipes are not opened.
    """
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        return None
    found = os.fstat(descriptor)
    if not stat.S_ISREG(found.st_mode) or found.st_size > most:
        os.close(descriptor)
        return None
    with open(descriptor, "rb") as file:
        return file.read()


def _last_lines(printed: str) -> tuple[str, ...]:
    return tuple(visible_line(line) for line in printed.splitlines() if line.strip())[-LAST_LINES:]


def _set(settings: Mapping[str, str]) -> str:
    """Return a Maxima assignment of the settings."""
    items = [f"'{name} = {value}" for name, value in settings.items()]
    return f"settings : [{', '.join(items)}]"


def _repeating_command(file: Path, call: str, settings: Mapping[str, str]) -> str:
    """Return a shell command that repeats a run with Maxima alone."""
    search = f"file_search_maxima : cons({quoted(LIBRARY / '$$$.mac')}, file_search_maxima)$"
    statements = f"{_set(settings)}$ {search} batch({quoted(file.resolve())})$ {call}"
    return f"maxima --init=/dev/null --batch-string={shlex.quote(statements)} </dev/null"
