"""The register of hard cases as a table: what each method keeps, and what a user should do."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table
from rich.text import Text

from .text import counted, styled

if TYPE_CHECKING:
    from ...benchmark.hard_cases.case import CaseReport


def show_stability(console: Console, reports: Sequence["CaseReport"]) -> None:
    """Print what each method keeps of each hard case, with the advice."""
    table = Table("case", "method", "quantity", "digits", "verdict")
    table.title, table.title_justify = "Digits kept in hard cases", "left"
    table.columns[3].justify = "right"
    for report in reports:
        table.add_section()
        name = report.case.name
        for result in report.results:
            digits = "" if result.digits is None else f"{result.digits:.1f}"
            table.add_row(name, result.method, result.quantity, digits, styled(result.verdict))
            name = ""
    console.print(table)
    for report in reports:
        console.print(Text(report.case.name, style="cyan"))
        console.print(f"    truth: {report.case.truth}", soft_wrap=True, markup=False)
        console.print(f"    {report.advice}", soft_wrap=True, markup=False)
    failed = sum(report.fails for report in reports)
    console.print(f"{counted(len(reports), 'hard case')}, {counted(failed, 'failure')}")
