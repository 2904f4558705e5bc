"""Final events: the first zero crossing of one of the scene's expressions.

They are examined part by part, like switching functions (`zeros.py`), through the engine's dense output. The motion is
integrated to its end once before it is recorded, so that the recording ends with a step of the engine.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import numpy as np

from ..failures import ErrorKind, HolonomError
from ..language import translatable
from ..program.motion_problem import MotionProblem
from ..program.motion_program import Program, names_used
from ..program.precision import Precision
from .engines.engine import Solutions, Step
from .evaluation import Numbers, as_floats, evaluation_once
from .inputs import Inputs
from .nominal import first_order_changes
from .zeros import NODES, ZERO, Crossing, SignedFunctions

if TYPE_CHECKING:
    from .hybrid_motion import HybridMotion
    from .mode import Mode

DRIFT = 10  # tolerances: the same later, where an expression has had no sign yet
STAY = 1 / 2048  # of the time span: what is zero for so long remains zero; friction may touch it for a step
POLE = 1e3  # times what an expression is nearby: at a change of its sign it has no zero

Values = Callable[[Numbers, Numbers], Numbers]


class Sides(dict[str, int]):
    """Signs that expressions have had since they left zero."""

    def __init__(self) -> None:
        super().__init__()
        self.arrived: dict[str, Any] = {}  # expressions that are zero again, and since when


class Ending(NamedTuple):
    """The events at which the scene ends a motion."""

    of: Annotated[tuple[str, ...], "The expressions whose first zero crossing ends the motion, as Maxima prints them."]
    crossed: Annotated[
        str | None, "The one that crossed zero at the last time; null where the time span was over before."
    ]


def first_event(motion: "HybridMotion", end: Any) -> Crossing | None:
    """Integrate a motion to the first zero crossing of one of its events.

    Parameters
    ----------
    motion : HybridMotion
        The motion. It is integrated to the event or to the end.
    end : number
        Last time of the motion.

    Returns
    -------
    Crossing or None
        None if no event crosses zero.

    Raises
    ------
    HolonomError
        An expression has no real, finite value, or the motion cannot be continued so far.
    """
    sides = Sides()
    events: dict[Mode, Events] = {}
    span, precision = float(end - motion.time), motion.mode.precision
    for step in motion.integrate(end):
        if step.mode not in events:
            problem, solutions = step.mode.problem, step.mode.engine.solutions
            values = values_in(problem, problem.ends.events, precision, solutions)
            events[step.mode] = Events(problem.ends.until, values, precision, span, STAY)
        found = events[step.mode].first_event(step, sides)
        if found is not None:
            return found
    return next((Crossing(t, name, -sides[name]) for name, t in sides.arrived.items()), None)


def values_in(
    problem: MotionProblem, program: Program, precision: Precision, solutions: Callable[..., Solutions] | None = None
) -> Values:
    """Return the values of a program's outputs along a motion.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    program : Program
        Expressions of time and state, and of multipliers where there are solutions.
    precision : Precision
        Numbers of the motion.
    solutions : callable or None
        The solutions of the motion's engine at times and states.

    Returns
    -------
    callable
        Takes times, shape (k,), and states, shape (2n, k), to values, shape (outputs, k).
    """
    inputs, evaluate = Inputs(problem, precision), evaluation_once(problem, program, precision)
    solved = solutions if names_used(program) & set(problem.multipliers) else None

    def values(times: Numbers, states: Numbers) -> Numbers:
        multipliers = None if solved is None else solved(times, states).multipliers
        return np.array([as_floats(row) for row in evaluate(inputs(times, states, multipliers))])

    return values


class Events(SignedFunctions):
    """Expressions along one mode of a motion.

    Parameters
    ----------
    names : sequence of str
        The expressions, as Maxima prints them.
    evaluate : callable
        Their values in the mode, in the order of the names, as `values_in` returns them.
    precision : Precision
        Numbers of the motion.
    span : float
        The time span.
    stay : float
        How long an expression stays zero until it counts, as a share of the span.
    """

    def __init__(
        self, names: Sequence[str], evaluate: Values, precision: Precision, span: float, stay: float = 0.0
    ) -> None:
        super().__init__(precision, span)
        self._names, self._evaluate, self._stay = names, evaluate, stay * span
        self._end: Any = None  # of the last step

    def first_event(self, step: Step, sides: Sides) -> Crossing | None:
        """Return the first crossing within a step.

        An expression that a new mode keeps at zero, as dry friction a speed, crosses zero where the mode begins.

        Parameters
        ----------
        step : Step
            A step of the mode.
        sides : Sides
            Those of this step are added.

        Returns
        -------
        Crossing or None

        Raises
        ------
        HolonomError
            An expression has no real, finite value before.
        """
        if arrived := self._arrived(step, sides):
            return arrived
        self._rows, all_seen = self._with_sides(sides), sides.keys() >= set(self._names)
        if all_seen and self._is_clear(step):
            return None
        all_rows = self._rows = [(name, -1, 1) for name in self._names]
        sizes = None if all_seen else self._sizes_in(step)
        for part, places, values in self._looked_at(step):
            begun = {} if sizes is None else self._see_sides(part, values, sizes, sides)
            self._rows = self._with_sides(sides)
            signed = self._signed(values)
            found = self._first_in(part, places, signed, [begun.get(name, 0) for name, *_ in self._rows])
            self._require_values(places, values, found)
            if found is not None:
                self._require_crossing(found, part, values)
                return found
            self._rows = all_rows
        return None

    def _arrived(self, step: Step, sides: Sides) -> Crossing | None:
        """Return the arrival of an expression that remains zero."""
        entered, self._end = step.start != self._end, step.end
        if not sides or not (entered or sides.arrived):
            return None
        since, zero = sides.arrived, self._at_zero(step, sides)
        sides.arrived = {name: since.get(name, step.start) for name in zero if entered or name in since}
        lasting = ((name, t) for name, t in sides.arrived.items() if float(step.end - t) >= self._stay)
        return next((Crossing(t, name, -sides[name]) for name, t in lasting), None)

    def _at_zero(self, step: Step, sides: Mapping[str, int]) -> list[str]:
        """Return the expressions that had a sign and have none in a whole step."""
        self._rows = [(name, -1, 1) for name in self._names]
        _, values = self._samples(step, NODES)
        least = self._sizes_in(step)[:, None] * max(ZERO, DRIFT * step.mode.engine.tol)
        at_zero = (np.abs(values) <= least).all(axis=1)
        return [name for name, zero in zip(self._names, at_zero, strict=True) if zero and name in sides]

    def _sizes_in(self, step: Step) -> Numbers:
        """Return the sizes of expressions in a step, or of their changes."""
        _, values = self._samples(step, NODES)
        start = np.array([step.start])
        changes = first_order_changes(self.values, start, step.states(start), step.mode.matrices.nominal)
        sizes = np.max(np.abs(np.where(np.isfinite(values), values, 0.0)), axis=1)
        return np.maximum(sizes, changes[:, 0])

    def _see_sides(self, part: Step, values: Numbers, sizes: Numbers, sides: dict[str, int]) -> dict[str, int]:
        """Add the signs of expressions that are seen for the first time.

        Return the samples at which those are seen that are zero before.
        """
        begun: dict[str, int] = {}
        least = np.outer(sizes, np.full(values.shape[1], max(ZERO, DRIFT * part.mode.engine.tol)))
        if float(part.start) == float(part.mode.problem.start["t"]):
            least[:, 0] = ZERO * sizes
        for name, row, clear in zip(self._names, values, np.abs(values) > least, strict=True):
            if name in sides or not clear.any():
                continue
            first = int(np.argmax(clear))
            sides[name] = 1 if row[first] > 0 else -1
            if first > 0:
                begun[name] = first
        return begun

    def _require_values(self, places: Numbers, values: Numbers, found: Crossing | None) -> None:
        """Reject an expression without a real, finite value at a time of the motion."""
        for row, place in np.argwhere(~np.isfinite(values)):
            if found is None or places[place] <= found.t:
                self._reject(self._names[row], places[place])

    def _require_crossing(self, found: Crossing, part: Step, values: Numbers) -> None:
        """Reject a change of sign through infinity."""
        row = [name for name, *_ in self._rows].index(found.name)
        at = np.array([found.t])
        seen = np.abs(values[self._names.index(found.name)])
        if abs(self.values(at, part.states(at))[row, 0]) > POLE * np.max(seen, where=np.isfinite(seen), initial=0.0):
            self._reject(found.name, found.t)

    def _reject(self, name: str, t: Any) -> None:
        raise HolonomError(
            ErrorKind.NO_EVENT_VALUE,
            detail=translatable("%(name)s at t = %(time)s", name=name, time=f"{float(t):.10g}"),
        )

    def values(self, times: Numbers, states: Numbers) -> Numbers:
        """Return expressions of a known side (see `SignedFunctions.values`)."""
        return self._signed(self._evaluate(times, states))

    def _with_sides(self, sides: Mapping[str, int]) -> list[tuple[str, int, int]]:
        return [(name, -sides[name], sides[name]) for name in self._names if name in sides]

    def _signed(self, values: Numbers) -> Numbers:
        """Return the rows of values whose side is known, each times its sign."""
        places = [self._names.index(name) for name, *_ in self._rows]
        sides = np.array([side for *_, side in self._rows], dtype=float)
        return sides[:, None] * values[places]
