"""History, bibliography and glossary: templates and data."""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...language import translatable
from ..chapter import Chapter, Page
from ..pages import TEMPLATES

DATA = TEMPLATES / "further_reading.toml"


def chapter(root: Path) -> Chapter:
    """The chapter; it does not depend on a root."""

    def page(results: Mapping[str, Any]) -> Page:
        data = tomllib.loads(DATA.read_text(encoding="utf-8"))
        return Page({"works": {each["key"]: each for each in data["work"]}, "words": data["word"]})

    return Chapter(
        slug="further-reading",
        title=translatable("History, bibliography, glossary"),
        aim=translatable("Where the questions come from, what to read, and the words in English and Chinese."),
        template="further_reading.html",
        runs={},
        page=page,
    )
