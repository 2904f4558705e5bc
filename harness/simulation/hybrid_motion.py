"""Motions that are analytic in modes, integrated by the engines from mode to mode.

While the signs in its equations stay the same, a motion is analytic. An engine integrates it with these signs. If a
switching function changes its sign, the step is cut, and the equations on both sides decide the continuation:

- if both sides lead across the switching surface, it is crossed.
- if both lead back to it, the motion slides on it, as dry friction sticks, until one of them does not
  (Filippov, Differential Equations with Discontinuous Righthand Sides, section 4).
- if a joint is released, its constraints end: the state stays the same, and the accelerations jump,
- if the time derivative of a control law is discontinuous, so are the velocities: the momenta dL/d dot(q) change along
  the constraints' gradients only, by the impulse that makes the new velocities satisfy the constraints (Pars, A
  Treatise on Analytical Dynamics, chapter 14).

Undetermined continuations are rejected: a control law that jumps in a constraint, an energy that jumps as a function of
the state, an impulse of a switching surface without a law of impact.
"""

from bisect import bisect_right
from collections import deque
from collections.abc import Callable, Hashable, Iterator, Sequence, Set
from dataclasses import replace
from enum import StrEnum
from fractions import Fraction
from heapq import merge
from itertools import groupby, islice
from typing import Annotated, Any, NamedTuple, NoReturn

import numpy as np

from ..failures import ErrorKind, HolonomError
from ..language import translatable
from ..program.friction import SLIDING, STUCK, Pattern, sticking
from ..program.motion_problem import Built, DependsOn, MotionProblem, Sign, function_of_knot
from ..program.motion_program import names_used
from ..program.precision import Precision
from ..program.rewriting import computing
from ..program.sign_pattern import driven, problem_in, program_in, switching_function, switching_functions
from .accuracy_check import has_root_of
from .branch_points import last_step, real_state
from .constraints.factorization import factored_constraints
from .control_matrix import controls_may_fail
from .engines.engine import Step, advance
from .engines.fallback import EngineSegment
from .evaluation import Evaluation, Numbers, as_floats, evaluation, evaluation_once
from .events import Events, Sides, Values, values_in
from .friction_modes import FrictionModes, modes_that_may_agree
from .inputs import Inputs
from .matrices import Matrices, MotionMatrices, Vector
from .mode import UNIQUE, Mode
from .nominal import first_order_changes, nominal_of, with_nominal
from .place_and_reason import place_and_reason
from .request import SimulationRequest
from .residuals import residuals
from .time_events import remains_zero, time_events
from .uniqueness import accelerations_differ, differing_outputs
from .zeros import ZERO, Crossing

CONTINUOUS = 1e-9  # relative change at a given time that is rounding
CROWD, CROWDED = 64, 1e-7  # switchings in a part of the time span: more have no end
NEAR = 1e-6  # share of its changes that a determinant has at a paradox, towards which steps become too short
NOT_UNIQUE = translatable(
    "forces that contain multipliers may leave no acceleration, or several (Painleve's paradoxes)"
)
ROOT_JUMPS = 1e-6  # of the nominal accelerations: a change from shortly before the zero of a root to shortly behind it
ROOT_OF_ZERO = translatable(
    "series do not continue a root beyond its zero, or atan2 beyond its cut "
    "(in a line, write abs(v) for the root of v^2)"
)
ROOT_PASSED = 1e-9  # of the time span: how far behind the zero of a root to continue
SOON = 1e-9  # of the time span: how far ahead the sign of a function of the time is looked for where it vanishes


class EventOutcome(StrEnum):
    """The outcome of an event at a switching surface."""

    CROSSED = "crossed"
    SLIDING = "sliding"
    RELEASED = "released"
    IMPULSE = "crossed with an impulse"
    JOINT_RELEASED = "joint released"


class Switching(NamedTuple):
    """A time at which a motion is not analytic."""

    t: Annotated[float, "Time of the switching."]
    function: Annotated[str, "Function whose sign changes, as Maxima prints it."]
    outcome: Annotated[EventOutcome, "Behaviour after the switching."]


class ModeInterval(NamedTuple):
    """A mode, and the time from which it is active."""

    start: Any
    mode: Mode


