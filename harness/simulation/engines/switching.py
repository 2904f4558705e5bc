"""One motion followed by more engines than one: where the first meets an obstacle, the robust engine leads past it.

The Taylor engine is the first choice, or the Runge-Kutta engine where that is quicker; both take the motion program.
Where constraints are redundant, no order of pivots solves the equations, and the robust engine does all; where the
configuration nears a singular one, or numbers leave their range, it takes over from either until the
constraints are as independent again as they were when it did.
"""

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cached_property
from math import log10
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...failures import Failure, HolonomError
from ...program.motion_problem import MotionProblem
from ...program.precision import GUARD_DIGITS, Precision
from ...program.sign_pattern import at_start, with_values_in
from ..diagnosis import HardCase
from ..evaluation import Numbers, as_floats
from ..matrices import MotionMatrices
from ..request import EngineName, SimulationRequest
from .choice import TRIAL, Between, Choice, comparable, quicker_engine
from .engine import Engine, Obstacle, Solutions, Step
from .program_engine import DECAYS_IN_A_RUN

if TYPE_CHECKING:
    from .taylor import TaylorEngine

BY_PROGRAM = (EngineName.TAYLOR, EngineName.RUNGE_KUTTA)
UNCOMPILED = (Failure.COMPILER_UNUSABLE, Failure.COMPILER_REFUSED, Failure.GSL_MISSING)
FINE = 1e-13  # tolerance of the robust engine between two legs of a Taylor engine that nobody gave one


class Leg(NamedTuple):
    """A part of the motion that one engine follows."""

    engine: EngineName
    start: float
    end: float
    case: HardCase | None = None  # what the robust engine was called for; None where nobody called it
    reason: str = ""  # why it was called, a clause


class SwitchingEngine:
    """The engines that a request allows, at work as one; see `Engine`.

    Parameters
    ----------
    end : number
        The last instant.
    matrices : MotionMatrices
        Of the same motion.
    between : Between or None
        What is wanted between the steps; None where the motion goes on after this one, so that engines cannot be
        weighed by what is ahead.

    Attributes
    ----------
    choice : Choice or None
        Why the engine that began was taken; None where there was nothing to weigh.
    legs : list of Leg
        In order, as far as the motion has come.

    Raises
    ------
    HolonomError
        The engine asked for cannot follow this motion, or not in this precision or to this tolerance.
    """

    def __init__(
        self,
        problem: MotionProblem,
        request: SimulationRequest,
        precision: Precision,
        end: Any,
        matrices: MotionMatrices,
        between: Between | None = None,
    ) -> None:
        self._problem, self._request, self._precision, self._matrices = problem, request, precision, matrices
        self.choice: Choice | None = None
        self._current = self._first = self._first_engine(end, between)
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
        """What the equations of motion determine, by the engine that followed the motion there or is at work."""
        second = self.__dict__.get("_second")
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

    def _first_engine(self, end: Any, between: Between | None) -> Engine:
        asked, obstacle = self._request.engine, self._problem.obstacle
        if obstacle is not None and asked in BY_PROGRAM:
            raise HolonomError(Failure.NO_PIVOTS, detail=obstacle)
        if obstacle is not None or asked is EngineName.ROBUST:
            if self._precision.name != "double":
                raise HolonomError(Failure.ROBUST_IS_DOUBLE, detail=obstacle or "--engine asks for it")
            return _robust(self._problem, self._request, self._matrices)
        if asked is EngineName.RUNGE_KUTTA:
            return _runge_kutta(self._problem, self._request, self._precision, end, self._matrices)
        taylor = _taylor(self._problem, self._request, self._precision, end, self._matrices)
        if between is None or not self._either:
            return taylor
        steps = taylor.steps_ahead(end, TRIAL)
        if steps is None or not comparable(self._request.tol):
            return taylor
        self.choice = quicker_engine(steps, self._problem.motion.operations, taylor.tol, between)
        if self.choice.engine is EngineName.TAYLOR:
            return taylor
        try:
            return _runge_kutta(self._problem, self._request, self._precision, end, self._matrices)
        except HolonomError as refusal:
            if refusal.failure not in UNCOMPILED:
                raise
            self.choice = replace(self.choice, engine=EngineName.TAYLOR, refused=str(refusal))
            return taylor

    @property
    def _either(self) -> bool:
        """Whether nothing asks for one of the engines that take the motion program."""
        open_ = self._request.engine is EngineName.AUTO and self._request.compact is None
        return open_ and self._precision.name == "double"

    @cached_property
    def _second(self) -> Engine:
        """The robust engine, where the first one needs it."""
        from .robust import RobustEngine

        return RobustEngine(self._problem, FINE if self._request.tol is None else self._request.tol, self._matrices)

    @property
    def _set_up(self) -> list[Engine]:
        """The engines that have been called for so far."""
        return [self._first, *(self.__dict__[name] for name in ("_second",) if name in self.__dict__)]

    def _by(self, engine: Engine, instants: Numbers) -> Numbers:
        """Which of the instants an engine has followed the motion to."""
        legs = [leg for leg in self.legs if leg.engine is engine.name]
        spans = [(leg.start, leg.end) for leg in legs]
        if engine is self._current:
            spans.append((self._begun, np.inf))
        return np.array([any(start < t <= end for start, end in spans) for t in instants], dtype=bool)

    # ---- legs ----

    def _followed(self, until: Any, along: Callable[[Engine, Any], Iterator[Step]]) -> Iterator[Step]:
        while self.time != until:
            try:
                yield from self._leg(along(self._first, until), lambda: False, *self._why_first)
            except Obstacle as obstacle:
                if self._request.engine in BY_PROGRAM or self._precision.name != "double":
                    raise
                yield from self._past(obstacle, self._second, until)

    def _past(self, obstacle: Obstacle, second: Engine, until: Any) -> Iterator[Step]:
        """The motion past an obstacle, or to an instant before that."""
        second.restart(self._first.time, self._first.state.copy())
        self._current = second

        def passed() -> bool:
            return not second.amid_passage and obstacle.passed(second.time, second.state)

        yield from self._leg(second.integrate(until), passed, obstacle.case, obstacle.reason)
        self._first.restart(second.time, second.state)
        self._current = self._first

    def _leg(self, steps: Iterator[Step], done: Callable[[], bool], *why: Any) -> Iterator[Step]:
        self._begun = float(self.time)
        try:
            for step in steps:
                yield step
                if done():
                    break
        finally:
            if float(self.time) > self._begun:
                self._add_leg(Leg(self._current.name, self._begun, float(self.time), *why))

    @property
    def _why_first(self) -> tuple[HardCase | None, str]:
        """Why the engine that began is the robust one, where nobody asked for it."""
        if self._problem.obstacle is None:
            return None, ""
        redundant = self._first.rank < len(self._problem.multipliers)
        return (HardCase.REDUNDANT if redundant else HardCase.SINGULAR_PASSAGE), self._problem.obstacle

    def _add_leg(self, leg: Leg) -> None:
        """Keep a leg, as one with the last where the same engine went on for the same reason."""
        if self.legs and self.legs[-1]._replace(start=leg.start, end=leg.end) == leg:
            leg = leg._replace(start=self.legs.pop().start)
        self.legs.append(leg)


