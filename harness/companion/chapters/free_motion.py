"""Free motion: the condition (10), and whether the example satisfies it."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from sympy import Expr, Symbol, simplify

from ...figures.curves import Panel, draw_curves
from ...free_motion import FreeMotion
from ...language import gettext
from ...simulation.result import Simulation
from ..cards import derivation_cards, named_equations, printed_card, scene_cards, scene_named
from ..chapter import Page
from ..expressions import under
from ..power import EnergyBalance, energy_balance
from ..runs import Derived, derived, free, printed, simulation
from . import BOB, CABIN, FREE_SCENE, INITIAL_SCENE, PAPER, PENDULUM
from .worked_example import in_sum

UNTIL, SAMPLES = Fraction(3), 2001
PARABOLIC_FLIGHT = "parabolic_flight_scene"
LIFT = "lift_scene"
UNPUSHED = "Lagrange's equations on a free motion"


RUNS = {
    "paper": derived(PAPER),
    "bob": derived(BOB),
    "cabin": derived(CABIN),
    "pendulum": derived(PENDULUM),
    "printed": printed(),
    "free_law": free(PAPER, FREE_SCENE),
    "other_law": free(PAPER, INITIAL_SCENE),
    "unpushed": simulation(PAPER, FREE_SCENE, UNTIL, SAMPLES),
    "pushed": simulation(PAPER, INITIAL_SCENE, UNTIL, SAMPLES),
    "flight": free(CABIN, PARABOLIC_FLIGHT),
    "lift": free(CABIN, LIFT),
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
    paper, cabin = results["paper"], results["cabin"]
    cards = derivation_cards(["10"], [paper, results["bob"]], results["printed"])
    scenes = scene_cards(["10"], [(paper, FREE_SCENE), (paper, INITIAL_SCENE)], (), "law")
    return Page(
        {
            **_example(paper, results["other_law"]),
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
            "pushed_until": float(results["pushed"].times[-1]),
            "pendulum": named_equations(results["pendulum"]),
        },
        figures={
            "cost": draw_curves(_panels(results["unpushed"], results["pushed"], balance), gettext("t (dimensionless)"))
        },
    )


def _example(paper: Derived, found: FreeMotion) -> dict[str, Expr]:
    """Return the multiplier of the example in S = q1 + q2, and a free motion."""
    law = scene_named(paper, FREE_SCENE).control_law
    sum_of_free = simplify(found.trajectory.motion["q1"] + found.trajectory.motion["q2"])
    return {
        "multiplier_in_sum": in_sum(named_equations(paper)["multipliers"].relations[0].right),
        "free_sum": sum_of_free,
        "free_height": simplify(under(law, Symbol("u", real=True)) * sum_of_free),
    }


def _panels(unpushed: Simulation, pushed: Simulation, balance: EnergyBalance) -> list[Panel]:
    """Return panels of the multiplier under both laws, and of the energy."""
    multipliers = {"u = u₀ exp(t)": unpushed, "u = u₀ + t": pushed}
    work = {
        gettext("kinetic energy gained"): balance.gained,
        gettext("work of spring and damping"): balance.by_forces,
        gettext("work of the control"): balance.by_knob,
    }
    return [
        Panel(
            gettext("multiplier λ₁\n(dimensionless)"),
            {law: (motion.times, motion.multipliers["lambda1"]) for law, motion in multipliers.items()},
        ),
        Panel(
            gettext("u = u₀ + t: energy\n(dimensionless)"),
            {name: (pushed.times, each) for name, each in work.items()},
        ),
    ]
