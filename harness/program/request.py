"""The motion program of a scene, asked of Maxima, and the forms it can be taken away in."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path

from ..confined import Limits
from ..documents import Document, ask
from ..failures import Failure, HolonomError
from .javascript_source import javascript_source
from .motion_program import Solve, read_program
from .python_source import python_source

LONGEST = 200  # digits of a number that an option gives
LARGEST_EXPONENT = 307  # of a double
SETTING = re.compile(r"([^\W\d]\w*)=(-?\d+(?:\.\d+)?(?:e-?\d+)?(?:/\d+)?)", re.IGNORECASE)


class Form(StrEnum):
    """What `holonom program` writes as one text."""

    PYTHON = "python"
    JAVASCRIPT = "javascript"
    JSON = "json"


@dataclass(frozen=True)
class Request:
    """Which motion program of a scene file.

    Parameters
    ----------
    scene : str or None
        Name of the scene; None for the last one, or for the system where there is none.
    settings : mapping of str to str
        Numbers in Maxima's notation, for what the file leaves open and for parameters.
    """

    scene: str | None = None
    solve: Solve = Solve.DIRECT
    settings: Mapping[str, str] = field(default_factory=dict)


def within_reach(number: str) -> bool:
    """Whether a double holds the parts of a decimal number or quotient, told without computing them."""
    for part in number.lower().split("/"):
        digits, _, exponent = part.partition("e")
        if len(digits) > LONGEST or len(exponent) > 4 or not abs(int(exponent or 0)) + len(digits) <= LARGEST_EXPONENT:
            return False
    return True


def read_settings(texts: Iterable[str]) -> dict[str, str]:
    """Read settings as they stand on a command line.

    Parameters
    ----------
    texts : iterable of str
        Each ``NAME=VALUE``, the value an integer, a decimal or a quotient of integers.

    Raises
    ------
    HolonomError
        One of them is not of that form.
    """
    settings = {}
    for text in texts:
        if (found := SETTING.fullmatch(text)) is None:
            raise HolonomError(Failure.NOT_A_SETTING, detail=text)
        if not within_reach(found[2]):
            raise HolonomError(Failure.SETTING_TOO_LARGE, detail=text if len(text) < LONGEST else found[1])
        settings[found[1]] = found[2]
    return settings


def program_text(file: Path, request: Request, form: Form, limits: Limits) -> str:
    """Write the motion program of a scene file in one of its forms.

    Raises
    ------
    HolonomError
        As `program_document`.
    """
    document = program_document(file, request, limits)
    program = read_program(document)
    match form:
        case Form.JSON:
            return document
        case Form.PYTHON:
            return python_source(program)
        case Form.JAVASCRIPT:
            return javascript_source(program)


def program_document(file: Path, request: Request, limits: Limits) -> str:
    """The document of a scene file's motion program, as Maxima writes it.

    Returns
    -------
    str
        JSON text, for `read_program`.

    Raises
    ------
    HolonomError
        As `holonom.maxima.ask_scene`; the request's scene has a name that no scene can have.
    """
    return ask(Document.PROGRAM, file, request.scene, request.solve, settings=request.settings, limits=limits)


def effects_document(file: Path, request: Request, limits: Limits) -> str:
    """The document of what a scene pays for, as Maxima writes it.

    Returns
    -------
    str
        JSON text, for `holonom.program.effects.read_costs`.

    Raises
    ------
    HolonomError
        As `program_document`.
    """
    return ask(Document.EFFECTS, file, request.scene, request.solve, settings=request.settings, limits=limits)
