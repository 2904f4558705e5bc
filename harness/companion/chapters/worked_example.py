"""The worked example of section 4: each equation as printed, and as derived."""

from collections.abc import Mapping
from dataclasses import replace
from itertools import dropwhile
from typing import Any

import sympy
from sympy import Symbol

from ...errata import PrintedEquation
from ...language import gettext, translatable, translated
from ...mathjson import from_sympy
from ...record import Equation, Relation
from ..cards import Card, Instance, anchors, named_equations, scene_named, verdicts_on
from ..expressions import RATES, right_side, under, zeros
from ..power import values_along
from ..runs import Derived
from . import FREE_SCENE, INITIAL_SCENE

FIRST_NUMBER = "14"
OF_COORDINATES = {
    "equation of motion of": ("driven_accelerations", None),
    "acceleration of": ("accelerations", None),
    "initial acceleration of": ("initial_accelerations", INITIAL_SCENE),
    "initial motion of": ("initial_series", INITIAL_SCENE),
}
COUNTERPARTS = {
    "constraint": ("constraints", None, 0),
    "condition of free motion of the example": ("free_motion_condition", None, 0),
    "multiplier": ("multipliers", None, 0),
    "initial value q3_0": ("determined_initial_values", INITIAL_SCENE, 0),
    "initial value dot(q3_0)": ("determined_initial_values", INITIAL_SCENE, 1),
    **{f"{name} q{k + 1}": (*equation, k) for name, equation in OF_COORDINATES.items() for k in range(3)},
}
"""The equation of the record that belongs to a printed one, its scene (None: the derivation), and which relation."""

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
    paper, pushed = results["paper"], results["pushed"]
    example = list(dropwhile(lambda each: each.number != FIRST_NUMBER, results["printed"]))
    laws = results["free"].universal.laws
    cards = [
        Card(place, each.number, each.name, "", True, (each,), _derived(each, paper, laws))
        for each, place in zip(example, anchors(example), strict=True)
    ]
    derived = named_equations(paper)["multipliers"].relations[0].right
    printed = right_side(next(each for each in example if each.name == "multiplier").printed_tree)
    scene, free_law = scene_named(paper, INITIAL_SCENE), scene_named(paper, FREE_SCENE).control_law
    start = scene.initial_state
    begun = {Symbol(name, real=True): value for name, value in {**start, **scene.parameter_values, "t": 0}.items()}
    return {
        "start_of_sum": {name("S"): start[name("q1")] + start[name("q2")] for name in RATES[:2]},
        "values": scene.parameter_values,
        "multiplier_at_start": under(scene.control_law, derived).subs(begun),
        "multiplier_followed": float(pushed.multipliers["lambda1"][0]),
        "example": example,
        "sections": _sections(cards),
        "anchors": {(card.number, card.name): card.anchor for card in cards},
        "roots": zeros(sympy.fraction(derived)[1]),
        "derived_under_law": under(free_law, derived),
        "printed_under_law": under(free_law, printed),
        "difference": under(scene.control_law, derived - printed),
        "printed_along": values_along(printed, scene, pushed),
    }


def _derived(each: PrintedEquation, paper: Derived, laws: tuple) -> tuple[Instance, ...]:
    """Return the derived counterpart of a printed equation, none if it is given."""
    if each.number == "15":
        return (_law(laws, paper),)
    if each.name not in COUNTERPARTS:
        return ()
    name, scene, place = COUNTERPARTS[each.name]
    equation = named_equations(paper, scene)[name]
    one = replace(equation, relations=(equation.relations[place],))
    title = f"({equation.number}) {translated(equation.name)}"
    return (Instance(title, one, verdicts_on(paper, equation, scene)),)


def _law(laws: tuple, paper: Derived) -> Instance:
    """Return the law that was found, with its verdict on the condition (10)."""
    relations = tuple(Relation(control, from_sympy(value)) for law in laws for control, value in law.controls.items())
    verdicts = verdicts_on(paper, named_equations(paper, FREE_SCENE)["free_motion_residual"], FREE_SCENE)
    title = gettext("the laws under which (10) vanishes for every state")
    return Instance(title, Equation("law", "15", "law", relations), verdicts)


def _sections(cards: list[Card]) -> list[tuple[str, list[Card]]]:
    """Return the cards of each section, by its title."""
    title, sections = "", {}
    for card in cards:
        title = SECTIONS.get(card.name, SECTIONS.get(card.number, title))
        sections.setdefault(title, []).append(card)
    return list(sections.items())
