"""The document of ``holonom free --json``, in which formulas are text."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from .crosscheck.report import Verdict
from .free_motion import FreeMotion, MotionVerdict, TrajectoryKind, UniversalVerdict
from .schema import Rules
from .structs import entry

if TYPE_CHECKING:
    from sympy import Expr

# SymPy expressions, which become text when the document is written.
Formula = Annotated["Expr", Rules({"type": "string"})]
Formulas = Mapping[str, Formula]


@dataclass(frozen=True)
class LawCheck:
    """Result of the trial of a law by SymPy."""

    verdict: Verdict = entry("Result of the check.")
    digits: int | None = entry("Number of digits that agree.")
    states: int | None = entry("Number of random states.")


@dataclass(frozen=True)
class ConditionText:
    """An expression that must vanish if every motion is to be free."""

    expression: Formula = entry("Expression that must vanish.")
    place: Formula = entry("Function of the state whose coefficient it is.")
    effects: tuple[str, ...] = entry("Effects that the coefficient comes from.")


@dataclass(frozen=True)
class UniversalText:
    """Laws under which every motion is free.

    The lists after them have an item for each law.
    """

    verdict: UniversalVerdict = entry("all: the laws are all analytic ones; some: others may exist; none: none exists.")
    laws: tuple[Formulas, ...] = entry("By control.")
    constants: tuple[tuple[str, ...], ...] = entry("Constants of integration of each law.")
    free: tuple[tuple[str, ...], ...] = entry("Controls that stay free functions of the time.")
    positive: tuple[tuple[Formula, ...], ...] = entry("Expressions that are positive where the law holds.")
    checks: tuple[LawCheck, ...] = entry("Verdict of SymPy on each law.")
    conditions: tuple[ConditionText, ...] = entry(
        "Coefficients that must vanish, each with its function of the state and the terms of the system it comes from."
    )
    generic: bool = entry("True for generic values of parameters that were left open.")
    reason: str = entry("Reason of the verdict.")


@dataclass(frozen=True)
class TrajectoryText:
    """The control under which one motion is free."""

    kind: TrajectoryKind = entry("Form of the result.")
    law: Formulas | None = entry("By control, where it is closed.")
    series: Mapping[str, Formula | int] | None = entry(
        "By control the law as a power series, and under `order` the order to which it is one; null where it is closed."
    )
    free: tuple[str, ...] = entry("Controls that stay free functions of the time.")
    samples: tuple[tuple[float, ...], ...] | None = entry("Times with the values of the controls.")
    reason: str = entry("Reason of the result.")


@dataclass(frozen=True)
class PrescribedText:
    """Controls under prescribed reactions."""

    reactions: Formulas = entry("Prescribed multipliers.")
    controls: Formulas = entry("Second time derivatives of the controls.")


@dataclass(frozen=True)
class FreeMotionText:
    """The free motion of a scene.

    Formulas are text, as the command prints them.
    """

    scene: str = entry("Name of the scene.")
    condition: tuple[Formula, ...] | None = entry(
        "The condition (10): each formula vanishes in free motion; null where it is not written out."
    )
    left_out: str | None = entry("Why (10) is not written out; null where it is.")
    motion: MotionVerdict = entry("Whether the motion of the scene is free, and what shows it.")
    universal: UniversalText = entry("Laws under which every motion is free.")
    trajectory: TrajectoryText = entry("The control under which one motion is free.")
    prescribed: PrescribedText | None = entry("Controls under prescribed reactions; null without any.")


def free_motion_text(found: FreeMotion) -> FreeMotionText:
    """Return the results as they are published.

    Parameters
    ----------
    found : FreeMotion
        Results with checked verdicts.

    Returns
    -------
    FreeMotionText
    """
    universal, trajectory, prescribed = found.universal, found.trajectory, found.prescribed
    laws, order = universal.laws, trajectory.order
    return FreeMotionText(
        found.scene,
        found.condition,
        found.left_out,
        found.motion,
        UniversalText(
            universal.verdict,
            laws=tuple(law.controls for law in laws),
            constants=tuple(law.constants for law in laws),
            free=tuple(law.free for law in laws),
            positive=tuple(law.positive for law in laws),
            checks=tuple(LawCheck(law.check.verdict, law.check.digits, law.check.points) for law in laws),
            conditions=tuple(ConditionText(each.expression, each.place, each.effects) for each in universal.conditions),
            generic=universal.generic,
            reason=universal.reason,
        ),
        TrajectoryText(
            trajectory.kind,
            law=None if order else trajectory.law or None,
            series=order and {**trajectory.law, "order": order},
            free=trajectory.free,
            samples=trajectory.samples or None,
            reason=trajectory.reason,
        ),
        prescribed and PrescribedText(prescribed.reactions, prescribed.controls),
    )
