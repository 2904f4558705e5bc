"""Chapters: the heads of pages.

A run in the head is ``name: command file --option value ...``, as on the command line: a method of `Scene`, ``derive``
or ``errata``, and a scene file below ``examples``. `further_runs` has others. Values and figures are expressions of
Jinja, over the results of the runs by their names. Figures are SVG documents.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

from myst_parser.config.main import read_topmatter

from . import EXAMPLES, runs
from .further_runs import FURTHER_RUNS
from .runs import Run

SOURCES = Path(__file__).parent
FOLDERS = ("book", "manual")


@dataclass(frozen=True, eq=False)
class Chapter:
    """The computation of one page."""

    runs: Mapping[str, Run] = field(default_factory=dict)  # what it needs, by the names of the results
    values: Mapping[str, str] = field(default_factory=dict)  # expressions of further values
    figures: Mapping[str, str] = field(default_factory=dict)  # expressions of the figures


def chapters_of_the_paper() -> dict[str, Chapter]:
    """Return the chapters of the book and the manual that have runs.

    Returns
    -------
    dict of str to Chapter
        Chapters by page.
    """
    found = {file.stem: _chapter(file) for folder in FOLDERS for file in sorted((SOURCES / folder).glob("*.md"))}
    return {name: chapter for name, chapter in found.items() if chapter.runs}


def _chapter(file: Path) -> Chapter:
    head = head_of(file.read_text(encoding="utf-8"))
    asked = {name: _run(*words.split()) for name, words in head.get("runs", {}).items()}
    return Chapter(asked | FURTHER_RUNS.get(file.stem, {}), head.get("values", {}), head.get("figures", {}))


def head_of(text: str) -> dict[str, dict[str, str]]:
    """Return the head of a page.

    Parameters
    ----------
    text : str
        Text of the page.

    Returns
    -------
    dict
        Runs, values and figures, each by its name.
    """
    return read_topmatter(text) or {}


def _run(command: str, *words: str) -> Run:
    """Return the run of a command."""
    if command == "errata":
        return Run(runs.errata)
    file, given = EXAMPLES / words[0], list(zip(words[1::2], words[2::2], strict=True))
    if command == "derive":
        return Run(runs.derive, (file,))
    settings = tuple(tuple(value.split("=")) for name, value in given if name == "--set")
    options = {name.removeprefix("--"): value for name, value in given if name != "--set"}
    scene = options.pop("scene", None)
    asked = tuple((name, _option(value)) for name, value in options.items())
    return Run(runs.answer, (command.replace("-", "_"), file, scene, asked, settings))


def _option(text: str) -> int | Fraction | tuple[str, ...]:
    """Return a number, or names that are separated by commas."""
    if text[0].isalpha():
        return tuple(text.split(","))
    return int(text) if text.isdigit() else Fraction(text)
