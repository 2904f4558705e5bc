"""The condition of free motion and the controls that satisfy it."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

from rich.console import Console
from rich.text import Text

from ..expression.presentation import formula_text
from .condition import condition_lines
from .motion import short_number

if TYPE_CHECKING:
    from ..free_motion import (
        ControlCondition,
        FreeMotion,
        Law,
        MotionVerdict,
        OpenAccelerations,
        UniversalControls,
        UniversalLaw,
    )


def show_free_motion(console: Console, found: "FreeMotion") -> None:
    """Print the condition of free motion and the controls that satisfy it.

    Parameters
    ----------
    console : Console
        Console to print on.
    found : FreeMotion
        Condition (10) and the verdicts for one scene.
    """
    if found.condition_trees is None:
        _show_list(console, "condition of free motion (10): not written out", [found.left_out or ""])
    else:
        lines = [line for tree in found.condition_trees for line in condition_lines(tree)]
        _show_list(console, "condition of free motion (10)", lines)
    if found.redundant:
        names = ", ".join(found.redundant)
        _show_list(
            console,
            "redundant constraints",
            [f"those of {names} follow from the others, of which (10) is; these multipliers are put to zero"],
        )
    if found.open is not None:
        _show_open(console, found.open)
    _show_list(console, f"{found.scene}: {_verdict(found.motion)}", [_first(found.motion), found.motion.evidence])
    _show_universal(console, found.universal)
    trajectory = found.trajectory
    samples = [_sample(sample, trajectory.law) for sample in trajectory.samples if trajectory.kind == "numeric"]
    law = _law(trajectory.law) if trajectory.order is None else _series(trajectory.law, trajectory.order)
    free = f"{', '.join(trajectory.free)} any function of the time" if trajectory.free else ""
    _show_list(console, f"control for one trajectory: {trajectory.kind}", [law, free, trajectory.reason, *samples])
    if found.prescribed is not None:
        reactions, controls = _law(found.prescribed.reactions), _law(found.prescribed.controls)
        _show_list(console, f"controls under the prescribed reactions {reactions}", [controls])


CONDITIONS_SHOWN = 5

TITLES = {
    "all": "controls that make every motion free, all there are",
    "some": "controls that make every motion free, some; whether there are others was not decided",
    "none": "controls that make every motion free: there are none",
    "undecided": "controls that make every motion free: undecided",
}


def _show_universal(console: Console, found: "UniversalControls") -> None:
    generic = "; for generic values of the parameters left open" if found.generic else ""
    conditions = () if found.verdict == "none" else found.conditions  # without laws the reason names one
    needed = [_needed(each) for each in conditions[:CONDITIONS_SHOWN]]
    more = len(conditions) - len(needed)
    rest = [f"and {more} longer conditions"] if more > 0 else []
    laws = [line for law in found.laws for line in _universal_law(law)]
    _show_list(console, TITLES[found.verdict], [*laws, found.reason + generic, *needed, *rest])


def _needed(condition: "ControlCondition") -> str:
    expression, place = formula_text(condition.expression), formula_text(condition.place)
    return f"needs {expression} = 0, at {place} in (10), from {', '.join(condition.effects)}"


def _universal_law(law: "UniversalLaw") -> list[str]:
    free = f"{', '.join(law.free)} any function of the time" if law.free else ""
    where = " and ".join(f"{formula_text(each)} > 0" for each in law.positive)
    check = law.check
    shown = "" if check.digits is None else f" to {check.digits} digits in {check.points} random states"
    return [
        ", ".join(filter(None, (_law(law.controls), free))) + (f"  where {where}" if where else ""),
        f"  SymPy, from the equations of motion: {check.verdict}{shown}{': ' + check.detail if check.detail else ''}",
    ]


def _show_open(console: Console, found: "OpenAccelerations") -> None:
    directions = [f"any multiple of {_law(direction)}" for direction in found.directions]
    plural = "s" if len(found.deciding) > 1 else ""
    numbers = ", ".join(map(str, found.deciding))
    decided = f"constraint{plural} {numbers} decide{'' if plural else 's'}"
    title = f"accelerations that the forces leave open: the mass matrix is singular, of rank {found.rank}"
    _show_list(console, title, [*directions, decided])


def _show_list(console: Console, title: str, lines: Iterable[str]) -> None:
    console.print(Text(title, style="cyan"))
    for line in lines:
        if line:
            console.print(f"    {line}", soft_wrap=True)


def _verdict(motion: "MotionVerdict") -> str:
    match motion.verdict, motion.states:
        case "free", "all states":
            return "every motion is free"
        case "free", _:
            return "motion is free for this state"
        case verdict, _:
            return f"motion is {verdict}"


def _first(motion: "MotionVerdict") -> str:
    """Return ``lambda1 = 132*(t - t0)^10 + ...``, numbers of many digits shortened."""
    if motion.first is None:
        return ""
    power = {0: "", 1: "*(t - t0)"}.get(motion.first.order, f"*(t - t0)^{motion.first.order}")
    return f"{motion.first.multiplier} = {short_number(motion.first.value)}{power} + ..."


def _sample(sample: Iterable[float], law: "Law") -> str:
    return "  ".join(f"{name} = {value:<12.6g}" for name, value in zip(("t", *law), sample, strict=True)).rstrip()


def _series(law: "Law", order: int) -> str:
    return ", ".join(f"{name} begins with {text}, to order {order}" for name, text in _texts(law))


def _law(law: "Law") -> str:
    return ", ".join(f"{name} = {text}" for name, text in _texts(law))


def _texts(law: "Law") -> Iterable[tuple[str, str]]:
    return ((name, formula_text(value)) for name, value in law.items())
