"""Free motion: the condition (10), and whether the example satisfies it."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..cards import derivation_cards, files_of, named_equations, printed_card, scene_cards
from ..chapter import Chapter, Page
from ..examples import BOB, CABIN, FREE_SCENE, INITIAL_SCENE, PAPER, PENDULUM
from ..runs import derived, free, printed

PARABOLIC_FLIGHT = "parabolic_flight_scene"
LIFT = "lift_scene"
UNPUSHED = "Lagrange's equations on a free motion"


def chapter(root: Path) -> Chapter:
    """The chapter, with the systems under a root."""

    def page(results: Mapping[str, Any]) -> Page:
        paper, cabin = results["paper"], results["cabin"]
        cards = derivation_cards(["10"], [paper, results["bob"]], results["printed"], root)
        scenes = scene_cards(["10"], [(paper, FREE_SCENE), (paper, INITIAL_SCENE)], (), root, "law")
        return Page(
            {
                "cards": cards,
                "scenes": scenes,
                "free_law": results["free_law"],
                "other_law": results["other_law"],
                "unpushed": printed_card(results["printed"], UNPUSHED),
                "cabin": named_equations(cabin),
                "flight": results["flight"].motion,
                "lift": results["lift"].motion,
                "pendulum": named_equations(results["pendulum"]),
            },
            sources=files_of(cards),
        )

    return Chapter(
        slug="free-motion",
        title="Free motion",
        aim="When the constraints are kept without a push: the condition (10).",
        template="free_motion.html",
        runs={
            "paper": derived(root / PAPER),
            "bob": derived(root / BOB),
            "cabin": derived(root / CABIN),
            "pendulum": derived(root / PENDULUM),
            "printed": printed(),
            "free_law": free(root / PAPER, FREE_SCENE),
            "other_law": free(root / PAPER, INITIAL_SCENE),
            "flight": free(root / CABIN, PARABOLIC_FLIGHT),
            "lift": free(root / CABIN, LIFT),
        },
        page=page,
    )
