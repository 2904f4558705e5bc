"""Equations of motion: from (2) to the constraint forces (9)."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sympy import Expr, Symbol, collect, expand

from ...figures.curves import Panel, draw_curves
from ...language import gettext
from ...simulation.result import Simulation
from ..cards import derivation_cards, missing, named_equations, printed_card
from ..chapter import Page
from ..runs import Derived, derived, printed, simulation
from . import BEAD, BOB, BOB_SCENE, PAPER, PENDULUM
from .worked_example import in_sum

CONDITIONS = ("condition on the kinetic energy", "condition on the mass matrix", "condition on the constraints")
SAMPLES = 201
NUMBERS = ("2", "3a", "3", "4", "5", "6", "7", "8", "9")


RUNS = {
    "paper": derived(PAPER),
    "bob": derived(BOB),
    "bead": derived(BEAD),
    "pendulum": derived(PENDULUM),
    "printed": printed(),
    "motion": simulation(BOB, BOB_SCENE, None, SAMPLES),
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
    cards = derivation_cards(NUMBERS, [results["bob"], paper], results["printed"])
    conditions = [printed_card(results["printed"], name) for name in CONDITIONS]
    return Page(
        {
            "steps": named_equations(paper),
            **_example_in_sum(paper),
            "cards": {card.anchor: card for card in (*cards, *conditions)},
            "missing": [*missing(results["bob"]), *missing(paper)],
            "momentum": float(momentum(results["motion"])[0]),
            "bob": results["bob"].record,
            "bead": named_equations(results["bead"]),
            "bob_equations": named_equations(results["bob"]),
            "pendulum": named_equations(results["pendulum"]),
        },
        figures={"bob": draw_curves(_panels(results["motion"]), gettext("t (units of the scene)"))},
    )


def _example_in_sum(paper: Derived) -> dict[str, Expr]:
    """Return the multiplier of the example and the acceleration of S = q1 + q2, in S."""
    equations = named_equations(paper)
    first, second = (relation.right for relation in equations["driven_accelerations"].relations[:2])
    return {
        "multiplier_in_sum": in_sum(equations["multipliers"].relations[0].right),
        "sum_acceleration": collect(in_sum(expand(first + second)), Symbol("lambda1", real=True)),
    }


def momentum(motion: Simulation) -> NDArray[np.float64]:
    """Angular momentum of the bob, its mass being one.

    Parameters
    ----------
    motion : Simulation
        Simulated motion.

    Returns
    -------
    ndarray
        Angular momentum at each sample.
    """
    return motion.coordinates["r"] ** 2 * motion.velocities["dot(phi)"]


def _panels(motion: Simulation) -> list[Panel]:
    """Return the panels of quantities that change and of quantities that do not."""
    shown = {
        gettext("length r"): motion.coordinates["r"],
        gettext("angular velocity φ̇"): motion.velocities["dot(phi)"],
        gettext("pull of the string, -λ₁"): -motion.multipliers["lambda1"],
        gettext("angular momentum m r² φ̇"): momentum(motion),
    }
    return [Panel(gettext("units of the scene"), {name: (motion.times, values) for name, values in shown.items()})]