class HybridMotion:
    """A motion through its switchings, with steps limited by its dependence on time.

    Parameters
    ----------
    end : number
        The last time.

    Raises
    ------
    HolonomError
        As `FallbackEngine`, or the motion starts where the equations leave open how it continues.
    """

    def __init__(self, problem: MotionProblem, request: SimulationRequest, end: Any) -> None:
        self._span = float(end) - float(problem.start["t"])
        self._request, self._precision, self._end = request, request.numbers, end
        self._modes: dict[tuple[Any, ...], Mode] = {}
        self._sides = Sides()  # of the conditions of releases
        self._zero = self._impulse = self._precision.number("0")
        self.switchings: list[Switching] = []
        self.intervals: list[ModeInterval] = []
        self.undetermined: dict[str, None] = {}  # multipliers, controls and outputs that friction leaves open
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
        self._functions: dict[Hashable, Any] = problem.once(("switching", precision.name), problem.matrices, dict)
        self._inputs = Inputs(problem, precision)
        self._left_open: tuple[str, ...] = ()  # outputs that depend on a sign that the accelerations do not
        self._undecided = ""  # functions with such signs that other accelerations depend on
        self._left: dict[str, Any] = {}  # signs whose switching surfaces the motion has left, with the times
        self._conditions: dict[Mode, Events] = {}
        start, *state = (precision.number(problem.start[name]) for name in ("t", *problem.state))
        pattern = self._first_pattern(start, np.array(state))
        self._require_signs(pattern, start, np.array(state))
        self.intervals.append(ModeInterval(start, self._mode_of(pattern, problem)))

    @property
    def mode(self) -> Mode:
        """The active mode."""
        return self.intervals[-1].mode

    @property
    def time(self) -> Any:
        """The time that is reached."""
        return self.mode.engine.time

    @property
    def state(self) -> Numbers:
        """The state at this time."""
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
        """The first time after which an expression of time changes too fast to examine."""
        found = (interval.mode.by_time.unresolved for interval in self.intervals)
        return min((t for t in found if t is not None), default=None)

    @property
    def segments(self) -> list[EngineSegment]:
        """Engines and the time intervals in which they integrated the motion."""
        ends = [*(float(interval.start) for interval in self.intervals[1:]), float(self.time)]
        found: list[EngineSegment] = []
        for interval, end in zip(self.intervals, ends, strict=True):
            for segment in interval.mode.engine.segments:
                cut = segment._replace(start=max(segment.start, float(interval.start)), end=min(segment.end, end))
                if cut.start < cut.end:
                    if found and found[-1]._replace(start=cut.start, end=cut.end) == cut:
                        cut = cut._replace(start=found.pop().start)
                    found.append(cut)
        return found

    def close(self) -> None:
        """Free resources of the engines outside of Python. The motion cannot be continued."""
        for mode in self._modes.values():
            mode.engine.close()

    def integrate(self, until: Any, dense: bool = True) -> Iterator[Step]:
        """Integrate to a time and yield each step with its mode.

        Parameters
        ----------
        until : number
            Last time.
        dense : bool
            False if the steps are not needed. Those of a single mode are not yielded then.

        Yields
        ------
        Step

        Raises
        ------
        HolonomError
            The motion cannot be continued so far.
        """
        looked_at = dense or self.problem.switching or self.problem.ends.released or controls_may_fail(self.problem)
        looked_at = looked_at or self.mode.radicands
        while self.time != until:
            stop = self._next_stop(until)
            if looked_at:
                yield from self._to_release(stop)
            else:
                advance(self.mode.engine, stop)
            self._pass_knots()
            self.mode.require_way_on(until)

    # ---- steps ----

    def _next_stop(self, until: Any) -> Any:
        stops = self.mode.stops
        known_times = [self._precision.ratio(t) for t in islice(self._to_come, 1)] + [t for t, _ in self._knots[-1:]]
        next_stop = bisect_right(stops, float(self.time))
        ahead = stops[next_stop : next_stop + 1]
        return min([until, *known_times, *(self._precision.number(repr(t)) for t in ahead)])

    def _pass_knots(self) -> None:
        """Continue at a knot of a law, which is continuous up to its second derivative."""
        while self._knots and self._knots[-1][0] <= self.time != self._end:
            t, exact = self._knots.pop()
            self.switchings.append(Switching(float(t), function_of_knot(exact), EventOutcome.CROSSED))

    def _to_release(self, stop: Any) -> Iterator[Step]:
        """Yield steps to a stop, or to the first release before it."""
        for step in self._to_stop(stop):
            release = self._first_release(step)
            if release is not None:
                step = step._replace(end=release.t)
            lost = None if step.mode.radicands is None else step.mode.radicands.lost(step)
            behind = None if lost is None else self._behind_root(lost, step)
            if lost is not None:
                step = step._replace(end=lost if behind is None else behind)
            if step.start != step.end:
                yield step._replace(impulse=self._impulse)
                self._impulse = self._zero
            if lost is not None:
                if behind is None:
                    self._reject(lost, ROOT_OF_ZERO)
                self.mode.engine.restart(behind, step.states(np.array([behind]))[:, 0])
                break
            if release is not None:
                self._release(release, step)
                break

    def _behind_root(self, zero: float, step: Step) -> float | None:
        """Return a time behind the zero of a root until which the step is right.

        It is None in other precisions, and if the accelerations jump at the zero.
        """
        near = ROOT_PASSED * self._span
        around = np.array([zero - near, zero + near])
        if self._precision.name != "double" or not step.start + 3 * near < zero < step.end - near:
            return None
        before, behind = step.mode.engine.solutions(around, step.states(around)).accelerations.T
        change = np.max(np.abs(behind - before) / self.nominal.accelerations)
        agrees = change <= ROOT_JUMPS and step.mode.radicands.agrees(step._replace(end=around[1]))
        return around[1] if agrees else None

    def _to_stop(self, stop: Any) -> Iterator[Step]:
        mode = self.mode
        if self.problem.switching is None:
            yield from mode.integrate(stop)
            return
        for step in self._steps(stop):
            crossing = mode.switching_functions.first_crossing(step, self._left)
            if crossing is None:
                self._look_at_rest(step)
                yield step
            else:
                if crossing.t > step.start:
                    yield step._replace(end=crossing.t)
                self._cross(crossing, step.states(np.array([crossing.t]))[:, 0])
                return
        if self._to_come and self._precision.ratio(self._to_come[0]) == self.time != self._end:
            time_point = self._to_come.popleft()
            changes = {name: event.to for name, event in self._time_events.items() if event.t == time_point}
            t, state = self.time, self.state.copy()
            pattern = self._after_jumps({**mode.pattern, **changes}, t, state)
            zeros = self._zeros_at({*sticking(pattern)}, pattern, t, state)
            pattern = self._decided_with_jumps(pattern, zeros, t, state)
            self._switch(pattern, list(changes), t, state, ())

    def _look_at_rest(self, step: Step) -> None:
        """Note outputs, and reject accelerations, that a sign left open."""
        if self._left_open or self._undecided:
            t = step.start + (step.end - step.start) / 2
            if self._zeros_at(set(), step.mode.pattern, t, step.states(np.array([t]))[:, 0]):
                self.undetermined |= dict.fromkeys(self._left_open)
                if self._undecided:
                    self._reject_zero(step.start, self._undecided)
            self._left_open, self._undecided = (), ""

    def _steps(self, stop: Any) -> Iterator[Step]:
        """Yield steps of the mode, the last one to a branch point.

        An error names the paradox that the motion comes near.
        """
        mode = self.mode
        try:
            yield from mode.integrate(stop)
        except HolonomError as error:
            if error.kind is not ErrorKind.NO_WAY_ON:
                raise
            if self._nears_paradox():
                self._reject(self.time, NOT_UNIQUE)
            if self._precision.name != "double":
                raise
            step = last_step(mode, stop, self._span, self.nominal)
            if step is not None:
                yield step
            raise

    def _nears_paradox(self) -> bool:
        """Return True if accelerations are hardly unique: multipliers grow."""
        if not self.problem.reacting:
            return False
        guards = self._lasting_modes(self.mode.pattern).guards
        return bool(self._near_zero(lambda *at: guards(self._inputs(*at)), NEAR, self.time, self.state).any())

    # ---- releases ----

    def _first_release(self, step: Step) -> Crossing | None:
        """Return the first zero crossing of a release condition within a step."""
        released, mode = self.problem.ends.released, step.mode
        if not released:
            return None
        if mode not in self._conditions:
            names = [each.of for each in released]
            conditions = values_in(mode.problem, mode.problem.ends.releases, self._precision, mode.engine.solutions)
            self._conditions[mode] = Events(names, conditions, self._precision, self._span)
        return self._conditions[mode].first_event(step, self._sides)

    def _release(self, crossing: Crossing, step: Step) -> None:
        """Continue without the constraints of a release, from the same state.

        A release needs no impulse.
        """
        state = step.states(np.array([crossing.t]))[:, 0]
        begun = self._started_at(crossing.t, state)
        after = next(each.after for each in self.problem.ends.released if each.of == crossing.name)
        self._begin(replace(after, start=begun.start, values=begun.values, nominal=begun.nominal))
        self.mode.engine.restart(crossing.t, state)
        self.switchings.append(Switching(float(crossing.t), crossing.name, EventOutcome.JOINT_RELEASED))

    # ---- switching ----

    def _cross(self, crossing: Crossing, state: Numbers) -> None:
        """Continue from a switching surface of the state, or from a time event."""
        t, name, before = crossing.t, crossing.name, self.mode.pattern
        stuck = not STUCK.keys().isdisjoint(before.values())
        if name == UNIQUE and not stuck:
            self._reject(t, NOT_UNIQUE)
        if self._left.get(name) == t or self._crowded(t):
            self._reject(t, translatable("%(sign)s changes its sign again and again", sign=self._of([name])))
        if stuck and name in (UNIQUE, *sticking(before)):
            self._leave_stuck(crossing, state)
            return
        sign, zeros = self._signs[name], sticking(before)
        pattern = {**before, name: crossing.to}
        if before[name] == SLIDING:
            zeros = [other for other in zeros if other != name]
        elif self._is_decided_by_accelerations(sign, pattern, t, state):
            zeros = self._zeros_at({name, *zeros}, pattern, t, state)
        else:
            pattern = self._after_jumps(pattern, t, state)
            zeros = sticking(pattern)
        if sign.by is not DependsOn.REACTION:
            pattern = self._decided_with_jumps(pattern, zeros, t, state)
        self._switch(pattern, [name], t, state, (name,))

    def _leave_stuck(self, crossing: Crossing, state: Numbers) -> None:
        """Let contacts that stick together slip, or share their friction otherwise."""
        t, before = crossing.t, self.mode.pattern
        zeros = sticking(before)
        found = self._modes_at(before, zeros).agreeing(self._inputs(t, state))
        if found and all(found[0].is_shared_as(each) for each in found):
            lead = next(name for name in zeros if before[name] == SLIDING)
            self._switch(found[-1].pattern, [lead], t, state, tuple(zeros))
        elif crossing.name == UNIQUE:
            self._reject(t, NOT_UNIQUE)
        else:
            self._switch(self._decided(before, zeros, t, state), [crossing.name], t, state, ())

    def _switch(self, pattern: Pattern, names: list[str], t: Any, state: Numbers, left: tuple[str, ...]) -> None:
        """Continue in another mode with some signs changed.

        `left` are the switching surfaces that the motion leaves.
        """
        before, start = self.mode, self._real_state(pattern, t, state)
        self._require_signs(pattern, t, start)
        after = self._mode_of(pattern, self._started_at(t, start))
        state = before.settled(t, state)  # without the drift, which takes no impulse
        moved = self._passed(before, after, self._signs[names[0]], t, state)
        moved = self._real_state(pattern, t, moved)
        change = self.nominal.share(as_floats(moved - state), as_floats(state))
        if change > CONTINUOUS:
            pattern = self._after_impulse(pattern, t, moved)
            after = self._mode_of(pattern, self._started_at(t, moved))
        after.engine.restart(t, moved)
        self._left |= dict.fromkeys(left, t)
        self.intervals.append(ModeInterval(t, after))
        self._impulse = self._impulse + (after.energy_at(t, moved) - before.energy_at(t, state))
        slid, slides = set(sticking(before.pattern)), set(sticking(pattern))
        for name in dict.fromkeys((*names, *(name for name in self._signs if pattern[name] != before.pattern[name]))):
            if name in slid & slides:
                continue  # contacts share their friction otherwise
            if name in slid:
                outcome = EventOutcome.RELEASED
            elif name in slides:
                outcome = EventOutcome.SLIDING
            else:
                outcome = EventOutcome.CROSSED if change <= CONTINUOUS else EventOutcome.IMPULSE
            self.switchings.append(Switching(float(t), self._signs[name].of, outcome))

    def _real_state(self, pattern: Pattern, t: Any, state: Numbers) -> Numbers:
        """Return the state, moved to where the functions of a pattern are real."""
        functions = [each for each in (self._with_roots(pattern), self._surfaces_with_roots(pattern)) if each]
        if not functions:
            return state
        number = self._precision.number
        share = max(self._precision.rounding, number(repr(self.mode.engine.tol)))
        least = share * max(abs(t), number(repr(float(self.nominal.time))))

        def values(*at: Numbers) -> Numbers:
            return np.concatenate([as_floats(each(self._inputs(*at))) for each in functions])

        return real_state(values, self.mode, t, state, least)

    def _surfaces_with_roots(self, pattern: Pattern) -> Evaluation | None:
        """Return the switching functions of a pattern, None if they contain no roots."""
        names = [
            sign.name
            for sign in self.problem.signs
            if sign.by is not DependsOn.REACTION and pattern[sign.name] not in (SLIDING, *STUCK)
        ]

        def build() -> Evaluation | None:
            functions = switching_functions(self.problem, pattern, names)
            return evaluation(functions, self._precision) if has_root_of(functions, self.problem.state) else None

        return self._once((switching_functions, frozenset(pattern.items())), build) if names else None

    def _with_roots(self, pattern: Pattern) -> Evaluation | None:
        """Return the accelerations of a pattern, None if they contain no roots."""

        def build() -> Evaluation | None:
            motion = program_in(self.problem, computing(self.problem.motion, self.problem.accelerations), pattern)
            has_root = has_root_of(motion, self.problem.state)
            return evaluation_once(self.problem, motion, self._precision) if has_root else None

        return self._once((has_root_of, frozenset(pattern.items())), build)

    def _is_decided_by_accelerations(self, sign: Sign, pattern: Pattern, t: Any, state: Numbers) -> bool:
        """Return True if the accelerations on both sides decide about a sign that is zero."""
        if sign.by is DependsOn.CONFIGURATION and not self._vanishes("switch_rate", sign, pattern, t, state):
            return False
        return driven(self.problem, sign.name)

    def _zeros_at(self, known: Set[str], pattern: Pattern, t: Any, state: Numbers) -> list[str]:
        """Return the signs that are zero, and that the accelerations decide about."""
        functions = self.mode.switching_functions
        if known.issuperset(functions.names):
            return [name for name in self._signs if name in known]
        small = self._near_zero(functions.values, ZERO, t, state)
        zeros = {name for name, is_small in zip(functions.names, small, strict=True) if is_small} & self._signs.keys()
        for sign in [self._signs[name] for name in zeros]:
            if self._signs_in(sign) and not self._vanishes("switch", sign, pattern, t, state):
                zeros.remove(sign.name)
        return [
            name
            for name, sign in self._signs.items()
            if name in known or (name in zeros and self._is_decided_by_accelerations(sign, pattern, t, state))
        ]

    def _decided_with_jumps(self, pattern: Pattern, zeros: Sequence[str], t: Any, state: Numbers) -> Pattern:
        """Return the pattern as `_decided`, with functions that jump then."""
        decided = self._decided(pattern, zeros, t, state)
        after = self._after_jumps(decided, t, state)
        if after == decided:
            return decided
        zeros = [name for name in zeros if after[name] == decided[name]]
        again = self._decided(after, zeros, t, state)
        if any(again[name] != decided[name] for name in zeros):
            self._reject_open(t, zeros)
        return again

    def _after_jumps(self, pattern: Pattern, t: Any, state: Numbers) -> Pattern:
        """Return the pattern with the signs of functions that other signs change."""
        if not any(map(self._signs_in, self.problem.signs)):
            return pattern
        state = self._real_state(pattern, t, state)
        changed = {name for name, value in pattern.items() if value != self.mode.pattern[name]}
        for sign in self.problem.signs:
            if sign.name not in changed and not changed.isdisjoint(self._signs_in(sign)):
                after = self._with_sign_at(sign, pattern, t, state)
                changed |= {sign.name} if after != pattern else set()
                pattern = after
        return pattern

    def _after_impulse(self, pattern: Pattern, t: Any, state: Numbers) -> Pattern:
        """Return the pattern with the signs that velocities behind an impulse have."""
        for sign in self.problem.signs:
            if sign.by is DependsOn.VELOCITY:
                pattern = self._with_sign_at(sign, pattern, t, state)
        return pattern

    def _with_sign_at(self, sign: Sign, pattern: Pattern, t: Any, state: Numbers) -> Pattern:
        """Return the pattern with the sign of a function that is not zero here."""
        share = CONTINUOUS if pattern[sign.name] in (SLIDING, *STUCK) else ZERO
        if sign.name in self._time_events or self._vanishes("switch", sign, pattern, t, state, share):
            return pattern
        return {**pattern, sign.name: 1 if self._output("switch", sign, pattern, t, state) > 0 else -1}

    def _signs_in(self, sign: Sign) -> Set[str]:
        """Return the signs in a switching function, none if it is a multiplier."""
        if sign.by is DependsOn.REACTION:
            return frozenset()
        name = f"switch[{self.problem.places[sign.name]}]"
        return self._once(
            (names_used, name), lambda: names_used(computing(self.problem.switching, {name})) & self._signs.keys()
        )

    def _decided(self, pattern: Pattern, zeros: Sequence[str], t: Any, state: Numbers) -> Pattern:
        """Return a pattern with the signs that the accelerations agree with.

        They are those of functions that are zero, and of multipliers in forces.
        """
        if not zeros and not self.problem.reacting:
            return pattern
        decided = self._only(self._modes_at(pattern, zeros), zeros, t, state, pattern)
        lasting = self._lasting_modes(decided)
        if lasting and not (lasting.guards(self._inputs(np.array([t]), state[:, None])) > 0).all():
            self._reject(t, NOT_UNIQUE)
        if lasting and set(sticking(decided)) < set(zeros):
            self._only(lasting, sticking(decided), t, state, decided)
        return decided

    def _lasting_modes(self, pattern: Pattern) -> FrictionModes | None:
        what = modes_that_may_agree, frozenset(pattern.items())
        return self._once(what, lambda: modes_that_may_agree(self.problem, pattern, self._precision))

    def _only(self, modes: FrictionModes, zeros: Sequence[str], t: Any, state: Numbers, pattern: Pattern) -> Pattern:
        """Return the pattern of the one solution at a state.

        It is the given one if no acceleration decides, as of a coordinate that a control holds at rest.
        """
        inputs = self._inputs(t, state)
        if not modes.known(inputs):
            inputs = self._inputs(*self._shortly_behind(t, state))
        found = modes.agreeing(inputs)
        if not found and (nonlinear := modes.nonlinear(inputs)):
            names = self._of(nonlinear)
            self._reject(t, translatable("%(sign)s slides, and forces are not linear in its friction", sign=names))
        if found and all(found[0].is_shared_as(each) for each in found):
            if len(found) > 1:
                self._left_open = differing_outputs(self.problem, found, self._precision, t, state)
                sizes = self.nominal.accelerations
                differ = accelerations_differ(self.problem, found, self._precision, t, state, sizes)
                self._undecided = self._of(zeros) if differ else ""
            patterns = [each.pattern for each in found]
            return min(patterns, key=lambda each: (self._with_roots(each) is not None, each != pattern))
        names, one = self._of(zeros), bool(found) and all(found[0].accelerates_as(each) for each in found)
        shared = modes.shared(found, inputs) if one else None
        if shared:
            self.undetermined |= dict.fromkeys(differing_outputs(self.problem, found, self._precision, t, state))
            return shared
        if one:
            self._reject(t, translatable("%(sign)s stick, and may share the friction in several ways", sign=names))
        if self.problem.reacting:
            self._reject(t, NOT_UNIQUE)
        self._reject_open(t, zeros)

    def _shortly_behind(self, t: Any, state: Numbers) -> tuple[Any, Numbers]:
        """Return a state by which roots have a value whose argument is zero here.

        Rounding has put the argument on the side that the motion leaves.
        """
        near, n = self._precision.number(repr(ROOT_PASSED * self._span)), len(state) // 2
        return t + near, np.concatenate([state[:n] + near * state[n:], state[n:]])

    def _of(self, names: Sequence[str]) -> str:
        return ", ".join(self._signs[name].of for name in names)

    def _modes_at(self, pattern: Pattern, zeros: Sequence[str]) -> FrictionModes:
        known = {name: value for name, value in pattern.items() if name not in zeros}
        what = FrictionModes, frozenset(known.items()), tuple(zeros)
        return self._once(what, lambda: FrictionModes(self.problem, known, zeros, self._precision))

    def _passed(self, before: Mode, after: Mode, sign: Sign, t: Any, state: Numbers) -> Numbers:
        """Return the state after a switching time."""
        floats, n = as_floats(state), len(state) // 2
        old, new = before.matrices(float(t), floats), after.matrices(float(t), floats)
        left = residuals(new, floats, np.zeros(n), self.nominal)["position"]
        energies = np.outer(self.nominal.velocities, self.nominal.velocities)
        if left > CONTINUOUS or not _close(new.mass * energies, old.mass * energies):
            self._reject(
                t, translatable("the constraints or the masses jump as %(sign)s changes its sign", sign=sign.of)
            )
        kick = before.momenta_at(t, state) - after.momenta_at(t, state)
        moved = state.copy()
        if np.max(np.abs(kick) * self.nominal.velocities, initial=0.0) > CONTINUOUS * self.nominal.energy(new.mass):
            if self._precision.name != "double":
                self._reject(
                    t,
                    translatable(
                        "momenta jump as %(sign)s changes its sign, which takes double precision", sign=sign.of
                    ),
                )
            moved[n:] += factored_constraints(new.mass, new.jacobian).accelerations(kick, new.residual_rate)
        moved = after.settled(t, moved)
        continuous = self.nominal.share(as_floats(moved - state), floats) <= CONTINUOUS
        impulse = new.mass @ as_floats(moved - state)[n:] - kick
        if self.problem.servo.constraints and not continuous:
            self._require_reactions(new, impulse, sign, t)
        if self.problem.reacting and not continuous:
            self._require_no_friction(new, impulse, sign, t)
        if sign.by is not DependsOn.TIME:
            jump = abs(float(after.energy_at(t, state) - before.energy_at(t, state)))
            if not continuous:
                self._reject(
                    t,
                    translatable(
                        "an impact decides how the motion continues as %(sign)s changes its sign", sign=sign.of
                    ),
                )
            if jump > CONTINUOUS * max(self.nominal.energy(old.mass), abs(float(before.energy_at(t, state)))):
                self._reject(t, translatable("the energy jumps as %(sign)s changes its sign", sign=sign.of))
        return moved

    def _require_reactions(self, at: Matrices, impulse: Vector, sign: Sign, t: Any) -> None:
        """Reject a change of velocities that needs an impulse by servo-constraints."""
        reactions = at.jacobian[: len(self.problem.reactions)].T
        left = impulse - reactions @ np.linalg.lstsq(reactions, impulse)[0]
        if np.max(np.abs(left)) > CONTINUOUS * np.max(np.abs(impulse)):
            self._reject(
                t,
                translatable(
                    "servo-constraints would take an impulse of the controls as %(sign)s changes its sign", sign=sign.of
                ),
            )

    def _require_no_friction(self, at: Matrices, impulse: Vector, sign: Sign, t: Any) -> None:
        """Reject a change of velocities by an impulse of multipliers that forces contain."""
        shares = at.jacobian.T * np.linalg.lstsq(at.jacobian.T, impulse)[0]
        reacting = [name in self.problem.reacting for name in self.problem.multipliers]
        if np.max(np.abs(shares[:, reacting])) > CONTINUOUS * np.max(np.abs(impulse)):
            self._reject(
                t,
                translatable(
                    "forces contain multipliers that have an impulse as %(sign)s changes its sign", sign=sign.of
                ),
            )

    def _first_pattern(self, t: Any, state: Numbers) -> Pattern:
        """Return the signs at the initial time, each function after its inputs."""
        pattern: dict[str, int | str] = dict.fromkeys(self._signs, 1)
        for name, event in self._time_events.items():
            pattern[name] = event.to if self._precision.ratio(event.t) <= t else -event.to
        while self._to_come and self._precision.ratio(self._to_come[0]) <= t:
            self._to_come.popleft()
        zeros = []
        for sign in self.problem.signs:
            if sign.name in self._time_events or sign.by is DependsOn.REACTION:
                continue
            if self._vanishes("switch", sign, pattern, t, state):
                self._left[sign.name] = t
                if sign.by is not DependsOn.TIME and self._is_decided_by_accelerations(sign, pattern, t, state):
                    zeros.append(sign.name)
                    continue
                pattern[sign.name] = self._leaving(sign, pattern, t, state)
            else:
                pattern[sign.name] = 1 if self._output("switch", sign, pattern, t, state) > 0 else -1
        return self._decided(pattern, zeros, t, state)

    def _leaving(self, sign: Sign, pattern: Pattern, t: Any, state: Numbers) -> int:
        """Return the sign with which a motion leaves a switching surface.

        Accelerations do not decide about it.
        """
        if sign.by is DependsOn.TIME:
            soon = t + self._precision.number(repr(SOON * self._span))
            return 1 if self._output("switch", sign, pattern, soon, state) >= 0 else -1
        if sign.by is DependsOn.CONFIGURATION and not self._vanishes("switch_rate", sign, pattern, t, state):
            return 1 if self._output("switch_rate", sign, pattern, t, state) > 0 else -1
        return self._reject(
            t,
            translatable(
                "%(sign)s is zero, and not in forces alone, which leaves open how the motion continues", sign=sign.of
            ),
        )

    def _require_signs(self, pattern: Pattern, t: Any, state: Numbers) -> None:
        """Reject signs of zero that the equations of motion depend on."""
        now, last = (Fraction(self._precision.text(time)) for time in (t, self._end))
        end = min([last, *self._to_come])
        for sign in self.problem.signs:
            if sign.by is DependsOn.TIME and sign.name not in self._time_events:
                function = switching_function(self.problem, "switch", sign.name, pattern)
                if remains_zero(self.problem, function, now, end) and self._depends_on(sign, pattern, t, state):
                    self._reject_zero(t, sign.of)

    def _depends_on(self, sign: Sign, pattern: Pattern, t: Any, state: Numbers) -> bool:
        """Return True if the equations of motion are others with the other sign."""
        sides = (problem_in(self.problem, {**pattern, sign.name: side}) for side in (1, -1))
        one, other = (MotionMatrices(side)(float(t), as_floats(state)) for side in sides)
        return not all(np.allclose(a, b, CONTINUOUS, 0) for a, b in zip(one, other, strict=True))

    def _crowded(self, t: Any) -> bool:
        return len(self.intervals) > CROWD and float(t - self.intervals[-CROWD].start) < CROWDED * self._span

    def _reject(self, t: Any, reason: str) -> NoReturn:
        raise HolonomError(ErrorKind.NO_WAY_ON, detail=place_and_reason(t, reason))

    def _reject_open(self, t: Any, zeros: Sequence[str]) -> NoReturn:
        names = self._of(zeros)
        self._reject(t, translatable("%(sign)s is zero, and the motion may leave to either side", sign=names))

    def _reject_zero(self, t: Any, functions: str) -> NoReturn:
        self._reject(t, translatable("%(sign)s remains zero, which decides no condition", sign=functions))

    # ---- numbers at a given time ----

    def _output(self, name: str, sign: Sign, pattern: Pattern, t: Any, state: Numbers) -> float:
        """Return the value of a `switching_function`, compiled at its first use."""
        return float(self._function(name, sign, pattern)(self._inputs(t, state))[0])

    def _vanishes(self, name: str, sign: Sign, pattern: Pattern, t: Any, state: Numbers, share: float = ZERO) -> bool:
        """Return True if a `switching_function` is zero, but for a share."""
        function = self._function(name, sign, pattern)
        return bool(self._near_zero(lambda *at: function(self._inputs(*at)), share, t, state)[0])

    def _near_zero(self, functions: Values, share: float, t: Any, state: Numbers) -> Vector:
        """Return True for functions within a share of their changes with state and time."""
        at = np.array([t]), state[:, None]
        changes = first_order_changes(functions, *at, self.nominal)
        return (np.abs(as_floats(functions(*at))) <= share * changes)[:, 0]

    def _function(self, name: str, sign: Sign, pattern: Pattern) -> Evaluation:
        def build() -> Evaluation:
            return evaluation(switching_function(self.problem, name, sign.name, pattern), self._precision)

        return self._once((name, sign.name, frozenset(pattern.items())), build)

    def _once(self, what: Hashable, build: Callable[[], Built]) -> Built:
        """Return the result of `build`, which is known after the first call."""
        if what not in self._functions:
            self._functions[what] = build()
        return self._functions[what]

    # ---- modes ----

    def _mode_of(self, pattern: Pattern, problem: MotionProblem) -> Mode:
        key = problem.multipliers, frozenset(pattern.items())
        if key not in self._modes:
            known, friction = self._known, self._lasting_modes(pattern)
            self._modes[key] = Mode(problem, pattern, self._time_events, self._request, self._end, known, friction)
        return self._modes[key]

    def _started_at(self, t: Any, state: Numbers) -> MotionProblem:
        numbers = (self._precision.text(number) for number in (t, *state))
        return replace(self.problem, start=dict(zip(("t", *self.problem.state), numbers, strict=True)))


def _knots_of(problem: MotionProblem, precision: Precision) -> list[tuple[Any, Fraction]]:
    """Return the knots of the tables after the initial time, in reverse order."""
    behind = precision.number(problem.start["t"])
    knots = [(precision.ratio(knot), knot) for knot, _ in groupby(merge(*(table.knots for table in problem.tables)))]
    return [(t, knot) for t, knot in reversed(knots) if t > behind]


def _close(numbers: Vector, others: Vector) -> bool:
    """Return True if two arrays of numbers differ by rounding alone."""
    return bool(np.max(np.abs(numbers - others), initial=0.0) <= CONTINUOUS * np.max(np.abs(others), initial=0.0))
