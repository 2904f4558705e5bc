"""Motions on the pages: every example is in the gallery, and a system that does not say how it looks has its curves."""

from xml.etree import ElementTree

import pages
import pytest
from click.testing import CliRunner

from holonom.cli import holonom
from holonom.companion.chapters.gallery import EXHIBITS
from holonom.companion.paper import REPOSITORY

OWN = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2, constraints = [y - u*x]{drawing})$
rising : holonomic_scene(system, title = "Rising", control_law = [u = 1 + t],
  initial_state = [x = 1, dot(x) = 0], time_span = [0, 1], observe = [residuals])$
endless : holonomic_scene(system, title = "Endless", control_law = [u = 1 + t], initial_state = [x = 1, dot(x) = 0])$
"""


def own_pages(tmp_path, drawing: str):
    file, directory = tmp_path / "own.mac", tmp_path / "pages"
    file.write_text(OWN.format(drawing=drawing))
    arguments = ["companion", str(file), "-o", str(directory)]
    assert CliRunner(mix_stderr=False).invoke(holonom, arguments, standalone_mode=False).return_value == 0
    assert pages.broken_references(directory) == []
    return directory


def test_every_example_is_in_the_gallery():
    shown = {exhibit["file"] for exhibit in EXHIBITS}
    examples = {str(file.relative_to(REPOSITORY)) for file in (REPOSITORY / "examples").rglob("*.mac")}
    assert shown == examples - {"examples/paper/printed.mac"}


@pytest.mark.parametrize("name", [exhibit["name"] for exhibit in EXHIBITS])
def test_every_exhibit_moves_stands_still_and_has_its_curves(companion, name):
    loaded = set(pages.references(companion / "gallery.html"))
    assert {f"figures/{name}-{kind}.svg" for kind in ("moving", "still", "curves")} <= loaded
    assert "<animate" in (companion / "figures" / f"{name}-moving.svg").read_text()
    assert "<animate" not in (companion / "figures" / f"{name}-still.svg").read_text()


def test_a_support_that_is_shaken_is_seen_to_move(companion):
    """Only the rim, the circle that the bob would reach, stands still."""
    film = ElementTree.parse(companion / "figures" / "spherical-pendulum-moving.svg")
    (still,) = (group for group in film.iter() if group.get("class") == "fixed")
    assert len(still) == 1


def test_a_scene_is_drawn_whatever_it_observes_and_one_without_end_says_why_not(tmp_path):
    directory = own_pages(tmp_path, ", drawing = [point([x, y])]")
    assert {file.name for file in (directory / "figures").iterdir()} == {
        f"scene-1-{kind}.svg" for kind in ("moving", "still", "curves")
    }
    assert "endless: the scene has no time span; give it one" in pages.words(directory / "motion.html")


def test_a_system_that_does_not_say_how_it_looks_has_its_curves(tmp_path):
    directory = own_pages(tmp_path, "")
    assert [file.name for file in (directory / "figures").iterdir()] == ["scene-1-curves.svg"]
    assert "The system does not say how it looks." in pages.words(directory / "motion.html")
