"""Final changes of pages: links to equations and column names of folded tables."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence

from markupsafe import Markup, escape

TAG = re.compile(r"(<[^>]+>)")
TAG_NAME = re.compile(r"</?([\w:]+)")
UNLINKED = {
    "a",
    "code",
    "pre",
    "math",
    "h1",
    "h2",
    "h3",
    "h4",
    "title",
    "style",
    "script",
    "svg",
    "button",
    "nav",
    "label",
}
REFERENCE = re.compile(r"\((\d{1,2}|3a)\)")
EQUATION = re.compile(r'id="eq-(\d{1,2}|3a)"')
TABLE = re.compile(r"<table.*?</table>", re.DOTALL)
HEADED = re.compile(r"<thead>.*?</thead>", re.DOTALL)
COLUMN = re.compile(r"<th [^>]*>(.*?)</th>", re.DOTALL)
ROW = re.compile(r"<tr>.*?</tr>", re.DOTALL)
CELL = re.compile(r"<(th|td)\b")


def with_equations(page: str, places: Mapping[str, str]) -> str:
    """Return a page in whose prose each number of an equation is a link to it.

    Parameters
    ----------
    page : str
        HTML of the page.
    places : mapping of str to str
        Address of each equation by its number.

    Returns
    -------
    str
        HTML of the page.
    """

    def linked(number: re.Match) -> str:
        link = places.get(number[1])
        return f'<a class="equation" href="{link}">{number[0]}</a>' if link else number[0]

    return "".join(_outside(page, lambda text: REFERENCE.sub(linked, text)))


def _outside(page: str, change: Callable[[str], str]) -> Iterator[str]:
    """Yield the page with its text changed outside of protected elements."""
    inside = 0
    for piece in TAG.split(page):
        if name := TAG_NAME.match(piece):
            if name[1] in UNLINKED and not piece.endswith("/>"):
                inside += -1 if piece.startswith("</") else 1
            yield piece
        else:
            yield piece if inside else change(piece)


def with_columns(page: str) -> str:
    """Return a page whose table cells have the names of their columns.

    Parameters
    ----------
    page : str
        HTML of the page.

    Returns
    -------
    str
        HTML of the page.
    """
    return TABLE.sub(lambda table: _with_columns(table[0]), page)


def _with_columns(table: str) -> str:
    head = HEADED.search(table)
    if head is None:
        return table
    columns = [escape(Markup(each).striptags()) for each in COLUMN.findall(head[0])]
    return table[: head.end()] + ROW.sub(lambda row: _labelled(row[0], columns), table[head.end() :])


def _labelled(row: str, columns: Sequence[str]) -> str:
    if "colspan" in row:
        return row
    labels = iter(columns)
    return CELL.sub(lambda cell: f'{cell[0]} data-label="{next(labels, "")}"', row)
