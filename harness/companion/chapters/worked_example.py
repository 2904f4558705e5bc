"""The worked example of section 4: each equation as printed, and as derived."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import dropwhile
from typing import Any

import sympy
from sympy import Expr, Symbol

from ...errata import PrintedEquation
from ...figures.curves import Panel, draw_curves
from ...language import gettext, translatable, translated
from ...mathjson import from_sympy
from ...record import Equation, Relation
from ...simulation.result import Simulation
from ..cards import Card, Instance, anchors, named_equations, scene_named, verdicts_on
from ..chapter import Page
from ..expressions import right_side, under, zeros
from ..power import values_along
from ..runs import Derived, derived, free, printed, simulation
from . import FREE_SCENE, INITIAL_SCENE, PAPER

FIRST_NUMBER = "14"
UNTIL, SAMPLES = Fraction(3), 2001
RATES = ("{}".format, "dot({})".format, "ddot({})".format)  # names of a quantity and its time derivatives


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


RUNS = {
    "paper": derived(PAPER),
    "printed": printed(),
    "free": free(PAPER, INITIAL_SCENE),
    "pushed": simulation(PAPER, INITIAL_SCENE, UNTIL, SAMPLES),
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
    example = list(dropwhile(lambda each: each.number != FIRST_NUMBER, results["printed"]))
    cards = _cards(example, paper, results["free"].universal.laws)
    derived_multiplier = named_equations(paper)["multipliers"].relations[0].right
    printed_multiplier = right_side(next(each for each in example if each.name == "multiplier").printed_tree)
    laws = {name: scene_named(paper, name).control_law for name in (FREE_SCENE, INITIAL_SCENE)}
    return Page(
        {
            **multiplier_at_start(paper, results["pushed"]),
            "scene": scene_named(paper, INITIAL_SCENE),
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
        figures={
            "misprint": draw_curves(
                [_printed_and_derived(paper, printed_multiplier, results["pushed"])], gettext("t (dimensionless)")
            )
        },
    )


def in_sum(expression: Expr) -> Expr:
    """Return an expression of the example in terms of S = q1 + q2.

    Parameters
    ----------
    expression : Expr
        SymPy expression.

    Returns
    -------
    Expr
        Expression in S.
    """
    replaced = {
        Symbol(name("q2"), real=True): Symbol(name("S"), real=True) - Symbol(name("q1"), real=True) for name in RATES
    }
    found = sympy.simplify(expression.subs(replaced))
    return sympy.collect(
        sympy.expand(sympy.numer(found)), [Symbol(name("S"), real=True) for name in RATES]
    ) / sympy.factor(sympy.denom(found))


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


def _printed_and_derived(paper: Derived, printed: Expr, pushed: Simulation) -> Panel:
    """Return the multiplier of the second task, as derived and as printed."""
    values = values_along(printed, scene_named(paper, INITIAL_SCENE), pushed)
    shown = {gettext("as derived"): pushed.multipliers["lambda1"], gettext("by the formula in print"): values}
    return Panel(gettext("multiplier λ₁ (dimensionless)"), {name: (pushed.times, each) for name, each in shown.items()})


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