def _with_steps(engine: Engine, until: Any) -> Iterator[Step]:
    return engine.integrate(until)


def _without_steps(engine: Engine, until: Any) -> Iterator[Step]:
    engine.advance(until)
    yield from ()


def _taylor(
    problem: MotionProblem, request: SimulationRequest, precision: Precision, end: Any, matrices: MotionMatrices
) -> "TaylorEngine":
    from ...program.expense import order_for, require_means
    from .taylor import TaylorEngine, held

    digits = precision.digits + GUARD_DIGITS if request.tol is None else -log10(held(request.tol, precision))
    require_means(at_start(problem), precision, order_for(digits))
    decay = decay_until(end, problem, precision)
    return TaylorEngine(problem, request.tol, precision, request.drift, request.compact, decay, matrices, end)


def _runge_kutta(
    problem: MotionProblem, request: SimulationRequest, precision: Precision, end: Any, matrices: MotionMatrices
) -> Engine:
    from .runge_kutta import RungeKuttaEngine

    if precision.name != "double":
        raise HolonomError(Failure.RUNGE_KUTTA_IS_DOUBLE, detail=precision.name)
    closed = with_values_in(problem)
    return RungeKuttaEngine(closed, request.tol, request.drift, decay_until(end, problem, precision), matrices)


def decay_until(end: Any, problem: MotionProblem, precision: Precision) -> float:
    """The rate gamma of Baumgarte's cure and Gear's for a motion to an instant."""
    return DECAYS_IN_A_RUN / float(end - precision.number(problem.start["t"]))


def _robust(problem: MotionProblem, request: SimulationRequest, matrices: MotionMatrices) -> Engine:
    from .robust import TIGHTEST, RobustEngine

    if request.tol is not None and not TIGHTEST <= request.tol < 1:
        holds = f"the robust engine holds tolerances from {TIGHTEST:.1e} to 1, not {request.tol:g}"
        raise HolonomError(Failure.TOLERANCE_UNHELD, detail=holds)
    return RobustEngine(problem, request.tol, matrices)
