"""One motion followed by more engines than one: where the first meets an obstacle, the robust engine leads past it.

The Taylor engine is the first choice, or the Runge-Kutta engine where that is quicker; both take the motion program.
Where constraints are redundant, no order of pivots solves the equations, and the robust engine does all; where the
configuration nears a singular one, or numbers leave their range, it takes over from either until the
constraints are as independent again as they were when it did.
"""

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ...failures import Failure, HolonomError
from ..evaluation import Numbers, as_floats
from ..hard_cases import HardCase
from ..request import EngineName
from .choice import TRIAL, Between, Choice, quicker_engine
from .engine import Engine, Obstacle, Solutions, Step, Task
from .registry import DEFAULT, FALLBACK, compared_engines, engine_class

UNCOMPILED = (Failure.COMPILER_UNUSABLE, Failure.COMPILER_REFUSED)
FINE = 1e-13  # tolerance of the robust engine between two segments of a Taylor engine, where none is asked for


class EngineSegment(NamedTuple):
    """A part of the motion that one engine follows."""

    engine: EngineName
    start: float
    end: float
    case: HardCase | None = None  # why the robust engine went on; None where it did not
    reason: str = ""  # why it was called, a clause


class FallbackEngine:
    """The engines that a request allows, at work as one; see `Engine`.

    Parameters
    ----------
    task : Task
    between : Between or None
        What is wanted between the steps; None where the motion goes on after this one, so that engines cannot be
        weighed by what is ahead.

    Attributes
    ----------
    choice : Choice or None
        Why the engine that began was taken; None where there was nothing to weigh.
    legs : list of EngineSegment
        In order, as far as the motion has come.

    Raises
    ------
    HolonomError
        The engine asked for cannot follow this motion, or not in this precision or to this tolerance.
    """

    def __init__(self, task: Task, between: Between | None = None) -> None:
        self._task, self._automatic = task, task.request.engine == EngineName.AUTO
        self.choice: Choice | None = None
        self._second: Engine | None = None
        self._current = self._first = self._first_engine(between)
        self._begun, self.legs = float(self.time), []

    @property
    def time(self) -> Any:
        """The instant that is reached."""
        return self._current.time

    @property
    def state(self) -> Numbers:
        """The state at this instant."""
        return self._current.state

    @property
    def steps(self) -> int:
        """Steps taken so far."""
        return sum(engine.steps for engine in self._set_up)

    @property
    def compile_seconds(self) -> float:
        """Time that the compilation of the engines took."""
        return sum(engine.compile_seconds for engine in self._set_up)

    @property
    def code(self) -> str:
        """How heyoka compiled the engine that began."""
        return self._first.code

    @property
    def tol(self) -> float:
        """Tolerance of the engine that began."""
        return self._first.tol

    def restart(self, instant: Any, state: Numbers) -> None:
        """Go on from another instant and state, shape (2n,), with the engine that began."""
        self._first.restart(instant, state)
        self._current, self._begun = self._first, float(instant)

    def advance(self, until: Any) -> None:
        """Follow the motion to an instant, each engine at its fastest.

        Raises
        ------
        HolonomError
            The motion cannot be followed so far by the engines allowed.
        """
        deque(self._followed(until, _without_steps), maxlen=0)

    def integrate(self, until: Any) -> Iterator[Step]:
        """Follow the motion to an instant, step by step; raises as `advance`."""
        return self._followed(until, _with_steps)

    def solutions(self, instants: Numbers, states: Numbers) -> Solutions:
        """Return what the equations of motion determine, by the engine that followed the motion there or is at work."""
        second = self._second
        if second is None:
            return self._first.solutions(instants, states)
        there = self._by(second, as_floats(instants))
        if there.all():
            return second.solutions(instants, states)
        found = self._first.solutions(instants, states)
        if there.any():
            for rows, better in zip(found, second.solutions(instants[there], states[:, there]), strict=True):
                rows[:, there] = better[: len(rows)]
        return found

    def close(self) -> None:
        """Give back what the engines hold outside of Python."""
        for engine in self._set_up:
            engine.close()

    # ---- engines ----

    def _first_engine(self, between: Between | None) -> Engine:
        obstacle, request = self._task.problem.obstacle, self._task.request
        chosen = request.engine if not self._automatic else DEFAULT if obstacle is None else FALLBACK
        if obstacle is not None and engine_class(chosen).fixed_pivots:
            raise HolonomError(Failure.NO_PIVOTS, detail=obstacle)
        first = engine_class(chosen).for_motion(self._task)
        weighs = self._automatic and obstacle is None and request.compact is None and self._in_doubles
        steps = first.steps_ahead(self._task.end, TRIAL) if weighs and between is not None else None
        if steps is None or not any(other.comparable(request.tol) for other in compared_engines()[1:]):
            return first
        self.choice = quicker_engine(steps, self._task.problem.motion.operations, first.tol, between)
        if self.choice.engine == DEFAULT:
            return first
        try:
            return engine_class(self.choice.engine).for_motion(self._task)
        except HolonomError as refusal:
            if refusal.failure not in UNCOMPILED:
                raise
            self.choice = replace(self.choice, engine=first.name, refused=str(refusal))
            return first

    def _fallback(self) -> Engine:
        """Return the engine that goes on where the first one cannot."""
        if self._second is None:
            problem, request, _, _, matrices = self._task
            self._second = engine_class(FALLBACK)(problem, FINE if request.tol is None else request.tol, matrices)
        return self._second

    @property
    def _in_doubles(self) -> bool:
        return self._task.precision.name == "double"

    @property
    def _set_up(self) -> list[Engine]:
        """The engines that have been called for so far."""
        return [self._first] if self._second is None else [self._first, self._second]

    def _by(self, engine: Engine, instants: Numbers) -> Numbers:
        """Return which of the instants an engine has followed the motion to."""
        legs = [leg for leg in self.legs if leg.engine is engine.name]
        spans = [(leg.start, leg.end) for leg in legs]
        if engine is self._current:
            spans.append((self._begun, np.inf))
        return np.array([any(start < t <= end for start, end in spans) for t in instants], dtype=bool)

    # ---- segments ----

    def _followed(self, until: Any, along: Callable[[Engine, Any], Iterator[Step]]) -> Iterator[Step]:
        while self.time != until:
            try:
                yield from self._segment(along(self._first, until), lambda: False, *self._why_first)
            except Obstacle as obstacle:
                if not (self._automatic and self._in_doubles):
                    raise
                yield from self._past(obstacle, self._fallback(), until)

    def _past(self, obstacle: Obstacle, second: Engine, until: Any) -> Iterator[Step]:
        """Yield the motion past an obstacle, or to an instant before that."""
        second.restart(self._first.time, self._first.state.copy())
        self._current = second

        def passed() -> bool:
            return not second.amid_passage and obstacle.passed(second.time, second.state)

        yield from self._segment(second.integrate(until), passed, obstacle.case, obstacle.reason)
        self._first.restart(second.time, second.state)
        self._current = self._first

    def _segment(self, steps: Iterator[Step], done: Callable[[], bool], *why: Any) -> Iterator[Step]:
        self._begun = float(self.time)
        try:
            for step in steps:
                yield step
                if done():
                    break
        finally:
            if float(self.time) > self._begun:
                self._add_segment(EngineSegment(self._current.name, self._begun, float(self.time), *why))

    @property
    def _why_first(self) -> tuple[HardCase | None, str]:
        """Why the engine that began is the robust one, where it was not asked for."""
        if self._task.problem.obstacle is None:
            return None, ""
        return self._first.case, self._task.problem.obstacle

    def _add_segment(self, leg: EngineSegment) -> None:
        """Keep a segment, as one with the last where the same engine went on for the same reason."""
        if self.legs and self.legs[-1]._replace(start=leg.start, end=leg.end) == leg:
            leg = leg._replace(start=self.legs.pop().start)
        self.legs.append(leg)


def _with_steps(engine: Engine, until: Any) -> Iterator[Step]:
    return engine.integrate(until)


def _without_steps(engine: Engine, until: Any) -> Iterator[Step]:
    engine.advance(until)
    yield from ()
