"""The commands about states at rest and motions near a motion: equilibria, linearize."""

from fractions import Fraction
from pathlib import Path
from typing import Any

import click

from ..options import options_of
from ..program.request import Request
from ..sandbox import Limits
from ..stability.request import EquilibriaRequest, LinearizationRequest
from .group import holonom
from .options import asks_one_scene, present, runs_scenes, takes, writes_json


@holonom.command(examples=["linearize examples/pendulum.mac --at 2", "linearize examples/crane.mac --json -"])
@asks_one_scene()
@takes(*options_of(LinearizationRequest))
@writes_json
@runs_scenes
def linearize(
    scene_file: Path, request: Request, options: dict[str, Any], json_file: Path | None, limits: Limits
) -> int:
    """Linearise the motion of a SCENE.

    The result holds eigenvalues, modes and the state space in coordinates of the constraint manifold.
    """
    from ..display.stability import show_linearization
    from ..formats import Publication, published
    from ..scene import Scene

    found = Scene(scene_file, request.scene, request.settings, limits).linearize(**options)
    present(published(Publication.LINEARIZED, found.document()), json_file, show_linearization, found)
    return 0


@holonom.command(examples=["equilibria examples/pendulum.mac --set l0=1", "equilibria examples/arm.mac --json -"])
@asks_one_scene()
@click.option(
    "--control", "controls", metavar="NAME=VALUE", multiple=True, help="A constant control, not as its law begins."
)
@takes(*options_of(EquilibriaRequest))
@writes_json
@runs_scenes
def equilibria(
    scene_file: Path,
    request: Request,
    controls: tuple[str, ...],
    options: dict[str, Any],
    json_file: Path | None,
    limits: Limits,
) -> int:
    """Find states at rest and their stability.

    The controls are constant. Others than the states found may exist.
    """
    from ..display.stability import show_equilibria
    from ..formats import Publication, published
    from ..program.request import read_settings
    from ..scene import Scene

    values = {name: float(Fraction(text)) for name, text in read_settings(controls).items()}
    found = Scene(scene_file, request.scene, request.settings, limits).equilibria(**options, **values)
    present(published(Publication.EQUILIBRIA, found.document()), json_file, show_equilibria, found)
    return 0
