"""Pages of the reference: well-formed, linked, and shaped like every other page."""

from itertools import pairwise
from pathlib import Path

import pages
import pytest

from holonom.companion.book import STYLE
from holonom.companion.pages import Contents, Entry, Part, chapter_page, index_page, topic_page
from holonom.companion.paper import chapter_of_the_paper


@pytest.fixture(scope="module")
def made(tmp_path_factory) -> Path:
    """A companion whose one chapter is the reference."""
    directory, chapter = tmp_path_factory.mktemp("reference"), chapter_of_the_paper("reference")
    parts = (Part("", (Entry("A", chapter.slug, chapter.title, chapter.aim),)),)
    contents = Contents("Reference", "", "own_foreword.html", "make companion", "5", parts)
    page = chapter.page({})
    files = {"companion.css": STYLE.read_text(), f"{chapter.slug}.html": chapter_page(contents, chapter, page.content)}
    files |= {f"reference/{topic.slug}.html": topic_page(contents, topic) for topic in page.topics}
    files["index.html"] = index_page(contents, ())
    for name, text in files.items():
        (directory / name).parent.mkdir(exist_ok=True)
        (directory / name).write_text(text, encoding="utf-8")
    return directory


def test_every_link_and_anchor_resolves(made):
    assert pages.broken_references(made) == []


def test_every_topic_is_reached_from_the_chapter(made):
    linked = set(pages.references(made / "reference.html"))
    assert {f"reference/{file.name}" for file in (made / "reference").iterdir()} <= linked


def test_pages_are_shaped_like_the_others(made):
    for page in (made / "reference").iterdir():
        levels = pages.heading_levels(page)
        assert levels.count(1) == 1
        assert all(below - above <= 1 for above, below in pairwise(levels)), page.name
        assert pages.badly_nested(page) == []
        assert not [sign for sign in ("&lt;", "&gt;", "&amp;", "&#") if sign in pages.words(page)]
        assert len(pages.names(page)) == len(set(pages.names(page)))
