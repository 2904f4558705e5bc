"""Reference: the pages on entries, commands, documents and names in Python."""

from collections.abc import Mapping
from itertools import groupby
from pathlib import Path
from typing import Any

from ...reference.topics import topics
from ..chapter import Page, Run


def runs(root: Path) -> dict[str, Run]:
    """Return what the chapter needs."""
    return {}


def page(root: Path, results: Mapping[str, Any]) -> Page:
    """Return the page that results make."""
    found = topics()
    groups = [(title, list(pages)) for title, pages in groupby(found, key=lambda topic: topic.group)]
    return Page({"groups": groups}, topics=tuple(found))
