"""Integration of a motion by several engines, with the robust engine as fallback.

The default engine is the first choice, or another one if it is quicker. They use the motion program. If constraints
are redundant, no order of pivots solves the equations, and the robust engine integrates the whole motion.
Near a singular configuration, or if numbers leave their range, it replaces the other engine until the constraints are
as independent again as they were before.
"""

from bisect import bisect_left
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Annotated, Any, NamedTuple

import numpy as np

from ...failures import ErrorKind, HolonomError
from ...language import translatable
from ..constraints.singularity import probed
from ..evaluation import Numbers, as_floats
from ..hard_cases import Difficulty
from ..request import EngineName
from .choice import TRIAL, Choice, quicker_engine
from .engine import Engine, Obstruction, Solutions, Step, Task
from .registry import DEFAULT, FALLBACK, compared_engines, engine_class

UNCOMPILED = (ErrorKind.COMPILER_UNUSABLE, ErrorKind.COMPILER_REFUSED)
FINE = 1e-13  # tolerance of the robust engine between two segments of a Taylor engine, where none is requested


class EngineSegment(NamedTuple):
    """A part of the motion that one engine integrates."""

    engine: Annotated[EngineName, "Engine that integrated the segment."]
    start: Annotated[float, "First time of the segment."]
    end: Annotated[float, "Last time of the segment."]
    case: Annotated[Difficulty | None, "Hard case for which the robust engine continued; null without one."] = None
    reason: Annotated[str, "Reason of the choice of the engine, a clause."] = ""


