"""Free motion of a scene: condition, verdict, universal and trajectory controls.

Free motion is the case zero of motion under prescribed reactions, which is also here.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cached_property
from pathlib import Path

from sympy import Add, Expr, Mul, Symbol

from .crosscheck.report import CheckResult
from .crosscheck.system import described_system
from .described import System, Values
from .documents import ask
from .expression.mathjson import to_sympy
from .expression.trees import Tree
from .formats import Document, read
from .free_verdicts import FreeMotionTrial
from .language import Message, translatable
from .sandbox import Limits
from .schema import FloatText
from .shown import Shown
from .source import Source
from .structs import entry, group, with_attributes

Law = Mapping[str, Expr]


class FreeMotionVerdict(StrEnum):
    """Verdicts on whether a motion is free."""

    FREE = "free"
    NOT_FREE = "not free"
    UNDECIDED = "undecided"


class UniversalVerdict(StrEnum):
    """Verdicts on the laws under which every motion is free."""

    ALL = "all"
    SOME = "some"
    NONE = "none"
    UNDECIDED = "undecided"


class TrajectoryKind(StrEnum):
    """Forms of the control under which one motion is free."""

    CLOSED_FORM = "closed form"
    NUMERIC = "numeric"
    SERIES = "series"
    ANY_CONTROL = "any control"
    NONE = "none"
    NOT_DETERMINED = "not determined"


@dataclass(frozen=True)
class FirstCoefficient:
    """The first nonzero coefficient of a multiplier's power series."""

    multiplier: str = entry("Name of the multiplier.")
    order: int = entry("Order of the coefficient: the power of t - t0.", minimum=0)
    value: str = entry(
        "p/q where the data are exact, else a decimal number of 30 digits.",
        pattern=r"^-?[0-9]+(/[0-9]+)?$|^-?[0-9][.][0-9]*e-?[0-9]+$",
    )


@dataclass(frozen=True)
class MotionVerdict:
    """The verdict on whether the motion of the scene is free."""

    verdict: FreeMotionVerdict = entry("Verdict on the motion. It is free only where that is proved.")
    states: str = entry(
        "all states where every motion under the scene's law is free, else this state.",
        key="for",
        enum=["all states", "this state"],
    )
    evidence: Message = entry("Reason of the verdict, or what is missing for a proof.")
    order: int | None = entry(
        "If undecided, the order to which the power series of all multipliers vanish; null where they have none.",
        minimum=2,
    )
    first: FirstCoefficient | None = entry(
        "The first coefficient that is not zero; null where the motion is not free for another reason."
    )


@dataclass(frozen=True)
class UniversalLaw:
    """A law under which every motion is free, or a family of such laws."""

    controls: Values = entry("By control; in the time, the constants and the free controls.")
    constants: tuple[str, ...] = entry("Constants of integration: any numbers.")
    free: tuple[str, ...] = entry("Controls that stay free functions of the time.")
    positive_trees: tuple[Tree, ...] = entry("Expressions that are positive where the law holds.", key="positive")
    # what SymPy found when it tried the law on the equations of motion; None before that
    check: CheckResult | None = None

    @cached_property
    def positive(self) -> tuple[Expr, ...]:
        """Expressions that are positive where the law holds, none if it always does."""
        return tuple(map(to_sympy, self.positive_trees))


@dataclass(frozen=True)
class ControlCondition:
    """Expressions that must vanish if every motion is to be free."""

    expression_tree: Tree = entry("Expression that must vanish.", key="expression")
    place_tree: Tree = entry("Function of the state that it is the coefficient of.", key="place")
    effects: tuple[str, ...] = entry(
        "Effects that the coefficient comes from; inertia for kinetic energy and constraints."
    )

    @cached_property
    def expression(self) -> Expr:
        """Expression in the time, the controls and their time derivatives."""
        return to_sympy(self.expression_tree)

    @cached_property
    def place(self) -> Expr:
        """Function of the state that it is the coefficient of in (10)."""
        return to_sympy(self.place_tree)


