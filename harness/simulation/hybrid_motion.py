"""A motion that is analytic in parts: followed in each by the engines, and led from one to the next.

While the signs in its equations stay the same a motion is analytic. An engine follows it with these signs; where a
switching function leaves its sign, the step is cut, and what the equations say on both sides decides how it goes on:

- where both sides lead across the surface, it is crossed;
- where both lead back to it, the motion is held on it, as dry friction sticks, until one of them does not
  (Filippov, Differential Equations with Discontinuous Righthand Sides, section 4);
- where a joint is released, its constraints end: the state goes on as it is, and the accelerations jump;
- where a law's rate jumps, the velocities do: the momenta dL/d dot(q) change along the constraints' gradients alone, by
  the impulse that makes the new velocities keep the constraints (Pars, A Treatise on Analytical Dynamics, chapter 14).

What mechanics does not decide is refused: a law that jumps in a constraint, an energy that does as a function of the
state, an impulse of a surface whose law of impact is not given.
"""

from bisect import bisect_right
from collections import deque
from collections.abc import Hashable, Iterator
from dataclasses import replace
from enum import StrEnum
from fractions import Fraction
from heapq import merge
from itertools import groupby, islice
from typing import Any, NamedTuple

import numpy as np

from ..failures import Failure, HolonomError
from ..program.motion_problem import By, MotionProblem, Sign, function_of_knot
from ..program.motion_program import names_used
from ..program.precision import Precision
from ..program.sign_pattern import SLIDING, Pattern, holdable, switching_function
from .constraints.factorization import factored_constraints
from .constraints.projection import settle
from .control_matrix import controls_may_fail
from .engines.engine import Step
from .engines.fallback import EngineSegment
from .evaluation import Evaluation, Numbers, as_floats, evaluation
from .events import Events
from .inputs import Inputs
from .matrices import Matrices, Vector
from .mode import Mode
from .nominal import nominal_of, with_nominal
from .request import SimulationRequest
from .residuals import residuals
from .time_events import time_events
from .zeros import Crossing

ZERO = 1e-12  # of what a switching function or its rate is at nominal sizes: no sign
CONTINUOUS = 1e-9  # relative change at an instant that is rounding
LATER = (1 / 7, 3 / 7, 6 / 7)  # of the nominal time: instants at which a function of the time is looked at
CROWD, CROWDED = 64, 1e-7  # switchings in a part of the time span: more have no end
SOON = 1e-9  # of the time span: how far ahead the sign of a function of the time is looked for where it vanishes


class Passage(StrEnum):
    """How a motion passes a surface."""

    CROSSED = "crossed"
    SLIDING = "held"
    RELEASED = "released"
    IMPULSE = "crossed with an impulse"
    JOINT_RELEASED = "joint released"


class Switching(NamedTuple):
    """An instant at which a motion is not analytic."""

    t: float
    function: str  # what changes its sign there, as Maxima prints it
    passage: Passage


class ModeInterval(NamedTuple):
    """A mode at work from an instant on."""

    start: Any
    mode: Mode


