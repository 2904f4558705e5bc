"""Maxima sessions of the chapters: an example and its questions."""

import re
from pathlib import Path

from ..language import gettext, translated
from . import table

LOADING = re.compile(r"^load\(.*\)\$$", re.MULTILINE)
PRINTING = re.compile(r"^(print_derivation\(.*\)\$|if holonom_print then\n(.+\n)*?.*\)\)\$)$", re.MULTILINE)


def session_text(root: Path, slug: str) -> str:
    """Return the session of a chapter as a Maxima file, in the current language.

    Parameters
    ----------
    root : Path
        Root of the repository.
    slug : str
        Name of the chapter.

    Returns
    -------
    str
        Text of the file.
    """
    known = table("sessions")[slug]
    head = gettext(
        "%(title)s: a session of Maxima, after `make install`, for example by  maxima -b %(slug)s.mac",
        title=slug,
        slug=slug,
    )
    return f"/* {head} */\n\n{_example(root / known['file'])}/* {translated(known['comment'])} */\n{known['text']}"


def questions(slug: str) -> str:
    """Return the questions of the session of a chapter.

    Parameters
    ----------
    slug : str
        Name of the chapter.

    Returns
    -------
    str
        Maxima input.
    """
    return table("sessions")[slug]["text"]


def _example(file: Path) -> str:
    text = PRINTING.sub("", LOADING.sub("load(holonom)$", file.read_text(encoding="utf-8")))
    return f"{text.rstrip()}\n"
