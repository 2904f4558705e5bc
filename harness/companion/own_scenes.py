"""The book of somebody's own scene files: the same cards and answers, without the teaching."""

import re
from collections.abc import Sequence
from pathlib import Path

from ..confined import Limits
from .book import Book
from .own import equations, free_motion, initial_motion, motion, system
from .paper import REPOSITORY
from .runs import Settings, study

CHAPTERS = (system, equations, free_motion, initial_motion, motion)


def book_of_scenes(files: Sequence[Path], settings: Settings, limits: Limits) -> Book:
    """The companion of scene files.

    Parameters
    ----------
    files : sequence of Path
    settings : tuple of (str, str)
        Numbers for what the files leave open.
    limits : Limits
        What each Maxima run may take.
    """
    prefixes = [""] if len(files) == 1 else [_prefix(file, place) for place, file in enumerate(files, 1)]
    return Book(
        title="A companion to systems of your own",
        subtitle=", ".join(file.name for file in files),
        foreword="own_foreword.html",
        command=f"holonom companion {' '.join(map(str, files))}",
        root=REPOSITORY,
        parts=tuple(
            (file.name, tuple(each.chapter(prefix, file, study(file, settings, limits)) for each in CHAPTERS))
            for prefix, file in zip(prefixes, files, strict=True)
        ),
    )


def _prefix(file: Path, place: int) -> str:
    """What the names of a file's pages begin with: no two files have the same."""
    return f"{place}-{re.sub(r'[^a-z0-9]+', '-', file.stem.lower())}-"
