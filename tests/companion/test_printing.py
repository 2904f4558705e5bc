"""The book as one PDF: an outline, numbers and heads on its sheets, contents that name the right ones."""

import shutil

import pytest
from pypdf import PdfReader

from holonom.companion.book import contents_of, pages
from holonom.companion.paper import book_of_the_paper
from holonom.companion.printing import BROWSERS, one_document, print_book

pytestmark = pytest.mark.skipif(not any(map(shutil.which, BROWSERS)), reason="nothing was printed: no browser")


@pytest.fixture(scope="module")
def book(results):
    made = book_of_the_paper()
    return contents_of(made, results), pages(made, results)


@pytest.fixture(scope="module")
def printed(book, tmp_path_factory):
    file = tmp_path_factory.mktemp("printed") / "book.pdf"
    print_book(*book, file)
    return PdfReader(file)


@pytest.mark.long
def test_the_document_is_well_formed_and_its_links_stay_inside(book):
    """It parses, or it would not have been made; every link within it leads to a place."""
    import re

    text = one_document(*book, {})
    places = set(re.findall(r' id="([^"]+)"', text))
    assert {link for link in re.findall(r' href="#([^"]+)"', text) if link not in places} == set()


@pytest.mark.long
def test_the_outline_has_every_chapter(printed, book):
    titles = {"".join(entry.title.split()) for entry in printed.outline if not isinstance(entry, list)}
    assert {"".join(entry.title.split()) for entry in book[0].entries} <= titles


@pytest.mark.long
def test_sheets_are_numbered_and_headed(printed, book):
    reader_of = {name.removeprefix("/"): place for name, place in printed.named_destinations.items()}
    for entry in book[0].entries[:6]:
        sheet = printed.get_destination_page_number(reader_of[entry.slug])
        text = printed.pages[sheet].extract_text()
        assert str(sheet + 1) in text.split(), entry.slug
        assert book[0].title in text, entry.slug


@pytest.mark.long
def test_the_contents_name_the_sheets_on_which_chapters_begin(printed, book):
    contents = next(
        page.extract_text()
        for page in printed.pages
        if page.extract_text().split()[:2] == ["2", "Contents"] or "Contents" in page.extract_text()[:20]
    )
    for entry in book[0].entries[:6]:
        sheet = printed.get_destination_page_number(printed.named_destinations[f"/{entry.slug}"]) + 1
        assert str(sheet) in contents.split(), entry.slug


@pytest.mark.long
def test_the_worked_example_takes_less_than_the_seventeen_sheets_of_once(printed, book):
    slugs = [entry.slug for entry in book[0].entries]
    following = slugs[slugs.index("worked-example") + 1]
    first, last = (
        printed.get_destination_page_number(printed.named_destinations[f"/{slug}"])
        for slug in ("worked-example", following)
    )
    assert last - first < 14
