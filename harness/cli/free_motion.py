"""The command about free motion: free."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..options import options_of
from ..program.request import FreeRequest
from ..sandbox import Limits
from .background import run_in_background
from .group import holonom
from .options import FAILED, asks_one_scene, present, runs_scenes, takes, writes_json

if TYPE_CHECKING:
    from ..program.request import Request


@holonom.command(examples=["free examples/pendulum.mac", "free examples/paper/paper.mac --scene free_motion_scene"])
@asks_one_scene()
@takes(*options_of(FreeRequest))
@writes_json
@runs_scenes
def free(
    scene_file: Path,
    request: "Request",
    options: dict[str, Any],
    json_file: Path | None,
    limits: Limits,
) -> int:
    """Find when a motion is free.

    A motion is free if all constraint forces vanish. The command tests the motion of the SCENE, and finds control laws
    that make every motion free, or one trajectory. The exit status is 1 if SymPy contradicts a law that was found.
    """
    from ..documents import ask
    from ..formats import Document

    with run_in_background(scene_file, limits, _import_readers):
        asked = request.scene, options["order"]
        text = ask(Document.FREE_MOTION, scene_file, *asked, settings=request.settings, limits=limits)

    from ..crosscheck.report import Verdict
    from ..display.free_motion import show_free_motion
    from ..expression.presentation import formula_text
    from ..formats import Publication, published, read
    from ..free_document import free_motion_text
    from ..free_motion import FreeMotion, with_verdicts

    found = with_verdicts(read(Document.FREE_MOTION, text, FreeMotion))
    present(published(Publication.FREE, free_motion_text(found), formula_text), json_file, show_free_motion, found)
    contradicted = any(law.check.verdict is Verdict.DISAGREES for law in found.universal.laws)
    return FAILED if contradicted else 0


def _import_readers() -> None:
    """Import SymPy and the modules of the analysis."""
    from ..display.free_motion import show_free_motion  # noqa: F401
    from ..free_motion import with_verdicts  # noqa: F401
