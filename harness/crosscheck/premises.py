"""The premises of a check, and the differences of a record from them.

The premises are the described system and its scenes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields
from typing import NamedTuple

import sympy as sp
from mpmath import mp

from ..described import System
from ..description import DescribedScene, Description
from ..failures import HolonomError
from ..language import translatable
from ..record import Record, Scene
from .described_motion import DescribedMotion
from .digits import CONFIRMING_DIGITS, DIGITS, WORKING_DIGITS
from .evaluation import Steps
from .irregular_point import IrregularPoint
from .law import Law, is_switched
from .motion_start import nearer_start
from .system import exact
from .taylor import Taylor

TIMES = 4
"""Number of times after the first at which a law, fixed around it, is compared with the stated one."""

SHORTEST = mp.mpf(2) ** -27
"""Time between two of them."""


@dataclass(frozen=True)
class Premises:
    """A description, as the record is compared with it."""

    description: Description

    @property
    def system(self) -> System:
        """The system."""
        return self.description.system

    @property
    def scenes(self) -> tuple[DescribedScene, ...]:
        """The scenes that a record holds.

        Scenes under prescribed reactions and servo-constraints move other systems.
        """
        scenes = self.description.scenes
        return tuple(scene for scene in scenes if not scene.prescribed_reactions and not scene.servo_trees)


class Difference(NamedTuple):
    """A difference of a record from the description, in the system or a named scene."""

    what: str
    detail: str
    scene: str | None = None


def differences(record: Record, premises: Premises) -> Iterator[Difference]:
    """Yield the differences of the record's system, scenes and effects.

    Parameters
    ----------
    record : Record
    premises : Premises
        The premises of the check.

    Yields
    ------
    Difference
        One difference.
    """
    for field in fields(System):
        recorded, stated = getattr(record.system, field.name), getattr(premises.system, field.name)
        if recorded != stated:
            yield Difference(f"system.{field.name}", _difference(recorded, stated))
    names = tuple(scene.name for scene in premises.scenes)
    if (recorded := tuple(scene.name for scene in record.scenes)) != names:
        yield Difference("scenes", _difference(recorded, names))
    else:
        for scene, stated in zip(record.scenes, premises.scenes, strict=True):
            yield from _differences_of_scene(scene, DescribedMotion(premises.description, stated))
    yield from _differences_of_effects(record, premises)


def _differences_of_scene(scene: Scene, motion: DescribedMotion) -> Iterator[Difference]:
    stated = motion.scene
    switched = any(map(is_switched, stated.control_law.trees.values()))
    recorded = {
        "title": (scene.title, stated.title),
        "effects": (scene.effects, stated.effects),
        "observe": (scene.observe, stated.observe),
        "parameter_values": (dict(scene.parameter_values), dict(stated.parameter_values)),
        "time_span": (scene.time_span, stated.time_span),
        "given": (scene.given, tuple(stated.initial_state)),
        "law_around_start": (scene.law_around_start, switched),
    }
    if not switched:
        recorded["control_law"] = (dict(scene.control_law), dict(stated.control_law))
    elif detail := _law_differs(scene, motion):
        yield Difference("control_law", detail, scene.name)
    if detail := _nearer_start(scene, motion):
        yield Difference("initial_guess", detail, scene.name)
    for what, (found, belongs) in recorded.items():
        if found != belongs or _order(found) != _order(belongs):
            yield Difference(what, _difference(found, belongs), scene.name)


def _law_differs(scene: Scene, motion: DescribedMotion) -> str:
    """Return the name of a law that differs around the first time, empty if none does."""
    if list(scene.control_law) != list(motion.scene.control_law):
        return _difference(scene.control_law, motion.scene.control_law)
    with mp.workdps(CONFIRMING_DIGITS):
        recorded_law = Law(scene.control_law.trees, motion.splines)
        parameters = {name: (mp.mpf(k) / 7,) for k, name in enumerate(motion.system.parameters, 8)}
        parameters |= motion.parameters()
        for k in range(1, TIMES + 1):
            time = motion.first_time + k * SHORTEST
            try:
                found, stated = (law.at(Taylor(0), time, parameters) for law in (recorded_law, motion.law))
            except IrregularPoint:
                return translatable("the law has no value at t = %(time)s", time=mp.nstr(time, 12))
            for name, (belongs,) in stated.items():
                if abs(found[name][0] - belongs) > mp.mpf(10) ** -DIGITS * abs(belongs):
                    return translatable(
                        "%(name)s is %(found)s, where %(stated)s is stated, at t = %(time)s",
                        name=name,
                        found=str(found[name][0]),
                        stated=str(belongs),
                        time=mp.nstr(time, 12),
                    )
    return ""


def _nearer_start(scene: Scene, motion: DescribedMotion) -> str:
    """Return an initial value with another nearer to the scene's guess, empty if none."""
    if not motion.scene.initial_guess or list(scene.initial_state) != _state_of(motion):
        return ""
    try:
        with mp.workdps(WORKING_DIGITS):
            parameters = {sp.Symbol(name, real=True): value for name, (value,) in motion.parameters().items()}
            values = Steps([exact(value) for value in scene.initial_state.values()]).at(parameters)
            start = dict(zip(scene.initial_state, values, strict=True)) | {"t": motion.first_time}
            return "" if None in values else nearer_start(motion, start)
    except HolonomError:  # a parameter or a control is left open
        return ""


def _state_of(motion: DescribedMotion) -> list[str]:
    return [*motion.system.coordinates, *motion.system.velocities]


def _differences_of_effects(record: Record, premises: Premises) -> Iterator[Difference]:
    system = premises.system
    parts = (*system.kinetic_energy, *system.potential_energy, *system.forces)
    everything = tuple(sorted({*system.switches, *(part.effect for part in parts)}))  # as Maxima's sets are
    stated = list(dict.fromkeys(scene.effects for scene in premises.scenes))
    recorded = [derived.effects for derived in record.derivations]
    if premises.scenes and recorded != stated:
        yield Difference("derivations", _difference(recorded, stated))
    elif not premises.scenes and recorded != [everything]:
        yield Difference("derivations", _difference(recorded, [everything]))
    for scene in record.scenes:
        if scene.derivation >= len(recorded) or recorded[scene.derivation] != scene.effects:
            yield Difference("derivation", translatable("its effects are not those of the scene"), scene.name)


def _order(found: object) -> object:
    return list(found) if isinstance(found, Mapping) else found


def _difference(recorded: object, stated: object) -> str:
    return translatable(
        "the record has %(recorded)s, the description %(stated)s", recorded=_short(recorded), stated=_short(stated)
    )


def _short(value: object, most: int = 120) -> str:
    text = ", ".join(map(str, value)) if isinstance(value, Iterable) and not isinstance(value, str) else str(value)
    return text if len(text) <= most else f"{text[:most]}..."
