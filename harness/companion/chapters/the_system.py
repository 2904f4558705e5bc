"""Chapter on the description of a system and its terms."""

from collections.abc import Mapping
from typing import Any

from ..cards import derivation_cards, scene_named
from ..chapter import Page
from ..mathematics import description
from ..runs import derived, printed
from ..tilted_plane import draw_tilted_plane
from . import FREE_SCENE, LINKAGE, PAPER, PENDULUM

RUNS = {
    "paper": derived(PAPER),
    "pendulum": derived(PENDULUM),
    "linkage": derived(LINKAGE),
    "printed": printed(),
}


def page(results: Mapping[str, Any]) -> Page:
    """Return the page that results make.

    Parameters
    ----------
    results : mapping
        Results of the runs by their names.

    Returns
    -------
    Page
        Content and files of the page.
    """
    paper = results["paper"]
    cards = derivation_cards(["1"], [paper, results["pendulum"]], results["printed"])
    scene = scene_named(paper, FREE_SCENE)
    start = {name: scene.initial_state[name] for name in paper.record.system.coordinates}
    tilt = float(scene.parameter_values["u0"])
    return Page(
        {
            "start": {"u": scene.parameter_values["u0"], **start},
            "system": paper.record.system,
            "description": description(paper.record.system),
            "scene": scene,
            "cards": cards,
            "pendulum": results["pendulum"].record.system,
            "linkage": results["linkage"].record.system,
        },
        figures={"tilted-plane": draw_tilted_plane([float(value) for value in start.values()], tilt)},
    )