@dataclass(frozen=True)
class UniversalControls:
    """The laws under which every motion is free."""

    verdict: UniversalVerdict = entry(
        "all: the laws are all analytic ones; some: others may exist; none: none exists; undecided."
    )
    laws: tuple[UniversalLaw, ...] = entry("Families of laws.")
    conditions: tuple[ControlCondition, ...] = entry(
        "Coefficients that must vanish, each with its function of the state and the terms of the system it comes from."
    )
    generic: bool = entry("True for generic values of parameters that were left open.")
    reason: Message = entry("Reason of the verdict.")


@dataclass(frozen=True)
class SeriesOfControls:
    """Power series of controls."""

    order: int = entry("Order of the series.")
    time_tree: Tree = entry("Time of the expansion.", key="time")
    coefficients: Mapping[str, tuple[Tree, ...]] = entry("Coefficients by control, from the power 0 on.")

    def law(self) -> Law:
        """Return the series as sums in the order of their powers.

        SymPy's evaluation would turn 3/2 + (t - 1) into t + 1/2.

        Returns
        -------
        mapping of str to SymPy expression
            Truncated series, by control.
        """
        step = Symbol("t", real=True) - to_sympy(self.time_tree)

        def added_up(coefficients: tuple[Expr, ...]) -> Expr:
            terms = [Mul(c, step**k, evaluate=k != 1 or c == 1) for k, c in enumerate(coefficients) if not c.is_zero]
            return Add(*terms, evaluate=False) if len(terms) > 1 else Add(*terms)

        return {name: added_up(tuple(map(to_sympy, trees))) for name, trees in self.coefficients.items()}


@dataclass(frozen=True)
class TrajectoryControl:
    """The control under which one motion is free."""

    kind: TrajectoryKind = entry(
        "closed form (in the initial data q1_0, dot(q1)_0, or the scene's numbers), numeric (along the time span), "
        "series (at the initial time), any control, none or not determined."
    )
    closed_law: Values = entry("By control, where it is closed.", key="law")
    free: tuple[str, ...] = entry("Controls that stay free functions of the time.")
    motion: Values = entry("Coordinates of the free motion as functions of the time, where they are known.")
    samples: tuple[tuple[FloatText, ...], ...] = entry(
        "Times of the scene's time span with values of the controls, if there are such controls."
    )
    reason: Message = entry("Reason of the result.")
    series: SeriesOfControls | None = entry(
        "The law to an order, where it is not closed: by control the coefficients of the powers of t - time, from "
        "the power 0 on."
    )

    @property
    def order(self) -> int | None:
        """Order to which the law is a series, or None if it is closed."""
        return self.series and self.series.order

    @cached_property
    def law(self) -> Law:
        """The law by control.

        A truncated series is an unevaluated sum, lowest power first.
        """
        return self.series.law() if self.series else self.closed_law


@dataclass(frozen=True)
class PrescribedReactions:
    """The multipliers that a scene prescribes, and the resulting controls.

    The multipliers are given by name, the controls as ``ddot(u)`` by name.
    """

    reactions: Values = entry("Prescribed multipliers, by name.")
    controls: Values = entry("Resulting ddot(u), by name.")


@dataclass(frozen=True)
class OpenAccelerations:
    """Accelerations that the forces do not determine if the mass matrix is singular."""

    rank: int = entry("The rank of the mass matrix.")
    directions: tuple[Values, ...] = entry(
        "Directions that the mass matrix turns into zero, each by the accelerations in it; empty where they were "
        "not worked out."
    )
    deciding: tuple[int, ...] = entry("Numbers of the constraints that decide these accelerations, from 1.")


@dataclass(frozen=True)
class Premises:
    """Premises of the results: the system with the scene's effects, and its numbers."""

    system: System = entry("The system that moves, as in record.json.")
    effects: tuple[str, ...] = entry("Those that the scene calls for.")
    redundant: tuple[str, ...] = entry(
        "Multipliers of the constraints that follow from the others: (10) is that of these others."
    )
    parameter_values: Values = entry("The scene's values of the parameters.")
    control_law: Values = entry("The scene's law of all controls; empty where there is none, or a table gives it.")
    time_span: tuple[Tree, Tree] | None = entry("First and last time; null where the scene gives none.")

    def trial(self) -> FreeMotionTrial:
        """Return the data for trials of the verdicts.

        Returns
        -------
        FreeMotionTrial
        """
        return FreeMotionTrial(
            described_system(self.system, self.effects).without(self.redundant),
            {Symbol(name, real=True): value for name, value in self.parameter_values.items()},
            self.time_span and tuple(map(to_sympy, self.time_span)),
        )


