"""A derivation, equation by equation, and the verdicts on it."""

from collections.abc import Iterable, Sequence
from itertools import groupby
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table
from rich.text import Text

from .text import counted, formula, styled

if TYPE_CHECKING:
    from ...crosscheck import CheckReport
    from ...record import Equation, Record


def show_record(console: Console, record: "Record") -> None:
    """Print a derivation, equation by equation, under the paper's numbers."""
    console.print(record.system.title, style="bold")
    if record.system.source:
        console.print(record.system.source, style="dim")
    for derivation in record.derivations:
        console.print(f"\nDerivation with {_listed(derivation.effects)}", style="bold")
        _show_equations(console, derivation.equations)
    for scene in record.scenes:
        console.print(f"\n{scene.name}: {scene.title}", style="bold")
        _show_equations(console, scene.equations)


def show_report(console: Console, scene: str, report: "CheckReport") -> None:
    """Print the verdicts on one scene file."""
    console.print(scene, style="italic", soft_wrap=True, markup=False)
    show_verdicts(console, report)


def show_verdicts(console: Console, report: "CheckReport") -> None:
    """Print the verdict on each equation, and the disagreements in full."""
    table = Table("no.", "equation", "verdict", "digits", "points")
    for name, verdicts in groupby(report.verdicts, key=lambda verdict: verdict.scene):
        table.add_section()
        if name:
            table.add_row("", Text(name, style="bold"))
        for found in verdicts:
            table.add_row(found.number, found.name, styled(found.verdict), _number(found.digits), _number(found.points))
    console.print(table)
    for found in report.verdicts:
        if found.verdict == "disagrees":
            console.print(f"({found.number}) {found.name}: {found.detail}", soft_wrap=True, markup=False)
    console.print(f"{len(report.verdicts)} equations, {counted(report.disagreements, 'disagreement')}")


def _show_equations(console: Console, equations: Iterable["Equation"]) -> None:
    for equation in equations:
        console.print(Text(f"({equation.number}) {equation.name}", style="cyan"))
        for relation in equation.relations:
            console.print(f"    {formula(relation.left)} = {formula(relation.right)}", soft_wrap=True, markup=False)
        if not equation.relations:
            console.print("    none", style="dim")


def _number(count: int | None) -> str:
    return "" if count is None else str(count)


def _listed(effects: Sequence[str]) -> str:
    return ", ".join(effects)
