"""`holonom companion SCENE... -o DIR`: the same pages for anybody's system, and refusals that say why."""

import re
from xml.etree import ElementTree

import pages
import pytest
from confinement import without_notice
from own_system import SMOOTH, TEXTS, UNCONSTRAINED, made
from refusing import message_of

from holonom.companion.directives import FILES
from holonom.companion.pages import _first_term
from holonom.failures import ErrorKind
from holonom.free_motion import FirstCoefficient

CHAPTERS = ("the-system", "equations-of-motion", "free-motion", "initial-motion", "motion")


def test_every_file_has_its_chapters(own):
    prefixes = [*(name.replace(" ", "-") for name in TEXTS), "weightless-cabin", "chain"]
    assert {page.name for page in pages.pages(own) if page.parent == own} == {
        "index.html",
        *(f"{place}-{prefix}-{slug}.html" for place, prefix in enumerate(prefixes, 1) for slug in CHAPTERS),
    }


def test_links_resolve_and_pages_are_sound(own):
    assert pages.broken_references(own) == []
    for page in pages.pages(own):
        found = pages.names(page)
        assert len(found) == len(set(found)), page.name
        assert pages.badly_nested(page) == [], page.name


def test_no_card_without_a_formula_has_a_verdict(own):
    """What stands in place of a formula was not compared with anything."""
    assert [page.name for page in pages.pages(own) if pages.verdicts_without_a_formula(page)] == []


def test_signs_of_markup_in_a_title_are_text(own):
    assert "Cart & bob on a <stiff> spring" in pages.words(own / "1-my-system-the-system.html")


def test_free_motion_and_series_are_answered(own):
    assert "Every motion is free" in pages.words(own / "6-weightless-cabin-free-motion.html")
    assert "Radius of convergence: " in pages.words(own / "1-my-system-initial-motion.html")


def test_constraints_that_follow_from_others_take_no_freedom(own):
    counts = re.search(r"<p>(\d+ [^<]*)</p>", (own / "2-rough-the-system.html").read_text(encoding="utf-8"))[1]
    assert re.findall(r"\d+", counts) == ["2", "1", "2", "1"]  # coordinates, controls, constraints, freedom


def test_numbers_come_before_closed_forms(own):
    page = (own / "1-my-system-initial-motion.html").read_text()
    assert page.index("First coefficients of") < page.index("smooth_scene-eq-12")


def test_an_answer_that_mathematics_refuses_is_replaced_by_the_reason(own):
    assert "No answer was found: " in (shown := pages.words(own / "2-rough-initial-motion.html"))
    assert "not analytic" in shown


def test_a_system_without_constraints_is_free(own):
    assert "every motion is free" in pages.words(own / "3-unconstrained-free-motion.html")
    for slug in CHAPTERS:
        paragraphs = pages.parsed(own / f"3-unconstrained-{slug}.html").iter(f"{pages.HTML}p")
        said = " ".join("".join(each.itertext()) for each in paragraphs if each.get("class") != "origin")
        assert "control" not in said.replace("no controls", ""), slug


def pictures(own, prefix: str) -> set[str]:
    return {file.name for file in (own / FILES).glob(f"{prefix}-*")}


def test_a_scene_is_drawn_whatever_it_observes_and_one_without_end_says_why_not(own):
    assert pictures(own, "4-drawn") == {f"4-drawn-motion-1-{kind}.svg" for kind in ("moving", "still", "curves")}
    assert "endless: the scene has no time span (add time_span" in pages.words(own / "4-drawn-motion.html")


def test_a_system_that_does_not_say_how_it_looks_has_its_curves(own):
    assert pictures(own, "5-undrawn") == {"5-undrawn-motion-1-curves.svg"}
    assert "The system has no drawing." in pages.words(own / "5-undrawn-motion.html")


def test_equations_that_forces_with_multipliers_leave_out_are_not_called_long(own):
    reacting, long = (pages.words(own / f"{name}-equations-of-motion.html") for name in ("5-undrawn", "7-chain"))
    assert ("for each pattern of signs alone" in reacting, "too long to read" in reacting) == (True, False)
    assert ("for each pattern of signs alone" in long, "too long to read" in long) == (False, True)


def test_a_switched_law_is_said_to_be_that_of_the_initial_time(own):
    around = "Control law around the initial time"
    assert around in pages.words(own / "5-undrawn-the-system.html")
    assert around not in pages.words(own / "4-drawn-the-system.html")


def test_the_contents_name_the_file_of_each_chapter(own):
    captions = re.findall(r'<span class="caption-text">(.*?)</span>', (own / "5-undrawn-motion.html").read_text())
    assert captions == [*(f"{name}.mac" for name in TEXTS), "weightless_cabin.mac", "chain.mac"]


def test_a_file_that_is_refused_leaves_nothing(tmp_path):
    outcome, directory = made(tmp_path, {"my system": SMOOTH.replace("x = 1", "x = 1, y = 2")})
    assert outcome.return_value == 2
    assert re.search(message_of(ErrorKind.REFUSED, "constraint 1"), outcome.stderr)
    assert without_notice(outcome.stderr).count("\n") == 1
    assert list(tmp_path.iterdir()) == [tmp_path / "my system.mac"]


def test_a_directory_with_other_things_in_it_is_left_alone(tmp_path):
    (tmp_path / "pages").mkdir()
    (tmp_path / "pages" / "thesis.txt").write_text("years of work")
    outcome, directory = made(tmp_path, {"own": SMOOTH})
    assert outcome.return_value == 2
    assert re.search(message_of(ErrorKind.NOT_A_COMPANION), outcome.stderr)
    assert (directory / "thesis.txt").read_text() == "years of work"


@pytest.mark.long
def test_of_a_companion_what_was_written_is_replaced_and_the_rest_stays(tmp_path):
    assert made(tmp_path, {"own": UNCONSTRAINED, "other": UNCONSTRAINED})[0].return_value == 0
    assert (tmp_path / "pages" / "2-other-the-system.html").exists()
    (tmp_path / "pages" / "own.mac").write_text("years of work")
    outcome, directory = made(tmp_path, {"own": UNCONSTRAINED.replace("Cart", "Sledge")})
    assert outcome.return_value == 0
    assert list(directory.glob("?-*.html")) == []
    assert (directory / "own.mac").read_text() == "years of work"
    shown = pages.words(directory / "the-system.html")
    assert "Sledge" in shown
    assert "The file has no scene" in shown


@pytest.mark.parametrize(
    ("order", "value", "shown"),
    [(0, "-14", "λ1=−14+…"), (1, "1/2", "λ1=12(t−t0)+…"), (3, "1.23456789012345e-5", "λ1=1.23456789·10−5(t−t0)3+…")],
)
def test_the_first_term_of_a_multiplier_is_one_formula(order, value, shown):
    formula = _first_term(FirstCoefficient("lambda1", order, value))
    assert "".join(ElementTree.fromstring(formula).itertext()) == shown
