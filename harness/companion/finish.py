"""Final changes of pages: links to equations and column names of folded tables."""

import re
from collections.abc import Callable, Iterator, Mapping

from markupsafe import Markup, escape

TAG = re.compile(r"(<[^>]+>)")
TAG_NAME = re.compile(r"</?([\w:]+)")
UNLINKED = {"a", "code", "pre", "math", "h1", "h2", "h3", "h4", "style", "script", "svg", "button", "nav", "label"}
REFERENCE = re.compile(r"(?<![0-9A-Za-z])\((\d{1,2}|3a)\)")  # and no issue of a journal, 28(1)
EQUATION = re.compile(r'id="eq-(\d{1,2}|3a)"')
TABLE = re.compile(r"<table.*?</table>", re.DOTALL)
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
    return TABLE.sub(_with_columns, page)


def _with_columns(table: re.Match) -> str:
    head, end, rows = table[0].partition("</thead>")

    def labelled(row: re.Match) -> str:
        columns = (escape(Markup(each).striptags()) for each in COLUMN.findall(head))
        return CELL.sub(lambda cell: f'{cell[0]} data-label="{next(columns, "")}"', row[0])

    return head + end + ROW.sub(labelled, rows)
