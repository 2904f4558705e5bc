"""Every page as a reader meets it: on a phone in the dark, on a desk, and on paper."""

from itertools import pairwise
from pathlib import Path
from urllib.parse import unquote, urldefrag, urlsplit

import pages
import pytest
from observation import observe
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait
from views import DESK

pytestmark = pytest.mark.browser


def told(seen, fault: str) -> list[str]:
    """A kind of fault on all pages, each with its page."""
    return [f"{each.page.name}: {found}" for each in seen for found in getattr(each, fault)]


def local_file(address: str) -> Path:
    return Path(unquote(urlsplit(address).path))


def test_the_browser_has_nothing_to_complain_about(seen):
    assert told(seen, "messages") == []


def test_nothing_is_loaded_but_files_of_the_book(seen):
    for each in seen:
        folders = ("reference", "book", "manual")
        book = each.page.parent.parent if each.page.parent.name in folders else each.page.parent
        assert [found for found in each.requests if not found.startswith((book.as_uri(), "data:"))] == []


def test_nothing_is_wider_than_the_page(seen):
    assert told(seen, "wider") == []


def test_nothing_is_cut_off(seen):
    assert told(seen, "cut_off") == []


def test_what_scrolls_is_scrolled_by_keys_too(seen):
    assert told(seen, "out_of_reach") == []


def test_the_keyboard_stops_only_where_something_scrolls(seen):
    assert told(seen, "idle_stops") == []


def test_no_formula_reaches_beyond_the_screen(seen):
    """Not even on a phone, where a misprint was once to the right of it."""
    assert told(seen, "off_screen") == []


def test_formulas_are_set_in_the_font_that_travels_with_the_pages(seen):
    for each in seen:
        page = pages.parsed(each.page)
        folded = {math for part in page.iter(f"{pages.HTML}details") for math in part.iter(f"{pages.MATHML}math")}
        if set(page.iter(f"{pages.MATHML}math")) - folded:
            assert each.fonts == ["Companion Math"], each.page.name


def test_mathematics_is_drawn(seen):
    assert told(seen, "flat_mathematics") == []
    assert told(seen, "broken_mathematics") == []


def test_pictures_are_drawn(seen):
    assert told(seen, "empty_pictures") == []


def test_text_stands_out_from_its_ground(seen):
    assert told(seen, "pale") == []


def test_assistive_technology_can_announce_everything_by_a_name(seen):
    assert told(seen, "nameless") == []


def test_assistive_technology_gets_headings_in_order(seen):
    for each in seen:
        assert each.headings[0] == 1, each.page.name
        assert all(below - above <= 1 for above, below in pairwise(each.headings)), each.page.name


def test_every_link_leads_to_a_place(seen):
    places = {each.page: set(each.names) for each in seen}
    for each in seen:
        for address, anchor in (urldefrag(link) for link in each.links if not link.startswith("https:")):
            assert local_file(address).is_file(), f"{each.page.name}: {address}"
            assert not anchor or anchor in places[local_file(address)], f"{each.page.name}: {address}#{anchor}"


@pytest.fixture
def chapter(browser, companion):
    """The chapter on the equations of motion, opened on a desk."""
    DESK.take(browser)
    browser.get((companion / "book" / "equations-of-motion.html").as_uri())
    return browser


def is_in_sight(browser, element) -> bool:
    box = browser.execute_script("return arguments[0].getBoundingClientRect().toJSON()", element)
    return box["width"] > 0 and box["left"] >= 0 and 0 <= box["top"] < browser.execute_script("return innerHeight")


def test_the_first_key_brings_the_way_past_the_contents_into_sight(chapter):
    skip = chapter.find_element("class name", "skip-to-content")
    assert not is_in_sight(chapter, skip)
    chapter.find_element("tag name", "body").send_keys(Keys.TAB)
    assert chapter.switch_to.active_element == skip
    WebDriverWait(chapter, 60).until(lambda _: is_in_sight(chapter, skip))  # it slides in


@pytest.fixture
def exhibit(browser, companion):
    """The first drawing of the gallery, on a desk."""
    DESK.take(browser)
    browser.get((companion / "manual" / "gallery.html").as_uri())
    return browser.find_element("css selector", "figure.film")


def shown_pictures(figure) -> list[str]:
    pictures = figure.find_elements("tag name", "img")
    return [Path(each.get_attribute("src")).stem.split("-")[-1] for each in pictures if each.is_displayed()]


def test_a_drawing_moves_until_it_is_folded_away(exhibit):
    assert shown_pictures(exhibit) == ["moving"]
    exhibit.find_element("tag name", "summary").click()
    assert shown_pictures(exhibit) == ["still"]


def test_a_reader_without_motion_sees_the_still_picture(browser, exhibit):
    calm = [{"name": "prefers-reduced-motion", "value": "reduce"}]
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": calm})
    assert shown_pictures(exhibit) == ["still"]


def test_what_is_printed_stands_still(browser, exhibit):
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    assert shown_pictures(exhibit) == ["still"]


@pytest.mark.long
def test_no_formula_of_an_own_scene_is_taller_than_a_screen(browser, own):
    for page in own.glob("*.html"):
        assert observe(browser, page, DESK).towering == [], page.name


@pytest.fixture
def knob(browser, companion):
    """The page of the knob, on a desk."""
    DESK.take(browser)
    browser.get((companion / "book" / "turn-the-knob.html").as_uri())
    return browser


def curve(browser, name: str) -> str:
    return browser.find_element("css selector", f"[data-curve='{name}']").get_attribute("points")


def turn(browser, name: str, value: str) -> None:
    """Let the reader move a slider, or choose a law."""
    browser.execute_script(
        "const control = document.querySelector(`#knob [name=${arguments[0]}]:not(output)`);"
        "control.value = arguments[1];"
        "control.dispatchEvent(new Event('input', {bubbles: true}));",
        name,
        value,
    )


def output(browser, name: str) -> str:
    return browser.execute_script("return document.querySelector(`output[name=${arguments[0]}]`).value", name)


def test_turning_the_knob_redraws_the_multiplier_and_the_circle(knob):
    before, radius = curve(knob, "lambda1"), float(output(knob, "radius"))
    turn(knob, "u0", "1")
    assert curve(knob, "lambda1") != before
    assert float(output(knob, "radius")) > radius
    turn(knob, "law", "exponential")
    assert output(knob, "radius") == "\N{INFINITY}"


def test_without_scripts_the_page_of_the_knob_shows_still_figures_alone(companion):
    page = pages.article(companion / "book" / "turn-the-knob.html")
    form = next(page.iter("form"))
    assert "hidden" in form.attrib
    assert not list(form.iter(f"{pages.HTML}img"))
    assert list(page.iter(f"{pages.HTML}img"))