class HybridMotion:
    """A motion followed through its switchings, and no farther in one step than it may depend on the time.

    Parameters
    ----------
    end : number
        The last instant.

    Raises
    ------
    HolonomError
        As `FallbackEngine`; the motion starts where the equations leave open how it goes on.
    """

    def __init__(self, problem: MotionProblem, request: SimulationRequest, precision: Precision, end: Any) -> None:
        self._span = float(end) - float(problem.start["t"])
        self._request, self._precision, self._end = request, precision, end
        self._modes: dict[tuple[Any, ...], Mode] = {}
        self._sides: dict[str, int] = {}  # signs of the conditions of releases, since they left zero
        self._zero = self._impulse = precision.number("0")
        self.switchings: list[Switching] = []
        self.intervals: list[ModeInterval] = []
        problem = with_nominal(problem, self._span)
        self.nominal = nominal_of(problem)
        self._begin(problem)

    def _begin(self, problem: MotionProblem) -> None:
        """Begin with the constraints of a problem, at its start."""
        precision, self.problem = self._precision, problem
        self._signs = {sign.name: sign for sign in problem.signs}
        self._time_events = time_events(problem)
        self._to_come = deque(sorted({event.t for event in self._time_events.values()}))
        self._knots = _knots_of(problem, precision)
        self._known: dict[Hashable, MotionProblem] = problem.once("modes", problem.matrices, dict)
        self._functions: dict[Hashable, tuple[Evaluation, list[int]]] = problem.once(
            ("switching", precision.name), problem.matrices, dict
        )
        self._inputs = Inputs(problem, precision)
        self._left: tuple[str, ...] = ()
        self._conditions: dict[Mode, Events] = {}
        start, *state = (precision.number(problem.start[name]) for name in ("t", *problem.state))
        pattern = self._first_pattern(start, np.array(state))
        self.intervals.append(ModeInterval(start, self._mode_of(pattern, problem)))

    @property
    def mode(self) -> Mode:
        """The mode at work."""
        return self.intervals[-1].mode

    @property
    def time(self) -> Any:
        """The instant that is reached."""
        return self.mode.engine.time

    @property
    def state(self) -> Numbers:
        """The state at this instant."""
        return self.mode.engine.state

    @property
    def steps(self) -> int:
        """Steps taken so far."""
        return sum(mode.engine.steps for mode in self._modes.values())

    @property
    def compile_seconds(self) -> float:
        """Time that the compilation of the engines took."""
        return sum(mode.engine.compile_seconds for mode in self._modes.values())

    @property
    def unresolved(self) -> float | None:
        """The first instant from which an expression of the time changes too fast to be looked at ahead."""
        found = (interval.mode.by_time.unresolved for interval in self.intervals)
        return min((t for t in found if t is not None), default=None)

    @property
    def legs(self) -> list[EngineSegment]:
        """Which engine followed the motion from when to when."""
        ends = [*(float(interval.start) for interval in self.intervals[1:]), float(self.time)]
        found: list[EngineSegment] = []
        for interval, end in zip(self.intervals, ends, strict=True):
            for leg in interval.mode.engine.legs:
                cut = leg._replace(start=max(leg.start, float(interval.start)), end=min(leg.end, end))
                if cut.start < cut.end:
                    if found and found[-1]._replace(start=cut.start, end=cut.end) == cut:
                        cut = cut._replace(start=found.pop().start)
                    found.append(cut)
        return found

    def close(self) -> None:
        """Give back what the engines hold outside of Python; the motion is not followed any more."""
        for mode in self._modes.values():
            mode.engine.close()

    def advance(self, until: Any) -> None:
        """Follow the motion to an instant.

        Raises
        ------
        HolonomError
            The motion cannot be followed so far.
        """
        if self.problem.signs or self.problem.released or controls_may_fail(self.problem):
            deque(self.integrate(until), maxlen=0)
            return
        while self.time != until:
            self.mode.engine.advance(self._next_stop(until))
            self._pass_knots()
            self.mode.require_way_on(until)

    def integrate(self, until: Any) -> Iterator[Step]:
        """Follow the motion to an instant, step by step, each with its mode; raises as `advance`."""
        while self.time != until:
            for step in self._to_stop(self._next_stop(until)):
                release = self._first_release(step)
                if release is not None:
                    step = step._replace(end=release.t)
                if step.start != step.end:
                    yield step._replace(impulse=self._impulse)
                    self._impulse = self._zero
                if release is not None:
                    self._release(release, step)
                    break
            self._pass_knots()
            self.mode.require_way_on(until)

    # ---- steps ----

    def _next_stop(self, until: Any) -> Any:
        stops, step = self.mode.stops, self._request.max_step
        ticking = [self._precision.ratio(t) for t in islice(self._to_come, 1)] + [t for t, _ in self._knots[-1:]]
        next_stop = bisect_right(stops, float(self.time))
        ahead = stops[next_stop : next_stop + 1]
        limits = [self.time + self._precision.number(repr(step))] if step is not None else []
        return min([until, *limits, *ticking, *(self._precision.number(repr(t)) for t in ahead)])

    def _pass_knots(self) -> None:
        """At a knot a law goes on with the same value and rates up to the second, and so does the motion."""
        while self._knots and self._knots[-1][0] <= self.time != self._end:
            t, exact = self._knots.pop()
            self.switchings.append(Switching(float(t), function_of_knot(exact), Passage.CROSSED))

    def _to_stop(self, stop: Any) -> Iterator[Step]:
        mode = self.mode
        if not self.problem.signs:
            yield from mode.integrate(stop)
            return
        for step in mode.integrate(stop):
            crossing = mode.surfaces.first_crossing(step, self._left)
            if crossing is None:
                yield step
                self._left = ()
            else:
                if crossing.t > step.start:
                    yield step._replace(end=crossing.t)
                self._cross(crossing, step.states(np.array([crossing.t]))[:, 0])
                return
        if self._to_come and self._precision.ratio(self._to_come[0]) == self.time != self._end:
            instant = self._to_come.popleft()
            changes = {name: event.to for name, event in self._time_events.items() if event.t == instant}
            self._switch({**mode.pattern, **changes}, list(changes), self.time, self.state.copy(), ())

    # ---- releases ----

    def _first_release(self, step: Step) -> Crossing | None:
        """Return where within a step the first condition of a release crosses zero."""
        released, mode = self.problem.released, step.mode
        if not released:
            return None
        if mode not in self._conditions:
            names = [each.of for each in released]
            self._conditions[mode] = Events(names, mode.problem.releases, mode, self._precision, self._span)
        return self._conditions[mode].first_event(step, self._sides)

    def _release(self, crossing: Crossing, step: Step) -> None:
        """Go on without the constraints of a release: from the same state, for that needs no impulse."""
        state = step.states(np.array([crossing.t]))[:, 0]
        begun = self._started_at(crossing.t, state)
        after = next(each.after for each in self.problem.released if each.of == crossing.name)
        self._begin(replace(after, start=begun.start, values=begun.values, nominal=begun.nominal))
        self.mode.engine.restart(crossing.t, state)
        self.switchings.append(Switching(float(crossing.t), crossing.name, Passage.JOINT_RELEASED))

    # ---- switching ----

    def _cross(self, crossing: Crossing, state: Numbers) -> None:
        """Go on from a surface of the state, or of the time."""
        t, name, before = crossing.t, crossing.name, self.mode.pattern
        again = t == self.intervals[-1].start and name in self._left
        if again or self._crowded(t):
            self._refuse(t, f"{self._signs[name].of} changes its sign again and again")
        pattern, sign = {**before, name: crossing.to}, self._signs[name]
        if before[name] != SLIDING and sign.by is not By.TIME:
            pattern[name] = self._sign_behind(sign, pattern, t, state, crossing.to)
        self._switch(pattern, [name], t, state, (name,))

    def _switch(self, pattern: Pattern, names: list[str], t: Any, state: Numbers, left: tuple[str, ...]) -> None:
        """Go on with another mode, in which some signs are others; `left` are the surfaces that are left."""
        before, after = self.mode, self._mode_of(pattern, self._started_at(t, state))
        moved = self._passed(before, after, self._signs[names[0]], t, state)
        after.engine.restart(t, moved)
        self._left = (*self._left, *left) if t == self.intervals[-1].start else left
        self.intervals.append(ModeInterval(t, after))
        self._impulse = self._impulse + (after.energy_at(t, moved) - before.energy_at(t, state))
        if before.pattern[names[0]] == SLIDING:
            passage = Passage.RELEASED
        elif pattern[names[0]] == SLIDING:
            passage = Passage.SLIDING
        else:
            change = self.nominal.share(as_floats(moved - state), as_floats(state))
            passage = Passage.CROSSED if change <= CONTINUOUS else Passage.IMPULSE
        self.switchings += [Switching(float(t), self._signs[name].of, passage) for name in names]

    def _sign_behind(self, sign: Sign, pattern: Pattern, t: Any, state: Numbers, to: int | None = None) -> int | str:
        """Return the sign with which a motion goes on from a surface of the state.

        None for `to` where it starts on it.
        """
        if sign.by is By.CONFIGURATION and not self._vanishes("switch_rate", sign, pattern, t, state):
            return to or (1 if self._output("switch_rate", sign, pattern, t, state) > 0 else -1)
        if holdable(self.problem, sign.name):
            return self._decided(sign, pattern, t, state)
        if to is None:
            self._refuse(t, f"{sign.of} is zero, and not in forces alone, which leaves open how the motion goes on")
        return to

    def _decided(self, sign: Sign, pattern: Pattern, t: Any, state: Numbers) -> int | str:
        """Return what the motions on both sides of a surface say about the sign of the motion that is on it."""
        above, below = (self._output("drive", sign, {**pattern, sign.name: to}, t, state) for to in (1, -1))
        if above * below > 0:
            return 1 if above > 0 else -1
        if above < 0 < below:
            if other := next((name for name, value in pattern.items() if value == SLIDING and name != sign.name), None):
                self._refuse(t, f"{self._signs[other].of} and {sign.of} are both held at zero")
            return SLIDING
        if above > 0 > below:
            self._refuse(t, f"{sign.of} is zero, and the motion may leave to either side")
        return 1 if above >= 0 and below >= 0 else -1

    def _passed(self, before: Mode, after: Mode, sign: Sign, t: Any, state: Numbers) -> Numbers:
        """Return the state behind an instant of switching."""
        floats, n = as_floats(state), len(state) // 2
        old, new = before.matrices(float(t), floats), after.matrices(float(t), floats)
        left = residuals(new, floats, np.zeros(n), self.nominal)["position"]
        energies = np.outer(self.nominal.velocities, self.nominal.velocities)
        if left > CONTINUOUS or not _close(new.mass * energies, old.mass * energies):
            self._refuse(t, f"the constraints or the masses jump as {sign.of} changes its sign")
        kick = np.subtract(*(as_floats(mode.momenta(self._inputs(t, state))) for mode in (before, after)))
        moved = state.copy()
        if np.max(np.abs(kick) * self.nominal.velocities, initial=0.0) > CONTINUOUS * self.nominal.energy(new.mass):
            if self._precision.name != "double":
                self._refuse(t, f"momenta jump as {sign.of} changes its sign, which takes double precision")
            moved[n:] += factored_constraints(new.mass, new.jacobian).accelerations(kick, new.residual_rate)
        if after.problem.projection is None:
            moved = settle(after.matrices, float(t), as_floats(moved))[0]
        else:
            after.projection.project(t, moved)
        continuous = self.nominal.share(as_floats(moved - state), floats) <= CONTINUOUS
        if self.problem.servo and not continuous:
            self._require_reactions(new, as_floats(moved - state)[n:], kick, sign, t)
        if sign.by is not By.TIME:
            jump = abs(float(after.energy_at(t, state) - before.energy_at(t, state)))
            if not continuous:
                self._refuse(t, f"an impact decides how the motion goes on as {sign.of} changes its sign")
            if jump > CONTINUOUS * max(self.nominal.energy(old.mass), abs(float(before.energy_at(t, state)))):
                self._refuse(t, f"the energy jumps as {sign.of} changes its sign")
        return moved

    def _require_reactions(self, at: Matrices, change: Vector, kick: Vector, sign: Sign, t: Any) -> None:
        """Refuse a change of velocities that takes an impulse of the controls that servo-constraints find."""
        reactions = at.jacobian[: len(self.problem.reactions)].T
        impulse = at.mass @ change - kick
        left = impulse - reactions @ np.linalg.lstsq(reactions, impulse)[0]
        if np.max(np.abs(left)) > CONTINUOUS * np.max(np.abs(impulse)):
            self._refuse(t, f"servo-constraints would take an impulse of the controls as {sign.of} changes its sign")

    def _first_pattern(self, t: Any, state: Numbers) -> Pattern:
        """Signs at the start, each function after those that it may contain."""
        pattern: dict[str, int | str] = dict.fromkeys(self._signs, 1)
        for name, event in self._time_events.items():
            pattern[name] = event.to if self._precision.ratio(event.t) <= t else -event.to
        while self._to_come and self._precision.ratio(self._to_come[0]) <= t:
            self._to_come.popleft()
        for sign in self.problem.signs:
            if sign.name in self._time_events:
                continue
            if self._vanishes("switch", sign, pattern, t, state):
                pattern[sign.name] = self._leaving(sign, pattern, t, state)
                self._left = (*self._left, sign.name)
            else:
                pattern[sign.name] = 1 if self._output("switch", sign, pattern, t, state) > 0 else -1
        return pattern

    def _leaving(self, sign: Sign, pattern: Pattern, t: Any, state: Numbers) -> int | str:
        """Return the sign with which a motion starts from a surface."""
        if sign.by is By.TIME:
            soon = t + self._precision.number(repr(SOON * self._span))
            return 1 if self._output("switch", sign, pattern, soon, state) >= 0 else -1
        return self._sign_behind(sign, pattern, t, state)

    def _crowded(self, t: Any) -> bool:
        return len(self.intervals) > CROWD and float(t - self.intervals[-CROWD].start) < CROWDED * self._span

    def _refuse(self, t: Any, reason: str) -> None:
        raise HolonomError(Failure.NO_WAY_ON, detail=f"{float(t):.10g}, where {reason}")

    # ---- numbers at an instant ----

    def _output(self, name: str, sign: Sign, pattern: Pattern, t: Any, state: Numbers) -> float:
        """Value of a `switching_function`, which is compiled when it is first asked for."""
        return float(self._function(name, sign, pattern)[0](self._inputs(t, state))[0])

    def _vanishes(self, name: str, sign: Sign, pattern: Pattern, t: Any, state: Numbers) -> bool:
        """Return True if a `switching_function` is rounding, beside what it changes by as the state and the time do."""
        function, places = self._function(name, sign, pattern)
        number = self._precision.number
        others = [(t + number(repr(share * self.nominal.time)), state) for share in LATER]
        for place in places:
            moved, size = state.copy(), max(abs(float(state[place])), float(self.nominal.state[place]))
            moved[place] += number(repr(size))
            others.append((t, moved))
        here, *there = (float(function(self._inputs(*at))[0]) for at in ((t, state), *others))
        changes = np.abs(np.array(there) - here)
        return abs(here) <= ZERO * float(np.sum(changes, where=np.isfinite(changes)))

    def _function(self, name: str, sign: Sign, pattern: Pattern) -> tuple[Evaluation, list[int]]:
        """Return a `switching_function`, and the places in the state of what it contains."""
        what = name, sign.name, frozenset(pattern.items())
        if what not in self._functions:
            program = switching_function(self.problem, name, sign.name, pattern)
            used = names_used(program)
            places = [place for place, each in enumerate(self.problem.state) if each in used]
            self._functions[what] = evaluation(program, self._precision), places
        return self._functions[what]

    # ---- modes ----

    def _mode_of(self, pattern: Pattern, problem: MotionProblem) -> Mode:
        key = (problem.multipliers, *pattern.values())
        if key not in self._modes:
            self._modes[key] = Mode(
                problem, pattern, self._time_events, self._request, self._precision, self._end, self._known
            )
        return self._modes[key]

    def _started_at(self, t: Any, state: Numbers) -> MotionProblem:
        numbers = (self._precision.text(number) for number in (t, *state))
        return replace(self.problem, start=dict(zip(("t", *self.problem.state), numbers, strict=True)))


def _knots_of(problem: MotionProblem, precision: Precision) -> list[tuple[Any, Fraction]]:
    """Return the knots of the tables behind the start, the last first."""
    behind = precision.number(problem.start["t"])
    knots = [(precision.ratio(knot), knot) for knot, _ in groupby(merge(*(table.knots for table in problem.tables)))]
    return [(t, knot) for t, knot in reversed(knots) if t > behind]


def _close(numbers: Vector, others: Vector) -> bool:
    """Return True if two arrays of numbers differ by rounding alone."""
    return bool(np.max(np.abs(numbers - others), initial=0.0) <= CONTINUOUS * np.max(np.abs(others), initial=0.0))
