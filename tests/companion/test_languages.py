"""The pages in other languages: all their prose goes through the catalog, and each has its twin."""

import re
from gettext import NullTranslations
from xml.etree.ElementTree import Element

import pages
import pytest
from click.testing import CliRunner
from matplotlib.figure import Figure

from holonom import language
from holonom.benchmark.machine import this_machine
from holonom.cli import holonom
from holonom.companion import book, table
from holonom.companion import pages as companion_pages
from holonom.companion.chapters import gallery
from holonom.companion.paper import REPOSITORY, book_of_the_paper
from holonom.files import write_whole_directory
from holonom.language import speaking
from holonom.simulation.request import Stabilization

PLACEHOLDER = re.compile(r"%\(\w+\)[.\d]*[a-z]")
WORD = re.compile(r"[A-Za-z]{3,}")
OPEN, CLOSE = "⟦", "⟧"
CODE = {"code", "pre", "math", "script", "style", "select"}


@pytest.fixture(scope="module")
def twins(tmp_path_factory):
    """Directory of a companion in English and Chinese."""
    directory = tmp_path_factory.mktemp("twins") / "pages"
    cabin = REPOSITORY / "examples" / "weightless_cabin.mac"
    arguments = ["companion", str(cabin), "-o", str(directory), "--language", "en", "--language", "zh"]
    assert CliRunner(mix_stderr=False).invoke(holonom, arguments, standalone_mode=False).return_value == 0
    return directory


def test_every_page_has_its_twin_and_names_its_language(twins):
    chinese = {page.relative_to(twins / "zh") for page in pages.pages(twins / "zh")}
    assert {page.relative_to(twins) for page in pages.pages(twins)} == chinese | {"zh" / page for page in chinese}
    for page in chinese:
        assert pages.parsed(twins / page).get("lang") == "en"
        assert pages.parsed(twins / "zh" / page).get("lang") == "zh"


def test_every_page_links_its_twin_in_both_directions(twins):
    assert pages.broken_references(twins) == []
    for page in pages.pages(twins / "zh"):
        twin = twins / page.relative_to(twins / "zh")
        assert linked(page, "en") == [twin.resolve()] * 2
        assert linked(twin, "zh") == [page.resolve()] * 2


def linked(page, hreflang: str) -> list:
    """The pages in another language that a page links to, in its head and for the reader."""
    elements = [each for each in pages.parsed(page).iter() if each.get("hreflang") == hreflang]
    return [(page.parent / each.get("href")).resolve() for each in elements]


class Bracketing(NullTranslations):
    """A language that puts every message into brackets, and what stands in its places outside of them."""

    def gettext(self, message):
        return OPEN + PLACEHOLDER.sub(lambda place: CLOSE + place[0] + OPEN, message) + CLOSE

    def ngettext(self, singular, plural, count):
        return self.gettext(plural)


@pytest.fixture(scope="module")
def bracketed(results, tmp_path_factory):
    """Directory of the companion of the paper in that language; no pictures are drawn."""
    directory = tmp_path_factory.mktemp("bracketed") / "pages"
    known = language._catalog
    with pytest.MonkeyPatch.context() as changed:
        changed.setattr(language, "_catalog", lambda name: Bracketing() if name == "zh" else known(name))
        changed.setattr(gallery, "figures_of", lambda shown: {})
        changed.setattr(Figure, "savefig", lambda figure, file, **how: file.write("<svg/>"))
        companion_pages._environment.cache_clear()  # in which the words of templates are kept, in proper Chinese
        with speaking("zh"):
            write_whole_directory(directory, book.pages(book_of_the_paper(), results))
        companion_pages._environment.cache_clear()
    return directory


def prose(element: Element) -> str:
    """The text of an element without mathematics, code, what says that it is English, and the index of the terms."""
    text = element.text or ""
    for each in element:
        tag = each.tag.rpartition("}")[2] if isinstance(each.tag, str) else "script"
        left_out = tag in CODE or each.get("lang") == "en" or each.get("class") == "terms-index"
        text += " " + ("" if left_out else prose(each)) + " " + (each.tail or "")
    return text


def outside(text: str) -> str:
    """What is in no brackets."""
    depth, found = 0, []
    for letter in text:
        depth += (letter == OPEN) - (letter == CLOSE)
        found.append(letter if depth == 0 and letter != CLOSE else " ")
    return "".join(found)


def names() -> set[str]:
    """Words that are the same in every language: of authors, works, machines, effects and options."""
    data = table("further_reading")
    texts = [text for work in data["works"].values() for text in work.values()] + [
        word[tongue] for word in data["words"] for tongue in ("english", "chinese")
    ]
    texts += [str(this_machine()), *Stabilization, "spring damping English DOI"]
    return {word for text in texts for word in WORD.findall(text)}


def test_no_prose_of_the_paper_s_companion_stands_outside_of_the_catalog(bracketed):
    found = {}
    for page in pages.pages(bracketed):
        if page.parent.name not in ("source", "reference") and page.stem != "reference":  # the reference is English
            found[page.name] = sorted(set(WORD.findall(outside(prose(pages.parsed(page))))) - names())
    assert {page: words for page, words in found.items() if words} == {}
