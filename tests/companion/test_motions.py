"""Motions on the pages: every example is in the gallery, moving, still and as curves."""

from xml.etree import ElementTree

import pages
import pytest

from holonom.companion.directives import FILES
from holonom.companion.further_runs import EXHIBITS


def test_every_example_is_in_the_gallery():
    shown = {exhibit["file"] for exhibit in EXHIBITS}
    examples = {str(file.relative_to(pages.REPOSITORY)) for file in (pages.REPOSITORY / "examples").rglob("*.mac")}
    assert shown == examples - {"examples/paper/by_hand.mac", "examples/paper/printed.mac"}


@pytest.mark.parametrize("name", [exhibit["name"] for exhibit in EXHIBITS])
def test_every_exhibit_moves_stands_still_and_has_its_curves(companion, name):
    loaded = set(pages.references(companion / "manual" / "gallery.html"))
    assert {f"../{FILES}/{name}-{kind}.svg" for kind in ("moving", "still", "curves")} <= loaded
    assert "<animate" in (companion / FILES / f"{name}-moving.svg").read_text()
    assert "<animate" not in (companion / FILES / f"{name}-still.svg").read_text()


def test_a_support_that_is_shaken_is_seen_to_move(companion):
    """Only the rim, the circle that the bob would reach, stands still."""
    film = ElementTree.parse(companion / FILES / "spherical-pendulum-moving.svg")
    (still,) = (group for group in film.iter() if group.get("class") == "fixed")
    assert len(still) == 1
