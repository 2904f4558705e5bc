"""Formats of documents: JSON with a format, a version and a schema.

A schema, `schemas/NAME.json` for the format ``holonom-NAME``, states the shape of a document down to expressions and
programs, which are read strictly where they are read.
"""

import gc
import json
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from enum import StrEnum
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .failures import ErrorKind, HolonomError
from .language import translatable

if TYPE_CHECKING:
    from jsonschema_rs import Draft202012Validator

SCHEMAS = Path(__file__).with_name("schemas")
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
    """Collect no garbage while a document becomes objects.

    All of them are part of the result, and Python would search them for garbage again and again: half of the time that
    a large program takes to be read.
    """
    if not gc.isenabled():
        yield
        return
    gc.disable()
    try:
        yield
    finally:
        gc.enable()


def read(document: Document, text: str) -> dict[str, Any]:
    """Read a document that Maxima writes.

    Parameters
    ----------
    document : Document
        Kind of the document.
    text : str
        JSON text.

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
    require(document, content)
    return content


def require(document: Document | Publication, content: Any) -> None:
    """Raise unless the value has the shape of a document.

    Parameters
    ----------
    document : Document or Publication
        Kind of the document.
    content : object
        Value that was read from JSON.

    Raises
    ------
    HolonomError
        The value has another shape.
    """
    try:
        errors = list(_validator(document).iter_errors(content))
    except UnicodeEncodeError as error:  # half of a character, which JSON can write
        raise _error(document, str(error)) from None
    if error := min(errors, key=lambda each: len(each.instance_path), default=None):
        raise _error(
            document,
            translatable("at %(place)s, %(error)s", place=_json_path(error.instance_path), error=error.message[:SHOWN]),
        )


def _json_path(steps: Iterable[str | int]) -> str:
    return "$" + "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in steps)


def published(name: Document | Publication, content: Mapping[str, Any]) -> dict[str, Any]:
    """Return a published document with its format and version.

    Parameters
    ----------
    name : Document or Publication
        Kind of the document.
    content : mapping of str to object
        The other entries.

    Returns
    -------
    dict
    """
    return {"format": f"holonom-{name}", "version": VERSION, **content}


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


def schema(name: str) -> dict[str, Any]:
    """Return the JSON schema of a format.

    Parameters
    ----------
    name : str
        Name of the format without ``holonom-``.

    Returns
    -------
    dict
    """
    return json.loads((SCHEMAS / f"{name}.json").read_text(encoding="utf-8"))


@cache
def _validator(name: str) -> "Draft202012Validator":
    from jsonschema_rs import Draft202012Validator

    return Draft202012Validator(schema(name))


def _error(document: Document | Publication, detail: str) -> HolonomError:
    return HolonomError(
        ErrorKind.NOT_A_DOCUMENT,
        detail=translatable("%(place)s: %(reason)s", place=f"holonom-{document}", reason=detail),
    )
