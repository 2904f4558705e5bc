"""A described system before the derivation: T, V, Q and f as names and trees.

Trees are those of `holonom.expression.trees`. SymPy expressions are made of them, and SymPy is imported, at the first
use.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, ClassVar, NamedTuple, TypeVar

from .expression.trees import Tree
from .structs import entry, with_attributes

if TYPE_CHECKING:
    from sympy import Expr

Result = TypeVar("Result")


class Shape(StrEnum):
    """A shape of a drawing."""

    POINT = "point"
    SEGMENT = "segment"
    POLYLINE = "polyline"
    CIRCLE = "circle"


@dataclass(frozen=True)
class Effect:
    """A named part of the kinetic or of the potential energy."""

    effect: str = entry("Name of the effect.")
    tree: Tree = entry("Energy as an expression.", key="value")

    @cached_property
    def value(self) -> "Expr":
        """The energy."""
        return expression(self.tree)


@dataclass(frozen=True)
class ForceEffect:
    """A named part of the generalized forces, one component a coordinate."""

    effect: str = entry("Name of the effect.")
    trees: tuple[Tree, ...] = entry("Generalized forces, one a coordinate.", key="value")

    @cached_property
    def value(self) -> "tuple[Expr, ...]":
        """The forces."""
        return tuple(map(expression, self.trees))


@with_attributes
@dataclass(frozen=True)
class System:
    """A system as its scene file describes it, before the derivation."""

    title: str = entry("Title of the system.")
    source: str | None = entry("Publication that describes the system.")
    time: str = entry("Name of the time.")
    coordinates: tuple[str, ...] = entry("Names of the coordinates.")
    velocities: tuple[str, ...] = entry("Names of the velocities, one a coordinate.")
    accelerations: tuple[str, ...] = entry("Names of the accelerations, one a coordinate.")
    controls: tuple[str, ...] = entry("Names of the controls.")
    control_rates: tuple[str, ...] = entry("Names of the first derivatives of the controls.")
    control_accelerations: tuple[str, ...] = entry("Names of the second derivatives of the controls.")
    parameters: tuple[str, ...] = entry("Names of the parameters.")
    multipliers: tuple[str, ...] = entry("Names of the multipliers, one a constraint.")
    kinetic_energy: tuple[Effect, ...] = entry("Kinetic energy by effects.")
    potential_energy: tuple[Effect, ...] = entry("Potential energy by effects.")
    forces: tuple[ForceEffect, ...] = entry("Generalized forces by effects.")
    constraint_trees: tuple[Tree, ...] = entry("Constraints f(q, t, u) = 0.", key="constraints")
    switches: tuple[str, ...] = entry(
        "Names in T, V and Q: 1 where a derivation has them among its effects, else 0.", ()
    )
    orientation_trees: tuple[Tree, ...] = entry("Expressions whose signs no motion changes.", (), key="orientations")

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the quantities and of the initial coordinates."""
        own = (*self.coordinates, *self.controls, *self.parameters, *self.switches)
        return (*own, *self.multipliers, *(f"{q}_0" for q in self.coordinates))

    @cached_property
    def constraints(self) -> "tuple[Expr, ...]":
        """The g constraints."""
        return tuple(map(expression, self.constraint_trees))

    @cached_property
    def orientations(self) -> "tuple[Expr, ...]":
        """The expressions whose signs no motion changes."""
        return tuple(map(expression, self.orientation_trees))


class SystemTitle(NamedTuple):
    """The title of a system and its source."""

    title: Annotated[str, "Title of the system."]
    source: Annotated[str | None, "Publication that describes the system."]


class Correction(NamedTuple):
    """A change of an initial value to satisfy the constraints."""

    name: Annotated[str, "Coordinate or velocity that was changed."]
    size: Annotated[str, "Size of the change, in decimal digits."]


class Values(Mapping[str, "Expr"]):
    """Expressions by name."""

    SHAPE: ClassVar = {"type": "object", "additionalProperties": {"type": ["integer", "string", "array", "object"]}}

    def __init__(self, trees: Mapping[str, Tree]) -> None:
        self.trees = trees
        self._made: dict[str, Expr] = {}

    def __getitem__(self, name: str) -> "Expr":
        if name not in self._made:
            self._made[name] = expression(self.trees[name])
        return self._made[name]

    def __contains__(self, name: object) -> bool:
        return name in self.trees

    def __iter__(self) -> Iterator[str]:
        return iter(self.trees)

    def __len__(self) -> int:
        return len(self.trees)


def expression(tree: Tree) -> "Expr":
    """Make a SymPy expression of a tree.

    Parameters
    ----------
    tree : Tree
        A tree of `holonom.expression.trees`.

    Returns
    -------
    SymPy expression
    """
    from .expression.mathjson import to_sympy

    return to_sympy(tree)
