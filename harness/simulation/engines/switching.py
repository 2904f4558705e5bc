"""The engines at work on one motion, one handing over to the other.

The Taylor engine is the first choice, the Runge-Kutta engine one that can be asked for; both take the motion program.
Where constraints are redundant, no order of pivots solves the equations, and the robust engine does all; where the
configuration nears a singular one, or numbers leave their range, it takes over from the Taylor engine until the
constraints are as independent again as they were when it did.
"""

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...failures import Failure, HolonomError
from ...program.motion_problem import MotionProblem
from ...program.precision import Precision
from ..advice import HardCase
from ..evaluation import Numbers, as_floats
from ..request import Engine, SimulationRequest
from ..solution import Solutions, program_solution
from .dense_output import Piece
from .program_motion import ProgramMotion, ProgramObstacle
from .taylor import DECAYS_IN_A_RUN, TaylorMotion

if TYPE_CHECKING:
    from .robust import RobustMotion

BY_PROGRAM = (Engine.TAYLOR, Engine.RUNGE_KUTTA)
FINE = 1e-13  # tolerance of the robust engine between two legs of a Taylor engine that nobody gave one
Take = Callable[[Piece], None]


class Leg(NamedTuple):
    """A part of the motion that one engine follows.

    Attributes
    ----------
    engine : Engine
    start, end : float
    case : HardCase or None
        What the robust engine was called for; None where nobody called it.
    reason : str
        Why it was called, a clause.
    """

    engine: Engine
    start: float
    end: float
    case: HardCase | None = None
    reason: str = ""


