"""Chapter on describing a system of one's own."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...documents import ask
from ...failures import HolonomError
from ...formats import Document
from ...temporary import private_directory
from ..runs import Run
from . import PENDULUM

FITTING, CONTRADICTING = "y = -cos(%pi/13)", "y = -1"


def page(results: Mapping[str, Any]) -> dict[str, Any]:
    """Return values of the page.

    Parameters
    ----------
    results : mapping
        Results of the runs by their names.

    Returns
    -------
    dict
        Values by name.
    """
    return {"fitting": FITTING, "contradicting": CONTRADICTING}


def _refusal_of_the_change(file: Path, given: str, changed: str) -> str:
    """Return the error for a scene file with one changed entry."""
    text = file.read_text(encoding="utf-8").replace(given, changed)
    with private_directory() as directory:
        copy = directory / file.name
        copy.write_text(_loading_the_library(text), encoding="utf-8")
        try:
            ask(Document.RECORD, copy)
        except HolonomError as error:
            return error.detail
    raise ValueError(f"{changed} is not refused")


def _loading_the_library(text: str) -> str:
    """Return the text with the library loaded by its name, for any folder."""
    load = next(line for line in text.splitlines() if line.startswith("load("))
    return text.replace(load, 'load("holonom.mac")$')


RUNS = {"refusal": Run(_refusal_of_the_change, (PENDULUM, FITTING, CONTRADICTING))}
