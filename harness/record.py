"""The derivation record: typed, frozen results of Maxima for one scene file.

This is the only module that reads the record's format. Its expressions are trees (`holonom.expression.trees`): data
that are never evaluated as code. SymPy expressions are made of them, and SymPy is imported, at the first use.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple

from .described import Correction, System, Values, expression
from .documents import ask
from .expression.trees import Tree
from .failures import ErrorKind, HolonomError
from .formats import Document, read
from .language import translatable
from .maxima import DEFAULT_LIMITS, NO_SETTINGS
from .sandbox import Limits
from .source import Source
from .structs import entry, with_attributes

if TYPE_CHECKING:
    from sympy import Expr


@dataclass(frozen=True)
class Relation:
    """left = right, on every motion of the system."""

    left_tree: Tree = entry("Left side.", key="left")
    right_tree: Tree = entry("Right side.", key="right")

    @cached_property
    def left(self) -> "Expr":
        """The left side."""
        return expression(self.left_tree)

    @cached_property
    def right(self) -> "Expr":
        """The right side."""
        return expression(self.right_tree)


@dataclass(frozen=True)
class Equation:
    """One item of the derivation."""

    id: str = entry("Identifier of the equation.", pattern="^[a-z_]+$")
    number: str = entry("Number of the equation in the paper.")
    name: str = entry("Name of the equation.")
    relations: tuple[Relation, ...] = entry("Relations that the equation consists of.")


LARGEST_SIZE = 10**300  # larger predicted sizes are replaced by this


class LeftOut(NamedTuple):
    """Equations that were left out."""

    numbers: Annotated[tuple[str, ...], "Equation numbers of these equations."]
    size: Annotated[int | None, "Terms and operations, as predicted; null where forces contain multipliers."]
    limit: Annotated[int, "closed_form_size."]


@dataclass(frozen=True)
class Derivation:
    """The equations of the system with the effects named."""

    effects: tuple[str, ...] = entry("Effects that the derivation contains.")
    equations: tuple[Equation, ...] = entry("Equations in the order of the paper.")
    mass_matrix: str = entry(
        "Regular, or singular and supported: (4), (5), (8) to (11) have A + J^T J in place of A.",
        enum=["regular", "supported"],
    )
    redundant: tuple[str, ...] = entry(
        "Multipliers of the constraints that follow from the others: (4), (5) and (8) to (11) are solved without these."
    )
    closed_form_operations: int | None = entry(
        "Operations of (8) and (11) as written; null where they stay a linear system."
    )
    left_out: LeftOut | None = entry("Equations of the derivation that are not made; null where all are.", None)


@dataclass(frozen=True)
class Scene:
    """A system with control law, parameter values and initial state."""

    name: str = entry("Name of the scene.")
    title: str = entry("Title of the scene.")
    derivation: int = entry("Index of the scene's derivation.", minimum=0)
    effects: tuple[str, ...] = entry("Effects that the scene contains.")
    control_law: Values = entry("Control law of each control.")
    parameter_values: Values = entry("Value of each parameter.")
    initial_state: Values = entry("Initial coordinates and velocities.")
    given: tuple[str, ...] = entry(
        "The coordinates and velocities whose initial values the scene gives; the others are solved for."
    )
    correction: Correction | None = entry(
        "The initial value that had to be corrected most to fit the constraints, and by how much."
    )
    span_trees: tuple[Tree, Tree] | None = entry("First and last time.", key="time_span")
    observe: tuple[str, ...] = entry("Quantities to observe.")
    equations: tuple[Equation, ...] = entry("Equations of the initial motion.")
    left_out: LeftOut | None = entry("Equations of the scene that are not made; null where all are.", None)
    law_around_start: bool = entry(
        "Whether the control law is switched, as by a table, and given as it is around the initial time.", False
    )

    @cached_property
    def time_span(self) -> "tuple[Expr, Expr] | None":
        """First and last time."""
        return None if self.span_trees is None else (expression(self.span_trees[0]), expression(self.span_trees[1]))

    def jumping(self, equation: Equation) -> "tuple[Expr, ...]":
        """Return functions whose signs jump initially and change an equation.

        The equation does not hold there.

        Parameters
        ----------
        equation : Equation
            (13) or (18).

        Returns
        -------
        tuple of Expr
            Functions of the initial values that vanish then.
        """
        if not any(head in repr([each.right_tree for each in equation.relations]) for head in ("'Sign'", "'Abs'")):
            return ()
        from .jumps import jumping_at

        start = {f"{name}_0": value for name, value in self.initial_state.items()}
        return jumping_at(start | dict(self.parameter_values), [each.right for each in equation.relations])


@with_attributes
@dataclass(frozen=True)
class Record:
    """All results of Maxima's derivation for one scene file."""

    maxima: str = entry("Version of Maxima.")
    system: System = entry("The system as it is described.")
    derivations: tuple[Derivation, ...] = entry("The equations, for each selection of effects that a scene calls for.")
    scenes: tuple[Scene, ...] = entry("The scenes, with the equations of their initial motion.")


def derived_record(
    file: Source | Path,
    settings: Mapping[str, str] = NO_SETTINGS,
    limits: Limits = DEFAULT_LIMITS,
) -> "Record":
    """Derive the record of a scene file.

    Parameters
    ----------
    file : Source or Path
        Scene file.
    settings : mapping of str to str
        Numbers in Maxima's notation, for what the file leaves open and for parameters.
    limits : Limits
        Limits of each run of Maxima.

    Returns
    -------
    Record

    Raises
    ------
    HolonomError
        As `holonom.documents.ask` and `read_record`.
    """
    return read_record(ask(Document.RECORD, file, settings=settings, limits=limits))


def read_record(text: str) -> Record:
    """Read a derivation record.

    A malformed expression raises at its first use.

    Parameters
    ----------
    text : str
        JSON document.

    Returns
    -------
    Record

    Raises
    ------
    HolonomError
        The text is not JSON, or does not have the shape of a record.
    """
    record = read(Document.RECORD, text, Record)
    for scene in record.scenes:
        if scene.derivation >= len(record.derivations):
            raise HolonomError(
                ErrorKind.NOT_A_RECORD, detail=translatable("the scene %(scene)s has no derivation", scene=scene.name)
            )
    return record
