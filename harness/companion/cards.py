"""Cards of equations: printed and derived form, verdict, explanation."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from ..crosscheck.report import OPINION, EquationVerdict
from ..errata import PrintedEquation
from ..language import translatable
from ..record import Derivation, Equation, Scene
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
) -> dict[str, Card]:
    """Return the cards of equations of systems or of their scenes, by their anchors.

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
    dict of str to Card
        Cards in the order of the first record.
    """
    found = [_instances(each) for each in systems]
    first = systems[0] if isinstance(systems[0], Derived) else systems[0][0]
    equations = {each.equation.id: each.equation for each in found[0] if each.equation.number in numbers}
    return {
        place: Card(
            place,
            each.number,
            each.name,
            each.id,
            bool(first.record.system.controls),
            tuple(one for one in printed if (one.number, one.name) == (each.number, each.name)),
            tuple(one for group in found for one in group if one.equation.id == each.id),
        )
        for place, each in zip(anchors(equations.values(), prefix), equations.values(), strict=True)
    }


def printed_cards(printed: Iterable[PrintedEquation]) -> dict[str, Card]:
    """Return the cards of the printed equations without a number, by their names.

    Parameters
    ----------
    printed : iterable of PrintedEquation
        Equations of the paper.

    Returns
    -------
    dict of str to Card
        Cards by name.
    """
    found = [each for each in printed if not each.number]
    return {
        each.name: Card(place, "", each.name, "", True, (each,), ())
        for place, each in zip(anchors(found), found, strict=True)
    }


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
    whole = _most_effects_first(derived)[0][1] if scene is None else scene_named(derived, scene)
    return {equation.id: equation for equation in whole.equations}


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


def verdicts_on(
    derived: Derived, equation: Equation, scene: str | None, derivation: int = 0
) -> tuple[EquationVerdict, ...]:
    """Return the verdicts on an equation of a scene, or of a derivation.

    Parameters
    ----------
    derived : Derived
        Derivation with its check.
    equation : Equation
        Equation of a record.
    scene : str or None
        Name of the scene, or None for the derivation.
    derivation : int
        Place of the derivation in the record.

    Returns
    -------
    tuple of EquationVerdict
        Verdicts on the equation.
    """
    names = {equation.id, OPINION.id if equation.id == "lagrange_equations" else equation.id}
    found = (each for each in derived.report.verdicts if each.id in names)
    return tuple(each for each in found if (each.scene, each.derivation) == (scene, derivation))


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


def _instances(system: System) -> list[Instance]:
    """Return the equations of a scene, or of all derivations of a system.

    A scene that prescribes reactions is not in the record, and has none.
    """
    derived, name = (system, None) if isinstance(system, Derived) else system
    if name is None:
        parts = [(_title(derived, each), each.equations, place) for place, each in _most_effects_first(derived)]
    else:
        scenes = (each for each in derived.record.scenes if each.name == name)
        parts = [(each.title, each.equations, each.derivation) for each in scenes]
    return [
        Instance(title, equation, verdicts_on(derived, equation, name, place))
        for title, equations, place in parts
        for equation in equations
    ]


def _most_effects_first(derived: Derived) -> list[tuple[int, Derivation]]:
    return sorted(enumerate(derived.record.derivations), key=lambda part: len(part[1].effects), reverse=True)


def _title(derived: Derived, derivation: Derivation) -> str:
    """Return the title of a system, with effects if there are several derivations."""
    title, effects = translatable(derived.record.system.title), ", ".join(derivation.effects)
    several = len(derived.record.derivations) > 1
    return translatable("%(system)s, with %(effects)s", system=title, effects=effects) if several else title
