"""The documents: JSON with a format, a version and a schema. What Maxima writes is asked for and read here alone.

A schema, `schemas/NAME.json` for the format ``holonom-NAME``, states the shape of a document down to expressions and
programs, which are read strictly where they are read.
"""

import json
from collections.abc import Iterable, Mapping, Sequence
from enum import StrEnum
from fractions import Fraction
from functools import cache
from pathlib import Path
from re import compile as pattern
from typing import TYPE_CHECKING, Any

from .confined import Limits
from .failures import Failure, HolonomError
from .maxima import DEFAULT_LIMITS, NO_SETTINGS, ask_scene, run_batch

if TYPE_CHECKING:
    from jsonschema_rs import Draft202012Validator

SCHEMAS = Path(__file__).with_name("schemas")
VERSION = 1
NAME = pattern(r"[^\W\d]\w*")
SHOWN = 200  # characters of what a validator says

Argument = None | int | Fraction | str | Sequence["Argument"]


class Document(StrEnum):
    """What Maxima writes; the value names format and schema, and `write_...` in Maxima writes it."""

    RECORD = "record"
    SCENES = "scenes"
    PROGRAM = "program"
    EFFECTS = "effects"
    MODEL = "model"
    MOTION_PROBLEM = "motion-problem"
    MOTION_SERIES = "motion-series"
    SERIES_COSTS = "series-costs"
    FREE_MOTION = "free-motion"
    ERRATA = "errata"
    VERSIONS = "versions"

    @property
    def writer(self) -> str:
        """The Maxima function."""
        return "write_" + self.value.replace("-", "_")


NO_SCENE = frozenset({Document.ERRATA, Document.VERSIONS})  # the paper's file holds more than a system


class Publication(StrEnum):
    """What a command publishes with ``--json`` and Maxima does not write."""

    CHECK = "check"
    SERIES = "series"
    SIMULATION = "simulation"
    DOCTOR = "doctor"
    SWEEP = "sweep"
    COSTS = "costs"
    HARD_CASES = "hard-cases"
    ACCURACY = "accuracy"


def ask(
    document: Document,
    file: Path,
    *arguments: Argument,
    settings: Mapping[str, str] = NO_SETTINGS,
    limits: Limits = DEFAULT_LIMITS,
) -> str:
    """Ask Maxima for a document about a scene file.

    Raises as `holonom.maxima.ask_scene`; and where a string can be no name.

    Parameters
    ----------
    *arguments : None, int, Fraction, str or sequence of these
        What the writer in Maxima takes behind the name of the file that it writes; a string is a name.
    settings : mapping of str to str
        Numbers in Maxima's notation, for what the file leaves open and for parameters.
    """
    call = ", ".join(["file", *map(_maxima_text, arguments)])
    run = run_batch if document in NO_SCENE else ask_scene
    return run(file, f"lambda([file], {document.writer}({call}))", limits, settings)


def read(document: Document, text: str) -> dict[str, Any]:
    """Read a document as Maxima writes it.

    Raises
    ------
    HolonomError
        The text is no JSON, or has another shape.
    """
    try:
        content = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise _refusal(document, f"it is not JSON, {error}") from None
    require(document, content)
    return content


def require(document: Document | Publication, content: Any) -> None:
    """Refuse what has not the shape of a document."""
    errors = _validator(document).iter_errors(content)
    if error := min(errors, key=lambda each: len(each.instance_path), default=None):
        raise _refusal(document, f"at {_json_path(error.instance_path)}, {error.message[:SHOWN]}")


def _json_path(steps: Iterable[str | int]) -> str:
    return "$" + "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in steps)


def published(name: Document | Publication, content: Mapping[str, Any]) -> dict[str, Any]:
    """What a command publishes, with its format and version."""
    return {"format": f"holonom-{name}", "version": VERSION, **content}


def schema(name: str) -> dict[str, Any]:
    """The JSON schema of a format, given its name without ``holonom-``."""
    return json.loads((SCHEMAS / f"{name}.json").read_text(encoding="utf-8"))


@cache
def _validator(name: str) -> "Draft202012Validator":
    from jsonschema_rs import Draft202012Validator

    return Draft202012Validator(schema(name))


def _maxima_text(argument: Argument) -> str:
    match argument:
        case None:
            return "false"
        case int() | Fraction():
            return str(argument)
        case str() if NAME.fullmatch(argument):
            return f"'{argument}"
        case str():
            raise HolonomError(Failure.NOT_A_SCENE_NAME, detail=argument)
        case _:
            return f"[{', '.join(map(_maxima_text, argument))}]"


def _refusal(document: Document | Publication, detail: str) -> HolonomError:
    return HolonomError(Failure.NOT_A_DOCUMENT, detail=f"holonom-{document}: {detail}")
