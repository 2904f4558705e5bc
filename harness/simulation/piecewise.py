"""A motion that is analytic in parts: followed in each by the engines, and led from one to the next.

While the signs in its equations stay the same a motion is analytic. An engine follows it with these signs; where a
switching function leaves its sign, the step is cut, and what the equations say on both sides decides how it goes on:

- where both sides lead across the surface, it is crossed;
- where both lead back to it, the motion is held on it, as dry friction sticks, until one of them does not
  (Filippov, Differential Equations with Discontinuous Righthand Sides, section 4);
- where a law's rate jumps, the velocities do: the momenta dL/d dot(q) change along the constraints' gradients alone, by
  the impulse that makes the new velocities keep the constraints (Pars, A Treatise on Analytical Dynamics, chapter 14).

What mechanics does not decide is refused: a law that jumps in a constraint, an energy that does as a function of the
state, an impulse of a surface whose law of impact nobody has given.
"""

from bisect import bisect_left, bisect_right
from collections import deque
from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import replace
from enum import StrEnum
from fractions import Fraction
from functools import cached_property
from heapq import merge
from itertools import groupby, islice
from typing import Any, NamedTuple

import numpy as np

from ..failures import Failure, HolonomError
from ..program.motion_problem import By, MotionProblem, Sign, computing, function_of_knot
from ..program.motion_program import names_used
from ..program.precision import Precision
from ..program.sign_pattern import (
    HELD,
    Pattern,
    holdable,
    in_numbers,
    problem_in,
    program_in,
    sharing_programs,
    switching_function,
)
from .clock import Tick, ticks
from .constraints.factorization import factored_constraints
from .constraints.program_projection import ProgramProjection
from .constraints.projection import project
from .constraints.singularity import no_controls, require_gradient, shortly_before, vanishing_instants
from .control_matrix import ControlMatrix, controls_may_fail
from .diagnosis import Instant, dependence
from .diagnostics import EnergyBalance, residuals
from .engines.choice import Between, Choice
from .engines.engine import Piece, Solutions
from .engines.switching import Leg, SwitchingEngine
from .evaluation import Evaluation, Numbers, as_floats, evaluation, evaluation_once
from .matrices import Matrices, Matrix, MotionMatrices, Vector, start_of
from .nominal import nominal_of, with_nominal
from .open_values import BesideState
from .request import SimulationRequest
from .surfaces import Crossing, Surfaces
from .time_dependence import time_dependence

ZERO = 1e-12  # of what a switching function or its rate is at nominal sizes: no sign
CONTINUOUS = 1e-9  # relative change at an instant that is rounding
LATER = (1 / 7, 3 / 7, 6 / 7)  # of the nominal time: instants at which a function of the time is looked at
CROWD, CROWDED = 64, 1e-7  # so many switchings in such a part of the time span have no end
SOON = 1e-9  # of the time span: how far ahead the sign of a function of the time is looked for where it vanishes


class Passage(StrEnum):
    """How a motion passes a surface."""

    CROSSED = "crossed"
    HELD = "held"
    RELEASED = "released"
    IMPULSE = "crossed with an impulse"


class Switching(NamedTuple):
    """An instant at which a motion is not analytic."""

    t: float
    function: str  # what changes its sign there, as Maxima prints it
    passage: Passage


