"""The worked example of section 4: each equation as printed, and as derived."""

from collections.abc import Sequence
from dataclasses import replace

from ..errata import PrintedEquation
from ..free_motion import UniversalLaw
from ..language import gettext, translated
from ..mathjson import from_sympy
from ..record import Equation, Relation
from . import FREE_SCENE, INITIAL_SCENE
from .cards import Card, Instance, anchors, named_equations, verdicts_on
from .runs import Derived

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


def worked_cards(example: Sequence[PrintedEquation], paper: Derived, laws: Sequence[UniversalLaw]) -> list[Card]:
    """Return the cards of the printed equations of the example.

    Parameters
    ----------
    example : sequence of PrintedEquation
        Equations of section 4.
    paper : Derived
        Derivation of the paper's example.
    laws : sequence of UniversalLaw
        Control laws under which every motion is free.

    Returns
    -------
    list of Card
        Cards in the order of the paper.
    """
    return [
        Card(place, each.number, each.name, "", True, (each,), _derived(each, paper, laws))
        for each, place in zip(example, anchors(example), strict=True)
    ]


def _derived(each: PrintedEquation, paper: Derived, laws: Sequence[UniversalLaw]) -> tuple[Instance, ...]:
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


def _law(laws: Sequence[UniversalLaw], paper: Derived) -> Instance:
    """Return the law that was found, with its verdict on the condition (10)."""
    relations = tuple(Relation(control, from_sympy(value)) for law in laws for control, value in law.controls.items())
    verdicts = verdicts_on(paper, named_equations(paper, FREE_SCENE)["free_motion_residual"], FREE_SCENE)
    title = gettext("the laws under which (10) vanishes for every state")
    return Instance(title, Equation("law", "15", "law", relations), verdicts)
