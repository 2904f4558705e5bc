"""A mode of a motion: the smooth motion of one pattern of signs, and what belongs to it."""

from collections.abc import Collection, Hashable, Iterator, Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from ..failures import Failure, HolonomError
from ..program.motion_problem import By, MotionProblem, computing
from ..program.motion_program import Program
from ..program.precision import Precision
from ..program.sign_pattern import (
    SLIDING,
    Pattern,
    in_numbers,
    problem_in,
    program_in,
    sharing_programs,
    switching_function,
)
from .constraints.program_projection import ProgramProjection
from .constraints.singularity import no_controls, require_gradient, shortly_before, vanishing_instants
from .control_matrix import ControlMatrix, controls_may_fail
from .energy import EnergyBalance
from .engines.choice import Between
from .engines.engine import Solutions, Step, Task
from .engines.fallback import FallbackEngine
from .evaluation import Evaluation, Numbers, as_floats, evaluation, evaluation_once
from .hard_cases import Instant, dependence
from .inputs import Inputs
from .matrices import MotionMatrices, start_of
from .request import SimulationRequest
from .time_dependence import time_dependence
from .time_events import TimeEvent
from .zeros import SignedFunctions


class Surfaces(SignedFunctions):
    """The surfaces on which a pattern of signs ends, but for signs whose changes are known without looking."""

    def __init__(
        self, problem: MotionProblem, pattern: Pattern, precision: Precision, span: float, known: Collection[str] = ()
    ) -> None:
        super().__init__(precision, span)
        self._inputs = Inputs(problem, precision)
        for sign in problem.signs:
            if sign.name not in known:
                value = pattern[sign.name]
                self._rows += [(sign.name, to, -to) for to in ((1, -1) if value == SLIDING else (-value,))]
        what = "surfaces", precision.name, frozenset(pattern.items()), frozenset(known)
        self._functions = problem.once(
            what,
            problem.switching,
            lambda: [evaluation(_inside(problem, pattern, name, to), precision) for name, to, _ in self._rows],
        )

    def values(self, instants: Numbers, states: Numbers) -> Numbers:
        """Return how far inside of its pattern the motion is, by each surface; negative outside."""
        inputs = self._inputs(instants, states)
        found = [as_floats(function(inputs)[0]) for function in self._functions]
        inside = np.array([side for *_, side in self._rows], dtype=float)
        return inside[:, None] * np.reshape(found, (len(self._rows), len(instants)))


def _inside(problem: MotionProblem, pattern: Pattern, name: str, to: int) -> Program:
    """Return the function whose sign tells on which side of a surface the motion is."""
    if pattern[name] == SLIDING:
        return switching_function(problem, "drive", name, {**pattern, name: to})
    return switching_function(problem, "switch", name, pattern)


