"""A chapter: the runs it needs, and the page it makes of their results."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Run:
    """A computation that chapters share. Equal runs are performed once."""

    compute: Callable[..., Any]  # a function of a module, for it may be called in another process
    arguments: tuple[Any, ...] = ()  # what it is given; hashable


@dataclass(frozen=True)
class Page:
    """Values for the templates of a page, and further files of the page."""

    content: Mapping[str, Any] = field(default_factory=dict)  # the template's variables
    figures: Mapping[str, str] = field(default_factory=dict)  # text of each SVG file, by its name
    files: Mapping[str, str] = field(default_factory=dict)  # text of other files in the folder of the page, by name


@dataclass(frozen=True, eq=False)
class Chapter:
    """The computation of one page."""

    runs: Mapping[str, Run]  # what it needs, by the names of the results
    page: Callable[[Mapping[str, Any]], Page]  # makes the page of the results
