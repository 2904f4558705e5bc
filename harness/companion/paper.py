"""Chapters of the book and the manual with computations, by page name."""

from importlib import import_module
from pkgutil import iter_modules

from . import chapters
from .chapter import Chapter


def chapters_of_the_paper() -> dict[str, Chapter]:
    """Return the chapters.

    Returns
    -------
    dict of str to Chapter
        Chapters by page.
    """
    names = [module.name for module in iter_modules(chapters.__path__)]
    modules = {name.replace("_", "-"): import_module(f".chapters.{name}", __package__) for name in names}
    return {name: Chapter(module.RUNS, module.page) for name, module in modules.items()}
