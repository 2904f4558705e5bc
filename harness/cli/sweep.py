"""The command about many motions: sweep."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from ..options import options_of
from ..program.request import Request
from ..sandbox import Limits
from ..sweeps.request import SweepRequest
from .group import holonom
from .options import asks_one_scene, present, runs_scenes, takes, writes_json
from .outputs import OutputFile, as_given

FAILED = 1  # exit status of a sweep none of whose rows came about


@holonom.command(
    examples=[
        "sweep examples/crane.mac --grid m=50:500:300 -o runs",
        'sweep examples/crane.mac --list m=100,200 --keep "max(abs(lambda1))" -o kept',
    ]
)
@asks_one_scene(*options_of(Request, "solve"))
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
@takes(*options_of(SweepRequest))
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
    request: Request,
    grids: Sequence[str],
    lists: Sequence[str],
    samples: Sequence[str],
    size: int | None,
    seed: int | None,
    keep: Sequence[str],
    output: Path,
    options: dict[str, Any],
    plot_file: Path | None,
    json_file: Path | None,
    limits: Limits,
) -> int:
    """Vary parameters over many motions.

    The rows go into a folder of Parquet files, each with its parameters, what is kept, its residual and its status.
    The same command again computes only what is missing there. The exit status is 1 where no row came about.

    A Dask scheduler is started by `dask scheduler`, each worker by `dask worker ADDRESS`. On a cluster dask-jobqueue
    does both: SLURMCluster(cores=8, processes=8, memory="16GB").scale(jobs=20), and its scheduler_address for --dask.
    """
    from ..display.motion import show_sweep
    from ..display.progress import sweep_progress
    from ..simulation.output import require_formats
    from ..sweeps.axes import read_axes
    from ..sweeps.outputs import read_quantities
    from ..sweeps.run import run_sweep

    axes, kept = read_axes(grids, lists, samples, size, seed), read_quantities(keep)
    if plot_file is not None:
        from ..figures.sweep import require_plottable

        require_formats(None, plot_file)
        require_plottable(axes)
    wanted = SweepRequest(axes, kept, called=as_given(scene_file), **options)
    with sweep_progress(axes.rows) as progress:
        found = run_sweep(scene_file, request, wanted, output, limits, progress)
    for name in found.mended:
        click.echo(f"holonom: warning: {output / name}: changed since it was written; computed again.", err=True)
    if plot_file is not None:
        found.plot().save(plot_file)
    statuses = found.statuses
    present({**found.document, "statuses": statuses}, json_file, show_sweep, found, statuses)
    return 0 if statuses.get("ok") else FAILED
