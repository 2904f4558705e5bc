"""Chapters: the head of a page, and what a module of the page's name computes.

A run in the head is ``name: function argument ...``, with a function of `runs`. An argument is a scene file below
``examples``, a scene, a number, a setting such as ``c=0``, or ``-`` for the default. Values and figures are expressions
of Jinja. Figures are SVG documents.
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


def _run(function: str, *words: str) -> Run:
    return Run(getattr(runs, function), tuple(map(_argument, words)))


def _argument(word: str) -> Any:
    """Return an argument of a run."""
    if word == "-":
        return None
    if word.endswith(".mac"):
        return EXAMPLES / word
    if "=" in word:
        return (tuple(word.split("=")),)
    return int(word) if word.isdigit() else Fraction(word) if word[0].isdigit() else word
