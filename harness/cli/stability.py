"""The command about motions near a motion: linearize."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..sandbox import Limits
from .group import holonom
from .options import asks_one_scene, present, runs_scenes, writes_json

if TYPE_CHECKING:
    from ..program.request import Request


@holonom.command()
@asks_one_scene
@click.option("--at", "at", metavar="T", help="The instant; without it, the start.")
@writes_json
@runs_scenes
def linearize(scene_file: Path, request: "Request", at: str | None, json_file: Path | None, limits: Limits) -> int:
    """Linearise the motion of a SCENE on the constraint manifold: eigenvalues, modes, state space."""
    from ..display.linearization import show_linearization
    from ..documents import Publication, published
    from ..scene import Scene

    found = Scene(scene_file, request.scene, request.settings, limits).linearize(at)
    present(published(Publication.LINEARIZED, found.document()), json_file, show_linearization, found)
    return 0