@with_attributes
@dataclass(frozen=True, repr=False)
class FreeMotion(Shown):
    """The results about free motion of one scene.

    ``condition_trees`` is None if (10) is not written out, and ``left_out`` gives the reason. ``prescribed`` is None
    if the scene prescribes no reactions, ``open`` if the mass matrix is regular. ``redundant`` are the multipliers of
    the constraints that follow from the others: (10) is that of the others, and a motion is free if it has no
    constraint forces.
    """

    scene: str = entry("Name of the scene.")
    condition_trees: tuple[Tree, ...] | None = entry(
        "The condition (10): each expression vanishes in free motion; null where it is not written out.",
        key="condition",
    )
    left_out: Message | None = entry("Why (10) is not written out; null where it is.")
    motion: MotionVerdict = entry("Whether the motion of the scene is free, and what shows it.")
    universal: UniversalControls = entry("Laws under which every motion is free.")
    trajectory: TrajectoryControl = entry("The control under which the motion of the scene is free.")
    prescribed: PrescribedReactions | None = entry("Prescribed reactions; null where the scene prescribes none.")
    open: OpenAccelerations | None = entry(
        "The accelerations that the forces leave open, where the mass matrix is singular; null where it is regular."
    )
    premises: Premises = group()

    @property
    def redundant(self) -> tuple[str, ...]:
        """Multipliers of the constraints that follow from the others."""
        return self.premises.redundant

    @cached_property
    def condition(self) -> tuple[Expr, ...] | None:
        """Expressions that vanish on a free motion, for each constraint.

        None if (10) is not written out.
        """
        return None if self.condition_trees is None else tuple(map(to_sympy, self.condition_trees))


def free_motion(
    file: Source | Path,
    scene: str | None,
    settings: Mapping[str, str],
    limits: Limits,
    order: int | None = None,
) -> FreeMotion:
    """Ask Maxima about the free motion of a scene.

    Parameters
    ----------
    file : Source or Path
        Scene file.
    scene : str or None
        Name of the scene, or None for the last one.
    settings : mapping of str to str
        Numbers for parameters and for what the file leaves open.
    limits : Limits
        Limits of each run of Maxima.
    order : int or None
        Highest order of the multipliers' power series, at least 2, or None for Maxima's ``verdict_order``.

    Returns
    -------
    FreeMotion
        With verdicts that `with_verdicts` has checked.

    Raises
    ------
    HolonomError
        As `holonom.documents.ask`, or the file has no such scene.

    References
    ----------
    Chen, Guo & Mei (2019), section 2, eq. (10).
    """
    text = ask(Document.FREE_MOTION, file, scene, order, settings=settings, limits=limits)
    return with_verdicts(read(Document.FREE_MOTION, text, FreeMotion))


def with_verdicts(found: FreeMotion) -> FreeMotion:
    """Check each verdict with the equations of motion.

    A contradicted verdict becomes undecided.

    Parameters
    ----------
    found : FreeMotion
        Results of Maxima.

    Returns
    -------
    FreeMotion
    """
    trial = found.premises.trial()
    motion, universal = found.motion, found.universal
    contradiction = ""
    if motion.verdict is FreeMotionVerdict.FREE and motion.states == "all states" and found.premises.control_law:
        contradiction = trial.contradiction_of_free_motion(found.premises.control_law)
    if contradiction:
        evidence = translatable("%(reason)s; %(note)s", reason=motion.evidence, note=contradiction)
        motion = replace(motion, verdict=FreeMotionVerdict.UNDECIDED, states="this state", evidence=evidence)
    laws = tuple(replace(law, check=trial.of_law(law.controls, law.positive)) for law in universal.laws)
    verdict, contradiction = trial.verdict_on_laws(universal.verdict, [law.check for law in laws])
    reason = contradiction or universal.reason
    universal = replace(universal, verdict=UniversalVerdict(verdict), laws=laws, reason=reason)
    return replace(found, motion=motion, universal=universal)
