"""A page of the reference, as data."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Table:
    """Rows of plain text under headings; the first column names the row."""

    caption: str
    heading: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Code:
    """Lines to be shown as they are."""

    caption: str
    text: str


@dataclass(frozen=True)
class Topic:
    """A page of the reference."""

    # group, slug, title, summary: the slug is unique in the whole reference
    group: str
    slug: str
    title: str
    summary: str
    parts: tuple[Table | Code, ...]
