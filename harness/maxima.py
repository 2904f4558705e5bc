"""One headless run of Maxima: no prompts, no init files, errors that say where.

This is the only module that knows Maxima is a process. A run has a private directory; `headless.lisp`, loaded before
anything else, makes errors of questions and leaves the ending in a file, for Maxima's exit status says nothing. What
Maxima prints is kept for people and not read, with one exception: the count of Maxima's own test runner.
"""

import os
import re
import shlex
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from .confined import MIB, PAGE, LimitExceeded, Limits, run_confined
from .failures import Failure, HolonomError

LIBRARY = Path(__file__).resolve().parents[1] / "maxima"
HEADLESS = Path(__file__).with_name("headless.lisp")
DEFAULT_LIMITS = Limits()
NO_SETTINGS: Mapping[str, str] = {}
PHYSICAL_MEMORY = os.sysconf("SC_PHYS_PAGES") * PAGE  # bytes
LAST_LINES = 10  # lines of Maxima's output that an error carries

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


def run_scene(scene: Path, limits: Limits = DEFAULT_LIMITS, settings: Mapping[str, str] = NO_SETTINGS) -> str:
    """Derive a scene file.

    Parameters
    ----------
    scene : Path
        A Maxima file that describes one system and any number of scenes.
    limits : Limits
        What the run may take.
    settings : mapping of str to str
        As for `run_batch`.

    Returns
    -------
    str
        The derivation record, JSON text.

    Raises
    ------
    HolonomError
        The file is missing, is refused, asks a question, exceeds a limit, or Maxima is missing.
    """
    return run_batch(scene, "write_record", limits, settings)


def run_batch(
    file: Path, writer: str, limits: Limits = DEFAULT_LIMITS, settings: Mapping[str, str] = NO_SETTINGS
) -> str:
    """Run a Maxima file, then one Maxima function that writes a document.

    Parameters
    ----------
    file : Path
        The Maxima file. ``load("holonom.mac")`` in it finds this project's library.
    writer : str
        The Maxima function that writes the document, given the name of the file to write.
    limits : Limits
        What the run may take.
    settings : mapping of str to str
        Numbers in Maxima's notation, for what the file leaves open and for parameters.

    Returns
    -------
    str
        What the function wrote.

    Raises
    ------
    HolonomError
        As `run_scene`.
    """
    with _private_directory() as directory:
        printed = _run(file, f'{writer}("document")$', limits, directory, settings)
        document = directory / "document"
        if not document.exists():
            raise HolonomError(Failure.NOTHING_WRITTEN, file, last_lines=_last_lines(printed))
        return document.read_text(encoding="utf-8")


