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
    from ...record import Equation, LeftOut, Record


def show_record(console: Console, record: "Record") -> None:
    """Print a derivation, equation by equation, under the paper's numbers."""
    console.print(record.system.title, style="bold")
    if record.system.source:
        console.print(record.system.source, style="dim")
    for derivation in record.derivations:
        console.print(f"\nDerivation with {_listed(derivation.effects)}", style="bold")
        _show_equations(console, derivation.equations)
        _show_left_out(console, derivation.left_out)
    for scene in record.scenes:
        console.print(f"\n{scene.name}: {scene.title}", style="bold")
        _show_equations(console, scene.equations)
        _show_left_out(console, scene.left_out)


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
        if found.verdict in ("disagrees", "undecided"):
            console.print(f"({found.number}) {found.name}: {found.detail}", soft_wrap=True, markup=False)
    left_out = {found.detail: found for found in report.verdicts if found.verdict == "left out"}
    for reason in left_out:
        numbers = [f"({found.number})" for found in report.verdicts if found.detail == reason]
        console.print(f"{', '.join(dict.fromkeys(numbers))} left out: {reason}.", soft_wrap=True, markup=False)
    console.print(f"{_sum(report)}; random points drawn by --seed {report.seed}", soft_wrap=True, markup=False)


def _sum(report: "CheckReport") -> str:
    from ...crosscheck.report import Verdict

    left_out, empty = report.count(Verdict.LEFT_OUT), report.count(Verdict.NOTHING)
    agreed = report.count(Verdict.PROVED, Verdict.AGREES)
    parts = [f"{len(report.verdicts) - left_out} equations made", f"{left_out} left out", f"{agreed} agreed"]
    if undecided := report.count(Verdict.UNDECIDED):
        parts.append(f"{undecided} undecided")
    if empty:
        parts.append(f"{empty} with nothing to check")
    return ", ".join([*parts, counted(report.disagreements, "disagreement")])


def _show_equations(console: Console, equations: Iterable["Equation"]) -> None:
    for equation in equations:
        console.print(Text(f"({equation.number}) {equation.name}", style="cyan"))
        for relation in equation.relations:
            console.print(f"    {formula(relation.left)} = {formula(relation.right)}", soft_wrap=True, markup=False)
        if not equation.relations:
            console.print("    none", style="dim")


def _show_left_out(console: Console, left_out: "LeftOut | None") -> None:
    if left_out is not None:
        from ...record import why_left_out

        numbers = ", ".join(f"({number})" for number in left_out.numbers)
        console.print(f"{numbers} not made: {why_left_out(left_out)}.", style="yellow", soft_wrap=True)


def _number(count: int | None) -> str:
    return "" if count is None else str(count)


def _listed(effects: Sequence[str]) -> str:
    return ", ".join(effects)
