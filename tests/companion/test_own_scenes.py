"""`holonom companion SCENE... -o DIR`: the same pages for anybody's system, and refusals that say why."""

import pages
from own_system import SMOOTH, made

from holonom.files import write_files

ROUGH = """rough_scene : holonomic_scene(system, title = "Rough",
  control_law = [u = 1 + t^(7/2)], parameter_values = [k = 2], initial_state = [x = 1, y = 1, dot(x) = 0, dot(y) = 0])$
"""
CHAPTERS = ("the-system", "equations-of-motion", "free-motion", "initial-motion")


def test_every_file_has_its_chapters(own):
    assert {f"{prefix}-{slug}.html" for prefix in ("1-my-system", "2-weightless-cabin") for slug in CHAPTERS} <= {
        page.name for page in own.glob("*.html")
    }


def test_links_resolve_and_pages_are_sound(own):
    assert pages.broken_references(own) == []
    for page in pages.pages(own):
        found = pages.names(page)
        assert len(found) == len(set(found)), page.name
        assert pages.badly_nested(page) == [], page.name


def test_signs_of_markup_in_a_title_are_text(own):
    assert "Cart & bob on a <stiff> spring" in pages.words(own / "1-my-system-the-system.html")


def test_free_motion_and_series_are_answered(own):
    assert "Every motion is free" in pages.words(own / "2-weightless-cabin-free-motion.html")
    assert "The series converges for" in pages.words(own / "1-my-system-initial-motion.html")


def test_numbers_come_before_closed_forms(own):
    page = (own / "1-my-system-initial-motion.html").read_text()
    assert page.index("First coefficients of") < page.index("smooth_scene-eq-12")


def test_an_answer_that_mathematics_refuses_is_replaced_by_the_reason(tmp_path):
    outcome, directory = made(tmp_path, ROUGH)
    assert outcome.return_value == 0
    assert "No answer was found: " in (shown := pages.words(directory / "initial-motion.html"))
    assert "not analytic" in shown


def test_a_system_without_constraints_is_free(tmp_path):
    outcome, directory = made(tmp_path, "", constrained=False)
    assert outcome.return_value == 0
    assert "every motion is free" in pages.words(directory / "free-motion.html")
    for slug in CHAPTERS:
        paragraphs = pages.parsed(directory / f"{slug}.html").iter(f"{pages.HTML}p")
        said = " ".join("".join(each.itertext()) for each in paragraphs if each.get("class") != "origin")
        assert "control" not in said.replace("no controls", ""), slug


def test_a_file_that_is_refused_leaves_nothing(tmp_path):
    outcome, directory = made(tmp_path, SMOOTH.replace("x = 1", "x = 1, y = 2"))
    assert outcome.return_value == 2
    assert "contradicts constraint 1" in outcome.stderr
    assert outcome.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == [tmp_path / "my system.mac"]


def test_a_directory_with_other_things_in_it_is_left_alone(tmp_path):
    (tmp_path / "pages").mkdir()
    (tmp_path / "pages" / "thesis.txt").write_text("years of work")
    outcome, directory = made(tmp_path, SMOOTH)
    assert outcome.return_value == 2
    assert "other things than a companion" in outcome.stderr
    assert (directory / "thesis.txt").read_text() == "years of work"


def test_of_a_companion_what_was_written_is_replaced_and_the_rest_stays(tmp_path):
    write_files(tmp_path / "pages", {"index.html": "an earlier edition", "stale.html": "from an earlier edition"})
    (tmp_path / "pages" / "own.mac").write_text("years of work")
    outcome, directory = made(tmp_path, "")
    assert outcome.return_value == 0
    assert not (directory / "stale.html").exists()
    assert (directory / "own.mac").read_text() == "years of work"
    assert "The file has no scene" in pages.words(directory / "the-system.html")
