"""The worked example of section 4: each equation as printed, and as derived."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from ..errata import PrintedEquation
from ..expression.mathjson import from_sympy
from ..free_motion import UniversalLaw
from ..language import gettext, translated
from ..record import Equation, Relation
from . import FREE_SCENE, INITIAL_SCENE
from .cards import Card, Instance, anchors, named_equations, verdicts_on
from .runs import Derived

DATA = {"kinetic energy", "generalized forces", "initial state of the example", "control law of the initial motion"}
BEFORE_THE_LAW = ("constraints", "free_motion_condition")
AFTER_THE_LAW = ("driven_accelerations", "multipliers", "accelerations")
OF_THE_SCENE = ("initial_accelerations", "initial_series", "determined_initial_values")


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
    derived = _in_order_of_the_paper(paper, laws)
    return [
        Card(place, each.number, each.name, "", True, (each,), () if each.name in DATA else (next(derived),))
        for each, place in zip(example, anchors(example), strict=True)
    ]


def _in_order_of_the_paper(paper: Derived, laws: Sequence[UniversalLaw]) -> Iterator[Instance]:
    """Yield the derived relations of the example, those of the second task last."""
    yield from _relations(paper, None, BEFORE_THE_LAW)
    yield _law(laws, paper)
    yield from _relations(paper, None, AFTER_THE_LAW)
    yield from _relations(paper, INITIAL_SCENE, OF_THE_SCENE)


def _relations(paper: Derived, scene: str | None, names: Sequence[str]) -> Iterator[Instance]:
    """Yield the relations of equations one by one, with the verdicts on the equations."""
    for equation in map(named_equations(paper, scene).get, names):
        title = f"({equation.number}) {translated(equation.name)}"
        for relation in equation.relations:
            yield Instance(title, replace(equation, relations=(relation,)), verdicts_on(paper, equation, scene))


def _law(laws: Sequence[UniversalLaw], paper: Derived) -> Instance:
    """Return the law that was found, with its verdict on the condition (10)."""
    relations = tuple(Relation(control, from_sympy(value)) for law in laws for control, value in law.controls.items())
    verdicts = verdicts_on(paper, named_equations(paper, FREE_SCENE)["free_motion_residual"], FREE_SCENE)
    title = gettext("the laws under which (10) vanishes for every state")
    return Instance(title, Equation("law", "15", "law", relations), verdicts)
