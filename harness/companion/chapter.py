"""A chapter: the runs it needs, and the page it makes of their results."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from ..reference.topic import Topic


@dataclass(frozen=True)
class Run:
    """A computation that chapters can share: two that are equal are done once."""

    compute: Callable[..., Any]  # a function of a module, for it may be called in another process
    arguments: tuple[Any, ...] = ()  # what it is given; hashable


@dataclass(frozen=True)
class Page:
    """What a chapter's template is given, and the files that go beside the page."""

    content: Mapping[str, Any]  # the template's variables
    figures: Mapping[str, str] = field(default_factory=dict)  # text of each SVG file, by its name
    # Maxima files that the page refers to, relative to the book's root; each becomes a page of its own
    sources: tuple[str, ...] = ()
    topics: tuple[Topic, ...] = ()  # pages of the reference that the page leads to
    files: Mapping[str, str] = field(default_factory=dict)  # text of other files beside the page, by name


@dataclass(frozen=True, eq=False)
class Chapter:
    """One page of the companion."""

    slug: str  # name of the page's file, without its ending
    title: str
    aim: str  # what the chapter is about, in one line of the contents
    template: str  # file in the directory of the templates
    runs: Mapping[str, Run]  # what it needs, by the name that `page` knows it by
    page: Callable[[Mapping[str, Any]], Page]  # makes the page of the runs' results
