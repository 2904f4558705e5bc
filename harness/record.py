"""The derivation record: what Maxima derived from one scene file, typed and frozen.

This is the only module that knows the record's wire format. Its expressions are read by `holonom.mathjson`: data, of
which nothing is evaluated as code.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from sympy import Expr

from .confined import Limits
from .documents import Document, ask, read
from .failures import Failure, HolonomError
from .mathjson import Tree, to_sympy
from .maxima import DEFAULT_LIMITS, NO_SETTINGS

NAMED_QUANTITIES = (
    "coordinates",
    "velocities",
    "accelerations",
    "controls",
    "control_rates",
    "control_accelerations",
    "parameters",
    "multipliers",
)
Result = TypeVar("Result")


@dataclass(frozen=True)
class Relation:
    """left = right, on every motion of the system; the SymPy expressions are made when they are first asked for."""

    left_tree: Tree
    right_tree: Tree

    @cached_property
    def left(self) -> Expr:
        """The left side."""
        return to_sympy(self.left_tree)

    @cached_property
    def right(self) -> Expr:
        """The right side."""
        return to_sympy(self.right_tree)


@dataclass(frozen=True)
class Equation:
    """One item of the derivation."""

    id: str  # what programs know it by, ``multipliers`` for instance
    number: str  # the number that the paper gives it; several items may share one
    name: str  # what it is, for people
    relations: tuple[Relation, ...]  # its components


@dataclass(frozen=True)
class Effect:
    """A named part of the kinetic or of the potential energy."""

    effect: str
    value: Expr


@dataclass(frozen=True)
class ForceEffect:
    """A named part of the generalized forces, one component a coordinate."""

    effect: str
    value: tuple[Expr, ...]


@dataclass(frozen=True)
class System:
    """A system as its scene file describes it, before anything is derived."""

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
    constraints: tuple[Expr, ...]  # each is zero on every motion


class LeftOut(NamedTuple):
    """Equations that were not made."""

    numbers: tuple[str, ...]  # the paper's
    # size, limit: how long their closed forms were predicted to be, and the `closed_form_size` that this is beyond
    size: int
    limit: int


@dataclass(frozen=True)
class Derivation:
    """The equations of the system with the effects named.

    `closed_form_operations` counts the operations of (8) and (11) as written; None where they are too long to read
    and stay a linear system, which the motion program solves; `left_out` names them. `mass_matrix` is ``regular``; or
    ``supported`` where it is singular and the constraints make up for it: A + J^T J is in its place in what is solved,
    and J^T times (7) is added to the equations of motion. `redundant` are the multipliers of the constraints that
    follow from the others: what is solved, (4), (5) and (8) to (11), is solved without these constraints.
    """

    effects: tuple[str, ...]
    equations: tuple[Equation, ...]
    mass_matrix: str
    redundant: tuple[str, ...]
    closed_form_operations: int | None
    left_out: LeftOut | None = None


@dataclass(frozen=True)
class Scene:
    """A system put to work.

    Parameters
    ----------
    name, title : str
        The name it is assigned to and what it is.
    derivation : int
        Index of its derivation in the record.
    effects : tuple of str
        Names of the effects it calls for.
    control_law, parameter_values : mapping of str to Expr
        The controls as functions of the time and the parameters as numbers, by name.
    initial_state : mapping of str to Expr
        All coordinates and velocities at the initial instant, by name.
    given : tuple of str
        Coordinates and velocities whose initial values the scene gives; the others follow from the constraints.
    correction : (str, str) or None
        The given value that missed the constraints in its last digits and was corrected most, and the size of the
        correction in decimal digits.
    time_span : pair of Expr or None
        First and last instant.
    observe : tuple of str
        What to compute.
    equations : tuple of Equation
        The equations of its initial motion.
    left_out : LeftOut or None
        Those of them that were not made.
    law_around_start : bool
        Whether the control law is switched, as by a table, and held as it is around the initial instant.
    """

    name: str
    title: str
    derivation: int
    effects: tuple[str, ...]
    control_law: Mapping[str, Expr]
    parameter_values: Mapping[str, Expr]
    initial_state: Mapping[str, Expr]
    given: tuple[str, ...]
    correction: tuple[str, str] | None
    time_span: tuple[Expr, Expr] | None
    observe: tuple[str, ...]
    equations: tuple[Equation, ...]
    left_out: LeftOut | None = None
    law_around_start: bool = False


@dataclass(frozen=True)
class Record:
    """Everything that Maxima derived from one scene file."""

    maxima: str
    system: System
    derivations: tuple[Derivation, ...]
    scenes: tuple[Scene, ...]


def derived_record(
    file: Path,
    settings: Mapping[str, str] = NO_SETTINGS,
    limits: Limits = DEFAULT_LIMITS,
    closed_form_size: int | None = None,
) -> "Record":
    """Derive a scene file; raises as `holonom.documents.ask` and `read_record`."""
    return read_record(ask(Document.RECORD, file, closed_form_size, settings=settings, limits=limits))


def read_record(text: str) -> Record:
    """Read a derivation record; the expressions in its equations are converted when they are first asked for.

    Raises
    ------
    HolonomError
        The text is not JSON, has not the shape of a record, or one of its expressions is malformed.
    """
    document = read(Document.RECORD, text)
    record = Record(
        maxima=document["maxima"],
        system=read_system(document["system"]),
        derivations=_each(_derivation, document["derivations"]),
        scenes=_each(_scene, document["scenes"]),
    )
    for scene in record.scenes:
        if scene.derivation >= len(record.derivations):
            raise HolonomError(Failure.NOT_A_RECORD, detail=f"the scene {scene.name} has no derivation")
    return record


def read_system(system: dict[str, Any]) -> System:
    """Read the description of a system, as records and other documents hold it."""
    return System(
        title=system["title"],
        source=system["source"],
        time=system["time"],
        **{kind: tuple(system[kind]) for kind in NAMED_QUANTITIES},
        kinetic_energy=_each(_effect, system["kinetic_energy"]),
        potential_energy=_each(_effect, system["potential_energy"]),
        forces=_each(_force_effect, system["forces"]),
        constraints=_each(to_sympy, system["constraints"]),
    )


def _effect(part: dict[str, Any]) -> Effect:
    return Effect(part["effect"], to_sympy(part["value"]))


def _force_effect(part: dict[str, Any]) -> ForceEffect:
    return ForceEffect(part["effect"], _each(to_sympy, part["value"]))


def _derivation(derivation: dict[str, Any]) -> Derivation:
    return Derivation(
        tuple(derivation["effects"]),
        _each(_equation, derivation["equations"]),
        derivation["mass_matrix"],
        tuple(derivation["redundant"]),
        derivation["closed_form_operations"],
        _left_out(derivation["left_out"]),
    )


def _left_out(found: dict[str, Any] | None) -> LeftOut | None:
    return found and LeftOut(tuple(found["numbers"]), found["size"], found["limit"])


def _scene(scene: dict[str, Any]) -> Scene:
    span = scene["time_span"]
    return Scene(
        name=scene["name"],
        title=scene["title"],
        derivation=scene["derivation"],
        effects=tuple(scene["effects"]),
        control_law=_values(scene["control_law"]),
        law_around_start=scene.get("law_around_start", False),
        parameter_values=_values(scene["parameter_values"]),
        initial_state=_values(scene["initial_state"]),
        given=tuple(scene["given"]),
        correction=scene["correction"] and (scene["correction"]["name"], scene["correction"]["size"]),
        time_span=None if span is None else (to_sympy(span[0]), to_sympy(span[1])),
        observe=tuple(scene["observe"]),
        equations=_each(_equation, scene["equations"]),
        left_out=_left_out(scene["left_out"]),
    )


def _equation(equation: dict[str, Any]) -> Equation:
    return Equation(equation["id"], equation["number"], equation["name"], _each(_relation, equation["relations"]))


def _relation(relation: dict[str, Any]) -> Relation:
    return Relation(relation["left"], relation["right"])


def _values(values: dict[str, Tree]) -> dict[str, Expr]:
    return {name: to_sympy(tree) for name, tree in values.items()}


def _each(read: Callable[[Any], Result], items: list[Any]) -> tuple[Result, ...]:
    return tuple(read(item) for item in items)
