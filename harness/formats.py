"""Formats of documents: JSON with a format, a version and a type of the content.

The schema of a document follows from its type (`holonom.schema`), down to expressions and programs, which are read
strictly where they are read.
"""

import gc
import json
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from enum import StrEnum
from functools import cache
from typing import TYPE_CHECKING, Any

from .failures import ErrorKind, HolonomError
from .language import translatable
from .schema import schema_of
from .structs import Struct, reader_of, written

if TYPE_CHECKING:
    from jsonschema_rs import Draft202012Validator

VERSION = 2
SHOWN = 200  # characters of a validator's message


class Document(StrEnum):
    """A document that Maxima writes.

    The value names format and schema, and `write_...` in Maxima writes it.
    """

    DESCRIPTION = "description"
    RECORD = "record"
    PROGRAM = "program"
    EFFECTS = "effects"
    MODEL = "model"
    MOTION_PROBLEM = "motion-problem"
    LINEARIZATION = "linearization"
    MOTION_SERIES = "motion-series"
    SERIES_COSTS = "series-costs"
    FREE_MOTION = "free-motion"
    ERRATA = "errata"
    VERSIONS = "versions"

    @property
    def writer(self) -> str:
        """The Maxima function."""
        return "write_" + self.value.replace("-", "_")


class Publication(StrEnum):
    """A document that a command publishes with ``--json`` and Maxima does not write."""

    CHECK = "check"
    SERIES = "series"
    SIMULATION = "simulation"
    DOCTOR = "doctor"
    SWEEP = "sweep"
    LINEARIZED = "linearized"
    LINEARIZED_ALONG = "linearized-along"
    EQUILIBRIA = "equilibria"
    COSTS = "costs"
    HARD_CASES = "hard-cases"
    ACCURACY = "accuracy"
    FREE = "free"


FORMATS = tuple(f"holonom-{name}" for name in (*Document, *Publication))


@contextmanager
def nothing_collected() -> Iterator[None]:
    """Collect no garbage while a document becomes objects, or these another text.

    Nearly all of them are part of the result, and Python would search them for garbage again and again: half of the
    time that a large program takes to be read, a third of the time that it takes to be written in C.

    Yields
    ------
    None
    """
    if not gc.isenabled():
        yield
        return
    gc.disable()
    try:
        yield
    finally:
        gc.enable()


@nothing_collected()
def read(document: Document, text: str, kind: type[Struct]) -> Struct:
    """Read a document that Maxima writes.

    Parameters
    ----------
    document : Document
        Kind of the document.
    text : str
        JSON text.
    kind : type
        Type of its content, by which it is checked.

    Returns
    -------
    object
        Instance of the type.

    Raises
    ------
    HolonomError
        The text is not JSON, or has another shape.
    """
    return reader_of(kind)(decoded(document, text, kind))


@nothing_collected()
def decoded(document: Document, text: str, kind: type) -> dict[str, Any]:
    """Return the JSON of a document that Maxima writes.

    Parameters
    ----------
    document, text, kind : Document, str, type
        As for `read`.

    Returns
    -------
    dict

    Raises
    ------
    HolonomError
        The text is not JSON, or has another shape.
    """
    try:
        content = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise _error(document, translatable("it is not JSON, %(error)s", error=error)) from None
    require(document, content, kind)
    return content


def require(document: Document | Publication, content: Any, kind: type) -> None:
    """Raise unless the value has the shape of a document.

    Parameters
    ----------
    document : Document or Publication
        Kind of the document.
    content : object
        Value that was read from JSON.
    kind : type
        Type of the content.

    Raises
    ------
    HolonomError
        The value has another shape.
    """
    try:
        errors = list(_validator(document, kind).iter_errors(content))
    except UnicodeEncodeError as error:  # half of a character, which JSON can write
        raise _error(document, str(error)) from None
    if error := min(errors, key=lambda each: len(each.instance_path), default=None):
        raise _error(
            document,
            translatable("at %(place)s, %(error)s", place=_json_path(error.instance_path), error=error.message[:SHOWN]),
        )


def _json_path(steps: Iterable[str | int]) -> str:
    return "$" + "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in steps)


def published(name: Document | Publication, content: Any, text: Callable[[Any], str] = str) -> dict[str, Any]:
    """Return a published document with its format and version.

    Parameters
    ----------
    name : Document or Publication
        Kind of the document.
    content : object
        Dataclass, or mapping of str to object: the other entries.
    text : callable
        As for `written`.

    Returns
    -------
    dict
    """
    return {"format": f"holonom-{name}", "version": VERSION, **written(content, text)}


def is_document(content: bytes) -> bool:
    """Return True for a document, by its format and version, or a list of documents.

    Parameters
    ----------
    content : bytes
        Content of a file.

    Returns
    -------
    bool
    """
    try:
        found = json.loads(content)
    except (ValueError, RecursionError):
        return False
    listed = found if isinstance(found, list) else [found]
    return bool(listed) and all(
        isinstance(each, dict) and each.get("format") in FORMATS and each.get("version") == VERSION for each in listed
    )


@cache
def _validator(name: str, kind: type) -> "Draft202012Validator":
    from jsonschema_rs import Draft202012Validator

    return Draft202012Validator(schema_of(kind, name, VERSION))


def _error(document: Document | Publication, detail: str) -> HolonomError:
    return HolonomError(
        ErrorKind.NOT_A_DOCUMENT,
        detail=translatable("%(place)s: %(reason)s", place=f"holonom-{document}", reason=detail),
    )
