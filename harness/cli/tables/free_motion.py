"""The condition of free motion and the controls that satisfy it."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

from rich.console import Console
from rich.text import Text

from .text import formula

if TYPE_CHECKING:
    from ...free_motion import FreeMotion, Law


def show_free_motion(console: Console, found: "FreeMotion") -> None:
    """Print the condition of free motion and the controls that satisfy it."""
    _show_list(console, "condition of free motion (10)", [f"{formula(e)} = 0" for e in found.condition])
    if found.verdict is not None:
        satisfied = {"no": "not free"}.get(found.verdict.satisfies, f"free for {found.verdict.satisfies}")
        left = [f"leaves {formula(e)}" for e in found.verdict.residual]
        _show_list(console, f"{found.scene}: motion is {satisfied}", [found.verdict.reason, *left])
    universal = found.universal
    ending = " (there are no others)" if universal.unique else ""
    separated = [f"needs {formula(e)} = 0" for e in universal.conditions]
    laws = [_law(law) for law in universal.laws] or ["none"]
    _show_list(console, f"controls that make every motion free{ending}", [*laws, universal.reason, *separated])
    trajectory = found.trajectory
    samples = [_sample(sample, trajectory.law) for sample in trajectory.samples if trajectory.kind == "numeric"]
    _show_list(
        console, f"control for one trajectory: {trajectory.kind}", [_law(trajectory.law), trajectory.reason, *samples]
    )
    if found.prescribed is not None:
        reactions, controls = _law(found.prescribed.reactions), _law(found.prescribed.controls)
        _show_list(console, f"controls under the prescribed reactions {reactions}", [controls])


def _show_list(console: Console, title: str, lines: Iterable[str]) -> None:
    console.print(Text(title, style="cyan"))
    for line in lines:
        if line:
            console.print(f"    {line}", soft_wrap=True, markup=False)


def _sample(sample: Iterable[float], law: "Law") -> str:
    return "  ".join(f"{name} = {value:<12.6g}" for name, value in zip(("t", *law), sample, strict=True)).rstrip()


def _law(law: "Law") -> str:
    return ", ".join(f"{control} = {formula(value)}" for control, value in law.items())
