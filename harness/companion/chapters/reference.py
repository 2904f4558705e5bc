"""Reference: the pages on entries, commands, documents and names in Python."""

from collections.abc import Mapping
from itertools import groupby
from pathlib import Path
from typing import Any

from ...language import translatable
from ...reference.topics import topics
from ..chapter import Chapter, Page


def chapter(root: Path) -> Chapter:
    """The chapter; what it holds does not depend on the root."""

    def page(results: Mapping[str, Any]) -> Page:
        found = topics()
        groups = [(title, list(pages)) for title, pages in groupby(found, key=lambda topic: topic.group)]
        return Page({"groups": groups}, topics=tuple(found))

    return Chapter(
        slug="reference",
        title=translatable("Reference"),
        aim=translatable("Every entry of a description, every command, every document and every name in Python."),
        template="reference.html",
        runs={},
        page=page,
    )
