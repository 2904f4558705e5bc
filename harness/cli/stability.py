"""The command about motions near a motion: linearize."""

from pathlib import Path
from typing import Any

from ..options import options_of
from ..program.request import Request
from ..sandbox import Limits
from ..stability.request import LinearizationRequest
from .group import holonom
from .options import asks_one_scene, present, runs_scenes, takes, writes_json


@holonom.command()
@asks_one_scene()
@takes(*options_of(LinearizationRequest))
@writes_json
@runs_scenes
def linearize(
    scene_file: Path, request: Request, options: dict[str, Any], json_file: Path | None, limits: Limits
) -> int:
    """Linearise the motion of a SCENE on the constraint manifold: eigenvalues, modes, state space."""
    from ..display.linearization import show_linearization
    from ..formats import Publication, published
    from ..scene import Scene

    found = Scene(scene_file, request.scene, request.settings, limits).linearize(**options)
    present(published(Publication.LINEARIZED, found.document()), json_file, show_linearization, found)
    return 0
