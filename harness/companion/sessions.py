"""The Maxima session of each chapter, to be downloaded: an example, and what the chapter asks of it."""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from ..language import gettext, translated
from . import table
from .chapter import Chapter

LOADING = re.compile(r"^load\(.*\)\$$", re.MULTILINE)
PRINTING = re.compile(r"^(print_derivation\(.*\)\$|if holonom_print then\n(.+\n)*?.*\)\)\$)$", re.MULTILINE)


@dataclass(frozen=True)
class Session:
    """What is asked of Maxima about an example."""

    # slug, title: of the chapter
    slug: str
    title: str
    example: str  # the text of the example's file, the library loaded by its name
    comment: str  # what the questions are about
    questions: str  # lines of Maxima


def sessions(root: Path, chapters: Iterable[Chapter]) -> dict[str, Session]:
    """Return the sessions, by the slugs of those chapters that have one."""
    known = table("sessions")
    return {
        chapter.slug: Session(
            chapter.slug,
            chapter.title,
            _example(root / known[chapter.slug]["file"]),
            known[chapter.slug]["comment"],
            known[chapter.slug]["text"],
        )
        for chapter in chapters
        if chapter.slug in known
    }


def session_text(session: Session) -> str:
    """Return a session as a Maxima file, its comments in the language spoken."""
    head = gettext(
        "%(title)s: a session of Maxima, after `make install`, for instance by  maxima -b %(slug)s.mac",
        title=translated(session.title),
        slug=session.slug,
    )
    return f"/* {head} */\n\n{session.example}/* {translated(session.comment)} */\n{session.questions}"


def _example(file: Path) -> str:
    text = PRINTING.sub("", LOADING.sub("load(holonom)$", file.read_text(encoding="utf-8")))
    return f"{text.rstrip()}\n"
