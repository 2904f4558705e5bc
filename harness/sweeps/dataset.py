"""The folder of a sweep: one Parquet file for each chunk, and a document on them.

A file is written completely or not at all. A manifest has a line for each file: its first and last row, and its
checksum. If the same sweep is run again, only files that are missing or altered are computed. Another sweep is
rejected.
"""

import fcntl
import hashlib
import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..failures import ErrorKind, HolonomError
from ..files import DRAFTS, append_line, write_whole
from ..formats import Publication, published, require
from ..language import translatable
from ..program.request import Solve
from ..simulation.request import Stabilization
from ..structs import entry
from .axes import Distribution

if TYPE_CHECKING:
    import pyarrow

DOCUMENT = "_sweep.json"  # readers of datasets skip names that begin so
LOCK = "_sweep.lock"
MANIFEST = "_parts.jsonl"
UNCOMPARED = ("file",)  # what a sweep may be called from and is still the same


@dataclass(frozen=True)
class Chunk:
    """Rows that one file holds."""

    # index, first, last: the last row is not among them
    index: int
    first: int
    last: int

    @property
    def name(self) -> str:
        """Of the file."""
        return f"part-{self.index:07d}.parquet"

    def _entry(self, content: bytes) -> dict[str, Any]:
        """Return the manifest's entry of the file, with its SHA-256 checksum."""
        checksum = hashlib.sha256(content).hexdigest()
        return {"part": self.name, "first": self.first, "last": self.last - 1, "sha256": checksum}


@dataclass(frozen=True)
class SweptScene:
    """The scene of a sweep."""

    file: str = entry("Path of the scene file, or - for standard input. A sweep is the same if its file has moved.")
    name: str = entry("Of the scene.")
    title: str = entry("Of the scene.")
    system: str = entry("Title of the system.")
    text: str = entry("The scene file.")
    sha256: str = entry("Of the text.")
    motion_sha256: str = entry("Of what was derived from it: other files may come into it.")


@dataclass(frozen=True)
class SweptParameter:
    """A parameter that varies."""

    name: str = entry("Of the parameter.")
    kind: str = entry(
        "A grid or list, or what a sample is drawn from.", enum=["values", *(str(each) for each in Distribution)]
    )
    asked: str = entry("As it stands on the command line.")


@dataclass(frozen=True)
class SweptOptions:
    """Options of the motions of a sweep."""

    tol: float = entry("Tolerance of a step.")
    until: str | None = entry("The last time; null for the end of the scene's time span.")
    stabilization: Stabilization = entry("Stabilization method of the constraints.")
    solve: Solve = entry("How the multipliers are solved for.")


@dataclass(frozen=True)
class SweepDocument:
    """A sweep: one motion for many values of its parameters."""

    scene: SweptScene = entry("Swept scene.")
    settings: Mapping[str, str] = entry("Numbers that were set for all rows.")
    parameters: tuple[SweptParameter, ...] = entry(
        "Varied quantities, in the order of the columns; the values of the last vary fastest."
    )
    size: int | None = entry("Members of the sample; null without one.")
    seed: int | None = entry("Of the sample; null without one.")
    rows: int = entry("How many there are.")
    chunk: int = entry("Rows of a file.")
    keep: tuple[str, ...] = entry("Recorded quantities of each motion.")
    columns: tuple[str, ...] = entry("Of the files.")
    options: SweptOptions = entry("How the motions are integrated.")
    versions: Mapping[str, str] = entry("Versions of the programs that computed it.")
    statuses: Mapping[str, int] | None = entry(
        "How many rows came about how; of the document that a command publishes.", None, optional=True
    )


