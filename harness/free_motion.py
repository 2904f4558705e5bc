"""Free motion of a scene: its condition, the verdict on its motion, universal controls, the control for one trajectory.

And the motion under prescribed reactions, of which free motion is the case zero.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cached_property
from pathlib import Path

from sympy import Add, Expr, Mul, Symbol

from .crosscheck.report import Judgement
from .crosscheck.system import described_system
from .described import read_system
from .documents import Document, ask, read
from .free_verdicts import FreeMotionTrial
from .mathjson import to_sympy
from .sandbox import Limits
from .shown import Shown
from .source import Source
from .trees import Tree

Law = Mapping[str, Expr]


class Free(StrEnum):
    """What is known of a motion."""

    FREE = "free"
    NOT_FREE = "not free"
    UNDECIDED = "undecided"


@dataclass(frozen=True)
class FirstCoefficient:
    """The first coefficient of a multiplier's power series that is not zero."""

    multiplier: str
    order: int  # the power of t - t0
    value: str  # ``p/q`` where the data are exact, else a decimal number of 30 digits


@dataclass(frozen=True)
class MotionVerdict:
    """Whether the motion of the scene is free."""

    verdict: Free  # free only where that is proved
    states: str  # ``all states``, where every motion under the scene's law is free, or ``this state``
    evidence: str  # what shows it, or what is in the way of a proof: one sentence
    # where undecided, the order to which all coefficients of the multipliers vanish; None where there are none
    order: int | None
    first: FirstCoefficient | None  # what shows that the motion is not free


@dataclass(frozen=True)
class UniversalLaw:
    """A law under which every motion is free, or a family of them."""

    controls: Law  # by control; in the time, the constants and the free controls
    constants: tuple[str, ...]  # constants of integration: any numbers
    free: tuple[str, ...]  # controls that stay free functions of the time
    positive: tuple[Expr, ...]  # what must be positive where the law holds; empty where it always holds
    check: Judgement  # what SymPy found when it tried the law on the equations of motion


@dataclass(frozen=True)
class ControlCondition:
    """What must vanish if every motion is to be free."""

    expression: Expr  # in the time, the controls and their rates
    place: Expr  # the function of the state that it is the coefficient of in (10)
    # the terms of the system that it comes from; ``inertia`` for kinetic energy and constraints
    effects: tuple[str, ...]


@dataclass(frozen=True)
class UniversalControls:
    """The laws under which every motion is free."""

    verdict: str  # ``all`` (no other analytic law does), ``some``, ``none`` (there are none) or ``undecided``
    laws: tuple[UniversalLaw, ...]
    conditions: tuple[ControlCondition, ...]  # shortest first
    generic: bool  # parameters were left open, and the answer is that for generic values
    reason: str


@dataclass(frozen=True)
class TrajectoryControl:
    """The control under which one motion is free."""

    # ``closed form`` (in letters, the initial data q1_0, dot(q1)_0, or in the scene's numbers), ``numeric`` (with the
    # scene's numbers, along its time span), ``series`` (with the scene's numbers, at the initial instant), ``any
    # control``, ``none`` (there is none) or ``not determined``
    kind: str
    law: Law  # by control; where there is an order a truncated series, an unevaluated sum, lowest power first
    free: tuple[str, ...]  # controls that stay free functions of the time; a closed form may contain them
    order: int | None  # to which the law is a series; None where it is closed
    motion: Law  # the free motion by coordinate, where its closed form is known
    # instants of the scene's time span with the values of the controls, as far as there are such controls
    samples: tuple[tuple[float, ...], ...]
    reason: str


@dataclass(frozen=True)
class PrescribedReactions:
    """The multipliers that a scene prescribes, by name, and what the controls do then: ``ddot(u)`` by name."""

    reactions: Law
    controls: Law


@dataclass(frozen=True)
class OpenAccelerations:
    """What the forces leave open where the mass matrix is singular."""

    rank: int  # of the mass matrix
    # directions that it turns into zero, each by the accelerations in it; empty where they were not worked out
    directions: tuple[Law, ...]
    deciding: tuple[int, ...]  # numbers of the constraints that decide, from 1


@dataclass(frozen=True, repr=False)
class FreeMotion(Shown):
    """The answers about one scene.

    ``condition_trees`` is None where (10) is not written out, and ``left_out`` says why; ``prescribed`` is None where
    the scene prescribes no reactions, ``open`` where the mass matrix is regular. ``redundant`` are the multipliers of
    the constraints that follow from the others: (10) is that of the others, and a motion is free where it has no
    constraint forces.
    """

    scene: str
    condition_trees: tuple[Tree, ...] | None  # as MathJSON
    left_out: str | None
    motion: MotionVerdict
    universal: UniversalControls
    trajectory: TrajectoryControl
    prescribed: PrescribedReactions | None
    open: OpenAccelerations | None
    redundant: tuple[str, ...]

    @cached_property
    def condition(self) -> tuple[Expr, ...] | None:
        """What vanishes where a motion is free, for each constraint; None where it is not written out."""
        return None if self.condition_trees is None else _expressions(self.condition_trees)


