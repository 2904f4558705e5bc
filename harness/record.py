"""The derivation record: typed, frozen results of Maxima for one scene file.

This is the only module that reads the record's format. Its expressions are trees (`holonom.expression.trees`): data
that are never evaluated as code. SymPy expressions are made of them, and SymPy is imported, at the first use.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from .described import Correction, System, Values, expression
from .documents import ask
from .expression.trees import Tree
from .failures import ErrorKind, HolonomError
from .formats import Document, nothing_collected, read
from .language import translatable
from .maxima import DEFAULT_LIMITS, NO_SETTINGS
from .sandbox import Limits
from .source import Source
from .structs import key, structured

if TYPE_CHECKING:
    from sympy import Expr


@dataclass(frozen=True)
class Relation:
    """left = right, on every motion of the system."""

    left_tree: Tree = key("left")
    right_tree: Tree = key("right")

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

    id: str  # what programs know it by, ``multipliers`` for example
    number: str  # the number that the paper gives it; several items may share one
    name: str  # what it is, for people
    relations: tuple[Relation, ...]  # its components


LARGEST_SIZE = 10**300  # larger predicted sizes are replaced by this


class LeftOut(NamedTuple):
    """Equations that were left out."""

    numbers: tuple[str, ...]  # the paper's
    # size, limit: how long their closed forms were predicted to be, None where forces contain multipliers, and the
    # `closed_form_size` that this is beyond
    size: int | None
    limit: int


@dataclass(frozen=True)
class Derivation:
    """The equations of the system with the effects named.

    `closed_form_operations` counts the operations of (8) and (11) as written, or None where they are too long to read
    and stay a linear system, which the motion program solves. `left_out` names them. `mass_matrix` is ``regular``, or
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
    """A system with control law, parameter values and initial state.

    Parameters
    ----------
    name, title : str
        The name it is assigned to and its title.
    derivation : int
        Index of its derivation in the record.
    effects : tuple of str
        Names of the effects it calls for.
    control_law, parameter_values : mapping of str to Expr
        The controls as functions of the time and the parameters as numbers, by name.
    initial_state : mapping of str to Expr
        All coordinates and velocities at the initial time, by name.
    given : tuple of str
        Coordinates and velocities whose initial values the scene gives. The others follow from the constraints.
    correction : Correction or None
        The largest correction of a given value that violated the constraints in its last digits.
    span_trees : pair of trees or None
        First and last time.
    observe : tuple of str
        Kinds of quantities to compute.
    equations : tuple of Equation
        The equations of its initial motion.
    left_out : LeftOut or None
        Equations of the initial motion that were left out.
    law_around_start : bool
        True if the control law is switched, as by a table, and recorded in its form around the initial time.
    """

    name: str
    title: str
    derivation: int
    effects: tuple[str, ...]
    control_law: Values
    parameter_values: Values
    initial_state: Values
    given: tuple[str, ...]
    correction: Correction | None
    span_trees: tuple[Tree, Tree] | None = key("time_span")
    observe: tuple[str, ...]
    equations: tuple[Equation, ...]
    left_out: LeftOut | None = None
    law_around_start: bool = False

    @cached_property
    def time_span(self) -> "tuple[Expr, Expr] | None":
        """First and last time."""
        return None if self.span_trees is None else (expression(self.span_trees[0]), expression(self.span_trees[1]))


@dataclass(frozen=True)
class Record:
    """All results of Maxima's derivation for one scene file."""

    maxima: str
    system: System
    derivations: tuple[Derivation, ...]
    scenes: tuple[Scene, ...]


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


@nothing_collected()
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
    record = structured(Record, read(Document.RECORD, text))
    for scene in record.scenes:
        if scene.derivation >= len(record.derivations):
            raise HolonomError(
                ErrorKind.NOT_A_RECORD, detail=translatable("the scene %(scene)s has no derivation", scene=scene.name)
            )
    return record