class Part:
    """The analytic motion of one pattern of signs, and what follows it.

    Parameters
    ----------
    problem : MotionProblem
        Its start is where the motion first has this pattern.
    clock : mapping of str to Tick
        The signs that the time alone decides.
    request, precision, end
        As for `PiecewiseMotion`.
    known : dict
        The analytic motions of other parts, as `sharing_programs` keeps them.
    """

    def __init__(
        self,
        problem: MotionProblem,
        pattern: Pattern,
        clock: Mapping[str, Tick],
        request: SimulationRequest,
        precision: Precision,
        end: Any,
        known: dict[Hashable, MotionProblem],
    ) -> None:
        self._whole, self.pattern, self._precision, self._clock = problem, pattern, precision, clock
        analytic = problem_in(problem, pattern)
        if any(sign.by is By.TIME for sign in problem.signs):
            analytic = sharing_programs(analytic, known)
        self.matrices = MotionMatrices(analytic)
        obstacle = analytic.obstacle or dependence(self.matrices, Instant(*start_of(analytic)))
        self.problem = replace(analytic, obstacle=obstacle)
        self.balance = EnergyBalance(self.problem, self._multipliers, precision)
        between = None if problem.signs or problem.tables else Between(request.samples or 0, self.balance.inner_states)
        self.engine = SwitchingEngine(self.problem, request, precision, end, self.matrices, between)
        self._start, self._end = float(problem.start["t"]), float(end)
        self.doubtful = vanishing_instants(self.problem, self.matrices, self._end)
        to_come = (float(tick.t) for name, tick in clock.items() if pattern[name] != tick.to)
        self.by_time = time_dependence(
            in_numbers(self.problem, self.problem.matrices),
            self._start,
            min([self._end, *to_come]),
            self.problem.tables,
        )
        ends = () if self.by_time.end is None else (self.by_time.end,)
        before = (shortly_before(t, self._start) for t in self.doubtful)
        self.stops = sorted({*self.by_time.stops, *ends, *before})

    @cached_property
    def surfaces(self) -> Surfaces:
        """The surfaces on which the pattern ends."""
        return Surfaces(self._whole, self.pattern, self._precision, self._end - self._start, self._clock)

    @cached_property
    def momenta(self) -> Any:
        """dL/d dot(q) as a function of the state."""
        switching = self._whole.switching
        wanted = {name for name in switching.outputs if name.startswith("momentum[")}

        def build() -> Evaluation:
            return evaluation(program_in(self._whole, computing(switching, wanted), self.pattern), self._precision)

        return self._whole.once(("momenta", self._precision.name, frozenset(self.pattern.items())), switching, build)

    def controls(self, instants: Numbers, states: Numbers) -> Numbers:
        """The controls at instants, shape (k,), and states, shape (2n, k)."""
        beside = BesideState(self.problem, self._precision)(instants)
        return self._controls(np.ascontiguousarray(np.concatenate([instants[None, :], states, beside])))

    @cached_property
    def _controls(self) -> Evaluation:
        return evaluation_once(self.problem, self.problem.controls, self._precision)

    @cached_property
    def projection(self) -> ProgramProjection:
        """What projects states in the numbers of the run."""
        return ProgramProjection(self.problem, self._precision, self.matrices)

    def pieces(self, until: Any) -> Iterator[Piece]:
        """Follow the motion as its engine does, to where servo-constraints leave their controls without values."""
        for piece in self.engine.pieces(until):
            lost = None if self._control_matrix is None else self._control_matrix.lost(piece)
            if lost is None:
                yield piece
                continue
            if lost > piece.start:
                yield Piece(piece.start, lost, piece.states)
            raise no_controls(float(lost))

    @cached_property
    def _control_matrix(self) -> ControlMatrix | None:
        if not controls_may_fail(self.problem):
            return None
        return ControlMatrix(self.problem, self._precision, self._end - self._start)

    def require_way_on(self, at: Instant) -> None:
        """Refuse to go on where a constraint loses its gradient, or an expression of the time its smoothness."""
        for t in self.doubtful:
            if shortly_before(t, self._start) == at.t:
                require_gradient(self.problem, self.matrices, t, at)

    def _multipliers(self, instants: Numbers, states: Numbers) -> Numbers:
        return self.engine.solutions(instants, states).multipliers


class Phase(NamedTuple):
    """A part at work from an instant on."""

    start: Any
    part: Part


