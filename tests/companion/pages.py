"""What tests look for in a page."""

from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

HTML = "{http://www.w3.org/1999/xhtml}"
MATHML = "{http://www.w3.org/1998/Math/MathML}"
BLOCKS = ("p", "div", "pre", "table", "ul", "ol", "dl", "section", "figure", "details", "h1", "h2", "h3", "h4")


def pages(directory: Path) -> list[Path]:
    return sorted(directory.rglob("*.html"))


def parsed(page: Path) -> Element:
    return ElementTree.parse(page).getroot()


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
    if reference == "data:,":
        return False
    file, _, anchor = reference.partition("#")
    target = (page.parent / file).resolve() if file else page.resolve()
    return not target.is_file() or (bool(anchor) and anchor not in anchors[target])


def heading_levels(page: Path) -> list[int]:
    tags = (element.tag.removeprefix(HTML) for element in parsed(page).iter() if isinstance(element.tag, str))
    return [int(tag[1]) for tag in tags if tag in ("h1", "h2", "h3", "h4", "h5", "h6")]


def badly_nested(page: Path) -> list[str]:
    """Blocks inside a paragraph, where a browser ends the paragraph."""
    return [
        block.tag.removeprefix(HTML)
        for paragraph in parsed(page).iter(f"{HTML}p")
        for block in paragraph.iter()
        if block is not paragraph and isinstance(block.tag, str) and block.tag.removeprefix(HTML) in BLOCKS
    ]


def verdicts_without_a_formula(page: Path) -> int:
    """How many cards have a verdict on what is not there."""
    cards = (each for each in parsed(page).iter() if each.get("class") == "derived")
    kinds = [{part.get("class") for part in card.iter()} for card in cards]
    return sum("check" in kind and "formula" not in kind for kind in kinds)


def nameless_mathematics(page: Path) -> int:
    return sum(not element.get("alttext") for element in parsed(page).iter(f"{MATHML}math"))


def words(page: Path) -> str:
    """All the text, in one line."""
    return " ".join(" ".join(parsed(page).itertext()).split())
