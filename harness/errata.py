"""The paper as published, compared with the derivation.

Maxima does the comparison, in `examples/paper/printed.mac`. This module runs that and reads the result.
"""

from dataclasses import dataclass

from .documents import ask
from .expression.trees import Tree
from .files import shared
from .formats import Document, read
from .structs import entry

PRINTED = shared("examples") / "paper" / "printed.mac"


@dataclass(frozen=True)
class PrintedEquation:
    """An equation of the paper, with the verdict on its printed form.

    The published version is that of our copy. Equations are Maxima text, on one line.
    """

    number: str = entry("The equation number; empty where it has none.")
    name: str = entry("Name of the equation.")
    agrees: bool = entry("Whether the printed equation is the derived one.")
    printed: str = entry("The equation as published, Maxima text.")
    difference: str | None = entry(
        "Left less right side as published, less the same as derived; null where the paper agrees."
    )
    corrected: str | None = entry("The printed equation, mended; null where the paper agrees.")
    note: str | None = entry("Note about the transcription.")
    printed_tree: Tree | None = entry(
        "The printed equation as MathJSON, in its own order, for typesetting; null where there is none."
    )
    difference_tree: Tree | None = entry("The difference as MathJSON.")
    corrected_tree: Tree | None = entry("The corrected equation as MathJSON.")


@dataclass(frozen=True)
class Errata:
    """Every equation that the paper prints, compared with the derived one."""

    equations: tuple[PrintedEquation, ...] = entry("The equations in the paper's order.")


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
    return read(Document.ERRATA, ask(Document.ERRATA, PRINTED), Errata).equations
