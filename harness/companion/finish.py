"""What is put into pages when all of them are there: their own contents, links to equations, names of the columns."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

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
HEADING = re.compile(r'<h2 id="([^"]+)">(.*?)</h2>', re.DOTALL)
ANCHOR = re.compile(r"</?a\b[^>]*>")  # a link in a heading is none in the link to it
TERM = re.compile(r'<dfn id="([^"]+)">(.*?)</dfn>', re.DOTALL)
TABLE = re.compile(r"<table.*?</table>", re.DOTALL)
HEADED = re.compile(r"<thead>.*?</thead>", re.DOTALL)
COLUMN = re.compile(r"<th [^>]*>(.*?)</th>", re.DOTALL)
ROW = re.compile(r"<tr>.*?</tr>", re.DOTALL)
CELL = re.compile(r"<(th|td)\b")
SECTIONS = "<!--sections-->"
NAVIGATION = re.compile(r'<nav class="here"[^>]*>\s*<!--sections-->\s*</nav>')
FEW = 2  # headings of a page that needs no contents of its own


@dataclass(frozen=True)
class Place:
    """Somewhere in the book: what is there, and the link to it."""

    text: Markup
    link: str


def finished(pages: Mapping[str, str], parts: Sequence[Sequence[str]]) -> dict[str, str]:
    """Finish pages, by name: an equation is looked for on the page itself, then in its part, then everywhere."""
    found = {name: list(dict.fromkeys(EQUATION.findall(text))) for name, text in pages.items()}
    everywhere = _links(found, found)
    done = {}
    for name, text in pages.items():
        near = next((part for part in parts if name in part), ())
        places = everywhere | _links(found, near) | {number: f"#eq-{number}" for number in found[name]}
        done[name] = with_columns(with_equations(with_sections(text), places))
    return done


def _links(found: Mapping[str, Sequence[str]], names: Sequence[str]) -> dict[str, str]:
    """Return where each equation is first."""
    links: dict[str, str] = {}
    for name in names:
        for number in found.get(name, ()):
            links.setdefault(number, f"{name}#eq-{number}")
    return links


def with_sections(page: str) -> str:
    """Return a page with links to its sections, where it has several."""
    headings = HEADING.findall(page)
    if len(headings) <= FEW:
        return NAVIGATION.sub("", page)
    items = Markup("").join(
        Markup('<li><a href="#{}">{}</a></li>').format(anchor, Markup(ANCHOR.sub("", title)))
        for anchor, title in headings
    )
    return page.replace(SECTIONS, Markup('<ol class="sections">{}</ol>').format(items))


def with_equations(page: str, places: Mapping[str, str]) -> str:
    """Return a page in whose prose each number of an equation is a link to it."""

    def linked(number: re.Match) -> str:
        link = places.get(number[1])
        return f'<a class="equation" href="{link}">{number[0]}</a>' if link else number[0]

    return "".join(_outside(page, lambda text: REFERENCE.sub(linked, text)))


def _outside(page: str, change: Callable[[str], str]) -> Iterator[str]:
    """Yield the page with its text changed, but for that in elements where nothing is to be changed."""
    inside = 0
    for piece in TAG.split(page):
        if name := TAG_NAME.match(piece):
            if name[1] in UNLINKED and not piece.endswith("/>"):
                inside += -1 if piece.startswith("</") else 1
            yield piece
        else:
            yield piece if inside else change(piece)


def with_columns(page: str) -> str:
    """Return a page whose table cells know the heads of their columns, for folded tables."""
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


def terms(pages: Mapping[str, str]) -> list[Place]:
    """Return the words that pages define, in the order of the alphabet."""
    found = [
        Place(Markup(text), f"{name}#{anchor}") for name, page in pages.items() for anchor, text in TERM.findall(page)
    ]
    return sorted(found, key=lambda place: place.text.striptags().lower())
