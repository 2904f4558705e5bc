"""Stored results of runs, by program, examples and arguments."""

import hashlib
import inspect
import pickle
import shutil
import sys
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

from ..files import shared, write_whole
from .runs import Run

HARNESS = Path(__file__).parents[1]
APART = {"cli", "companion", "display", "locale", "reference", "__pycache__"}  # folders that no result depends on
SUFFIXES = {".py", ".mac", ".lisp", ".json", ".toml", ".c", ".h"}

Compute = Callable[[list[Run]], dict[Run, Any]]


def results_of(runs: Iterable[Run], directory: Path | None, compute: Compute) -> dict[Run, Any]:
    """Return the results of runs from a directory, and store new ones there.

    Parameters
    ----------
    runs : iterable of Run
        Runs.
    directory : Path or None
        Folder of the results of earlier builds.
    compute : callable
        Function that performs runs.

    Returns
    -------
    dict of Run to Any
        Results by run.
    """
    wanted = dict.fromkeys(runs)
    files = {run: directory / f"{_key(run)}.pickle" for run in wanted} if directory else {}
    found = {run: pickle.loads(file.read_bytes()) for run, file in files.items() if file.is_file()}
    made = compute([run for run in wanted if run not in found])
    for run, result in made.items():
        if directory:
            directory.mkdir(parents=True, exist_ok=True)
            write_whole(files[run], pickle.dumps(result))
    return found | made


def _digest(files: Iterable[Path]) -> str:
    """Return a digest of the names and contents of files, whatever their folders."""
    digests = sorted(hashlib.sha256(file.name.encode() + file.read_bytes()).digest() for file in files)
    return hashlib.sha256(b"".join(digests)).hexdigest()


def digest_of_all() -> str:
    """Return the digest of all that pages are made of, but their texts.

    Returns
    -------
    str
        Hexadecimal digest.
    """
    patterns = "companion/*.py", "companion/chapters/*.py", "companion/templates/*", "locale/*/*/holonom.po"
    own = (file for pattern in patterns for file in HARNESS.glob(pattern))
    return _digest([*_below(shared("maxima")), *_below(shared("examples")), *_below(HARNESS), *own])


def _key(run: Run) -> str:
    paths = [each for each in run.arguments if isinstance(each, Path)]
    own = _digest([*(paths or _below(shared("examples"))), Path(inspect.getfile(run.compute))])
    asked = [each.name if isinstance(each, Path) else each for each in run.arguments]
    parts = (_program(), own, run.compute.__module__, run.compute.__qualname__, asked)
    return hashlib.sha256(repr(parts).encode()).hexdigest()


@cache
def _program() -> str:
    """Return the digest of all that computes."""
    tools = [HARNESS / "companion" / name for name in ("runs.py", "motions.py", "sessions.py")]
    installed = [Path(found) for found in (shutil.which("maxima"), sys.executable) if found]
    return _digest([*_below(shared("maxima")), *_below(HARNESS), *tools, *installed])


def _below(directory: Path) -> Iterator[Path]:
    """Yield the files below a folder that results depend on."""
    found = (file for file in directory.rglob("*") if file.suffix in SUFFIXES)
    return (file for file in found if APART.isdisjoint(file.relative_to(directory).parts))
