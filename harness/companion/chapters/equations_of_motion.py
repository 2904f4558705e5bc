"""Equations of motion: from (2) to the constraint forces (9)."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...figures.curves import Panel, draw_curves
from ...language import gettext, translatable
from ...simulation.result import Simulation
from ..cards import derivation_cards, files_of, missing, named_equations, printed_card
from ..chapter import Chapter, Page
from ..examples import BEAD, BOB, BOB_SCENE, PAPER, PENDULUM
from ..runs import derived, printed, simulation

CONDITIONS = ("condition on the kinetic energy", "condition on the mass matrix", "condition on the constraints")
SAMPLES = 201
NUMBERS = ("2", "3a", "3", "4", "5", "6", "7", "8", "9")


def chapter(root: Path) -> Chapter:
    """The chapter, with the systems under a root."""

    def page(results: Mapping[str, Any]) -> Page:
        paper = results["paper"]
        cards = derivation_cards(NUMBERS, [results["bob"], paper], results["printed"], root)
        conditions = [printed_card(results["printed"], name) for name in CONDITIONS]
        return Page(
            {
                "cards": {card.anchor: card for card in (*cards, *conditions)},
                "missing": [*missing(results["bob"]), *missing(paper)],
                "momentum": float(momentum(results["motion"])[0]),
                "bob": results["bob"].record,
                "bead": named_equations(results["bead"]),
                "bob_equations": named_equations(results["bob"]),
                "pendulum": named_equations(results["pendulum"]),
            },
            figures={"bob": draw_curves(panels(results["motion"]), gettext("t (units of the scene)"))},
            sources=files_of(cards),
        )

    return Chapter(
        slug="equations-of-motion",
        title=translatable("Equations of motion"),
        aim=translatable(
            "From the kinetic energy to the accelerations, the multipliers and the constraint forces: (2) to (9)."
        ),
        template="equations_of_motion.html",
        runs={
            "paper": derived(root / PAPER),
            "bob": derived(root / BOB),
            "bead": derived(root / BEAD),
            "pendulum": derived(root / PENDULUM),
            "printed": printed(),
            "motion": simulation(root / BOB, BOB_SCENE, None, SAMPLES),
        },
        page=page,
    )


def momentum(motion: Simulation) -> NDArray[np.float64]:
    """Angular momentum of the bob, its mass being one."""
    return motion.coordinates["r"] ** 2 * motion.velocities["dot(phi)"]


def panels(motion: Simulation) -> list[Panel]:
    """What changes as the string is drawn in, and what does not."""
    shown = {
        gettext("length r"): motion.coordinates["r"],
        gettext("angular velocity φ̇"): motion.velocities["dot(phi)"],
        gettext("pull of the string, -λ₁"): -motion.multipliers["lambda1"],
        gettext("angular momentum m r² φ̇"): momentum(motion),
    }
    return [Panel(gettext("units of the scene"), {name: (motion.instants, values) for name, values in shown.items()})]
