"""A companion in Chinese to scenes that refuse, end early or leave something open: no English prose on its pages.

The scenes in ``chinese/`` are drawn to meet many messages; their titles are in Chinese.
"""

import re
from pathlib import Path

import pages
import pytest
from own_system import made
from refusing import english_in
from test_languages import CODE, prose

import holonom
from holonom.companion.own_scenes import or_reason
from holonom.language import speaking, translated

SCENES = sorted(Path(__file__).with_name("chinese").glob("*.mac"))
# What stays in English: titles of icons and labels for screen readers that the theme Furo writes without translation.
ICONS = {"symbol"}
LABELS = {
    "Toggle site navigation sidebar",
    "Toggle table of contents sidebar",
    "Toggle Light / Dark / Auto color theme",
}


@pytest.fixture(scope="module")
def chinese(tmp_path_factory):
    """Directory of the pages, in Chinese alone."""
    outcome, directory = made(tmp_path_factory.mktemp("chinese"), {}, *SCENES, language="zh")
    assert outcome.return_value == 0
    return directory


def shown(page: Path) -> list[str]:
    """The prose of a page, then its texts for screen readers and in place of pictures."""
    whole = pages.parsed(page)
    attributes = [each.get(name) for each in whole.iter() for name in ("alt", "title", "aria-label")]
    return [prose(whole, CODE | ICONS), *(text for text in attributes if text and text not in LABELS)]


@pytest.mark.long
def test_no_page_has_english_prose(chinese):
    found = {page.name: [words for text in shown(page) for words in english_in(text)] for page in pages.pages(chinese)}
    assert {name: words for name, words in found.items() if words} == {}


@pytest.mark.long
def test_the_page_of_a_system_lists_its_scenes_those_too_that_the_record_lacks(chinese):
    for place, file in enumerate(SCENES, 1):
        titles = re.findall(r'holonomic_scene\(system, title = "(\w+)"', file.read_text(encoding="utf-8"))
        headings = [head.text for head in pages.parsed(chinese / f"{place}-{file.stem}-the-system.html").iter("h3")]
        assert titles
        assert [title for title in titles if not any(title in (head or "") for head in headings)] == []


@pytest.mark.long
def test_the_pages_give_many_reasons(chinese):
    reasons = {
        "".join(each.itertext()).rpartition("：")[2]
        for page in pages.pages(chinese)
        for each in pages.parsed(page).iter()
        if each.get("class") == "refused"
    }
    assert len(reasons) >= 8


@pytest.mark.parametrize("asked", ["free", "series", "sensitivities"])
def test_an_error_on_a_page_is_wholly_in_chinese(asked):
    """The short form: two refusals of Maxima with hints, and a reason from Python."""
    scene = holonom.load(SCENES[0].with_name("reacting.mac"))
    options = {"sensitivities": "x"} if asked == "sensitivities" else {}
    reason = or_reason(lambda: getattr(scene, "simulate" if options else asked)(**options))
    with speaking("zh"):
        text = translated(reason)
    assert text != reason
    assert english_in(text) == []
