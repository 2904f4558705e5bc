"""Notation: the paper's symbols, their names in Maxima and in Python."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...language import translatable
from ..chapter import Chapter, Page
from ..pages import TEMPLATES

NOTATION_FILE = "maxima/notation.mac"


@dataclass(frozen=True)
class Symbol:
    """A symbol of the paper and its names."""

    paper: str  # TeX
    meaning: str
    scene: str  # as it is written in a scene file and printed by Maxima
    maxima: str  # the function of the library that gives it; empty where the description does
    python: str  # where the record has it


DATA = TEMPLATES / "notation.toml"
SYMBOLS = tuple(Symbol(**each) for each in tomllib.loads(DATA.read_text(encoding="utf-8"))["symbol"])


def chapter(root: Path) -> Chapter:
    """The chapter, with the Maxima files under a root."""

    def page(results: Mapping[str, Any]) -> Page:
        return Page({"symbols": SYMBOLS, "file": NOTATION_FILE}, sources=(NOTATION_FILE,))

    return Chapter(
        slug="notation",
        title=translatable("Notation"),
        aim=translatable("The paper's symbols, and their names in Maxima and in Python."),
        template="notation.html",
        runs={},
        page=page,
    )
