"""Chapters of the book and the manual with computations, by page name."""

from functools import partial
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

from ..files import shared
from . import chapters
from .chapter import Chapter

REPOSITORY = shared("maxima").parent


def chapters_of_the_paper(root: Path = REPOSITORY) -> dict[str, Chapter]:
    """Return the chapters, with the examples and Maxima files of a repository.

    Parameters
    ----------
    root : Path
        Root of the repository.

    Returns
    -------
    dict of str to Chapter
        Chapters by page.
    """
    return {module.name.replace("_", "-"): _chapter(root, module.name) for module in iter_modules(chapters.__path__)}


def _chapter(root: Path, name: str) -> Chapter:
    module = import_module(f".chapters.{name}", __package__)
    return Chapter(module.runs(root), partial(module.page, root))
