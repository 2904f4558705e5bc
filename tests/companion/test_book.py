"""The pages of the companion: well-formed, linked, readable by everybody, and complete."""

import math
import re
from itertools import pairwise

import pages
import pytest
from fontTools.ttLib import TTFont
from sympy import Symbol, sin

from holonom.companion import BEAD, INITIAL_SCENE, PAPER
from holonom.companion.cards import named_equations, scene_named
from holonom.companion.chapter import chapters_of_the_paper
from holonom.companion.directives import FILES
from holonom.companion.runs import Run, derive
from holonom.companion.shelf import Shelf
from holonom.companion.stored_results import Results
from holonom.errata import errata

LOADING = {"link", "script", "img", "source", "iframe"}
CARDS = {
    "the-system": ("1",),
    "equations-of-motion": ("2", "3a", "3", "4", "5", "6", "7", "8", "9"),
    "free-motion": ("10",),
    "initial-motion": ("11", "12", "13", "18", "19"),
    "worked-example": ("14", "15", "16", "17", "18", "19"),
}


def test_every_page_is_well_formed_and_says_its_language(companion):
    for page in pages.pages(companion):
        assert page.read_text().lower().startswith("<!doctype html>")
        assert pages.parsed(page).get("lang") == "en"


def test_every_link_and_anchor_resolves_inside_the_companion(companion):
    assert pages.broken_references(companion) == []


def test_no_name_is_given_twice_on_a_page(companion):
    for page in pages.pages(companion):
        found = pages.names(page)
        assert len(found) == len(set(found)), page.name


def test_nothing_is_loaded_from_the_network(companion):
    for page in pages.pages(companion):
        loaded = [each.get("src", each.get("href")) for each in pages.parsed(page).iter() if each.tag in LOADING]
        assert not [each for each in loaded if each and "//" in each], page.name
    assert "http" not in (companion / FILES / "knob.js").read_text().replace("http://www.w3.org/2000/svg", "")
    style = (companion / "_static" / "holonom.css").read_text()
    assert re.findall(r"url\((.*?)\)", style) == ['"mathematics.woff"']
    assert "@import" not in style


def test_no_formula_needs_a_script(companion):
    for page in pages.pages(companion):
        scripts = [each.get("src", "") + (each.text or "") for each in pages.parsed(page).iter("script")]
        assert not [each for each in scripts if "mathjax" in each.lower()], page.name


def test_the_font_says_under_which_licence_it_travels(companion):
    notice = (companion / "_static" / "mathematics.txt").read_text()
    assert "SIL Open Font License" in notice
    assert "STIX Fonts Project Authors" in notice
    names = TTFont(companion / "_static" / "mathematics.woff")["name"]
    assert "SIL Open Font License" in names.getDebugName(13)


def test_every_number_of_an_equation_in_the_prose_is_a_link_to_it(companion):
    for slug in CARDS:
        page = pages.parsed(companion / "book" / f"{slug}.html")
        linked = {each.text for each in page.iter(f"{pages.HTML}a") if each.get("class") == "equation"}
        paragraphs = [each for each in page.iter(f"{pages.HTML}p") if each.get("class") in (None, "words")]
        plain = {found for each in paragraphs for found in re.findall(r"\((?:\d{1,2})\)", each.text or "")}
        assert not plain - linked, slug


def test_headings_begin_with_one_of_the_first_level_and_skip_none(companion):
    for page in pages.pages(companion):
        levels = pages.heading_levels(page)
        assert levels[0] == 1, page.name
        assert levels.count(1) == 1, page.name
        assert all(below - above <= 1 for above, below in pairwise(levels)), page.name


def test_paragraphs_hold_no_blocks(companion):
    for page in pages.pages(companion):
        assert pages.badly_nested(page) == [], page.name


def test_no_text_is_escaped_twice(companion):
    for page in pages.pages(companion):
        assert not [sign for sign in ("&lt;", "&gt;", "&amp;", "&#") if sign in pages.words(page)], page.name


def test_mathematics_and_figures_say_in_words_what_they_show(companion):
    for page in pages.pages(companion):
        assert pages.nameless_mathematics(page) == 0, page.name
        assert all(image.get("alt") for image in pages.parsed(page).iter(f"{pages.HTML}img")), page.name


def test_the_contents_lead_to_every_page(companion):
    linked = {each for name in ("book", "manual") for each in pages.references(companion / name / "index.html")}
    made = {page.name for name in ("book", "manual") for page in (companion / name).iterdir()}
    assert made <= linked | {"index.html"}


def test_every_chapter_that_computes_has_its_page(companion):
    made = {page.stem for name in ("book", "manual") for page in (companion / name).iterdir()}
    assert set(chapters_of_the_paper()) <= made


def test_every_equation_of_the_paper_s_record_has_a_card(companion, results):
    record = results[Run(derive, (PAPER,))].record
    derived = {each.number for part in (*record.derivations, *record.scenes) for each in part.equations}
    assert derived <= {number for numbers in CARDS.values() for number in numbers}
    for page, numbers in CARDS.items():
        assert {f"eq-{number}" for number in numbers} <= set(pages.names(companion / "book" / f"{page}.html"))


def test_every_misprint_is_counted_and_marked(companion, results):
    printed = results[Run(errata)]
    shown = pages.words(companion / "manual" / "misprints.html")
    wrong = sum(not each.agrees for each in printed)
    assert f"Of {len(printed)} equations {len(printed) - wrong} are printed as derived, {wrong} are not." in shown
    marked = [
        element
        for element in pages.parsed(companion / "manual" / "misprints.html").iter()
        if element.get("class") == "misprint"
    ]
    assert len(marked) >= wrong


