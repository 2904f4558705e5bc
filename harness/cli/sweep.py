"""The command about many motions: sweep."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..sandbox import Limits
from .group import holonom
from .options import asks_one_scene, chooses_solve, present, read_instant, runs_scenes, writes_json
from .outputs import OutputFile, as_given

if TYPE_CHECKING:
    from fractions import Fraction

    from ..program.request import Request

FAILED = 1  # exit status of a sweep none of whose rows came about


@holonom.command()
@asks_one_scene
@click.option("--grid", "grids", metavar="NAME=FIRST:LAST:COUNT", multiple=True, help="Equidistant values.")
@click.option("--list", "lists", metavar="NAME=VALUE,...", multiple=True, help="These values.")
@click.option(
    "--sample",
    "samples",
    metavar="NAME=normal(A,B)|uniform(A,B)|loguniform(A,B)",
    multiple=True,
    help="Random values: mean and deviation, or least and greatest.",
)
@click.option("--size", metavar="N", type=click.IntRange(min=1), help="Members of the sample.")
@click.option("--seed", metavar="N", type=click.IntRange(min=0), help="Of the sample; without it, 0.")
@click.option(
    "--keep",
    metavar="WHAT,...",
    multiple=True,
    default=("final",),
    show_default=True,
    help="final, EXPR, at(EXPR,T), max(EXPR), max(abs(EXPR)), min(EXPR), mean(EXPR), zero(EXPR), free, radius.",
)
@click.option(
    "-o", "--output", metavar="FOLDER", required=True, type=click.Path(path_type=Path), help="Where the rows go."
)
@click.option("--tol", type=float, default=1e-12, show_default=True, help="Tolerance of a step.")
@click.option("--until", metavar="T", callback=read_instant, help="The last instant, in place of the scene's.")
@click.option(
    "--drift",
    type=click.Choice(["projection", "none"]),
    default="projection",
    show_default=True,
    help="What keeps the constraints.",
)
@chooses_solve
@click.option(
    "--chunk", metavar="ROWS", type=click.IntRange(1, 10**7), default=10_000, show_default=True, help="Rows of a file."
)
@click.option("--workers", metavar="N", type=click.IntRange(1, 4096), help="Processes; without it, one a processor.")
@click.option("--dask", "scheduler", metavar="ADDRESS", help="A running Dask scheduler, whose workers compute instead.")
@click.option("--resume", is_flag=True, help="Go on with what is there; without it, that or begin.")
@click.option(
    "--plot",
    "plot_file",
    metavar="FILE.svg|.png",
    type=OutputFile(),
    help="Also draw the first that is kept: a curve over one parameter, a map over two.",
)
@writes_json
@runs_scenes
def sweep(
    scene_file: Path,
    request: "Request",
    grids: Sequence[str],
    lists: Sequence[str],
    samples: Sequence[str],
    size: int | None,
    seed: int | None,
    keep: Sequence[str],
    output: Path,
    tol: float,
    until: "Fraction | None",
    drift: str,
    chunk: int,
    workers: int | None,
    scheduler: str | None,
    resume: bool,
    plot_file: Path | None,
    json_file: Path | None,
    limits: Limits,
) -> int:
    """Follow the motion of a SCENE for many values of its parameters.

    The rows go into a folder of Parquet files, each with its parameters, what is kept, its residual and its status.
    The same command again computes only what is missing there. The exit status is 1 where no row came about.
    """
    from ..display.motion import show_sweep
    from ..display.progress import sweep_progress
    from ..simulation.output import require_formats
    from ..simulation.request import Stabilization
    from ..sweeps.axes import read_axes
    from ..sweeps.kept import read_kept
    from ..sweeps.run import SweepRequest, run_sweep

    axes, kept = read_axes(grids, lists, samples, size, seed), read_kept(keep)
    if plot_file is not None:
        from ..figures.sweep import require_plottable

        require_formats(None, plot_file)
        require_plottable(axes)
    cure, called = Stabilization(drift), as_given(scene_file)
    wanted = SweepRequest(axes, kept, tol, until, cure, chunk, workers, scheduler, resume, called)
    with sweep_progress(axes.rows) as progress:
        found = run_sweep(scene_file, request, wanted, output, limits, progress)
    for name in found.mended:
        click.echo(f"holonom: {output / name} was not as it was written, and has been computed again.", err=True)
    if plot_file is not None:
        found.plot().save(plot_file)
    statuses = found.statuses
    present({**found.document, "statuses": statuses}, json_file, show_sweep, found, statuses)
    return 0 if statuses.get("ok") else FAILED
