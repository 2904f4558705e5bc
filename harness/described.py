"""A described system before the derivation: T, V, Q and f as names and trees.

Trees are those of `holonom.expression.trees`. SymPy expressions are made of them, and SymPy is imported, at the first
use.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from .expression.trees import Tree
from .structs import key

if TYPE_CHECKING:
    from sympy import Expr

Result = TypeVar("Result")


@dataclass(frozen=True)
class Effect:
    """A named part of the kinetic or of the potential energy."""

    effect: str
    tree: Tree = key("value")

    @cached_property
    def value(self) -> "Expr":
        """The energy."""
        return expression(self.tree)


@dataclass(frozen=True)
class ForceEffect:
    """A named part of the generalized forces, one component a coordinate."""

    effect: str
    trees: tuple[Tree, ...] = key("value")

    @cached_property
    def value(self) -> "tuple[Expr, ...]":
        """The forces."""
        return each(expression, self.trees)


@dataclass(frozen=True)
class System:
    """A system as its scene file describes it, before the derivation."""

    title: str  # what the system is
    source: str | None  # where it is published
    time: str  # name of the time
    # coordinates, velocities, accelerations: names of q, dot(q) and ddot(q)
    coordinates: tuple[str, ...]
    velocities: tuple[str, ...]
    accelerations: tuple[str, ...]
    # controls, control_rates, control_accelerations: names of u, dot(u) and ddot(u)
    controls: tuple[str, ...]
    control_rates: tuple[str, ...]
    control_accelerations: tuple[str, ...]
    parameters: tuple[str, ...]  # names of the constants
    multipliers: tuple[str, ...]  # names of the constraint multipliers
    # kinetic_energy, potential_energy: T and V as sums of named parts
    kinetic_energy: tuple[Effect, ...]
    potential_energy: tuple[Effect, ...]
    forces: tuple[ForceEffect, ...]  # Q as a sum of named parts
    constraint_trees: tuple[Tree, ...] = key("constraints")  # each is zero on every motion
    switches: tuple[str, ...] = ()  # names in T, V and Q that are 1 where a scene calls for them, else 0

    @cached_property
    def constraints(self) -> "tuple[Expr, ...]":
        """The g constraints."""
        return each(expression, self.constraint_trees)


class Correction(NamedTuple):
    """A change of an initial value to satisfy the constraints."""

    name: str
    size: str  # in decimal digits


class Values(Mapping[str, "Expr"]):
    """Expressions by name."""

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


def each(read: Callable[[Any], Result], items: Sequence[Any]) -> tuple[Result, ...]:
    """Read each item of a sequence.

    Parameters
    ----------
    read : callable
        Takes an item to its value.
    items : sequence
        Parts of a document.

    Returns
    -------
    tuple
    """
    return tuple(read(item) for item in items)
