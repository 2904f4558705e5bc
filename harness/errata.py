"""The paper as published, compared with the derivation.

Maxima does the comparison, in `examples/paper/printed.mac`. This module runs that and reads the result.
"""

from dataclasses import dataclass

from .documents import ask
from .expression.trees import Tree
from .files import shared
from .formats import Document, read
from .structs import structured

PRINTED = shared("examples") / "paper" / "printed.mac"


@dataclass(frozen=True)
class PrintedEquation:
    """An equation of the paper, with the verdict on its printed form.

    The published version is that of our copy. Equations are Maxima text, on one line.
    """

    number: str  # the equation number, without brackets; empty for an equation that has none
    name: str  # what the equation is
    agrees: bool  # whether the printed equation is the derived one
    printed: str  # the equation as published
    # left side less right side as published, less the same as derived; None where the paper agrees
    difference: str | None
    corrected: str | None  # the printed equation, mended; None where the paper agrees
    note: str | None  # note about the transcription
    # printed_tree, difference_tree, corrected_tree: the same equations as trees that `holonom.typeset` sets in type, in
    # their own order; None where there is none
    printed_tree: Tree
    difference_tree: Tree | None
    corrected_tree: Tree | None


def errata() -> tuple[PrintedEquation, ...]:
    """Compare every printed equation and condition with the derived one.

    Returns
    -------
    tuple of PrintedEquation
        In the paper's order.

    Raises
    ------
    HolonomError
        Maxima is missing or raises an error.
    """
    document = read(Document.ERRATA, ask(Document.ERRATA, PRINTED))
    return tuple(structured(PrintedEquation, equation) for equation in document["equations"])
