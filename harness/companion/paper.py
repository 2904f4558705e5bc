"""The book of the paper: its chapters and their order, which `contents.toml` has."""

from functools import partial
from importlib import import_module
from pathlib import Path

from ..files import shared
from ..language import translatable
from . import table
from .book import Book
from .chapter import Chapter, Page
from .sessions import sessions

REPOSITORY = shared("maxima").parent


def book_of_the_paper(root: Path = REPOSITORY) -> Book:
    """Return the companion of the paper, with the examples and Maxima files of a repository."""
    parts = tuple(
        (part["heading"], tuple(_chapter(root, **each) for each in part["chapter"]))
        for part in table("contents")["part"]
    )
    return Book(
        title=translatable("Free motion and initial motion"),
        subtitle=translatable(
            "A textbook companion to Chen, Guo & Mei, “Free motion and initial motion of controllable holonomic system "
            "with redundant coordinates” (2019)"
        ),
        foreword="foreword.html",
        command="make companion",
        root=root,
        parts=parts,
        sessions=sessions(root, (chapter for _, chapters in parts for chapter in chapters)),
    )


def chapter_of_the_paper(name: str, root: Path = REPOSITORY) -> Chapter:
    """Return a chapter of that book by the name of its template."""
    return next(each for each in book_of_the_paper(root).chapters if each.template == f"{name}.html")


def _chapter(root: Path, name: str, heading: str, aim: str, data: bool = False) -> Chapter:
    """Return a chapter that computes, or one whose page is made of a table alone; both bear their template's name."""
    about = (name.replace("_", "-"), heading, aim, f"{name}.html")
    if data:
        content = table(name)
        return Chapter(*about, runs={}, page=lambda results: Page(content, sources=tuple(content.get("sources", ()))))
    module = import_module(f".chapters.{name}", __package__)
    return Chapter(*about, runs=module.runs(root), page=partial(module.page, root))
