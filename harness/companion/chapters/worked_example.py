"""The worked example of section 4: each equation as printed, and as derived."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import dropwhile
from pathlib import Path
from typing import Any

import sympy

from ...errata import PrintedEquation
from ...mathjson import from_sympy
from ...record import Equation, Relation
from ..cards import Card, Instance, anchors, files_of, named_equations, scene_named, verdicts_on
from ..chapter import Chapter, Page
from ..examples import FREE_SCENE, INITIAL_SCENE, PAPER
from ..excerpts import excerpt
from ..expressions import right_side, under, zeros
from ..runs import Derived, derived, free, printed
from ..steps import step

FIRST_NUMBER = "14"


@dataclass(frozen=True)
class Counterpart:
    """What stands in the record against a printed equation of the example.

    Attributes
    ----------
    equation : str
        The record's name for it.
    place : int
        Which of its relations.
    scene : str or None
        The scene that it belongs to; None for an equation of the derivation.
    """

    equation: str
    place: int = 0
    scene: str | None = None


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
    "14": "The system",
    "condition of free motion of the example": "Free motion",
    "equation of motion of q1": "Equations of motion",
    "initial state of the example": "Initial motion",
}
"""Titles of the chapter's sections, by the number or name of the equation that each begins with."""


def chapter(root: Path) -> Chapter:
    """The chapter, with the systems under a root."""

    def page(results: Mapping[str, Any]) -> Page:
        paper = results["paper"]
        example = list(dropwhile(lambda each: each.number != FIRST_NUMBER, results["printed"]))
        cards = _cards(example, paper, results["free"].universal.laws, root)
        derived_multiplier = named_equations(paper)["multipliers"].relations[0].right
        printed_multiplier = right_side(next(each for each in example if each.name == "multiplier").printed_tree)
        laws = {name: scene_named(paper, name).control_law for name in (FREE_SCENE, INITIAL_SCENE)}
        return Page(
            {
                "sections": _sections(cards),
                "equations": len(example),
                "misprints": [each for each in example if not each.agrees],
                "initial": [each for each in example if each.number == "17"],
                "multiplier": named_equations(paper)["multipliers"],
                "anchors": {(card.number, card.name): card.anchor for card in cards},
                "roots": (roots := zeros(sympy.fraction(derived_multiplier)[1])),
                "real": any(each.is_real for each in roots),
                "derived_under_law": under(laws[FREE_SCENE], derived_multiplier),
                "printed_under_law": under(laws[FREE_SCENE], printed_multiplier),
                "difference": under(laws[INITIAL_SCENE], derived_multiplier - printed_multiplier),
            },
            sources=files_of(cards),
        )

    return Chapter(
        slug="worked-example",
        title="The worked example",
        aim="Section 4 of the paper, equation by equation: as printed, and as derived.",
        template="worked_example.html",
        runs={"paper": derived(root / PAPER), "printed": printed(), "free": free(root / PAPER, INITIAL_SCENE)},
        page=page,
    )


def _cards(example: list[PrintedEquation], paper: Derived, laws: tuple, root: Path) -> list[Card]:
    cards: list[Card] = []
    for each, place in zip(example, anchors(example), strict=True):
        instances, lines = _derived(each, paper, laws, root)
        cards.append(Card(place, each.number, each.name, "", True, (each,), instances, lines))
    return cards


def _derived(each: PrintedEquation, paper: Derived, laws: tuple, root: Path) -> tuple[tuple, tuple]:
    """The instance against a printed equation and the lines that derive it; none where it is given, not derived."""
    if each.number == "15":
        universal = "maxima/free_motion/universal.mac"
        lines = tuple(
            excerpt(root, universal, name) for name in ("universal_controls", "solved_conditions", "solved_linear")
        )
        return (_law(laws, paper),), lines
    if (found := COUNTERPARTS.get(each.name)) is None:
        return (), ()
    equation = named_equations(paper, found.scene)[found.equation]
    one = replace(equation, relations=(equation.relations[found.place],))
    title = f"({equation.number}) {equation.name}"
    return (Instance(title, one, verdicts_on(paper, equation, found.scene)),), step(root, equation.id)


def _law(laws: tuple, paper: Derived) -> Instance:
    """The law found, with the verdict that it leaves nothing of the condition (10)."""
    relations = tuple(Relation(control, from_sympy(value)) for law in laws for control, value in law.controls.items())
    condition = named_equations(paper, FREE_SCENE)["free_motion_residual"]
    verdicts = verdicts_on(paper, condition, FREE_SCENE)
    return Instance(
        "the laws under which (10) vanishes for every state", Equation("law", "15", "law", relations), verdicts
    )


def _sections(cards: list[Card]) -> list[tuple[str, list[Card]]]:
    sections: list[tuple[str, list[Card]]] = []
    for card in cards:
        title = SECTIONS.get(card.name, SECTIONS.get(card.number, ""))
        if title and title not in [known for known, _ in sections]:
            sections.append((title, []))
        sections[-1][1].append(card)
    return sections
