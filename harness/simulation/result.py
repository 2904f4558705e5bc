"""Result of a simulation: samples of the motion, and a report on its accuracy."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import NDArray

from ..described import Correction
from ..extras import missing_package
from ..schema import Rules
from ..shown import Shown
from ..structs import computed, entry, group
from .accuracy_check import AccuracyViolation
from .engines.choice import Choice
from .engines.fallback import EngineSegment
from .events import Ending
from .hard_cases import Difficulty
from .hybrid_motion import Switching

if TYPE_CHECKING:
    from pandas import DataFrame

    from ..figures.film import MovingPicture
    from ..figures.style import Picture
    from ..program.drawing import Drawing

Samples = Mapping[str, NDArray[Any]]
Number = Annotated[Any, Rules({"type": ["number", "string"]})]  # beyond double precision, heyoka's own


@dataclass(frozen=True)
class Report:
    """The end of a motion, and its accuracy.

    Numbers of the motion are floats in double precision, heyoka's own beyond.
    """

    t: Number = entry("The last time.")
    coordinates: Mapping[str, Number] = entry("Values of the coordinates, by name.")
    velocities: Mapping[str, Number] = entry("Values of the velocities, by name.")
    multipliers: Mapping[str, Number] = entry("Empty where the scene does not observe them.")
    residuals: Mapping[str, float] = entry(
        "position, velocity and acceleration: how far the final state is from the constraints.",
        required=["position", "velocity", "acceleration"],
    )
    energy_error: Number = entry("Energy gained beyond the work of the forces and the controls.")
    condition: float = entry("Condition number of G = J A^-1 J^T at the end, each constraint scaled to unit length.")
    steps: int = entry("Number of steps.", minimum=0)
    segments: tuple[EngineSegment, ...] = entry("Engine of each interval of the motion, and the reason for it.")
    code: str = entry("How heyoka compiled the Taylor engine; empty where it did nothing.")
    precision: str = entry("The numbers that were computed with.")
    digits: int = entry("Decimal digits that distinguish these numbers.")
    tol: float = entry("Tolerance of a step.")
    compile_seconds: float = entry("Time to compile.")
    run_seconds: float = entry("Time to integrate the motion.")
    correction: Correction | None = entry(
        "The initial value that had to be corrected most to fit the constraints, and by how much."
    )
    cases: tuple[Difficulty, ...] = entry("Kinds of hard case that the motion is.")
    switchings: tuple[Switching, ...] = entry(
        "Times at which the motion is not analytic: the function that changes its sign, and how the motion passes "
        "its zero."
    )
    violations: tuple[AccuracyViolation, ...] = entry(
        "Quantities whose relative error exceeds what the tolerance allows. A motion with any is rejected."
    )
    ending: Ending | None = entry("Whether an event ended the motion; null where the scene names none.", None)
    unreleased: tuple[str, ...] = entry("Conditions of releases that do not cross zero: their joints stay.", ())
    choice: Choice | None = entry(
        "Why the engine that began was taken: the steps that the default engine has ahead, the operations of the "
        "motion program, and the seconds that the motion is expected to take with each engine. Null where one was "
        "asked for, or is the only one.",
        None,
    )
    controls: Mapping[str, Number] = entry("Empty where the scene does not observe them.", dict)
    outputs: Mapping[str, Number] = entry("Observed quantities with names of their own.", dict)
    undetermined: tuple[str, ...] = entry(
        "Outputs that are not unique because constraints are redundant, because contacts stuck together, which may "
        "share their friction in several ways, or because a path holds at rest what friction may hold, too. "
        "Multipliers and controls in the latter cases, too.",
        (),
    )
    joints: Mapping[str, str] = entry(
        "Of multipliers the joint or body that they belong to, by its name in the scene file.", dict
    )
    relative_degrees: tuple[int, ...] = entry(
        "Of each output that servo-constraints prescribe: which of its time derivatives the controls are in.", ()
    )
    moved: Correction | None = entry(
        "The initial value that differs most from initial_guess, and by how much; null without a guess.", None
    )
    unresolved: float | None = entry(
        "The first time from which a function of the time changes too often to be looked at ahead, or null.", None
    )
    sensitivities: Mapping[str, Number] = entry(
        "Derivatives at the end, by name such as d(x, m). d(t, m) where an event ends the motion: then the others are "
        "those of the values at the event, not at a fixed time.",
        dict,
    )

    @property
    @computed(
        "True if all errors are in proportion to the tolerance. If false, the simulation failed the accuracy check."
    )
    def trusted(self) -> bool:
        """True if no error is too large for the tolerance."""
        return not self.violations


@dataclass(frozen=True)
class SimulationDocument:
    """A motion integrated numerically.

    Numbers beyond double precision are decimal text.
    """

    report: Report = group()
    engine: str = entry("The same as the segments in one line.")
    notes: tuple[str, ...] = entry("One message each: a hand-over, advice on a hard case.")
    scene: str | None = entry("Name of the scene.", None, optional=True)
    title: str | None = entry("Title of the scene.", None, optional=True)
    samples: Mapping[str, tuple[Number, ...]] | None = entry(
        "By name, t first; missing where the final state alone is asked for.", None, optional=True
    )


@dataclass(frozen=True, repr=False, eq=False)  # arrays have no one answer to ==
class Sampled:
    """Consecutive samples of a motion."""

    times: NDArray[Any]  # shape (k,)
    # coordinates, velocities, multipliers, constraint_forces, controls: shape (k,): at the times; empty where the
    # scene does not observe them
    coordinates: Samples
    velocities: Samples
    multipliers: Samples
    constraint_forces: Samples
    # energy, residuals: shape (k,): ``energy`` and ``energy_error``; ``position``, ``velocity`` and ``acceleration``.
    # Empty likewise.
    energy: Samples
    residuals: Samples
    controls: Samples = field(default_factory=dict)
    outputs: Samples = field(default_factory=dict)  # by their own names
    sensitivities: Samples = field(default_factory=dict)  # ``d(x, m)``: derivatives at the times

    def columns(self) -> Iterator[tuple[str, NDArray[Any]]]:
        """Yield every series of samples with its name, the time first.

        Residuals are named ``residual.position`` and so on.

        Yields
        ------
        name : str
        samples : ndarray, shape (k,)
        """
        yield "t", self.times
        forces = self.multipliers, self.constraint_forces, self.controls
        for part in (self.coordinates, self.velocities, *forces, self.outputs, self.energy, self.sensitivities):
            yield from part.items()
        yield from self.residual_columns().items()

    def residual_columns(self) -> Samples:
        """Return the residuals by the names of their columns.

        Returns
        -------
        dict of str to ndarray, shape (k,)
        """
        return {f"residual.{name}": samples for name, samples in self.residuals.items()}


@dataclass(frozen=True, repr=False, eq=False, kw_only=True)
class Simulation(Sampled, Shown):
    """A simulated motion with its samples."""

    scene: str
    title: str
    report: Report
    drawing: "Drawing | None" = field(default=None, compare=False)  # the drawing of the system, or None

    def __getitem__(self, name: str) -> NDArray[Any]:
        """Return the samples of a quantity.

        Names are ``t``, a coordinate, ``dot(x)``, ``lambda1``, ``residual.position``.

        Raises
        ------
        KeyError
            There is no such quantity, or the scene does not observe it.
        """
        columns = dict(self.columns())
        if name not in columns:
            raise KeyError(f"no samples of {name!r}; the scene observes {', '.join(columns)}")
        return columns[name]

    def __iter__(self) -> Iterator[str]:
        """Return an iterator over the names of `keys`, as of a mapping."""
        return iter(self.keys())

    def keys(self) -> tuple[str, ...]:
        """Return names of the quantities that have samples.

        Returns
        -------
        tuple of str
        """
        return tuple(name for name, _ in self.columns())

    def to_pandas(self) -> "DataFrame":
        """Return all samples as a pandas DataFrame.

        Returns
        -------
        pandas.DataFrame
            A row for each time, a column for each other quantity. Numbers that pandas does not have, those beyond
            extended precision, are objects.

        Raises
        ------
        HolonomError
            pandas is not installed.
        """
        try:
            from pandas import DataFrame
        except ImportError:
            raise missing_package("pandas") from None
        known = {name: each if each.dtype.isbuiltin == 1 else each.astype(object) for name, each in self.columns()}
        return DataFrame(known).set_index("t")

    def plot(self, curves: Sequence[str] | str | None = None) -> "Picture":
        """Return the motion as a picture, for a notebook or a file.

        Parameters
        ----------
        curves : sequence of str, str or None
            Names of quantities as in `keys`, or one name, or None for all but residuals and sensitivities.

        Returns
        -------
        Picture

        Raises
        ------
        HolonomError
            Matplotlib is not installed, or there is no such quantity, or the scene does not observe it.
        """
        from ..figures.motion import motion_figure
        from ..figures.style import Picture

        return Picture(motion_figure(self, [curves] if isinstance(curves, str) else curves))

    def film(self) -> "MovingPicture":
        """Return the motion as a film, for a notebook or a file.

        Returns
        -------
        MovingPicture

        Raises
        ------
        HolonomError
            The system has no drawing, the scene does not observe the trajectory, or the samples are not equidistant, as
            those of ``samples=601`` are.
        """
        from ..figures.film import moving_picture

        return moving_picture(self)


def joined(parts: Sequence[Sampled]) -> Sampled:
    """Join consecutive samples.

    Parameters
    ----------
    parts : sequence of Sampled
        At least one, in order, with the same quantities.

    Returns
    -------
    Sampled
    """
    groups = {
        name: {each: np.concatenate([getattr(part, name)[each] for part in parts]) for each in getattr(parts[0], name)}
        for name in vars(parts[0])
        if name != "times"
    }
    return Sampled(times=np.concatenate([part.times for part in parts]), **groups)