class Mode:
    """The smooth motion of one pattern of signs, with its engine and its surfaces.

    Parameters
    ----------
    problem : MotionProblem
        Its start is where the motion first has this pattern.
    time_events : mapping of str to TimeEvent
        The signs that the time alone decides.
    request, precision, end
        As for `HybridMotion`.
    known : dict
        The analytic motions of other modes, as `sharing_programs` keeps them.
    """

    def __init__(
        self,
        problem: MotionProblem,
        pattern: Pattern,
        time_events: Mapping[str, TimeEvent],
        request: SimulationRequest,
        precision: Precision,
        end: Any,
        known: dict[Hashable, MotionProblem],
    ) -> None:
        self.whole, self.pattern, self._precision, self._time_events = problem, pattern, precision, time_events
        analytic = problem_in(problem, pattern)
        if any(sign.by is By.TIME for sign in problem.signs):
            analytic = sharing_programs(analytic, known)
        self.matrices, self._inputs = MotionMatrices(analytic), Inputs(analytic, precision)
        obstacle = analytic.obstacle or dependence(analytic, Instant(self.matrices, *start_of(analytic)))
        self.problem = replace(analytic, obstacle=obstacle)
        self.balance = EnergyBalance(self.problem, self._multipliers, precision)
        between = None if problem.signs or problem.tables else Between(request.samples or 0, self.balance.inner_states)
        self.engine = FallbackEngine(Task(self.problem, request, precision, end, self.matrices), between)
        self._start, self._end = float(problem.start["t"]), float(end)
        self._doubtful = vanishing_instants(self.problem, self.matrices, self._end)
        to_come = (float(event.t) for name, event in time_events.items() if pattern[name] != event.to)
        self.by_time = time_dependence(
            in_numbers(self.problem, self.problem.matrices),
            self._start,
            min([self._end, *to_come]),
            self.problem.tables,
        )
        ends = () if self.by_time.end is None else (self.by_time.end,)
        before = (shortly_before(t, self._start) for t in self._doubtful)
        self.stops = sorted({*self.by_time.stops, *ends, *before})

    @cached_property
    def surfaces(self) -> Surfaces:
        """The surfaces on which the pattern ends."""
        return Surfaces(self.whole, self.pattern, self._precision, self._end - self._start, self._time_events)

    @cached_property
    def momenta(self) -> Any:
        """dL/d dot(q) as a function of the state."""
        switching = self.whole.switching
        wanted = {name for name in switching.outputs if name.startswith("momentum[")}

        def build() -> Evaluation:
            return evaluation(program_in(self.whole, computing(switching, wanted), self.pattern), self._precision)

        return self.whole.once(("momenta", self._precision.name, frozenset(self.pattern.items())), switching, build)

    def controls(self, instants: Numbers, states: Numbers) -> Numbers:
        """Return the observed controls at instants, shape (k,), and states, shape (2n, k).

        Raises
        ------
        HolonomError
            One has no value at one of the instants.
        """
        if self.problem.controls is None:
            return np.empty((0, len(instants)))
        found = self._controls(self._inputs(instants, states))
        _require_values("control", self.problem.controls, instants, found)
        return found

    @cached_property
    def _controls(self) -> Evaluation:
        return evaluation_once(self.problem, self.problem.controls, self._precision)

    def outputs(self, instants: Numbers, states: Numbers, solutions: Solutions) -> Numbers:
        """Return the outputs that the scene names, at instants, shape (k,), and states, shape (2n, k).

        Raises
        ------
        HolonomError
            One has no value at one of the instants.
        """
        if self.problem.outputs is None:
            return np.empty((0, len(instants)))
        inputs = self._inputs(instants, states, solutions.multipliers, accelerations=solutions.accelerations)
        found = self._outputs(inputs)
        _require_values("output", self.problem.outputs, instants, found)
        return found

    @cached_property
    def _outputs(self) -> Evaluation:
        return evaluation_once(self.problem, self.problem.outputs, self._precision)

    @cached_property
    def projection(self) -> ProgramProjection:
        """What projects states in the numbers of the run."""
        return ProgramProjection(self.problem, self._precision)

    def integrate(self, until: Any) -> Iterator[Step]:
        """Follow the motion as its engine does, to where servo-constraints leave their controls without values."""
        for step in self.engine.integrate(until):
            step = step._replace(mode=self)
            lost = None if self._control_matrix is None else self._control_matrix.lost(step)
            if lost is None:
                yield step
                continue
            if lost > step.start:
                yield step._replace(end=lost)
            raise no_controls(float(lost))

    @cached_property
    def _control_matrix(self) -> ControlMatrix | None:
        if not controls_may_fail(self.problem):
            return None
        return ControlMatrix(self.problem, self._precision, self._end - self._start)

    def require_way_on(self, until: Any) -> None:
        """Refuse to go on where a constraint loses its gradient, or an expression of the time its smoothness."""
        now = self.engine.time
        if self.by_time.end is not None and float(now) >= self.by_time.end and now != until:
            raise HolonomError(Failure.NO_WAY_ON, detail=f"{self.by_time.end:.10g}, where {self.by_time.reason}")
        for t in self._doubtful:
            if shortly_before(t, self._start) == float(now):
                require_gradient(self.problem, t, Instant(self.matrices, float(now), as_floats(self.engine.state)))

    def energy_at(self, t: Any, state: Numbers) -> Any:
        """Return the energy at one state."""
        return self.balance.energy(np.array([t]), state[:, None])[0]

    def _multipliers(self, instants: Numbers, states: Numbers) -> Numbers:
        return self.engine.solutions(instants, states).multipliers


def _require_values(what: str, program: Program, instants: Numbers, found: Numbers) -> None:
    """Refuse values, shape (outputs, k), one of which is none."""
    missing = np.argwhere(~np.isfinite(as_floats(found)).T)
    if len(missing):
        point, place = missing[0]
        reason = f"the {what} {list(program.outputs)[place]} has no value"
        raise HolonomError(Failure.NO_WAY_ON, detail=f"{float(instants[point]):.10g}, where {reason}")