def test_no_verdict_disagrees(companion):
    for page in pages.pages(companion):
        if page.name not in ("index.html", "your-own-system.html"):
            assert "verdict disagrees" not in page.read_text(), page.name


def test_no_card_without_a_formula_has_a_verdict(companion):
    """What stands in place of a formula was not compared with anything."""
    assert [page.name for page in pages.pages(companion) if pages.verdicts_without_a_formula(page)] == []


def test_the_general_inverse_has_one_index_above_and_one_below(companion):
    card = (
        (companion / "book" / "equations-of-motion.html")
        .read_text()
        .partition('id="eq-5"')[2]
        .partition("</section>")[0]
    )
    assert card.count("<msubsup><mi>δ</mi>") == 1


def test_one_letter_has_one_shape(companion):
    for page in pages.pages(companion):
        assert "ϕ" not in page.read_text(), page.name


def test_sines_and_cosines_that_cancel_are_not_left_standing(results):
    """T of the bead is M v^2/2 + m(v^2 + r'^2 + r^2 w^2)/2 + ..., since sin^2 + cos^2 = 1."""
    relations = named_equations(results[Run(derive, (BEAD,))])["kinetic_energy"].relations
    m, w, r = (Symbol(name, real=True) for name in ("m", "w", "r"))
    found = {str(each.left): each.right for each in relations}
    assert found["A[2, 2]"] == m
    assert found["T0"].coeff(w, 2).equals(m * r**2 / 2)
    assert not found["A[1, 1]"].has(sin)


def chapters_with_exercises(companion) -> list:
    return [page for page in sorted((companion / "book").iterdir()) if "exercise" in page.read_text()]


def test_chapters_open_with_aims(companion):
    for page in chapters_with_exercises(companion):
        assert [each for each in pages.article(page).iter("div") if "aims" in each.get("class", "").split()], page.name


def test_every_chapter_has_a_figure_that_tells_its_finding(companion):
    for page in chapters_with_exercises(companion):
        figures = list(pages.article(page).iter("figure"))
        assert figures, page.name
        for each in figures:
            assert len(" ".join(each.find("figcaption").itertext()).split()) >= 5, page.name


def test_a_chapter_has_five_exercises_with_grades_and_answers_apart(companion):
    assert len(chapters_with_exercises(companion)) >= 12
    for page in chapters_with_exercises(companion):
        questions = [each for each in pages.article(page).iter("div") if each.get("class") == "exercise"]
        assert len(questions) == 5, page.name
        apart = next(each for each in pages.article(page).iter("section") if each.get("id") == "answers")
        answers = {each.get("id"): each for each in apart.iter("details")}
        for number, each in enumerate(questions, 1):
            assert len([part for part in each.iter() if part.get("class") == "grade"]) == 1
            assert next(each.iter("a")).get("href") == f"#answer-{number}"
            assert len(" ".join(answers[f"answer-{number}"].itertext()).split()) > 5, page.name


def test_numbers_that_exercises_need_are_on_their_page(companion, results):
    """Those of the scene that a chapter is about, before its exercises."""
    given = {"initial-motion": INITIAL_SCENE, "worked-example": INITIAL_SCENE, "radius-of-convergence": INITIAL_SCENE}
    for slug, name in given.items():
        scene = scene_named(results[Run(derive, (PAPER,))], name)
        page = pages.parsed(companion / "book" / f"{slug}.html")
        exercises = next(each for each in page.iter("section") if each.get("id") == "exercises")
        notes = [each for each in exercises.iter("p") if each.get("class") == "note"]
        found = {each.get("alttext") for note in notes for each in note.iter("math")}
        assert {str(value) for value in (*scene.parameter_values.values(), *scene.initial_state.values())} <= found, (
            slug
        )


def test_words_of_the_index_lead_to_their_definitions(companion):
    entries = pages.parsed(companion / "genindex.html").iter("li")
    found = next(each for each in entries if "".join(each.itertext()).split(",")[0].strip() == "virtual displacement")
    linked = dict(each.get("href").split("#") for each in found.iter("a"))
    assert set(linked) == {"book/the-system.html", "book/further-reading.html"}
    assert all(anchor in pages.names(companion / page) for page, anchor in linked.items())


def test_the_glossary_says_it_in_chinese_too(companion):
    found = pages.words(companion / "book" / "further-reading.html")
    assert all(word in found for word in ("自由运动", "初始运动", "多余坐标", "可控力学系统"))


@pytest.mark.long
def test_the_radii_of_the_whole_figure_are_those_of_the_truth():
    """Those of the zeros of 1 + 2 (u0 + t)^2."""
    found = chapters_of_the_paper()["radius-of-convergence"].runs["radii"].compute()
    assert len(found) == 17
    for u0, radius in found.items():
        assert abs(radius.estimate - math.sqrt(u0**2 + 0.5)) <= radius.uncertainty, u0


@pytest.mark.long
def test_the_whole_study_has_its_fifty_digits_on_the_page(tmp_path):
    shelf = Shelf(chapters_of_the_paper(), "en", tmp_path, Results())
    assert min(each.error for each in shelf.values("work-precision")["rows"]) < 1e-48
    shelf.figure("work-precision", "accuracy")
    assert "<svg" in (tmp_path / "accuracy.svg").read_text(encoding="utf-8")