class SweepFolder:
    """A folder that holds a sweep, or is to hold one.

    Parameters
    ----------
    document : SweepDocument
        Description of the sweep.

    Raises
    ------
    HolonomError
        It holds another sweep, or other things, or it cannot be written.
    """

    def __init__(self, path: Path, document: SweepDocument) -> None:
        self.path, self.document = path, published(Publication.SWEEP, document)

    @contextmanager
    def locked(self, resume: bool) -> Iterator[None]:
        """Lock the folder while the block runs.

        Parameters
        ----------
        resume : bool
            If True, the folder must contain this sweep.

        Yields
        ------
        None

        Raises
        ------
        HolonomError
            There is another sweep or something else in the folder, another command is at work there, or there is
            nothing to resume.
        """
        self._require_own(resume)
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            lock = os.open(self.path / LOCK, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o644)
        except OSError as error:
            raise HolonomError(ErrorKind.UNWRITABLE, self.path, error.strerror or str(error)) from None
        try:
            _lock(lock, self.path)
            self._require_own(resume)
            for left in self.path.glob(DRAFTS):  # of a command that was killed
                left.unlink(missing_ok=True)
            if not (self.path / DOCUMENT).exists():
                write_whole(self.path / DOCUMENT, json.dumps(self.document, ensure_ascii=False, indent=1) + "\n")
            yield
        finally:
            os.close(lock)

    def missing(self) -> tuple[list[Chunk], list[Chunk]]:
        """Return the chunks without a file, and the chunks whose files were altered.

        Returns
        -------
        absent : list of Chunk
            Chunks without a file.
        altered : list of Chunk
            Chunks whose file differs from its entry in the manifest.
        """
        listed = self._listed()
        absent, altered = [], []
        for chunk in chunks_of(self.document):
            file = self.path / chunk.name
            if not os.path.lexists(file):
                absent.append(chunk)
            elif file.is_symlink() or listed.get(chunk.name) != chunk._entry(file.read_bytes()):
                altered.append(chunk)
        return absent, altered

    def write(self, chunk: Chunk, content: bytes) -> None:
        """Put a chunk in its place, whole, and into the manifest.

        Parameters
        ----------
        chunk : Chunk
        content : bytes
            Bytes of its Parquet file.

        Raises
        ------
        HolonomError
            There is no space for it, or it cannot be written.
        """
        file = self.path / chunk.name
        if file.is_symlink():  # which would lead to another file
            file.unlink()
        write_whole(file, content)
        append_line(self.path / MANIFEST, json.dumps(chunk._entry(content)))

    def _listed(self) -> dict[str, dict[str, Any]]:
        """Return the last entry of the manifest for each file, without unreadable lines."""
        listed: dict[str, dict[str, Any]] = {}
        with suppress(FileNotFoundError):
            for line in (self.path / MANIFEST).read_bytes().splitlines():
                with suppress(ValueError, TypeError, KeyError):
                    entry = json.loads(line)
                    listed[str(entry["part"])] = entry
        return listed

    def _require_own(self, resume: bool) -> None:
        if not (self.path / DOCUMENT).exists():
            if self.path.exists() and (not self.path.is_dir() or set(os.listdir(self.path)) - {LOCK}):
                raise HolonomError(ErrorKind.UNRELATED_FOLDER, self.path)
            if resume:
                raise HolonomError(ErrorKind.NOTHING_TO_RESUME, self.path)
            return
        there = _read_document(self.path)
        for name, value in self.document.items():
            if _compared(there.get(name)) != _compared(value):
                raise HolonomError(
                    ErrorKind.OTHER_SWEEP,
                    self.path,
                    translatable("%(name)s is %(value)s there", name=name, value=_shown(there.get(name))),
                )


def _read_document(folder: Path) -> dict[str, Any]:
    """Return the content of ``_sweep.json`` in the folder of a sweep."""
    try:
        document = json.loads((folder / DOCUMENT).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        raise HolonomError(ErrorKind.UNRELATED_FOLDER, folder) from None
    require(Publication.SWEEP, document, SweepDocument)
    return document


def chunks_of(document: Mapping[str, Any]) -> list[Chunk]:
    """Return the chunks that a sweep is made of.

    Parameters
    ----------
    document : mapping of str to object
        Document of the sweep. Its ``rows`` and ``chunk`` are used.

    Returns
    -------
    list of Chunk
        Chunks in the order of their rows.
    """
    rows, size = document["rows"], document["chunk"]
    return [Chunk(k, first, min(first + size, rows)) for k, first in enumerate(range(0, rows, size))]


def part_of(table: "pyarrow.Table") -> bytes:
    """Return a table as the bytes of a Parquet file.

    Parameters
    ----------
    table : Table
        Rows of a chunk.

    Returns
    -------
    bytes
    """
    import pyarrow.parquet

    buffer = BytesIO()
    words = [field.name for field in table.schema if pyarrow.types.is_string(field.type)]  # numbers hardly come twice
    pyarrow.parquet.write_table(table.replace_schema_metadata({"holonom": "sweep"}), buffer, use_dictionary=words)
    return buffer.getvalue()


def _compared(value: Any) -> Any:
    """Return an entry of a document without the keys that are not compared."""
    return {k: v for k, v in value.items() if k not in UNCOMPARED} if isinstance(value, Mapping) else value


def _lock(lock: int, path: Path) -> None:
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise HolonomError(ErrorKind.FOLDER_TAKEN, path) from None


def _shown(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 60 else f"{text[:57]}..."
