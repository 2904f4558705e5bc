"""The system and its words: what is described, and in which terms."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...figures.tilted_plane import draw_tilted_plane
from ...language import translatable
from ..cards import derivation_cards, files_of, scene_named
from ..chapter import Chapter, Page
from ..examples import CABIN, FREE_SCENE, LINKAGE, PAPER, PENDULUM
from ..excerpts import excerpt
from ..mathematics import description
from ..runs import derived, printed


def chapter(root: Path) -> Chapter:
    """The chapter, with the systems under a root."""

    def page(results: Mapping[str, Any]) -> Page:
        paper = results["paper"]
        cards = derivation_cards(["1"], [paper, results["pendulum"]], results["printed"], root)
        scene = scene_named(paper, FREE_SCENE)
        start = {name: scene.initial_state[name] for name in paper.record.system.coordinates}
        tilt = float(scene.parameter_values["u0"])
        return Page(
            {
                "start": {"u": scene.parameter_values["u0"], **start},
                "system": paper.record.system,
                "description": description(paper.record.system),
                "description_lines": excerpt(root, PAPER, "system"),
                "scene_lines": excerpt(root, PAPER, FREE_SCENE),
                "cards": cards,
                "pendulum": results["pendulum"].record.system,
                "linkage": results["linkage"].record.system,
                "cabin": results["cabin"].record.system,
                "cabin_lines": excerpt(root, CABIN, "system"),
            },
            figures={"tilted-plane": draw_tilted_plane([float(value) for value in start.values()], tilt)},
            sources=(PAPER, CABIN, *files_of(cards)),
        )

    return Chapter(
        slug="the-system",
        title=translatable("The system and its words"),
        aim=translatable(
            "Coordinates, controls, constraints: what a controllable system is, and how to write one down."
        ),
        template="the_system.html",
        runs={
            "paper": derived(root / PAPER),
            "pendulum": derived(root / PENDULUM),
            "linkage": derived(root / LINKAGE),
            "cabin": derived(root / CABIN),
            "printed": printed(),
        },
        page=page,
    )