class Engines:
    """A motion followed by the engines that a request allows.

    Parameters
    ----------
    problem : MotionProblem
    request : SimulationRequest
    precision : Precision
    end : number
        The last instant.

    Attributes
    ----------
    time : number
    state : ndarray, shape (2n,)
    legs : list of Leg
        In order, as far as the motion has come.
    """

    def __init__(self, problem: MotionProblem, request: SimulationRequest, precision: Precision, end: Any) -> None:
        self._problem, self._request, self._precision = problem, request, precision
        self._end = self._goal = end
        self.legs: list[Leg] = []
        self._engine = Engine.TAYLOR if request.engine is Engine.AUTO else request.engine
        self._only_robust = request.engine is Engine.ROBUST or problem.obstacle is not None
        if problem.obstacle is not None and request.engine in BY_PROGRAM:
            raise HolonomError(Failure.NO_PIVOTS, detail=problem.obstacle)
        if self._only_robust and precision.name != "double":
            raise HolonomError(Failure.ROBUST_IS_DOUBLE, detail=problem.obstacle or "--engine asks for it")
        self._current = self.robust if self._only_robust else self.by_program
        self._program_solution = None if self._only_robust else program_solution(problem, precision)

    @cached_property
    def by_program(self) -> ProgramMotion:
        """The engine that takes the motion program."""
        request = self._request
        if request.engine is Engine.RUNGE_KUTTA:
            return _runge_kutta(self._problem, request, self._precision)
        decay = DECAYS_IN_A_RUN / float(self._end - self._precision.number(self._problem.start["t"]))
        return TaylorMotion(self._problem, request.tol, self._precision, request.drift, request.compact, decay)

    @cached_property
    def robust(self) -> "RobustMotion":
        """The robust engine."""
        from .robust import TIGHTEST, RobustMotion

        asked = self._request.tol
        if asked is not None and self._only_robust and not TIGHTEST <= asked < 1:
            holds = f"the robust engine holds tolerances from {TIGHTEST:.1e} to 1, not {asked:g}"
            raise HolonomError(Failure.TOLERANCE_UNHELD, detail=holds)
        return RobustMotion(self._problem, FINE if asked is None and not self._only_robust else asked)

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
    def _set_up(self) -> "list[ProgramMotion | RobustMotion]":
        """The engines that have been called for so far."""
        return [self.__dict__[engine] for engine in ("by_program", "robust") if engine in self.__dict__]

    @property
    def code(self) -> str:
        """How heyoka compiled the Taylor engine; empty where it did nothing."""
        return self.by_program.code if "by_program" in self.__dict__ else ""

    @property
    def tol(self) -> float:
        """Tolerance of the engine that began."""
        return (self.robust if self._only_robust else self.by_program).tol

    @property
    def redundant(self) -> bool:
        """Whether there are fewer independent constraints than constraints."""
        return self._problem.obstacle is not None and self.robust.rank < len(self._problem.multipliers)

    def solve(self, instants: Numbers, states: Numbers) -> Solutions:
        """Accelerations, multipliers and constraint forces near the instant that is reached, by the engine at work."""
        return (self._robust_solution if self._robust_works() else self._program_solution)(instants, states)

    def solve_all(self, instants: Numbers, states: Numbers) -> Solutions:
        """The same at states of the whole motion, each by the engine that followed it there."""
        robust = [leg for leg in self.legs if leg.engine is Engine.ROBUST]
        there = np.array([any(leg.start < t <= leg.end for leg in robust) for t in as_floats(instants)], dtype=bool)
        if self._only_robust or there.all():
            return self._robust_solution(instants, states)
        found = self._program_solution(instants, states)
        if there.any():
            for rows, better in zip(found, self._robust_solution(instants[there], states[:, there]), strict=True):
                rows[:, there] = better[: len(rows)]
        return found

    def follow(self, until: Any, take: Take | None) -> None:
        """Follow the motion to an instant.

        Parameters
        ----------
        until : number
        take : callable or None
            Takes each piece of the motion; without it there are none, and the engine is at its fastest.

        Raises
        ------
        HolonomError
            The motion cannot be followed so far by the engines allowed.
        """
        self._goal = until
        if self._only_robust:
            self._robust_leg(take, self._at_the_end, *self._why_robust())
        while self.time != self._goal:
            try:
                self._program_leg(take)
            except ProgramObstacle as obstacle:
                self._hand_over(obstacle, take)

    def _program_leg(self, take: Take | None) -> None:
        start = float(self.time)
        try:
            if take is None:
                self.by_program.advance(self._goal)
            else:
                for piece in self.by_program.pieces(self._goal):
                    take(piece)
        finally:
            if float(self.time) > start:
                self._add_leg(Leg(self._engine, start, float(self.time)))

    def _hand_over(self, obstacle: ProgramObstacle, take: Take | None) -> None:
        if self._request.engine in BY_PROGRAM or self._precision.name != "double":
            raise obstacle
        taylor, robust = self.by_program, self.robust
        robust.restart(taylor.time, taylor.state.copy())
        least = taylor.watch.least(taylor.time, taylor.state)
        self._current = robust

        def passed() -> bool:
            return taylor.watch.least(robust.time, robust.state) > least

        self._robust_leg(take, passed, obstacle.case, obstacle.reason)
        taylor.restart(robust.time, robust.state)
        self._current = taylor

    def _robust_leg(self, take: Take | None, done: Callable[[], bool], *why: Any) -> None:
        start = self.robust.time
        for piece in self.robust.pieces(self._goal):
            if take is not None:
                take(piece)
            if not self.robust.singular_ahead and done():
                break
        self._add_leg(Leg(Engine.ROBUST, start, self.robust.time, *why))

    def _why_robust(self) -> tuple[HardCase | None, str]:
        if self._problem.obstacle is None:
            return None, ""
        return (HardCase.REDUNDANT if self.redundant else HardCase.SINGULAR_PASSAGE), self._problem.obstacle

    def _at_the_end(self) -> bool:
        return self.robust.time == self._goal

    def _add_leg(self, leg: Leg) -> None:
        """Keep a leg, as one with the last where the same engine went on for the same reason."""
        if self.legs and self.legs[-1]._replace(start=leg.start, end=leg.end) == leg:
            leg = leg._replace(start=self.legs.pop().start)
        self.legs.append(leg)

    def _robust_works(self) -> bool:
        return self._current is self.__dict__.get("robust")

    def _robust_solution(self, instants: Numbers, states: Numbers) -> Solutions:
        found = [self.robust.solution(t, state) for t, state in zip(instants, states.T, strict=True)]
        return Solutions(*(np.array(each).T for each in zip(*found, strict=True)))


def _runge_kutta(problem: MotionProblem, request: SimulationRequest, precision: Precision) -> ProgramMotion:
    from .runge_kutta import RungeKuttaMotion

    if precision.name != "double":
        raise HolonomError(Failure.RUNGE_KUTTA_IS_DOUBLE, detail=precision.name)
    return RungeKuttaMotion(problem, request.tol, request.drift)
