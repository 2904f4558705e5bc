"""Free motion: the condition (10), and whether the example satisfies it."""

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

from ...figures.curves import Panel, draw_curves
from ...language import gettext
from ...simulation.result import Simulation
from ..cards import derivation_cards, files_of, named_equations, printed_card, scene_cards, scene_named
from ..chapter import Page, Run
from ..power import EnergyBalance, energy_balance
from ..runs import derived, free, printed, simulation
from . import BOB, CABIN, FREE_SCENE, INITIAL_SCENE, PAPER, PENDULUM

UNTIL, SAMPLES = Fraction(3), 2001
PARABOLIC_FLIGHT = "parabolic_flight_scene"
LIFT = "lift_scene"
UNPUSHED = "Lagrange's equations on a free motion"


def runs(root: Path) -> dict[str, Run]:
    """Return what the chapter needs."""
    return {
        "paper": derived(root / PAPER),
        "bob": derived(root / BOB),
        "cabin": derived(root / CABIN),
        "pendulum": derived(root / PENDULUM),
        "printed": printed(),
        "free_law": free(root / PAPER, FREE_SCENE),
        "other_law": free(root / PAPER, INITIAL_SCENE),
        "unpushed": simulation(root / PAPER, FREE_SCENE, UNTIL, SAMPLES),
        "pushed": simulation(root / PAPER, INITIAL_SCENE, UNTIL, SAMPLES),
        "flight": free(root / CABIN, PARABOLIC_FLIGHT),
        "lift": free(root / CABIN, LIFT),
    }


def page(root: Path, results: Mapping[str, Any]) -> Page:
    """Return the page that results make."""
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
            "balance": (
                balance := energy_balance(paper.record.system, scene_named(paper, INITIAL_SCENE), results["pushed"])
            ),
            "spent": float(balance.by_knob[-1]),
            "pushed_until": float(results["pushed"].instants[-1]),
            "pendulum": named_equations(results["pendulum"]),
        },
        figures={
            "cost": draw_curves(panels(results["unpushed"], results["pushed"], balance), gettext("t (dimensionless)"))
        },
        sources=files_of(cards),
    )


def panels(unpushed: Simulation, pushed: Simulation, balance: EnergyBalance) -> list[Panel]:
    """Return the multiplier under both laws, and where the energy goes under the second."""
    multipliers = {"u = u₀ exp(t)": unpushed, "u = u₀ + t": pushed}
    work = {
        gettext("kinetic energy gained"): balance.gained,
        gettext("work of spring and damping"): balance.by_forces,
        gettext("work at the knob"): balance.by_knob,
    }
    return [
        Panel(
            gettext("multiplier λ₁\n(dimensionless)"),
            {law: (motion.instants, motion.multipliers["lambda1"]) for law, motion in multipliers.items()},
        ),
        Panel(
            gettext("u = u₀ + t: energy\n(dimensionless)"),
            {name: (pushed.instants, each) for name, each in work.items()},
        ),
    ]