def run_rtest(rtest: Path, limits: Limits = DEFAULT_LIMITS) -> int:
    """Run a file in Maxima's own test convention, pairs of input and expected result, with the library loaded.

    Parameters
    ----------
    rtest : Path
        The file, ``rtest_*.mac``.
    limits : Limits
        What the run may take.

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
    with _private_directory() as directory:
        shutil.copy(rtest, directory)  # for Maxima leaves a list of errors beside the file it tests
        printed = _run(LIBRARY / "holonom.mac", f"batch({_quoted(rtest.name)}, test)$", limits, directory)
    if re.findall(r"(\d+)/(\d+) tests passed", printed) != [(str(tests), str(tests))]:
        raise HolonomError(Failure.RTEST_FAILED, rtest, str(tests), last_lines=tuple(printed.splitlines()))
    return tests


def count_statements(text: str) -> int:
    """Count the statements in Maxima text.

    Parameters
    ----------
    text : str
        Maxima text, its statements ended by ``;`` or ``$``.

    Returns
    -------
    int
        The number of terminators outside comments and strings.
    """
    return sum(1 for _ in statement_ends(text))


def statement_ends(text: str, position: int = 0) -> Iterator[int]:
    """Yield where statements end in Maxima text.

    Parameters
    ----------
    text : str
        Maxima text.
    position : int
        Where to begin, outside comments and strings.

    Yields
    ------
    int
        The position just past a terminator, ``;`` or ``$``.
    """
    depth = 0
    while match := (IN_COMMENT if depth else IN_CODE).search(text, position):
        position = match.end()
        depth += {"/*": 1, "*/": -1}.get(match[0], 0)
        if match[0] in (";", "$"):
            yield position


@contextmanager
def _private_directory() -> Iterator[Path]:
    with tempfile.TemporaryDirectory(prefix="holonom-") as name:
        yield Path(name)


def _run(file: Path, call: str, limits: Limits, directory: Path, settings: Mapping[str, str] = NO_SETTINGS) -> str:
    """Run the statements of `file` and then `call`; return what Maxima printed."""
    _refuse_unreadable(file)
    if (maxima := shutil.which("maxima")) is None:
        raise HolonomError(Failure.MAXIMA_MISSING)
    (directory / "job.lisp").write_text(_job(file, call, settings), encoding="utf-8")
    command = [maxima, "--init=/dev/null", "--very-quiet", "--preload-lisp=job.lisp"]
    output = bytearray()
    try:
        run_confined(command, directory, _environment(directory, limits), limits, output)
    except LimitExceeded as exceeded:
        ending = Ending(exceeded.failure, str(file), exceeded.detail)
    else:
        ending = _read_ending(directory / "outcome", file)
    printed = output.decode(errors="replace")
    if ending is None:
        return printed
    raise HolonomError(
        ending.failure,
        ending.place,
        ending.detail,
        last_lines=_last_lines(printed),
        command=_repeating_command(file, call, settings),
    )


def _environment(directory: Path, limits: Limits) -> dict[str, str]:
    """A private directory for all that Maxima keeps, and English messages."""
    return os.environ | {
        "MAXIMA_USERDIR": str(directory),
        "MAXIMA_TEMPDIR": str(directory),
        "LC_ALL": "C",
        # GCL collects garbage in earnest from about a fifth of this share of the machine's memory on (measured), well
        # under the limit: what garbage there is depends on the limit then, and not on the machine.
        "GCL_MEM_MULTIPLE": f"{limits.memory_mib * MIB / PHYSICAL_MEMORY:.6f}",
    }


def _refuse_unreadable(file: Path) -> None:
    try:
        file.open("rb").close()
    except FileNotFoundError:
        raise HolonomError(Failure.FILE_MISSING, file) from None
    except OSError as error:
        raise HolonomError(Failure.FILE_UNREADABLE, file, error.strerror or str(error)) from None


def _job(file: Path, call: str, settings: Mapping[str, str]) -> str:
    """The Lisp that Maxima loads first, which does the whole run."""
    preparation = f"(holonom_print : false, {_set(settings)})$"
    arguments = [_quoted(argument) for argument in (file.resolve(), LIBRARY, preparation, call, "outcome")]
    return f"{HEADLESS.read_text(encoding='utf-8')}\n(run-headless {' '.join(arguments)})\n"


def _read_ending(outcome: Path, file: Path) -> Ending | None:
    """The ending that `headless.lisp` wrote; None when the run is finished."""
    if not outcome.exists():
        return Ending(Failure.ENDED_EARLY, str(file))
    kind, running, line, message = outcome.read_text(encoding="utf-8", errors="replace").split("\n", 3)
    if kind == "FINISHED":
        return None
    shown = str(file) if running == str(file.resolve()) else running
    place = shown if line == "0" else f"{shown}:{line}"
    return Ending(ENDINGS[kind], place, " ".join(message.split()))


def _last_lines(printed: str) -> tuple[str, ...]:
    return tuple(line for line in printed.splitlines() if line.strip())[-LAST_LINES:]


def _set(settings: Mapping[str, str]) -> str:
    """A Maxima assignment of the settings."""
    return f"settings : [{', '.join(f'{name} = {value}' for name, value in settings.items())}]"


def _repeating_command(file: Path, call: str, settings: Mapping[str, str]) -> str:
    """A shell command that repeats a run with Maxima alone."""
    search = f"file_search_maxima : cons({_quoted(LIBRARY / '$$$.mac')}, file_search_maxima)$"
    statements = f"{_set(settings)}$ {search} batch({_quoted(file.resolve())})$ {call}"
    return f"maxima --init=/dev/null --batch-string={shlex.quote(statements)} </dev/null"


def _quoted(text: str | Path) -> str:
    """A string literal, for Lisp and for Maxima alike."""
    return '"' + str(text).replace("\\", "\\\\").replace('"', '\\"') + '"'
