"""The commands that measure: accuracy, stability."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..options import options_of
from ..sandbox import Limits
from ..simulation.request import SimulationRequest
from .group import holonom
from .options import FAILED, asks_one_scene, present, runs_scenes, takes, writes_json
from .outputs import OutputFile

if TYPE_CHECKING:
    from ..program.request import Request


@holonom.command(examples=["accuracy examples/pendulum.mac", "accuracy examples/pendulum.mac --plot accuracy.svg"])
@asks_one_scene()
@takes(*options_of(SimulationRequest, "until"))
@click.option("--plot", "plot_file", metavar="FILE", type=OutputFile(), help="Draw a figure (SVG).")
@writes_json
@runs_scenes
def accuracy(
    scene_file: Path,
    request: "Request",
    options: dict[str, Any],
    plot_file: Path | None,
    json_file: Path | None,
    limits: Limits,
) -> int:
    """Measure what accuracy costs in time.

    The motion of a SCENE is integrated at coarse to fine tolerances. The report recommends methods.
    """
    from ..benchmark.work_precision.study import Plan, study
    from ..display.measurements import show_study
    from ..display.progress import progress
    from ..formats import Publication, published

    plan = Plan(**options)
    with progress("methods", plan.steps) as advance:
        done = study(scene_file, request, limits, plan, advance)
    present(published(Publication.ACCURACY, done), json_file, show_study, done)
    if plot_file is not None:
        from ..figures.benchmark import study_figure
        from ..figures.style import Picture

        Picture(study_figure(done)).save(plot_file)
    return 0


@holonom.command(examples=["stability --short", "stability --plot stability.svg --json stability.json"])
@click.option("--short", is_flag=True, help="Shorten the long motions: under a minute in total.")
@click.option("--plot", "plot_file", metavar="FILE", type=OutputFile(), help="Draw a figure.")
@writes_json
def stability(short: bool, plot_file: Path | None, json_file: Path | None) -> int:
    """Run the test set of hard cases.

    The report states the correct digits of each method, and advice.
    """
    from ..benchmark.hard_cases.case import CaseReports, Extent
    from ..benchmark.hard_cases.register import REGISTER, examine_all
    from ..display.measurements import show_stability
    from ..display.progress import progress
    from ..formats import Publication, published

    extent = Extent.SHORT if short else Extent.FULL
    with progress("Hard cases", len(REGISTER)) as done:
        reports = examine_all(extent, done)
    present(published(Publication.HARD_CASES, CaseReports(tuple(reports))), json_file, show_stability, reports)
    if plot_file is not None:
        from ..figures.benchmark import stability_figure
        from ..figures.style import Picture

        Picture(stability_figure(reports)).save(plot_file)
    return FAILED if any(report.fails for report in reports) else 0
