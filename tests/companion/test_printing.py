"""The book as one PDF: an outline, numbers and heads on its pages, contents that name the right ones."""

import re
import shutil

import pytest
from pypdf import PdfReader

from holonom.companion.pages import environment
from holonom.companion.printing import BROWSERS, one_document, print_site

pytestmark = pytest.mark.skipif(not any(map(shutil.which, BROWSERS)), reason="nothing was printed: no browser")
ROOT, TITLE = "book/index", "Free motion and initial motion"


@pytest.fixture(scope="module")
def document(made_companion):
    return one_document(made_companion[0], ROOT, {})


@pytest.fixture(scope="module")
def chapters(document):
    """Titles of the chapters by the ids of their articles."""
    return dict(re.findall(r'<li><a href="#([^".]+)">(.*?)</a> <span class="sheet">', document))


@pytest.fixture(scope="module")
def printed(made_companion, tmp_path_factory):
    file = tmp_path_factory.mktemp("printed") / "book.pdf"
    print_site(made_companion[0], ROOT, file)
    return PdfReader(file)


def joined(text: str) -> str:
    return "".join(text.split())


def page_of(printed, slug: str) -> int:
    return printed.get_destination_page_number(printed.named_destinations[f"/{slug}"])


@pytest.mark.long
def test_links_stay_inside(document):
    places = set(re.findall(r' id="([^"]+)"', document))
    assert {link for link in re.findall(r' href="#([^"]+)"', document) if link not in places} == set()


@pytest.mark.long
def test_the_outline_has_every_chapter(printed, chapters):
    titles = {joined(entry.title) for entry in printed.outline if not isinstance(entry, list)}
    assert {joined(title) for title in chapters.values()} <= titles


@pytest.mark.parametrize("title", ["2 Equations of motion", "自由运动", 'd\'Alembert <"principle">'])
def test_a_title_is_a_string_of_a_style_sheet(title):
    written = environment("en").from_string("{{ title | css_string }}").render(title=title)
    assert re.fullmatch(r'"([^"\\<]|\\[0-9a-f]+ )*"', written)
    assert re.sub(r"\\([0-9a-f]+) ", lambda found: chr(int(found[1], 16)), written[1:-1]) == title


@pytest.mark.long
def test_pages_are_numbered_and_headed(printed, chapters):
    for slug, title in chapters.items():
        page = page_of(printed, slug)
        text = printed.pages[page].extract_text()
        assert str(page + 1) in text.split(), slug
        assert joined(TITLE) in joined(text), slug
        assert joined(text).count(joined(title)) >= 2, slug  # the running head, and the chapter's own


@pytest.mark.long
def test_the_contents_name_the_pages_on_which_chapters_begin(printed, chapters):
    contents = next(page.extract_text() for page in printed.pages if "Contents" in page.extract_text()[:20])
    for slug in chapters:
        assert str(page_of(printed, slug) + 1) in contents.split(), slug


@pytest.mark.long
def test_the_book_has_at_most_110_pages(printed):
    assert len(printed.pages) <= 110
