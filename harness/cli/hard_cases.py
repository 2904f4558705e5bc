"""The command about hard cases: stability."""

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .group import holonom
from .options import json_text, publish, writes_json
from .outputs import STANDARD_OUTPUT, OutputFile

if TYPE_CHECKING:
    from ..benchmark.hard_cases.case import CaseReport

FAILED = 1


@holonom.command()
@click.option("--short", is_flag=True, help="Follow the long motions for less time: under a minute in all.")
@click.option("--plot", "plot_file", metavar="FILE", type=OutputFile("svg", "png"), help="Also draw a figure.")
@writes_json
def stability(short: bool, plot_file: Path | None, json_file: Path | None) -> int:
    """Run the register of hard cases: the digits that each method keeps, and what to do."""
    from ..benchmark.hard_cases.case import Extent
    from ..benchmark.hard_cases.register import REGISTER, examine_all
    from ..documents import Publication, published
    from .tables.hard_cases import show_stability
    from .tables.progress import progress
    from .tables.text import make_console

    extent = Extent.SHORT if short else Extent.FULL
    with progress("Hard cases", len(REGISTER)) as done:
        reports = examine_all(extent, done)
    content = {"cases": [_report_document(report) for report in reports]}
    publish(json_text(published(Publication.HARD_CASES, content)), json_file)
    if plot_file is not None:
        from ..figures.hard_cases import draw_stability

        draw_stability(reports, plot_file)
    if json_file != STANDARD_OUTPUT:
        show_stability(make_console(), reports)
    return FAILED if any(report.fails for report in reports) else 0


def _report_document(report: "CaseReport") -> dict[str, Any]:
    sweep = report.sweep
    return {
        "case": report.case.name,
        "kind": report.case.kind,
        "truth": report.case.truth,
        "results": [asdict(result) for result in report.results],
        "sweep": sweep and asdict(sweep),
        "advice": report.advice,
        "fails": report.fails,
    }
