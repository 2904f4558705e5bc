"""What tests look for in a page."""

from collections.abc import Iterator
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import urlsplit
from xml.etree.ElementTree import Element, TreeBuilder

REPOSITORY = Path(__file__).parents[2]
HTML = MATHML = ""  # the name spaces, which HTML does not write
VOID = {"area", "base", "br", "col", "hr", "img", "input", "link", "meta", "source", "track", "wbr"}
MADE_BY_SPHINX = {"genindex.html", "search.html", "py-modindex.html"}
BLOCKS = ("p", "div", "pre", "table", "ul", "ol", "dl", "section", "figure", "details", "h1", "h2", "h3", "h4")


class Reader(HTMLParser):
    """A page as a tree; a tag that is not closed in its place is a fault."""

    def __init__(self) -> None:
        super().__init__()
        self.tree, self.open = TreeBuilder(), []

    def handle_starttag(self, tag, attributes):
        self.tree.start(tag, {name: value or "" for name, value in attributes})
        if tag in VOID:
            self.tree.end(tag)
        else:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.tree.start(tag, {name: value or "" for name, value in attributes})
        self.tree.end(tag)

    def handle_endtag(self, tag):
        if tag not in VOID:
            assert self.open.pop() == tag
            self.tree.end(tag)

    def handle_data(self, data):
        if self.open:
            self.tree.data(data)


def pages(directory: Path) -> list[Path]:
    """The pages whose text is ours."""
    return sorted(page for page in directory.rglob("*.html") if page.name not in MADE_BY_SPHINX)


@cache
def parsed(page: Path) -> Element:
    """The whole page."""
    reader = Reader()
    reader.feed(page.read_text(encoding="utf-8"))
    return reader.tree.close()


def article(page: Path) -> Element:
    """What the page says, without the theme around it."""
    return next(each for each in parsed(page).iter("article") if each.get("role") == "main")


def names(page: Path) -> list[str]:
    """All ids."""
    return [element.get("id") for element in parsed(page).iter() if element.get("id")]


def references(page: Path) -> Iterator[str]:
    """All that the page links to or loads."""
    for element in parsed(page).iter():
        for attribute in ("href", "src"):
            if element.get(attribute):
                yield element.get(attribute)


def broken_references(directory: Path) -> list[str]:
    """Links that lead nowhere, each with its page."""
    anchors = {page.resolve(): set(names(page)) for page in pages(directory)}
    return [
        f"{page.name}: {each}" for page in pages(directory) for each in references(page) if _broken(page, each, anchors)
    ]


def _broken(page: Path, reference: str, anchors: dict[Path, set[str]]) -> bool:
    split = urlsplit(reference)
    if split.scheme in ("data", "https"):  # what is loaded from elsewhere is a fault that another test finds
        return False
    target, anchor = (page.parent / split.path).resolve() if split.path else page.resolve(), split.fragment
    return not target.is_file() or (bool(anchor) and anchor not in anchors[target])


def heading_levels(page: Path) -> list[int]:
    tags = (element.tag.removeprefix(HTML) for element in article(page).iter() if isinstance(element.tag, str))
    return [int(tag[1]) for tag in tags if tag in ("h1", "h2", "h3", "h4", "h5", "h6")]


def badly_nested(page: Path) -> list[str]:
    """Blocks inside a paragraph, where a browser ends the paragraph."""
    return [
        block.tag.removeprefix(HTML)
        for paragraph in article(page).iter(f"{HTML}p")
        for block in paragraph.iter()
        if block is not paragraph and isinstance(block.tag, str) and block.tag.removeprefix(HTML) in BLOCKS
    ]


def verdicts_without_a_formula(page: Path) -> int:
    """How many cards have a verdict on what is not there."""
    cards = (each for each in article(page).iter() if each.get("class") == "derived")
    kinds = [{part.get("class") for part in card.iter()} for card in cards]
    return sum("check" in kind and "formula" not in kind for kind in kinds)


def nameless_mathematics(page: Path) -> int:
    return sum(not element.get("alttext") for element in article(page).iter(f"{MATHML}math"))


def words(page: Path) -> str:
    """All the text, in one line."""
    return " ".join(" ".join(article(page).itertext()).split())
