"""The Maxima session of each chapter, to be downloaded: an example, and what the chapter asks of it."""

import re
import tomllib
from collections.abc import Iterable
from pathlib import Path

from .chapter import Chapter
from .pages import TEMPLATES

DATA = TEMPLATES / "sessions.toml"
LOADING = re.compile(r"^load\(.*\)\$$", re.MULTILINE)
PRINTING = re.compile(r"^(print_derivation\(.*\)\$|if holonom_print then\n(.+\n)*?.*\)\)\$)$", re.MULTILINE)
HEAD = "/* {title}: a session of Maxima, after `make install`, for instance by  maxima -b {slug}.mac */\n\n"


def sessions(root: Path, chapters: Iterable[Chapter]) -> dict[str, str]:
    """The text of the sessions, by the slugs of those chapters that have one; the library is loaded by its name."""
    known = tomllib.loads(DATA.read_text(encoding="utf-8"))
    return {
        chapter.slug: HEAD.format(title=chapter.title, slug=chapter.slug)
        + _example(root / known[chapter.slug]["file"])
        + known[chapter.slug]["text"]
        for chapter in chapters
        if chapter.slug in known
    }


def _example(file: Path) -> str:
    text = PRINTING.sub("", LOADING.sub("load(holonom)$", file.read_text(encoding="utf-8")))
    return f"{text.rstrip()}\n"
