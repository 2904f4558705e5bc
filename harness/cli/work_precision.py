"""The command about work and precision: accuracy."""

from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path

import click

from ..confined import Limits
from .group import holonom
from .options import (
    asks_one_scene,
    json_text,
    publish,
    read_instant,
    runs_scenes,
    writes_json,
)
from .outputs import STANDARD_OUTPUT, OutputFile


@holonom.command()
@asks_one_scene
@click.option("--until", metavar="T", callback=read_instant, help="The last instant, in place of the scene's.")
@click.option("--plot", "plot_file", metavar="FILE", type=OutputFile("svg", "png"), help="Also draw a figure, SVG.")
@writes_json
@runs_scenes
def accuracy(
    scene_file: Path,
    scene: str | None,
    settings: Sequence[str],
    until: Fraction | None,
    plot_file: Path | None,
    json_file: Path | None,
    limits: Limits,
) -> int:
    """Measure what accuracy costs in time for the motion of a SCENE, and give plain advice."""
    from ..benchmark.work_precision.plan import Plan
    from ..benchmark.work_precision.study import study, study_document
    from ..program.request import Request, read_settings
    from .tables.progress import progress
    from .tables.text import make_console
    from .tables.work_precision import show_study

    plan = Plan(until=until)
    with progress("methods", plan.steps) as advance:
        done = study(scene_file, Request(scene, settings=read_settings(settings)), limits, plan, advance)
    publish(json_text(study_document(done)), json_file)
    if plot_file is not None:
        from ..figures.work_precision import draw_study

        draw_study(done, plot_file)
    if json_file != STANDARD_OUTPUT:
        show_study(make_console(), done)
    return 0
