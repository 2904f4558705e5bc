"""The commands about equilibria and linearised motions."""

from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..options import options_of
from ..program.request import Request
from ..sandbox import Limits
from ..stability.request import AlongRequest, EquilibriaRequest, LinearizationRequest
from .background import run_in_background
from .group import holonom
from .options import asks_one_scene, present, runs_scenes, takes, writes_json
from .outputs import OutputFile

if TYPE_CHECKING:
    from ..scene import Scene


@holonom.command(examples=["linearize examples/pendulum.mac --at 2", "linearize examples/crane.mac --json -"])
@asks_one_scene()
@takes(*options_of(LinearizationRequest))
@click.option(
    "--plot",
    "plot_file",
    metavar="FILE.svg|.png",
    type=OutputFile(),
    help="Plot eigenvalues and modes.",
)
@writes_json
@runs_scenes
def linearize(
    scene_file: Path,
    request: Request,
    options: dict[str, Any],
    plot_file: Path | None,
    json_file: Path | None,
    limits: Limits,
) -> int:
    """Linearise the motion of a SCENE.

    The report lists eigenvalues, modes and the state space in coordinates of the constraint manifold.
    """
    from ..display.stability import show_linearization
    from ..formats import Publication, published
    from ..simulation.output import require_formats

    require_formats(None, plot_file)
    found = _described(scene_file, request, limits).linearize(**options)
    if plot_file is not None:
        found.plot().save(plot_file)
    present(published(Publication.LINEARIZED, found), json_file, show_linearization, found)
    return 0


@holonom.command(
    examples=[
        "linearize-along examples/pendulum.mac --until 2 --samples 21",
        "linearize-along examples/shaken_pendulum.mac --scene upright_scene",
    ]
)
@asks_one_scene()
@takes(*options_of(AlongRequest))
@writes_json
@runs_scenes
def linearize_along(
    scene_file: Path, request: Request, options: dict[str, Any], json_file: Path | None, limits: Limits
) -> int:
    """Linearise along the motion of a SCENE.

    The result holds the state space and the state-transition matrix at times. Of a periodic motion it has the
    characteristic multipliers, of a free motion the multipliers of small deviations.
    """
    from ..display.stability import show_linearized_motion
    from ..formats import Publication, published

    found = _described(scene_file, request, limits).linearize_along(**options)
    present(published(Publication.LINEARIZED_ALONG, found), json_file, show_linearized_motion, found)
    return 0


@holonom.command(
    examples=["equilibria examples/pendulum.mac --set l0=1", "equilibria examples/pendulum.mac --over u=1:3:5"]
)
@asks_one_scene()
@click.option(
    "--control",
    "controls",
    metavar="NAME=VALUE",
    multiple=True,
    help="Value of a control. Default: the initial one.",
)
@click.option("--over", metavar="NAME=FIRST:LAST:COUNT", help="Values of a control, in order.")
@click.option(
    "--plot",
    "plot_file",
    metavar="FILE.svg|.png",
    type=OutputFile(),
    help="Plot them over that control.",
)
@takes(*options_of(EquilibriaRequest))
@writes_json
@runs_scenes
def equilibria(
    scene_file: Path,
    request: Request,
    controls: tuple[str, ...],
    over: str | None,
    plot_file: Path | None,
    options: dict[str, Any],
    json_file: Path | None,
    limits: Limits,
) -> int:
    """Find states at rest and their stability.

    The controls are constant. The search is random and may miss equilibria. If the equations are polynomial and small,
    their real solutions are counted.
    """
    from ..display.stability import show_branches, show_equilibria
    from ..formats import Publication, published
    from ..program.request import read_settings
    from ..simulation.output import require_formats
    from ..sweeps.axes import Axes, read_grids

    if plot_file is not None and over is None:
        raise click.UsageError("--plot draws what --over asks for")
    require_formats(None, plot_file)
    values = {name: Fraction(text) for name, text in read_settings(controls).items()}
    scene = _described(scene_file, request, limits)
    if over is None:
        found = scene._equilibria(values, **options)
        present(published(Publication.EQUILIBRIA, found), json_file, show_equilibria, found)
        return 0
    axes = Axes(tuple(read_grids("--over", [over])), (), 1, 0)
    branches = scene._branches(axes.names[0], axes.numbers(0, axes.rows)[0].tolist(), values, **options)
    if plot_file is not None:
        branches.plot().save(plot_file)
    documents = [published(Publication.EQUILIBRIA, each) for each in branches]
    present(documents, json_file, show_branches, branches)
    return 0


def _described(scene_file: Path, request: Request, limits: Limits) -> "Scene":
    """Return a scene with its description. Import modules in the background."""
    from ..scene import Scene

    scene = Scene(scene_file, request.scene, request.settings, limits)
    with run_in_background(scene_file, limits, _import_linearization):
        _ = scene.description
    return scene


def _import_linearization() -> None:
    from ..stability import linearization  # noqa: F401
