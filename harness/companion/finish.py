"""Final changes of pages: links to equations and column names of folded tables."""

import re
from collections.abc import Mapping

from markupsafe import Markup, escape

UNLINKED = "a|code|pre|math|h1|h2|h3|h4|style|script|svg|button|nav|label"
NUMBER = re.compile(
    rf"<({UNLINKED})\b.*?</\1>|<[^>]+>"  # elements without links, tags
    r"|(?<![0-9A-Za-z])\((?P<number>\d{1,2}|3a)\)",  # and no issue of a journal, 28(1)
    re.DOTALL,
)
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

    def linked(found: re.Match) -> str:
        link = places.get(found["number"])
        return f'<a class="equation" href="{link}">{found[0]}</a>' if link else found[0]

    return NUMBER.sub(linked, page)


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
