"""The command about free motion: free."""

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..options import options_of
from ..program.request import FreeRequest
from ..sandbox import Limits
from .background import run_in_background
from .group import holonom
from .options import DISAGREEMENT, asks_one_scene, present, runs_scenes, takes, writes_json

if TYPE_CHECKING:
    from ..free_motion import FreeMotion
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
    from ..free_motion import read_free_motion, with_verdicts

    found = with_verdicts(read_free_motion(text))
    present(_free_motion_document(found), json_file, show_free_motion, found)
    contradicted = any(law.check.verdict is Verdict.DISAGREES for law in found.universal.laws)
    return DISAGREEMENT if contradicted else 0


def _import_readers() -> None:
    """Import SymPy and the modules of the analysis."""
    from ..display.free_motion import show_free_motion  # noqa: F401
    from ..free_motion import read_free_motion  # noqa: F401


def _free_motion_document(found: "FreeMotion") -> dict[str, Any]:
    from ..display.free_motion import formula, power_series
    from ..formats import Publication, published

    def law_text(law: Mapping[str, Any]) -> dict[str, str]:
        return {control: formula(value) for control, value in law.items()}

    motion, universal, trajectory, prescribed = found.motion, found.universal, found.trajectory, found.prescribed
    content = {
        "scene": found.scene,
        "condition": None if found.condition is None else [formula(each) for each in found.condition],
        "left_out": found.left_out,
        "motion": {
            "verdict": motion.verdict,
            "for": motion.states,
            "evidence": motion.evidence,
            "order": motion.order,
            "first": motion.first and asdict(motion.first),
        },
        "universal": {
            "verdict": universal.verdict,
            "laws": [law_text(law.controls) for law in universal.laws],
            "constants": [law.constants for law in universal.laws],
            "free": [law.free for law in universal.laws],
            "positive": [[formula(each) for each in law.positive] for law in universal.laws],
            "checks": [
                {"verdict": law.check.verdict, "digits": law.check.digits, "states": law.check.points}
                for law in universal.laws
            ],
            "conditions": [
                {"expression": formula(each.expression), "place": formula(each.place), "effects": each.effects}
                for each in universal.conditions
            ],
            "generic": universal.generic,
            "reason": universal.reason,
        },
        "trajectory": {
            "kind": trajectory.kind,
            "law": law_text(trajectory.law) or None if trajectory.order is None else None,
            "series": None
            if trajectory.order is None
            else {u: power_series(value) for u, value in trajectory.law.items()} | {"order": trajectory.order},
            "free": trajectory.free,
            "samples": trajectory.samples or None,
            "reason": trajectory.reason,
        },
        "prescribed": prescribed
        and {"reactions": law_text(prescribed.reactions), "controls": law_text(prescribed.controls)},
    }
    return published(Publication.FREE, content)
