"""The worked example of section 4: each equation as printed, and as derived."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import dropwhile
from typing import Any

import sympy
from sympy import Symbol

from ...errata import PrintedEquation
from ...language import gettext, translatable, translated
from ...mathjson import from_sympy
from ...record import Equation, Relation
from ...simulation.result import Simulation
from ..cards import Card, Instance, anchors, named_equations, scene_named, verdicts_on
from ..expressions import RATES, in_sum, right_side, under, zeros
from ..power import values_along
from ..runs import Derived
from . import FREE_SCENE, INITIAL_SCENE

FIRST_NUMBER = "14"


@dataclass(frozen=True)
class Counterpart:
    """The derived counterpart of a printed equation of the example."""

    equation: str  # the record's name for it
    place: int = 0  # which of its relations
    scene: str | None = None  # the scene that it belongs to; None for an equation of the derivation


COUNTERPARTS = {
    "constraint": Counterpart("constraints"),
    "condition of free motion of the example": Counterpart("free_motion_condition"),
    "multiplier": Counterpart("multipliers"),
    **{
        f"{name} {coordinate}": Counterpart(equation, place, scene)
        for place, coordinate in enumerate(("q1", "q2", "q3"))
        for name, equation, scene in (
            ("equation of motion of", "driven_accelerations", None),
            ("acceleration of", "accelerations", None),
            ("initial acceleration of", "initial_accelerations", INITIAL_SCENE),
            ("initial motion of", "initial_series", INITIAL_SCENE),
        )
    },
    "initial value q3_0": Counterpart("determined_initial_values", 0, INITIAL_SCENE),
    "initial value dot(q3_0)": Counterpart("determined_initial_values", 1, INITIAL_SCENE),
}

SECTIONS = {
    "14": translatable("The system"),
    "condition of free motion of the example": translatable("Free motion"),
    "equation of motion of q1": translatable("Equations of motion"),
    "initial state of the example": translatable("Initial motion"),
}
"""Titles of the chapter's sections, by the number or name of the equation that each begins with."""


def page(results: Mapping[str, Any]) -> dict[str, Any]:
    """Return values of the page.

    Parameters
    ----------
    results : mapping
        Results of the runs by their names.

    Returns
    -------
    dict
        Values by name.
    """
    paper = results["paper"]
    example = list(dropwhile(lambda each: each.number != FIRST_NUMBER, results["printed"]))
    cards = _cards(example, paper, results["free"].universal.laws)
    derived = named_equations(paper)["multipliers"].relations[0].right
    printed = right_side(next(each for each in example if each.name == "multiplier").printed_tree)
    scene = scene_named(paper, INITIAL_SCENE)
    free_law = scene_named(paper, FREE_SCENE).control_law
    return {
        **multiplier_at_start(paper, results["pushed"]),
        "example": example,
        "sections": _sections(cards),
        "anchors": {(card.number, card.name): card.anchor for card in cards},
        "roots": zeros(sympy.fraction(derived)[1]),
        "derived_under_law": under(free_law, derived),
        "printed_under_law": under(free_law, printed),
        "difference": under(scene.control_law, derived - printed),
        "printed_along": values_along(printed, scene, results["pushed"]),
    }


def multiplier_at_start(paper: Derived, pushed: Simulation) -> dict[str, Any]:
    """Return the initial multiplier of the second task, by formula and by integration.

    Parameters
    ----------
    paper : Derived
        Derivation of the paper's example.
    pushed : Simulation
        Motion of the second task.

    Returns
    -------
    dict
        Formula and values by name.
    """
    scene = scene_named(paper, INITIAL_SCENE)
    multiplier = in_sum(named_equations(paper)["multipliers"].relations[0].right)
    start = scene.initial_state
    begun = {f"{name}_0": value for name, value in start.items()} | dict(scene.parameter_values)
    numbers = {Symbol(name, real=True): value for name, value in begun.items()} | {Symbol("t", real=True): 0}
    at_start = {Symbol(each("S"), real=True): start[each("q1")] + start[each("q2")] for each in RATES[:2]}
    return {
        "start_of_sum": {str(symbol): value for symbol, value in at_start.items()},
        "values": scene.parameter_values,
        "multiplier_at_start": under(scene.control_law, multiplier).subs(at_start).subs(numbers),
        "multiplier_followed": float(pushed.multipliers["lambda1"][0]),
    }


def _cards(example: list[PrintedEquation], paper: Derived, laws: tuple) -> list[Card]:
    return [
        Card(place, each.number, each.name, "", True, (each,), _derived(each, paper, laws))
        for each, place in zip(example, anchors(example), strict=True)
    ]


def _derived(each: PrintedEquation, paper: Derived, laws: tuple) -> tuple[Instance, ...]:
    """Return the derived counterpart of a printed equation, none if it is given."""
    if each.number == "15":
        return (_law(laws, paper),)
    if (found := COUNTERPARTS.get(each.name)) is None:
        return ()
    equation = named_equations(paper, found.scene)[found.equation]
    one = replace(equation, relations=(equation.relations[found.place],))
    title = f"({equation.number}) {translated(equation.name)}"
    return (Instance(title, one, verdicts_on(paper, equation, found.scene)),)


def _law(laws: tuple, paper: Derived) -> Instance:
    """Return the law that was found, with its verdict on the condition (10)."""
    relations = tuple(Relation(control, from_sympy(value)) for law in laws for control, value in law.controls.items())
    condition = named_equations(paper, FREE_SCENE)["free_motion_residual"]
    verdicts = verdicts_on(paper, condition, FREE_SCENE)
    return Instance(
        gettext("the laws under which (10) vanishes for every state"), Equation("law", "15", "law", relations), verdicts
    )


def _sections(cards: list[Card]) -> list[tuple[str, list[Card]]]:
    sections: list[tuple[str, list[Card]]] = []
    for card in cards:
        title = SECTIONS.get(card.name, SECTIONS.get(card.number, ""))
        if title and title not in [known for known, _ in sections]:
            sections.append((title, []))
        sections[-1][1].append(card)
    return sections
