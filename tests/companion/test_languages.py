"""The pages in other languages: all their prose goes through the catalog, and each has its translation."""

import re
from collections.abc import Collection
from gettext import NullTranslations
from xml.etree.ElementTree import Element, fromstring

import pages
import pytest
from babel.messages.mofile import write_mo
from catalog import faults, page_templates, read_catalog
from click.testing import CliRunner
from matplotlib.figure import Figure

from holonom import language
from holonom.benchmark.machine import this_machine
from holonom.cli import holonom
from holonom.companion import directives, site
from holonom.companion import pages as companion_pages
from holonom.companion.chapter import SOURCES, chapters_of_the_paper
from holonom.companion.conf import exclude_patterns
from holonom.companion.directives import FILES
from holonom.companion.shelf import Shelf
from holonom.companion.stored_results import Results
from holonom.free_motion import free_motion
from holonom.language import Message, speaking
from holonom.sandbox import Limits
from holonom.simulation.request import Stabilization

PLACEHOLDER = re.compile(r"%\(\w+\)[.\d]*[a-z]")
WORD = re.compile(r"[A-Za-z]{3,}")
ENGLISH_PROSE = re.compile(r"[A-Za-z]{2,} [a-z]{2,}")
OPEN, CLOSE = "⟦", "⟧"
CODE = {"code", "pre", "math", "script", "style", "select"}


@pytest.fixture(scope="module")
def partners(tmp_path_factory):
    """Directory of a companion in Chinese and English; a build takes nothing of the one before."""
    directory = tmp_path_factory.mktemp("translations") / "pages"
    cabin = pages.REPOSITORY / "examples" / "weightless_cabin.mac"
    arguments = ["companion", str(cabin), "-o", str(directory), "--language", "zh", "--language", "en"]
    assert CliRunner(mix_stderr=False).invoke(holonom, arguments, standalone_mode=False).return_value == 0
    return directory


def test_every_page_has_its_translation_and_names_its_language(partners):
    english = {page.relative_to(partners / "en") for page in pages.pages(partners / "en")}
    assert {page.relative_to(partners) for page in pages.pages(partners)} == english | {"en" / page for page in english}
    for page in english:
        assert pages.parsed(partners / page).get("lang") == "zh-CN"
        assert pages.parsed(partners / "en" / page).get("lang") == "en"
    assert "自由运动" in pages.words(partners / "free-motion.html")
    assert "自由运动" not in pages.words(partners / "en" / "free-motion.html")


def test_every_page_links_its_translation_in_both_directions(partners):
    assert pages.broken_references(partners) == []
    for page in pages.pages(partners / "en"):
        partner = partners / page.relative_to(partners / "en")
        assert linked(page, "zh") == [partner.resolve()]
        assert linked(partner, "en") == [page.resolve()]


def linked(page, hreflang: str) -> list:
    """The pages in another language that a page links to, for the reader."""
    elements = [each for each in pages.parsed(page).iter() if each.get("hreflang") == hreflang]
    return [(page.parent / each.get("href")).resolve() for each in elements]


def test_the_pages_of_the_book_and_the_manual_are_translated():
    for name in ("book", "manual"):
        assert faults(read_catalog("zh", name)) == [], name


def test_the_catalogs_have_the_messages_of_the_pages(tmp_path):
    for name, template in page_templates(tmp_path).items():
        assert {each.id for each in template if each.id} == {each.id for each in read_catalog("zh", name) if each.id}


@pytest.mark.parametrize(
    ("constraint", "law", "start"),
    [
        ("y - u*x", "1 + t^(7/2)", "x = 1, dot(x) = 0"),  # a law that is not analytic
        ("(y - u)^2", "t", "x = 0, y = 0, dot(x) = 0, dot(y) = 1"),  # a constraint without a gradient
        ("y - u", "t", "x = 0, dot(x) = 0"),  # free in this state, for generic values
    ],
)
def test_reasons_of_verdicts_have_no_english_on_a_chinese_page(constraint, law, start, tmp_path):
    file = tmp_path / "scene.mac"
    file.write_text(
        f"""load("holonom.mac")$
        system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [k],
          kinetic_energy = (dot(x)^2 + dot(y)^2)/2, forces = [spring = [-k*x, 0]], constraints = [{constraint}])$
        scene : holonomic_scene(system, control_law = [u = {law}], initial_state = [{start}])$""",
        encoding="utf-8",
    )
    found = free_motion(file, None, {}, Limits())
    assert isinstance(found.motion.evidence, Message)  # with values
    with speaking("zh"):
        answers = companion_pages.environment("zh").get_template("answers.html").module
        shown = answers.motion_answer(found.motion) + answers.universal_answer(found.universal)
        shown += answers.trajectory_answer(found.trajectory) + answers.refused(found.left_out or "")
    page = fromstring(f"<body>{shown}</body>")
    assert ENGLISH_PROSE.findall(prose(page)) == []


class Bracketing(NullTranslations):
    """A language that puts every message into brackets, and what stands in its places outside of them."""

    def gettext(self, message):
        return OPEN + PLACEHOLDER.sub(lambda place: CLOSE + place[0] + OPEN, message) + CLOSE

    def ngettext(self, singular, plural, count):
        return self.gettext(plural)


def write_bracketed(file, catalog):
    """Write a catalog of pages for Sphinx, whose messages are English in brackets."""
    for message in catalog:
        message.string = OPEN + message.id + CLOSE if message.id and isinstance(message.id, str) else message.string
    write_mo(file, catalog)


@pytest.fixture(scope="module")
def bracketed(results, tmp_path_factory):
    """Directory of the companion of the paper in that language; no pictures are drawn."""
    directory = tmp_path_factory.mktemp("bracketed") / "pages"
    known = language._catalog
    with pytest.MonkeyPatch.context() as changed:
        changed.setattr(language, "_catalog", lambda name: Bracketing() if name == "zh" else known(name))
        changed.setattr(directives, "write_mo", write_bracketed)
        changed.setattr(Figure, "savefig", lambda figure, file, **how: file.write("<svg/>"))
        companion_pages.environment.cache_clear()  # which stores the words of templates, in proper Chinese
        shelf = Shelf(chapters_of_the_paper(), "zh", directory / FILES, Results(None, results))
        with speaking("zh"):
            site.build(SOURCES, directory, shelf, {"exclude_patterns": [*exclude_patterns, "reference"]})
        companion_pages.environment.cache_clear()
    return directory


def prose(element: Element, others: Collection[str] = CODE) -> str:
    """The text of an element without mathematics, code and other elements, and what says that it is English."""
    text = element.text or ""
    for each in element:
        left_out = each.tag in others or each.get("lang") == "en" or each.get("class") == "headerlink"
        text += " " + ("" if left_out else prose(each, others)) + " " + (each.tail or "")
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
    works = (pages.REPOSITORY / "harness" / "companion" / "book" / "works.bib").read_text(encoding="utf-8")
    texts = [works, str(this_machine()), *Stabilization, "spring damping English DOI"]
    return {word for text in texts for word in WORD.findall(text)}


@pytest.mark.long
def test_no_prose_of_the_book_and_the_manual_stands_outside_of_the_catalogs(bracketed):
    found = {}
    for page in (*bracketed.glob("book/*.html"), *bracketed.glob("manual/*.html")):
        found[page.name] = sorted(set(WORD.findall(outside(prose(pages.article(page))))) - names())
    assert {page: words for page, words in found.items() if words} == {}
