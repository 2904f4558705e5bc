"""The command about initial motion: series."""

from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..confined import Limits
from .group import holonom
from .options import asks_one_scene, present, read_instant, runs_scenes, writes_json

if TYPE_CHECKING:
    from ..program.request import Request


@holonom.command()
@asks_one_scene
@click.option("--order", metavar="N", type=click.IntRange(min=2), required=True, help="Highest power of the time.")
@click.option("--exact", is_flag=True, help="Rational coefficients, or none; the default is exact where possible.")
@click.option("--digits", metavar="D", type=click.IntRange(min=1), help="Coefficients of D significant digits.")
@click.option(
    "--precision",
    metavar="double|extended|quadruple|DIGITS",
    help="Compute with heyoka, in these numbers; their last digits are rounded, not confirmed.",
)
@click.option("--at", metavar="T", callback=read_instant, help="Also add the series up at the instant T.")
@click.option("--until", metavar="T", callback=read_instant, help="Also continue the motion to T, beyond the radius.")
@writes_json
@runs_scenes
def series(
    scene_file: Path,
    request: "Request",
    order: int,
    exact: bool,
    digits: int | None,
    precision: str | None,
    at: Fraction | None,
    until: Fraction | None,
    json_file: Path | None,
    limits: Limits,
) -> int:
    """Expand the initial motion of a SCENE in power series, and say how far they hold."""
    from ..series.power_series import (
        AUTOMATIC,
        EXACT,
        SeriesRequest,
        compute_series,
        series_document,
        values_at,
    )
    from .tables.motion import show_series

    if sum([exact, digits is not None, precision is not None]) > 1:
        raise click.UsageError("--exact, --digits and --precision exclude one another")
    wanted = EXACT if exact else digits or AUTOMATIC
    asked = SeriesRequest(order, request.scene, wanted, until, request.settings, precision)
    motion = compute_series(scene_file, asked, limits)
    values = None if at is None else values_at(motion, at)
    present(series_document(motion, values), json_file, show_series, motion, values)
    return 0
