"""The equations that a record must hold, their order and names.

They are known before any of them is read, but for closed forms whose predicted length is beyond a limit: these are
there if they come out within it (`has_closed_forms`). The prediction is Maxima's: symbols and operations of T, V, Q
and f, times g! for the multipliers, times b! for the largest block of coordinates that a row of the mass matrix
couples, times r + 1 for r different roots. It is repeated here.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import factorial, inf

import sympy as sp

from ..described import System
from ..expression.trees import Tree
from ..record import LARGEST_SIZE, Derivation, Equation
from .displayed import displayed, operations, roots, size
from .report import Item
from .system import MechanicalSystem, gradient

LARGEST_TRIED_SIZE = 10000  # up to which closed forms may be there beyond the limit, as Maxima's largest_tried_size
CLOSED_NUMBERS = ("4", "5", "8", "9", "10", "11")
"""Numbers of the equations that are left out where closed forms would be too long."""


ZEROS_LEFT_OUT = ", without the zeros off the diagonal of A"


def derivation_items(closed: bool, regular: bool, redundant: Sequence[str], all_entries: bool) -> tuple[Item, ...]:
    """Return the equations of a derivation, in their order.

    Parameters
    ----------
    closed : bool
        True if closed forms are made.
    regular : bool
        True if the mass matrix is regular.
    redundant : sequence of str
        Multipliers of redundant constraints.
    all_entries : bool
        True if (3a) holds the zeros of A as well.

    Returns
    -------
    tuple of Item
    """
    inverse = "inverse of the mass matrix" + ("" if regular else " with J^T J added, which is singular without")
    items = (
        Item("constraints", "1", "constraints"),
        Item("lagrange_equations", "2", "Lagrange's equations with multipliers"),
        Item(
            "kinetic_energy", "3a", "kinetic energy, split into A, B and T0" + ("" if all_entries else ZEROS_LEFT_OUT)
        ),
        Item("expanded_equations", "3", "equations of motion, expanded"),
        Item("driven_accelerations", "4", "accelerations, with multipliers"),
        Item("inverse_mass_matrix", "5", inverse),
        Item("christoffel_symbols", "6", "Christoffel symbols of the first kind"),
        Item("constraint_accelerations", "7", "constraints, differentiated twice"),
        Item("multiplier_equations", "8", "equations for the multipliers"),
        Item("multipliers", "8", _multipliers_in_words(redundant)),
        Item("constraint_forces", "9", "constraint forces"),
        Item("free_motion_condition", "10", "condition of free motion"),
        Item("accelerations", "11", "accelerations, multipliers eliminated"),
    )
    return tuple(item for item in items if closed or item.number not in CLOSED_NUMBERS)


def scene_items(closed: bool, series: bool, law: bool) -> tuple[Item, ...]:
    """Return the equations of a scene, in their order.

    Parameters
    ----------
    closed : bool
        True if closed forms are made.
    series : bool
        True if the initial series is made.
    law : bool
        True if the scene has a control law.

    Returns
    -------
    tuple of Item
    """
    items = (
        (closed and law, Item("free_motion_residual", "10", "condition of free motion under the control law")),
        (True, Item("initial_state", "12", "initial state")),
        (True, Item("determined_initial_values", "19", "initial values that the constraints fix")),
        (closed, Item("initial_accelerations", "13", "initial accelerations")),
        (closed and series, Item("initial_series", "18", "initial motion, as a series")),
    )
    return tuple(item for is_there, item in items if is_there)


def scene_numbers_left_out(closed: bool, series: bool, law: bool) -> tuple[str, ...]:
    """Return numbers of the equations of a scene that are left out for their length.

    Parameters
    ----------
    closed : bool
        True if closed forms are made.
    series : bool
        True if the initial series is made.
    law : bool
        True if the scene has a control law.

    Returns
    -------
    tuple of str
    """
    if closed:
        return () if series else ("18",)
    return (*(("10",) if law else ()), "13", "18")


def _multipliers_in_words(redundant: Sequence[str]) -> str:
    return "multipliers, not unique: zero for redundant constraints" if redundant else "multipliers"


def predicted_size(system: System, derived: Derivation, known: MechanicalSystem, limit: int) -> float:
    """Predict the length of closed forms, infinite if forces contain multipliers.

    Parameters
    ----------
    system : System
        The described system.
    derived : Derivation
        Derivation of the record, with its effects.
    known : MechanicalSystem
        The system with these effects and the independent constraints.
    limit : int
        Limit of closed forms.

    Returns
    -------
    float
        Number of symbols and operations. If finite, at most `LARGEST_SIZE`.
    """
    if any(symbol.name in system.multipliers for force in known.forces for symbol in force.free_symbols):
        return inf
    multipliers = {multiplier.name for multiplier in known.multipliers}
    called = [
        *(["=", part.effect, displayed(part.tree)] for part in _called(system.kinetic_energy, derived.effects)),
        *(["=", part.effect, displayed(part.tree)] for part in _called(system.potential_energy, derived.effects)),
        *(["=", part.effect, ("[", *map(displayed, part.trees))] for part in _called(system.forces, derived.effects)),
    ]
    constraints = (
        displayed(tree)
        for name, tree in zip(system.multipliers, system.constraint_trees, strict=True)
        if name in multipliers
    )
    described = ("[", *map(tuple, called), *constraints)
    length = size(described) * factorial(len(multipliers)) * (len(roots([described])) + 1)
    alone = length * factorial(_largest_block(known, False))
    if alone > limit or derived.mass_matrix == "regular":
        return min(alone, LARGEST_SIZE)
    return min(length * factorial(_largest_block(known, True)), LARGEST_SIZE)


def has_closed_forms(derived: Derivation, predicted: float, limit: int) -> bool:
    """Return True if closed forms belong in a derivation.

    They do if their predicted size is within the limit. If it is not, they may, and (11) must be within it.

    Parameters
    ----------
    derived : Derivation
        Derivation of the record.
    predicted : float
        Predicted size.
    limit : int
        Limit of closed forms.

    Returns
    -------
    bool
    """
    if predicted <= limit or derived.left_out is not None or predicted > LARGEST_TRIED_SIZE:
        return predicted <= limit
    return all(length_of(each) <= limit for each in derived.equations if each.id == "accelerations")


def _called(parts: Iterable, effects: Sequence[str]) -> list:
    return [part for part in parts if part.effect in effects]


def _largest_block(system: MechanicalSystem, supported: bool) -> int:
    """Return the largest number of coordinates that a row of the mass matrix couples.

    If A is singular, the row is one of A + J^T J.
    """
    if supported:
        return _largest_block_supported(system)
    rows = gradient(system.kinetic_energy, system.velocities)
    moving = set(system.velocities)
    return max(sum(momentum.diff(v) != 0 for v in momentum.free_symbols & moving) for momentum in rows)


def _largest_block_supported(system: MechanicalSystem) -> int:
    v, q = system.velocities, system.coordinates
    J = [gradient(f, q) for f in system.constraints]
    momenta = gradient(system.kinetic_energy, v)
    n = len(q)
    return max(
        sum(sp.Add(momenta[s].diff(v[k]), *(row[s] * row[k] for row in J)) != 0 for k in range(n)) for s in range(n)
    )


def length_of(equation: Equation) -> int:
    """Return the length of the right sides of an equation, as a list.

    Parameters
    ----------
    equation : Equation
        Equation of a record.

    Returns
    -------
    int
    """
    return size(("[", *(displayed(relation.right_tree) for relation in equation.relations)))


def operations_of(equations: Iterable[Equation]) -> int:
    """Return the number of operations in the right sides of equations.

    Parameters
    ----------
    equations : iterable of Equation
        Equations of a record.

    Returns
    -------
    int
    """
    rights: list[Tree] = [relation.right_tree for equation in equations for relation in equation.relations]
    return sum(operations(displayed(right)) for right in rights)
