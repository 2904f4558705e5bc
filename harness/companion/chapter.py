"""Chapters: the head of a page, and what a module of the page's name computes.

A run in the head is ``name: command file --option value ...``, as on the command line: a method of `Scene`, ``derive``
or ``errata``, and a scene file below ``examples``. Values and figures are expressions of Jinja. Figures are SVG
documents.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import Any

import yaml

from . import chapters, runs
from .chapters import EXAMPLES
from .runs import Run

SOURCES = Path(__file__).parent
FOLDERS = ("book", "manual")
FENCE = "---\n"  # around the head of a page
FILES = "files"  # among the values of a page: text of further files, by name


@dataclass(frozen=True, eq=False)
class Chapter:
    """The computation of one page."""

    runs: Mapping[str, Run] = field(default_factory=dict)  # what it needs, by the names of the results
    page: Callable[[Mapping[str, Any]], Mapping[str, Any]] = lambda results: {}  # values for the templates
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
    name = file.stem.replace("-", "_")
    known = name in {module.name for module in iter_modules(chapters.__path__)}
    module = vars(import_module(f"{chapters.__name__}.{name}")) if known else {}
    begin, *rest = file.read_text(encoding="utf-8").split(FENCE, 2)
    head = {} if begin else yaml.safe_load(rest[0])
    asked = {name: _run(*words.split()) for name, words in head.get("runs", {}).items()} | module.get("RUNS", {})
    return Chapter(asked, module.get("page", Chapter.page), head.get("values", {}), head.get("figures", {}))


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
    asked = tuple((name, _number(value)) for name, value in options.items())
    return Run(runs.answer, (command.replace("-", "_"), file, scene, asked, settings))


def _number(text: str) -> int | Fraction:
    return int(text) if text.isdigit() else Fraction(text)