class PiecewiseMotion:
    """A motion followed through its switchings, and no farther in one step than it may depend on the time.

    Parameters
    ----------
    end : number
        The last instant.

    Raises
    ------
    HolonomError
        As `SwitchingEngine`; the motion starts where the equations leave open how it goes on.
    """

    def __init__(self, problem: MotionProblem, request: SimulationRequest, precision: Precision, end: Any) -> None:
        self._span = float(end) - float(problem.start["t"])
        problem = with_nominal(problem, self._span)
        self._problem, self._request, self._precision, self._end = problem, request, precision, end
        self.nominal = nominal_of(problem)
        self._signs = {sign.name: sign for sign in problem.signs}
        self._clock = ticks(problem)
        self._to_come = deque(sorted({tick.t for tick in self._clock.values()}))
        self._knots = _knots_of(problem, precision)
        self._parts: dict[tuple[Any, ...], Part] = {}
        self._known: dict[Hashable, MotionProblem] = problem.once("parts", problem.matrices, dict)
        self._functions: dict[Hashable, tuple[Evaluation, list[int]]] = problem.once(
            ("switching", precision.name), problem.matrices, dict
        )
        self._others = BesideState(problem, precision)
        self._left: tuple[str, ...] = ()
        self._jump = precision.number("0")
        self.switchings: list[Switching] = []
        start = np.array([precision.number(problem.start[name]) for name in problem.state])
        pattern = self._first_pattern(precision.number(problem.start["t"]), start)
        self.phases: list[Phase] = []
        self._starts: list[float] = []
        self._add_phase(precision.number(problem.start["t"]), self._part(pattern, problem))

    @property
    def part(self) -> Part:
        """The part at work."""
        return self.phases[-1].part

    @property
    def time(self) -> Any:
        """The instant that is reached."""
        return self.part.engine.time

    @property
    def state(self) -> Numbers:
        """The state at this instant."""
        return self.part.engine.state

    @property
    def steps(self) -> int:
        """Steps taken so far."""
        return sum(part.engine.steps for part in self._parts.values())

    @property
    def tol(self) -> float:
        """Tolerance of the engine that began."""
        return self.part.engine.tol

    @property
    def code(self) -> str:
        """How heyoka compiled the engine that began."""
        return self.part.engine.code

    @property
    def choice(self) -> Choice | None:
        """Why the engine that began was taken; None where there was nothing to weigh."""
        return self.phases[0].part.engine.choice

    @property
    def compile_seconds(self) -> float:
        """Time that the compilation of the engines took."""
        return sum(part.engine.compile_seconds for part in self._parts.values())

    @property
    def unresolved(self) -> float | None:
        """The first instant from which an expression of the time changes too fast to be looked at ahead."""
        found = (phase.part.by_time.unresolved for phase in self.phases)
        return min((t for t in found if t is not None), default=None)

    @property
    def conservative(self) -> bool:
        """Whether there is no work to integrate."""
        return not self._problem.signs and self.part.balance.conservative

    @property
    def legs(self) -> list[Leg]:
        """Which engine followed the motion from when to when."""
        ends = [*(float(phase.start) for phase in self.phases[1:]), float(self.time)]
        found: list[Leg] = []
        for phase, end in zip(self.phases, ends, strict=True):
            for leg in phase.part.engine.legs:
                cut = leg._replace(start=max(leg.start, float(phase.start)), end=min(leg.end, end))
                if cut.start < cut.end:
                    if found and found[-1]._replace(start=cut.start, end=cut.end) == cut:
                        cut = cut._replace(start=found.pop().start)
                    found.append(cut)
        return found

    def close(self) -> None:
        """Give back what the engines hold outside of Python; the motion is not followed any more."""
        for part in self._parts.values():
            part.engine.close()

    def advance(self, until: Any) -> None:
        """Follow the motion to an instant.

        Raises
        ------
        HolonomError
            The motion cannot be followed so far.
        """
        if self._problem.signs or controls_may_fail(self._problem):
            deque(self.pieces(until), maxlen=0)
            return
        while self.time != until:
            self.part.engine.advance(self._next_stop(until))
            self._pass_knots()
            self._require_way_on(until)

    def pieces(self, until: Any) -> Iterator[Piece]:
        """Follow the motion to an instant, step by step; raises as `advance`."""
        while self.time != until:
            yield from self._to_stop(self._next_stop(until))
            self._pass_knots()
            self._require_way_on(until)

    def solutions(self, instants: Numbers, states: Numbers) -> Solutions:
        """What the equations of motion determine at states of the motion, each in its phase."""
        found = [part.engine.solutions(instants[here], states[:, here]) for part, here in self._by_phase(instants)]
        return Solutions(*(_side_by_side(rows) for rows in zip(*found, strict=True)))

    def energy(self, instants: Numbers, states: Numbers) -> Numbers:
        """The energy function at states of the motion, shape (k,)."""
        return np.concatenate(
            [part.balance.energy(instants[here], states[:, here]) for part, here in self._by_phase(instants)]
        )

    def controls(self, instants: Numbers, states: Numbers) -> dict[str, Numbers]:
        """The controls at states of the motion, by name, each of shape (k,); empty where they are not observed.

        Raises
        ------
        HolonomError
            One has no value at one of the instants.
        """
        if self._problem.controls is None:
            return {}
        found = np.concatenate(
            [part.controls(instants[here], states[:, here]) for part, here in self._by_phase(instants)], axis=1
        )
        names, missing = list(self._problem.controls.outputs), np.argwhere(~np.isfinite(as_floats(found)).T)
        if len(missing):
            self._refuse(instants[missing[0, 0]], f"the control {names[missing[0, 1]]} has no value")
        return dict(zip(names, found, strict=True))

    def matrices(self, t: float, state: Vector) -> Matrices:
        """The matrices at a state of the motion, in its phase."""
        return self.phases[self._phase_at(t)].part.matrices(t, state)

    def matrices_by_phase(self, instants: Vector, states: Matrix) -> list[Matrices]:
        """The matrices at instants in order, shape (k,), and states, shape (2n, k): a block for each phase."""
        return [part.matrices(instants[here], states[:, here].T) for part, here in self._by_phase(instants)]

    def take_impulse(self) -> Any:
        """Energy that the impulse at the beginning of the phase at work brought; zero when asked again."""
        jump, self._jump = self._jump, self._precision.number("0")
        return jump

    def _by_phase(self, instants: Numbers) -> Iterator[tuple[Part, slice]]:
        """The instants, in order, by the phases that end with them or hold them."""
        floats, first = as_floats(instants), 0
        while first < len(floats):
            phase = self._phase_at(floats[first])
            ends = self._starts[phase + 1 : phase + 2]
            last = int(np.searchsorted(floats, ends[0], side="right")) if ends else len(floats)
            yield self.phases[phase].part, slice(first, last)
            first = last

    def _phase_at(self, t: float) -> int:
        """Place of the phase that ends with an instant or holds it."""
        return max(0, bisect_left(self._starts, t) - 1)

    # ---- steps ----

    def _next_stop(self, until: Any) -> Any:
        stops, step = self.part.stops, self._request.max_step
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

    def _require_way_on(self, until: Any) -> None:
        by_time = self.part.by_time
        if by_time.end is not None and float(self.time) >= by_time.end and self.time != until:
            raise HolonomError(Failure.NO_WAY_ON, detail=f"{by_time.end:.10g}, where {by_time.reason}")
        if self.part.doubtful:
            self.part.require_way_on(Instant(float(self.time), as_floats(self.state)))

    def _to_stop(self, stop: Any) -> Iterator[Piece]:
        part = self.part
        if not self._problem.signs:
            yield from part.pieces(stop)
            return
        for piece in part.pieces(stop):
            crossing = part.surfaces.first_crossing(piece, self._left)
            if crossing is None:
                yield piece
                self._left = ()
            else:
                if crossing.t > piece.start:
                    yield Piece(piece.start, crossing.t, piece.states)
                self._switch(crossing, piece.states(np.array([crossing.t]))[:, 0])
                return
        if self._to_come and self._precision.ratio(self._to_come[0]) == self.time != self._end:
            self._tick(self._to_come.popleft())

    # ---- switching ----

    def _tick(self, instant: Fraction) -> None:
        """Go on from an instant at which signs change that the time alone decides."""
        t, state, before = self.time, self.state.copy(), self.part
        changed = [name for name, tick in self._clock.items() if tick.t == instant]
        after = self._part(
            {**before.pattern, **{name: self._clock[name].to for name in changed}}, self._started_at(t, state)
        )
        passages = self._enter(before, after, self._signs[changed[0]], t, state)
        self._left = self._left if t == self.phases[-2].start else ()
        self.switchings += [Switching(float(t), self._signs[name].of, passages) for name in changed]

    def _switch(self, crossing: Crossing, state: Numbers) -> None:
        t, sign, before = crossing.t, self._signs[crossing.name], self.part
        again = t == self.phases[-1].start and crossing.name in self._left
        if again or self._crowded(t):
            self._refuse(t, f"{sign.of} changes its sign again and again")
        pattern = {**before.pattern, sign.name: crossing.to}
        held = before.pattern[sign.name] == HELD
        if not held and sign.by is not By.TIME:
            pattern[sign.name] = self._behind(sign, pattern, t, state, crossing.to)
        after = self._part(pattern, self._started_at(t, state))
        passage = self._enter(before, after, sign, t, state)
        self._left = (*self._left, sign.name) if t == self.phases[-2].start else (sign.name,)
        if held:
            passage = Passage.RELEASED
        elif pattern[sign.name] == HELD:
            passage = Passage.HELD
        self.switchings.append(Switching(float(t), sign.of, passage))

    def _enter(self, before: Part, after: Part, sign: Sign, t: Any, state: Numbers) -> Passage:
        """Go on with another part; how the surface is passed where nothing holds the motion on it."""
        moved = self._passed(before, after, sign, t, state)
        after.engine.restart(t, moved)
        self._add_phase(t, after)
        self._jump = self._jump + (self._energy(after, t, moved) - self._energy(before, t, state))
        change = self.nominal.share(as_floats(moved - state), as_floats(state))
        return Passage.CROSSED if change <= CONTINUOUS else Passage.IMPULSE

    def _add_phase(self, start: Any, part: Part) -> None:
        self.phases.append(Phase(start, part))
        self._starts.append(float(start))

    def _behind(self, sign: Sign, pattern: Pattern, t: Any, state: Numbers, to: int) -> int | str:
        """The sign with which a motion goes on from a surface of the state."""
        if sign.by is By.CONFIGURATION and not self._vanishes("switch_rate", sign, pattern, t, state):
            return to
        if not holdable(self._problem, sign.name):
            return to
        return self._decided(sign, pattern, t, state)

    def _decided(self, sign: Sign, pattern: Pattern, t: Any, state: Numbers) -> int | str:
        """What the motions on both sides of a surface say about the sign of the motion that is on it."""
        above, below = (self._output("drive", sign, {**pattern, sign.name: to}, t, state) for to in (1, -1))
        if above * below > 0:
            return 1 if above > 0 else -1
        if above < 0 < below:
            if other := next((name for name, value in pattern.items() if value == HELD and name != sign.name), None):
                self._refuse(t, f"{self._signs[other].of} and {sign.of} are both held at zero")
            return HELD
        if above > 0 > below:
            self._refuse(t, f"{sign.of} is zero, and the motion may leave to either side")
        return 1 if above >= 0 and below >= 0 else -1

    def _passed(self, before: Part, after: Part, sign: Sign, t: Any, state: Numbers) -> Numbers:
        """The state behind an instant of switching."""
        floats, n = as_floats(state), len(state) // 2
        old, new = before.matrices(float(t), floats), after.matrices(float(t), floats)
        left = residuals(new, floats, np.zeros(n), self.nominal)["position"]
        energies = np.outer(self.nominal.velocities, self.nominal.velocities)
        if left > CONTINUOUS or not _close(new.mass * energies, old.mass * energies):
            self._refuse(t, f"the constraints or the masses jump as {sign.of} changes its sign")
        kick = as_floats(self._momenta(before, t, state)) - as_floats(self._momenta(after, t, state))
        moved = state.copy()
        if np.max(np.abs(kick) * self.nominal.velocities, initial=0.0) > CONTINUOUS * self.nominal.energy(new.mass):
            if self._precision.name != "double":
                self._refuse(t, f"momenta jump as {sign.of} changes its sign, which takes double precision")
            moved[n:] += factored_constraints(new.mass, new.jacobian).accelerations(kick, new.residual_rate)
        if after.problem.projection is None:
            moved = project(after.matrices, float(t), as_floats(moved))
        else:
            after.projection.project(t, moved)
        continuous = self.nominal.share(as_floats(moved - state), floats) <= CONTINUOUS
        if self._problem.servo and not continuous:
            self._require_reactions(new, as_floats(moved - state)[n:], kick, sign, t)
        if sign.by is not By.TIME:
            jump = abs(float(self._energy(after, t, state) - self._energy(before, t, state)))
            if not continuous:
                self._refuse(t, f"an impact decides how the motion goes on as {sign.of} changes its sign")
            if jump > CONTINUOUS * max(self.nominal.energy(old.mass), abs(float(self._energy(before, t, state)))):
                self._refuse(t, f"the energy jumps as {sign.of} changes its sign")
        return moved

    def _require_reactions(self, at: Matrices, change: Vector, kick: Vector, sign: Sign, t: Any) -> None:
        """Velocities may change by reactions alone: the controls that servo-constraints find are forces."""
        reactions = at.jacobian[: len(self._problem.reactions)].T
        impulse = at.mass @ change - kick
        left = impulse - reactions @ np.linalg.lstsq(reactions, impulse)[0]
        if np.max(np.abs(left)) > CONTINUOUS * np.max(np.abs(impulse)):
            self._refuse(t, f"servo-constraints would take an impulse of the controls as {sign.of} changes its sign")

    def _first_pattern(self, t: Any, state: Numbers) -> Pattern:
        """Signs at the start, each function after those that it may contain."""
        pattern: dict[str, int | str] = dict.fromkeys(self._signs, 1)
        for name, tick in self._clock.items():
            pattern[name] = tick.to if self._precision.ratio(tick.t) <= t else -tick.to
        while self._to_come and self._precision.ratio(self._to_come[0]) <= t:
            self._to_come.popleft()
        for sign in self._problem.signs:
            if sign.name in self._clock:
                continue
            if self._vanishes("switch", sign, pattern, t, state):
                pattern[sign.name] = self._leaving(sign, pattern, t, state)
                self._left = (*self._left, sign.name)
            else:
                pattern[sign.name] = 1 if self._output("switch", sign, pattern, t, state) > 0 else -1
        return pattern

    def _leaving(self, sign: Sign, pattern: Pattern, t: Any, state: Numbers) -> int | str:
        """The sign with which a motion starts from a surface."""
        if sign.by is By.TIME:
            soon = t + self._precision.number(repr(SOON * self._span))
            return 1 if self._output("switch", sign, pattern, soon, state) >= 0 else -1
        if sign.by is By.CONFIGURATION and not self._vanishes("switch_rate", sign, pattern, t, state):
            return 1 if self._output("switch_rate", sign, pattern, t, state) > 0 else -1
        if not holdable(self._problem, sign.name):
            self._refuse(t, f"{sign.of} is zero, and not in forces alone, which leaves open how the motion goes on")
        return self._decided(sign, pattern, t, state)

    def _crowded(self, t: Any) -> bool:
        return len(self.phases) > CROWD and float(t - self.phases[-CROWD].start) < CROWDED * self._span

    def _refuse(self, t: Any, reason: str) -> None:
        raise HolonomError(Failure.NO_WAY_ON, detail=f"{float(t):.10g}, where {reason}")

    # ---- numbers at an instant ----

    def _output(self, name: str, sign: Sign, pattern: Pattern, t: Any, state: Numbers) -> float:
        """Value of a `switching_function`, which is compiled when it is first asked for."""
        return float(self._function(name, sign, pattern)[0](self._inputs(t, state))[0])

    def _vanishes(self, name: str, sign: Sign, pattern: Pattern, t: Any, state: Numbers) -> bool:
        """Whether a `switching_function` is rounding, beside what it changes by as the state and the time do."""
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
        """A `switching_function`, and the places in the state of what it contains."""
        what = name, sign.name, frozenset(pattern.items())
        if what not in self._functions:
            program = switching_function(self._problem, name, sign.name, pattern)
            used = names_used(program)
            places = [place for place, each in enumerate(self._problem.state) if each in used]
            self._functions[what] = evaluation(program, self._precision), places
        return self._functions[what]

    def _momenta(self, part: Part, t: Any, state: Numbers) -> Numbers:
        return part.momenta(self._inputs(t, state))

    def _energy(self, part: Part, t: Any, state: Numbers) -> Any:
        return part.balance.energy(np.array([t]), state[:, None])[0]

    def _inputs(self, t: Any, state: Numbers) -> Numbers:
        return np.array([t, *state, *self._others(np.array([t]))[:, 0]])

    # ---- parts ----

    def _part(self, pattern: Pattern, problem: MotionProblem) -> Part:
        key = tuple(pattern.values())
        if key not in self._parts:
            self._parts[key] = Part(
                problem, pattern, self._clock, self._request, self._precision, self._end, self._known
            )
        return self._parts[key]

    def _started_at(self, t: Any, state: Numbers) -> MotionProblem:
        numbers = (self._precision.text(number) for number in (t, *state))
        return replace(self._problem, start=dict(zip(("t", *self._problem.state), numbers, strict=True)))


def _knots_of(problem: MotionProblem, precision: Precision) -> list[tuple[Any, Fraction]]:
    """The knots of the tables behind the start, the last first."""
    behind = precision.number(problem.start["t"])
    knots = [(precision.ratio(knot), knot) for knot, _ in groupby(merge(*(table.knots for table in problem.tables)))]
    return [(t, knot) for t, knot in reversed(knots) if t > behind]


def _side_by_side(parts: Sequence[Numbers]) -> Numbers:
    """Rows that all parts have: the robust engine adds constraint forces that the scene does not observe."""
    shared = min(len(rows) for rows in parts)
    return np.concatenate([rows[:shared] for rows in parts], axis=1)


def _close(numbers: Vector, others: Vector) -> bool:
    """Whether two arrays of numbers differ by rounding alone."""
    return bool(np.max(np.abs(numbers - others), initial=0.0) <= CONTINUOUS * np.max(np.abs(others), initial=0.0))
