"""A chapter: the runs it needs, and the page it makes of their results."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from ..reference.topics import Topic


@dataclass(frozen=True)
class Run:
    """A computation that chapters can share: two that are equal are done once.

    Attributes
    ----------
    compute : callable
        A function of a module, for it may be called in another process.
    arguments : tuple
        What it is given; hashable.
    """

    compute: Callable[..., Any]
    arguments: tuple[Any, ...] = ()


@dataclass(frozen=True)
class Page:
    """What a chapter's template is given, and the files that go beside the page.

    Attributes
    ----------
    content : mapping of str to object
        The template's variables.
    figures : mapping of str to str
        Text of each SVG file, by its name.
    sources : tuple of str
        Maxima files that the page refers to, relative to the book's root; each becomes a page of its own.
    topics : tuple of Topic
        Pages of the reference that the page leads to.
    files : mapping of str to str
        Text of other files beside the page, by name.
    """

    content: Mapping[str, Any]
    figures: Mapping[str, str] = field(default_factory=dict)
    sources: tuple[str, ...] = ()
    topics: tuple[Topic, ...] = ()
    files: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Chapter:
    """One page of the companion.

    Attributes
    ----------
    slug : str
        Name of the page's file, without its ending.
    aim : str
        What the chapter is about, in one line of the contents.
    template : str
        File in the directory of the templates.
    runs : mapping of str to Run
        What it needs, by the name that `page` knows it by.
    page : callable
        Makes the page of the runs' results.
    """

    slug: str
    title: str
    aim: str
    template: str
    runs: Mapping[str, Run]
    page: Callable[[Mapping[str, Any]], Page]
