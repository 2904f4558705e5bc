"""Build the pages of book and manual, or of scene files, with Sphinx."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx
from sphinx.errors import SphinxError
from sphinx.locale import translators
from sphinx.util.docutils import docutils_namespace, patch_docutils

from ..failures import ErrorKind, HolonomError
from ..files import write_files
from ..language import LANGUAGES, gettext, speaking
from ..temporary import remove_tree
from .chapter import SOURCES, Chapter
from .directives import FILES, RESULTS
from .own_scenes import texts_of_scenes
from .printing import browser, print_site
from .shelf import Shelf
from .stored_results import Results

SPHINX = {"en": "en", "zh": "zh_CN"}  # what Sphinx calls a language
TEXTS = ".texts"  # the folder of the content of pages about scene files
MARK = ".doctrees"  # a folder of each directory that Sphinx has written into


def make_site(
    scenes: Sequence[Path],
    chapters: Mapping[str, Chapter],
    directory: Path,
    pdf: Path | None,
    languages: Sequence[str],
    done: Callable[[], None],
) -> None:
    """Perform the runs of pages, write the pages in each language, and print them.

    Parameters
    ----------
    scenes : sequence of Path
        The files that the pages are about. Without any they are the book and the manual.
    chapters : mapping of str to Chapter
        What stands behind the pages, by the last part of their names.
    directory : Path
        Where the pages are put, those of each language but the first in a directory of its name.
    pdf : Path or None
        The file that the book is printed to. Of each language but the first, with its name before the ending.
    languages : sequence of str
        Language codes. The first is that of the root folder.
    done : callable
        Called each time that one of the runs is done.

    Raises
    ------
    HolonomError
        A run fails, or the directory holds something else or cannot be written.
    """
    _require_site_or_nothing(directory)
    if pdf is not None:
        browser()  # before the work, not after it
    root, result_folder = ("index", None) if scenes else ("book/index", directory / RESULTS)
    results = Results(result_folder, done=done)
    for language in languages:
        first = language == languages[0]
        folder = directory if first else directory / language
        shelf = Shelf(chapters, language, folder / FILES, results)
        if scenes:
            shelf.perform(chapters)  # if one has an error, nothing is written
        with speaking(language):
            sources = _texts_about(scenes, folder) if scenes else SOURCES
            title = gettext("A companion to systems of your own")
            own = {"bibtex_bibfiles": [], "gettext_compact": "own", "html_title": title} if scenes else {}
            app = build(sources, folder, shelf, {"html_context": {"partners": _partners(language, languages)}} | own)
            if pdf is not None:
                print_site(app, root, pdf if first else pdf.with_suffix(f".{language}{pdf.suffix}"))


def _partners(language: str, languages: Sequence[str]) -> list[tuple[str, str, str]]:
    """Return code, name and relative folder of each other language."""
    up = "" if language == languages[0] else "../"
    others = (each for each in languages if each != language)
    return [(each, LANGUAGES[each], up if each == languages[0] else f"{up}{each}/") for each in others]


def build(sources: Path, directory: Path, shelf: Shelf, settings: Mapping[str, Any]) -> Sphinx:
    """Build pages with Sphinx, and return its application.

    Parameters
    ----------
    sources : Path
        Folder of the texts.
    directory : Path
        Folder of the pages.
    shelf : Shelf
        Chapters of the build.
    settings : mapping of str to Any
        Settings of Sphinx other than those of ``conf.py``.

    Returns
    -------
    Sphinx
        Application after the build.
    """
    language = {"language": SPHINX[shelf.language]}
    translators.clear()  # Sphinx would add the messages of this build to those of the one before
    with _errors_about(directory), patch_docutils(SOURCES), docutils_namespace():
        app = Sphinx(sources, SOURCES, directory, directory / ".doctrees", "html", language | settings, status=None)
        app.holonom_shelf = shelf
        app.build()
    return app


@contextmanager
def _errors_about(directory: Path) -> Iterator[None]:
    """Raise errors of Sphinx and of the file system as those about a directory."""
    try:
        yield
    except (OSError, SphinxError) as error:
        if isinstance(reason := getattr(error, "orig_exc", None), HolonomError):
            raise reason from None
        raise HolonomError(ErrorKind.UNWRITABLE, directory, error) from None


def _texts_about(scenes: Sequence[Path], directory: Path) -> Path:
    """Write the texts of the pages about scene files to a new folder. Return it."""
    folder = directory / TEXTS
    with _errors_about(directory):
        remove_tree(folder)
        write_files(folder, texts_of_scenes(scenes))
    return folder


def _require_site_or_nothing(directory: Path) -> None:
    """Raise if a directory contains files that Sphinx did not write."""
    if directory.is_file() or (any(directory.glob("*")) and not (directory / MARK).is_dir()):
        raise HolonomError(ErrorKind.NOT_A_COMPANION, directory)
