"""The book: chapters in their order, their runs performed, their pages written."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path
from string import ascii_uppercase
from typing import Any

from ..failures import Failure, HolonomError
from ..files import write_whole_directory, written_before
from ..language import speaking, spoken, translatable, translated
from .chapter import Chapter, Page, Run
from .finish import finished, terms
from .fonts import mathematics_font
from .pages import (
    STYLE,
    Contents,
    Entry,
    Part,
    Twin,
    chapter_page,
    index_page,
    source_name,
    source_page,
    topic_name,
    topic_page,
)
from .printing import browser, print_book
from .runs import Derived, FileAnswers, perform
from .sessions import Session, session_text

APPENDICES = translatable("Appendices")  # title of the part whose chapters have letters


@dataclass(frozen=True)
class Book:
    """Chapters, in parts."""

    title: str
    subtitle: str
    foreword: str  # template of what the first page says before the contents
    command: str  # the command that makes the book
    root: Path  # what the names of source files are relative to
    parts: tuple[tuple[str, tuple[Chapter, ...]], ...]  # title and chapters of each part
    # the Maxima session of each chapter that has one, by the chapter's slug
    sessions: Mapping[str, Session] = field(default_factory=dict)

    @property
    def runs(self) -> dict[Run, None]:
        """What its chapters need, each once."""
        return {run: None for chapter in self.chapters for run in chapter.runs.values()}

    @property
    def chapters(self) -> list[Chapter]:
        """All chapters in their order."""
        return [chapter for _, chapters in self.parts for chapter in chapters]


def make_book(
    book: Book, directory: Path, pdf: Path | None, languages: Sequence[str], done: Callable[[], None]
) -> None:
    """Perform a book's runs and write its pages in each language, and print them.

    Parameters
    ----------
    directory : Path
        Where the pages are put, those of each language but the first in a directory of its name; of a companion that is
        there, the pages are replaced and what else there is stays.
    pdf : Path or None
        The file that they are printed to as one book; of each language but the first, with its name before the ending.
    done : callable
        Called each time that one of the runs is done.

    Raises
    ------
    HolonomError
        A run fails, or the directory holds something else or cannot be written.
    """
    require_companion_or_nothing(directory)
    if pdf is not None:
        browser()  # before the work, not after it
    results = perform(book.runs, done)
    files: dict[str, str | bytes] = {}
    for language in languages:
        with speaking(language):
            twins = twins_of(language, languages)
            made = pages(book, results, twins)
            if pdf is not None:
                named = pdf if language == languages[0] else pdf.with_suffix(f".{language}{pdf.suffix}")
                print_book(contents_of(book, results, twins), made, named)
        files |= {_folder(language, languages) + name: content for name, content in made.items()}
    write_whole_directory(directory, files)


def twins_of(language: str, languages: Sequence[str]) -> tuple[Twin, ...]:
    """Return where the pages of the other languages are, as seen from those of one."""
    back = "../" if _folder(language, languages) else ""
    return tuple(Twin(other, back + _folder(other, languages)) for other in languages if other != language)


def _folder(language: str, languages: Sequence[str]) -> str:
    return "" if language == languages[0] else f"{language}/"


def require_companion_or_nothing(directory: Path) -> None:
    """Refuse a directory that holds what is no companion."""
    if not directory.exists() or (directory.is_dir() and not any(directory.iterdir())):
        return
    if not directory.is_dir() or "index.html" not in written_before(directory):
        raise HolonomError(Failure.NOT_A_COMPANION, directory)


def pages(book: Book, results: Mapping[Run, Any], twins: tuple[Twin, ...] = ()) -> dict[str, str | bytes]:
    """Return the files of a book, in the language spoken, by their names."""
    contents = contents_of(book, results, twins)
    made = {chapter: _page(chapter, results) for chapter in book.chapters}
    written = {f"{chapter.slug}.html": chapter_page(contents, chapter, page.content) for chapter, page in made.items()}
    parts = [[f"{chapter.slug}.html" for chapter in chapters] for _, chapters in book.parts]
    written["index.html"] = index_page(contents, terms(written))
    font, notice = mathematics_font()
    files = finished(written, parts) | {
        "companion.css": STYLE.read_text(encoding="utf-8"),
        "fonts/mathematics.woff": font,
        "fonts/mathematics.txt": notice,
    }
    files |= {f"sessions/{slug}.mac": session_text(session) for slug, session in book.sessions.items()}
    for page in made.values():
        files |= {f"figures/{name}.svg": svg for name, svg in page.figures.items()} | page.files
    for topic in (topic for page in made.values() for topic in page.topics):
        files[topic_name(topic)] = topic_page(contents, topic)
    for file in dict.fromkeys(source for page in made.values() for source in page.sources):
        files[source_name(file)] = source_page(contents, file, (book.root / file).read_text(encoding="utf-8"))
    return files


def _page(chapter: Chapter, results: Mapping[Run, Any]) -> Page:
    return chapter.page({name: results[run] for name, run in chapter.runs.items()})


def contents_of(book: Book, results: Mapping[Run, Any], twins: tuple[Twin, ...] = ()) -> Contents:
    """Return what every page of a book knows about it."""
    numbers, letters = map(str, count(1)), iter(ascii_uppercase)
    return Contents(
        title=translated(book.title),
        subtitle=translated(book.subtitle),
        foreword=book.foreword,
        command=book.command,
        maxima=next(found.record.maxima for found in results.values() if isinstance(found, Derived | FileAnswers)),
        parts=tuple(
            Part(translated(title), tuple(_entries(chapters, letters if title == APPENDICES else numbers)))
            for title, chapters in book.parts
        ),
        sessions=frozenset(book.sessions),
        language=spoken(),
        twins=twins,
    )


def _entries(chapters: tuple[Chapter, ...], labels: Iterator[str]) -> Iterator[Entry]:
    for chapter in chapters:
        yield Entry(next(labels), chapter.slug, translated(chapter.title), translated(chapter.aim))
