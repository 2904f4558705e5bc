"""Equations of motion: from (2) to the constraint forces (9)."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..cards import derivation_cards, files_of, missing, named_equations, printed_card
from ..chapter import Chapter, Page
from ..examples import BEAD, BOB, PAPER, PENDULUM
from ..runs import derived, printed

CONDITIONS = ("condition on the kinetic energy", "condition on the mass matrix", "condition on the constraints")
NUMBERS = ("2", "3a", "3", "4", "5", "6", "7", "8", "9")


def chapter(root: Path) -> Chapter:
    """The chapter, with the systems under a root."""

    def page(results: Mapping[str, Any]) -> Page:
        paper = results["paper"]
        cards = derivation_cards(NUMBERS, [paper, results["bob"]], results["printed"], root)
        conditions = [printed_card(results["printed"], name) for name in CONDITIONS]
        return Page(
            {
                "cards": {card.anchor: card for card in (*cards, *conditions)},
                "missing": missing(paper),
                "bob": results["bob"].record,
                "bead": named_equations(results["bead"]),
                "bob_equations": named_equations(results["bob"]),
                "pendulum": named_equations(results["pendulum"]),
            },
            sources=files_of(cards),
        )

    return Chapter(
        slug="equations-of-motion",
        title="Equations of motion",
        aim="From the kinetic energy to the accelerations, the multipliers and the constraint forces: (2) to (9).",
        template="equations_of_motion.html",
        runs={
            "paper": derived(root / PAPER),
            "bob": derived(root / BOB),
            "bead": derived(root / BEAD),
            "pendulum": derived(root / PENDULUM),
            "printed": printed(),
        },
        page=page,
    )
