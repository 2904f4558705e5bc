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
from .options import FAILED, IntegerRange, asks_one_scene, present, runs_scenes, takes, writes_json
from .outputs import OutputFile, as_given


@holonom.command(
    examples=[
        "sweep examples/crane.mac --grid m=50:500:300 -o runs",
        'sweep examples/crane.mac --list m=1,2 --keep "max(lambda1)" -o two',
    ]
)
@asks_one_scene(*options_of(Request, "solve"))
@click.option("--grid", "grids", metavar="NAME=FIRST:LAST:COUNT", multiple=True, help="Equally spaced values.")
@click.option("--list", "lists", metavar="NAME=VALUE,...", multiple=True, help="List of values.")
@click.option(
    "--sample",
    "samples",
    metavar="NAME=normal(A,B)|uniform(A,B)|loguniform(A,B)",
    multiple=True,
    help="Random values: mean and deviation, or smallest and largest value.",
)
@click.option("--size", metavar="N", type=IntegerRange(min=1), help="Size of the sample.")
@click.option("--seed", metavar="N", type=IntegerRange(min=0), help="Seed of the sample. Default: 0.")
@click.option(
    "--keep",
    metavar="WHAT,...",
    multiple=True,
    default=("final",),
    show_default=True,
    help="Output: final, EXPR, at(EXPR,T), max(EXPR), max(abs(EXPR)), min(EXPR), mean(EXPR), zero(EXPR), free, radius.",
)
@click.option(
    "-o", "--output", metavar="FOLDER", required=True, type=click.Path(path_type=Path), help="Folder of the rows."
)
@takes(*options_of(SweepRequest))
@click.option(
    "--plot",
    "plot_file",
    metavar="FILE.svg|.png",
    type=OutputFile(),
    help="Plot the first output: a curve over one parameter, a map over two.",
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

    The rows are written to Parquet files in a folder: parameters, outputs, residual and status. Run the same command
    again to compute only missing rows. The exit status is 1 if no row succeeds.

    To use Dask, start `dask scheduler` and, for each worker, `dask worker ADDRESS`. On a cluster dask-jobqueue starts
    both: SLURMCluster(cores=8, processes=8, memory="16GB").scale(jobs=20). Pass its scheduler_address to --dask.
    """
    from ..display.motion import show_sweep
    from ..display.progress import sweep_progress
    from ..simulation.output import require_formats
    from ..sweeps.axes import read_axes
    from ..sweeps.outputs import read_quantities
    from ..sweeps.run import run_sweep

    axes, quantities = read_axes(grids, lists, samples, size, seed), read_quantities(keep)
    if plot_file is not None:
        from ..figures.sweep import require_plottable

        require_formats(None, plot_file)
        require_plottable(axes)
    wanted = SweepRequest(axes, quantities, called=as_given(scene_file), **options)
    with sweep_progress(axes.rows) as progress:
        found = run_sweep(scene_file, request, wanted, output, limits, progress)
    for name in found.mended:
        click.echo(f"holonom: warning: {output / name}: changed since it was written; computed again.", err=True)
    if plot_file is not None:
        found.plot().save(plot_file)
    statuses = found.statuses
    present({**found.document, "statuses": statuses}, json_file, show_sweep, found, statuses)
    return 0 if statuses.get("ok") else FAILED
