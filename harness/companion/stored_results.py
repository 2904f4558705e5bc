"""Results of runs, stored by program, examples and arguments."""

import hashlib
import inspect
import pickle
import shutil
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from ..files import shared, write_whole
from .runs import Run, perform

HARNESS = Path(__file__).parents[1]
APART = {"cli", "companion", "display", "locale", "reference", "__pycache__"}  # folders that no result depends on
SUFFIXES = {".py", ".mac", ".lisp", ".json", ".toml", ".c", ".h"}


class Results:
    """The results of runs, each performed once.

    Parameters
    ----------
    folder : Path or None
        Folder of the results of earlier builds, where new ones are stored.
    known : mapping of Run to Any, optional
        Results that are there already.
    done : callable, optional
        Called each time that one of the runs is done.
    """

    def __init__(
        self,
        folder: Path | None = None,
        known: Mapping[Run, Any] | None = None,
        done: Callable[[], None] = lambda: None,
    ) -> None:
        self.folder, self.known, self.done = folder, dict(known or {}), done

    def perform(self, runs: Iterable[Run]) -> None:
        """Perform the runs that have no result yet, two at a time.

        Parameters
        ----------
        runs : iterable of Run
            Runs.
        """
        missing = [run for run in dict.fromkeys(runs) if run not in self.known and not self._is_stored(run)]
        for run, result in perform(missing, self.done).items():
            self._keep(run, result)

    def __getitem__(self, run: Run) -> Any:
        """Return the result of a run, which is performed in this process if there is none."""
        if run not in self.known:
            if self._is_stored(run):
                self.known[run] = pickle.loads(self._file(run).read_bytes())
            else:
                self._keep(run, run.compute(*run.arguments))
        return self.known[run]

    def _is_stored(self, run: Run) -> bool:
        return self.folder is not None and self._file(run).is_file()

    def _file(self, run: Run) -> Path:
        return self.folder / f"{_key(run)}.pickle"

    def _keep(self, run: Run, result: Any) -> None:
        self.known[run] = result
        if self.folder is not None:
            self.folder.mkdir(parents=True, exist_ok=True)
            write_whole(self._file(run), pickle.dumps(result))


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
    patterns = "companion/*.py", "companion/templates/*", "locale/*/*/holonom.po"
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
