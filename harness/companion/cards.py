"""Cards of equations: printed and derived form, verdict, explanation."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from ..crosscheck.report import OPINION, EquationVerdict, Verdict
from ..errata import PrintedEquation
from ..language import translatable
from ..record import Equation, Scene
from .runs import Derived


@dataclass(frozen=True)
class Instance:
    """An equation as derived for one system."""

    title: str  # the system, or the scene of it
    equation: Equation
    verdicts: tuple[EquationVerdict, ...]  # verdicts of the cross-check, with the third opinion


@dataclass(frozen=True)
class Card:
    """The content of the card of one equation."""

    anchor: str  # where the card is, on its page
    # number, name: the equation number and what the equation is
    number: str
    name: str
    # of the equation in a record; empty where only the paper has it. Its plain words are under it in a template.
    id: str
    controlled: bool  # whether its system has controls to speak of
    printed: tuple[PrintedEquation, ...]  # as the paper prints it; empty if the paper does not print it
    instances: tuple[Instance, ...]  # as derived: the first is shown, the others on request


System = Derived | tuple[Derived, str]  # a derivation, or one with the name of its scene


def cards_for(
    numbers: Sequence[str], systems: Sequence[System], printed: Sequence[PrintedEquation] = (), prefix: str = ""
) -> list[Card]:
    """Return the cards of equations of systems or of their scenes.

    A prefix begins the anchors, where a page shows the cards of several scenes.

    Parameters
    ----------
    numbers : sequence of str
        Numbers of the equations.
    systems : sequence of Derived or of tuple of Derived and str
        Derivations with equations (1) to (11), or scenes with (10) and (12) to (19). The first are shown, the others on
        request.
    printed : sequence of PrintedEquation
        Equations of the paper.
    prefix : str
        Beginning of the anchors.

    Returns
    -------
    list of Card
        Cards in the order of the first record.
    """
    found = [_derivation_instances(each) if isinstance(each, Derived) else _scene_instances(*each) for each in systems]
    equations = {each.equation.id: each.equation for each in found[0] if each.equation.number in numbers}
    first = systems[0] if isinstance(systems[0], Derived) else systems[0][0]
    return [
        Card(
            place,
            each.number,
            each.name,
            each.id,
            bool(first.record.system.controls),
            tuple(one for one in printed if (one.number, one.name) == (each.number, each.name)),
            tuple(one for group in found for one in group if one.equation.id == each.id),
        )
        for place, each in zip(anchors(equations.values(), prefix), equations.values(), strict=True)
    ]


def by_anchor(cards: Iterable[Card]) -> dict[str, Card]:
    """Return cards by their anchors.

    Parameters
    ----------
    cards : iterable of Card
        Cards of a page.

    Returns
    -------
    dict of str to Card
        Cards by anchor.
    """
    return {card.anchor: card for card in cards}


def printed_card(printed: Iterable[PrintedEquation], name: str) -> Card:
    """Return the card of a printed equation without a number, by its name.

    Parameters
    ----------
    printed : iterable of PrintedEquation
        Equations of the paper.
    name : str
        Name of the equation.

    Returns
    -------
    Card
        Card of the equation.
    """
    found = next(each for each in printed if each.name == name)
    return Card(*anchors([found]), found.number, found.name, "", True, (found,), ())


def named_equations(derived: Derived, scene: str | None = None) -> dict[str, Equation]:
    """Return the equations of a derivation, of all its effects, or of a scene, by id.

    Parameters
    ----------
    derived : Derived
        Derivation with its check.
    scene : str or None
        Name of the scene, or None for the derivation.

    Returns
    -------
    dict of str to Equation
        Equations by id.
    """
    record = derived.record
    whole = max(record.derivations, key=lambda each: len(each.effects))
    found = whole.equations if scene is None else scene_named(derived, scene).equations
    return {equation.id: equation for equation in found}


def scene_named(derived: Derived, name: str) -> Scene:
    """Return the scene of that name in a record.

    Parameters
    ----------
    derived : Derived
        Derivation with its check.
    name : str
        Name of the scene.

    Returns
    -------
    Scene
        Scene of the record.
    """
    return next(scene for scene in derived.record.scenes if scene.name == name)


def verdicts_on(derived: Derived, equation: Equation, scene: str | None) -> tuple[EquationVerdict, ...]:
    """Return the verdicts on an equation of a scene, or of the derivation.

    Parameters
    ----------
    derived : Derived
        Derivation with its check.
    equation : Equation
        Equation of a record.
    scene : str or None
        Name of the scene, or None for the derivation.

    Returns
    -------
    tuple of EquationVerdict
        Verdicts on the equation.
    """
    return tuple(found for found in derived.report.verdicts if found.scene == scene and found.id == equation.id)


def missing(derived: Derived) -> list[EquationVerdict]:
    """Return the verdicts on equations that are missing in a record.

    Parameters
    ----------
    derived : Derived
        Derivation with its check.

    Returns
    -------
    list of EquationVerdict
        Verdicts on missing equations.
    """
    return [found for found in derived.report.verdicts if not found.is_recorded and found.verdict is Verdict.DISAGREES]


def anchors(equations: Iterable[Equation | PrintedEquation], prefix: str = "") -> list[str]:
    """Return anchors of equations on one page: numbers, with names if not unique.

    Parameters
    ----------
    equations : iterable of Equation or PrintedEquation
        Equations.
    prefix : str
        Beginning of the anchors.

    Returns
    -------
    list of str
        Anchors in the order of the equations.
    """
    found: list[str] = []
    for each in equations:
        short = "-".join(filter(None, [prefix, "eq", each.number]))
        named = f"{short}-{re.sub(r'[^a-z0-9]+', '-', each.name.lower()).strip('-')}"
        found.append(named if not each.number or short in found else short)
    return found


def _derivation_instances(derived: Derived) -> list[Instance]:
    """Return the equations of all derivations, those with most effects first."""
    record, several = derived.record, len(derived.record.derivations) > 1
    parts = sorted(enumerate(record.derivations), key=lambda part: len(part[1].effects), reverse=True)
    title = translatable(record.system.title)
    return [
        Instance(
            translatable("%(system)s, with %(effects)s", system=title, effects=", ".join(derivation.effects))
            if several
            else title,
            equation,
            tuple(
                found
                for found in derived.report.verdicts
                if (found.scene, found.derivation) == (None, place)
                and equation.id in (found.id, "lagrange_equations" if found.id == OPINION.id else "")
            ),
        )
        for place, derivation in parts
        for equation in derivation.equations
    ]


def _scene_instances(derived: Derived, name: str) -> list[Instance]:
    """Return the equations of a scene, none if it prescribes reactions."""
    scenes = [scene for scene in derived.record.scenes if scene.name == name]
    return [Instance(each.title, one, verdicts_on(derived, one, name)) for each in scenes for one in each.equations]
