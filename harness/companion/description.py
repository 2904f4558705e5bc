"""A system as its scene file describes it, typeset."""

from collections.abc import Iterator

import sympy
from markupsafe import Markup
from sympy import Expr, IndexedBase, Symbol

from ..record import System
from .mathematics import display


def description(system: System) -> list[Markup]:
    """T, V, Q and f of a system, those that it has."""
    return [display(left, right) for left, right in _parts(system)]


def _parts(system: System) -> Iterator[tuple[Expr, Expr]]:
    yield _letter("T"), sympy.Add(*(effect.value for effect in system.kinetic_energy))
    if system.potential_energy:
        yield _letter("V"), sympy.Add(*(effect.value for effect in system.potential_energy))
    if system.forces:
        for s, components in enumerate(zip(*(effect.value for effect in system.forces), strict=True), 1):
            yield IndexedBase(_letter("Q"))[s], sympy.Add(*components)
    for beta, constraint in enumerate(system.constraints, 1):
        yield IndexedBase(_letter("f"))[beta], constraint


def _letter(name: str) -> Symbol:
    return Symbol(name, real=True)