def free_motion(
    file: Source | Path, scene: str | None, settings: Mapping[str, str], limits: Limits, order: int | None = None
) -> FreeMotion:
    """Ask Maxima about the free motion of a scene.

    Parameters
    ----------
    scene : str or None
        Name of the scene; None for the last one.
    settings : mapping of str to str
        Numbers for what the file leaves open.
    order : int or None
        Up to which order the power series of the multipliers are looked at, 2 or more; None for Maxima's
        ``verdict_order``.

    Raises
    ------
    HolonomError
        As `holonom.maxima.ask_scene`; the file has no such scene.

    References
    ----------
    Chen, Guo & Mei (2019), section 2, eq. (10).
    """
    return read_free_motion(ask(Document.FREE_MOTION, file, scene, order, settings=settings, limits=limits))


def read_free_motion(text: str) -> FreeMotion:
    """Read what Maxima wrote, and check the laws in it.

    Raises
    ------
    HolonomError
        As `holonom.documents.read`.
    """
    document = read(Document.FREE_MOTION, text)
    trial = _trial(document)
    motion, trajectory, prescribed, left_open = (
        document[part] for part in ("motion", "trajectory", "prescribed", "open")
    )
    return FreeMotion(
        document["scene"],
        None if document["condition"] is None else tuple(document["condition"]),
        document["left_out"],
        _motion(motion, trial, _law(document["control_law"])),
        _universal(document["universal"], trial),
        TrajectoryControl(
            trajectory["kind"],
            _law(trajectory["law"]) if trajectory["series"] is None else _truncated_law(trajectory["series"]),
            tuple(trajectory["free"]),
            trajectory["series"] and trajectory["series"]["order"],
            _law(trajectory["motion"]),
            tuple(tuple(map(float, sample)) for sample in trajectory["samples"]),
            trajectory["reason"],
        ),
        prescribed and PrescribedReactions(_law(prescribed["reactions"]), _law(prescribed["controls"])),
        left_open
        and OpenAccelerations(
            left_open["rank"], tuple(map(_law, left_open["directions"])), tuple(left_open["deciding"])
        ),
        tuple(document["redundant"]),
    )


def _truncated_law(series: dict) -> Law:
    """Power series of controls as sums in the order of their powers: evaluated, 3/2 + (t - 1) would be t + 1/2."""
    step = Symbol("t", real=True) - to_sympy(series["instant"])

    def added_up(coefficients: tuple[Expr, ...]) -> Expr:
        terms = [Mul(c, step**k, evaluate=k != 1 or c == 1) for k, c in enumerate(coefficients) if c != 0]
        return Add(*terms, evaluate=False) if len(terms) > 1 else Add(*terms)

    return {name: added_up(_expressions(trees)) for name, trees in series["coefficients"].items()}


def _trial(document: dict) -> FreeMotionTrial:
    span = document["time_span"]
    return FreeMotionTrial(
        described_system(read_system(document["system"]), document["effects"]).without(document["redundant"]),
        {Symbol(name, real=True): value for name, value in _law(document["parameter_values"]).items()},
        span and (to_sympy(span[0]), to_sympy(span[1])),
    )


def _motion(motion: dict, trial: FreeMotionTrial, law: Law) -> MotionVerdict:
    found = MotionVerdict(
        Free(motion["verdict"]),
        motion["for"],
        motion["evidence"],
        motion["order"],
        motion["first"] and FirstCoefficient(**motion["first"]),
    )
    if found.verdict is not Free.FREE or found.states != "all states" or not law:
        return found
    contradiction = trial.contradiction_of_free_motion(law)
    if not contradiction:
        return found
    return replace(
        found, verdict=Free.UNDECIDED, states="this state", evidence=f"{found.evidence}; but {contradiction}"
    )


def _universal(universal: dict, trial: FreeMotionTrial) -> UniversalControls:
    families = zip(*(universal[part] for part in ("laws", "constants", "free", "positive")), strict=True)
    laws = tuple(_checked_law(trial, *family) for family in families)
    verdict, contradiction = trial.verdict_on_laws(universal["verdict"], [law.check for law in laws])
    return UniversalControls(
        verdict,
        laws,
        tuple(
            ControlCondition(to_sympy(each["expression"]), to_sympy(each["place"]), tuple(each["effects"]))
            for each in universal["conditions"]
        ),
        universal["generic"],
        contradiction or universal["reason"],
    )


def _checked_law(trial: FreeMotionTrial, law: dict, constants: list, free: list, positive: list) -> UniversalLaw:
    controls, conditions = _law(law), _expressions(positive)
    return UniversalLaw(controls, tuple(constants), tuple(free), conditions, trial.of_law(controls, conditions))


def _expressions(trees: Iterable[Tree]) -> tuple[Expr, ...]:
    return tuple(to_sympy(tree) for tree in trees)


def _law(trees: dict) -> Law:
    return {name: to_sympy(tree) for name, tree in trees.items()}