class FallbackEngine:
    """Engine that falls back to another one if the first fails (see `Engine`).

    Parameters
    ----------
    task : Task
    dense : bool or None
        Whether states between the steps are wanted. None if the motion continues after this one, so that engines
        cannot be weighed by what is ahead.

    Attributes
    ----------
    choice : Choice or None
        Why the engine that began was taken, or None where there was nothing to weigh.
    segments : list of EngineSegment
        In order, up to the current time.

    Raises
    ------
    HolonomError
        The requested engine cannot integrate this motion, or not in this precision or to this tolerance.
    """

    def __init__(self, task: Task, dense: bool | None = None) -> None:
        self._task, self._automatic = task, task.request.engine == EngineName.AUTO
        self.choice: Choice | None = None
        self._second: Engine | None = None
        self._current = self._first = self._first_engine(dense)
        self._begun, self.segments = float(self.time), []
        self._why_first = self._reason_for_first()

    @property
    def time(self) -> Any:
        """The time that is reached."""
        return self._current.time

    @property
    def state(self) -> Numbers:
        """The state at this time."""
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
        """The options with which heyoka compiled the first engine."""
        return self._first.code

    @property
    def tol(self) -> float:
        """Tolerance of the engine that began."""
        return self._first.tol

    def restart(self, time_point: Any, state: Numbers) -> None:
        """Continue with the engine that began (see `Engine.restart`)."""
        self._first.restart(time_point, state)
        self._current, self._begun = self._first, float(time_point)
        self._why_first = self._reason_for_first()

    def integrate(self, until: Any, dense: bool = True) -> Iterator[Step]:
        """Integrate to a time, each engine at its fastest (see `Engine.integrate`)."""
        while self.time != until:
            try:
                yield from self._segment(self._first.integrate(until, dense), lambda: False, *self._why_first)
            except Obstruction as obstruction:
                if not (self._automatic and self._in_doubles) or self._task.problem.reacting:
                    raise
                yield from self._past(obstruction, self._fallback(), until)

    def solutions(self, times: Numbers, states: Numbers) -> Solutions:
        """Return the unknowns by the engine of those times (see `Engine.solutions`)."""
        second = self._second
        if second is None:
            return self._first.solutions(times, states)
        there = self._by(second, as_floats(times))
        if there.all():
            return second.solutions(times, states)
        found = self._first.solutions(times, states)
        if there.any():
            for rows, better in zip(found, second.solutions(times[there], states[:, there]), strict=True):
                rows[:, there] = better[: len(rows)]
        return found

    def close(self) -> None:
        """Free resources of the engines outside of Python."""
        for engine in self._set_up:
            engine.close()

    # ---- engines ----

    def _first_engine(self, dense: bool | None) -> Engine:
        obstruction, request = self._task.problem.obstruction, self._task.request
        chosen = request.engine if not self._automatic else DEFAULT if obstruction is None else FALLBACK
        if self._task.problem.reacting and (obstruction is not None or chosen == FALLBACK):
            detail = translatable("which the robust engine does not take")
            if obstruction is not None:
                detail = translatable("and the robust engine is needed: %(reason)s", reason=obstruction)
            raise HolonomError(ErrorKind.REACTING, detail=detail)
        if obstruction is not None and engine_class(chosen).fixed_pivots:
            raise HolonomError(ErrorKind.NO_PIVOTS, detail=obstruction)
        first = engine_class(chosen)(self._task)
        weighs = self._automatic and obstruction is None and request.compact is None and self._in_doubles
        steps = first.steps_ahead(self._task.end, TRIAL) if weighs and dense is not None else None
        if steps is None or not any(other.comparable(request.tol) for other in compared_engines()[1:]):
            return first
        self.choice = quicker_engine(steps, self._task.problem.motion.operations, first.tol, dense)
        if self.choice.engine == DEFAULT:
            return first
        try:
            return engine_class(self.choice.engine)(self._task)
        except HolonomError as refusal:
            if refusal.kind not in UNCOMPILED:
                raise
            self.choice = replace(self.choice, engine=first.name, refused=str(refusal))
            return first

    def _fallback(self) -> Engine:
        """Return the engine that continues if the first one fails."""
        if self._second is None:
            kind, request = engine_class(FALLBACK), self._task.request
            tol = FINE if request.tol is None else max(request.tol, kind.finest)
            self._second = kind(self._task._replace(request=replace(request, tol=tol)))
        return self._second

    @property
    def _in_doubles(self) -> bool:
        return self._task.request.numbers.name == "double"

    @property
    def _set_up(self) -> list[Engine]:
        """The engines that were used so far."""
        return [self._first] if self._second is None else [self._first, self._second]

    def _by(self, engine: Engine, times: Numbers) -> Numbers:
        """Return True for each time that an engine integrates over."""
        current = EngineSegment(self._current.name, self._begun, np.inf)

        def last_before(t: float) -> EngineSegment:
            place = bisect_left(self.segments, t, key=lambda segment: segment.end)
            return self.segments[place] if place < len(self.segments) else current

        found = map(last_before, times)
        return np.array([each.engine == engine.name and each.start < t for each, t in zip(found, times, strict=True)])

    # ---- segments ----

    def _past(self, obstruction: Obstruction, second: Engine, until: Any) -> Iterator[Step]:
        """Yield the motion past an obstruction, or to a time before that."""
        second.restart(self._first.time, self._first.state.copy())
        self._current = second

        def passed() -> bool:
            return not second.near_singularity and obstruction.passed(second.time, second.state)

        yield from self._segment(second.integrate(until), passed, obstruction.case, obstruction.cause)
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

    def _reason_for_first(self) -> tuple[Difficulty | None, str]:
        """Return the reason for which no engine with fixed pivots can begin here."""
        problem = self._task.problem
        if problem.obstruction is None:
            return None, ""
        rank, _ = probed(self._task.matrices, float(self.time), as_floats(self.state))
        redundant = rank < len(problem.multipliers)
        return Difficulty.REDUNDANT if redundant else Difficulty.SINGULAR_CONFIGURATION, problem.obstruction

    def _add_segment(self, segment: EngineSegment) -> None:
        """Add a segment, or extend the last one if engine and reason are equal."""
        if self.segments and self.segments[-1]._replace(start=segment.start, end=segment.end) == segment:
            segment = segment._replace(start=self.segments.pop().start)
        self.segments.append(segment)
