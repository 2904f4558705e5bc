"""A mode of a motion: the smooth motion of one pattern of signs."""

from collections.abc import Hashable, Iterator, Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from ..failures import ErrorKind, HolonomError
from ..language import translatable
from ..program.friction import SLIDING, STUCK, Pattern
from ..program.motion_problem import DependsOn, MotionProblem
from ..program.motion_program import Program
from ..program.rewriting import computing
from ..program.sign_pattern import (
    problem_in,
    program_in,
    program_with_values,
    sharing_programs,
    switching_functions,
)
from .constraints.program_projection import ProgramProjection
from .constraints.projection import settle
from .constraints.singularity import VanishingGradients, laws_of, no_controls
from .control_matrix import ControlMatrix, controls_may_fail
from .energy import EnergyBalance
from .engines.engine import Solutions, Step, Task
from .engines.fallback import FallbackEngine
from .evaluation import Evaluation, Numbers, as_floats, evaluation, evaluation_once
from .friction_modes import FrictionModes
from .hard_cases import MotionState, dependence
from .inputs import Inputs
from .matrices import MotionMatrices, start_of
from .place_and_reason import place_and_reason
from .radicands import Radicands, radicands
from .request import FINAL_STATE_ALONE, SimulationRequest
from .time_dependence import TimeDependence, time_dependence, time_dependence_of_motion
from .time_events import TimeEvent
from .zeros import SignedFunctions

UNIQUE = "unique"  # name of the switching surfaces on which accelerations cease to be unique
TOO_OFTEN = translatable("a switching function of the time changes its sign too often to be followed")
FREE = 1e-12  # of the nominal size of a multiplier: no reaction


class SwitchingFunctions(SignedFunctions):
    """The switching surfaces on which a pattern of signs ends.

    Signs whose changes are known beforehand have none.
    """

    def __init__(self, mode: "Mode") -> None:
        super().__init__(mode.precision, mode.span)
        problem, pattern, precision = mode.whole, mode.pattern, mode.precision
        self._inputs = Inputs(problem, precision)
        for sign in problem.signs:
            value = pattern[sign.name]
            if sign.name not in mode.time_events and value not in STUCK:
                self._rows += [(sign.name, to, -to) for to in ((1, -1) if value == SLIDING else (-value,))]
        names = list(dict.fromkeys(name for name, *_ in self._rows))
        self._of_rows = [names.index(name) for name, *_ in self._rows]
        self._constants = precision.numbers([pattern[name] == SLIDING for name, *_ in self._rows])[:, None]
        self._slopes = precision.numbers([-to for _, to, _ in self._rows])[:, None]
        rounding = mode.reactions_of_rounding
        self._rounding = np.array([rounding.get(name, 0.0) for name, *_ in self._rows])[:, None]
        what = "surfaces", precision.name, frozenset(pattern.items()), frozenset(mode.time_events)

        def compiled() -> Evaluation:
            return evaluation(switching_functions(problem, pattern, names), precision) if names else _none

        self._function = problem.once(what, problem.switching, compiled)
        self._friction = mode.friction
        self._rows += [(UNIQUE, 0, 1)] * (mode.friction.count if mode.friction else 0)

    def values(self, times: Numbers, states: Numbers) -> Numbers:
        """Return the switching functions (see `SignedFunctions.values`)."""
        inputs = self._inputs(times, states)
        found = self._constants + self._slopes * self._function(inputs)[self._of_rows]
        signed = as_floats(found) + self._rounding
        return np.concatenate([signed, self._friction.guards(inputs)]) if self._friction else signed


def _none(inputs: Numbers) -> Numbers:
    return inputs[:0]


class Mode:
    """The smooth motion of one pattern of signs, with its engine and its events.

    Parameters
    ----------
    problem : MotionProblem
        Its start is where the motion first has this pattern.
    time_events : mapping of str to TimeEvent
        The signs that the time alone decides.
    request, end
        As for `HybridMotion`.
    known : dict
        The analytic motions of other modes, as `sharing_programs` keeps them.
    friction : FrictionModes or None
        As `modes_that_may_agree` returns them.
    """

    def __init__(
        self,
        problem: MotionProblem,
        pattern: Pattern,
        time_events: Mapping[str, TimeEvent],
        request: SimulationRequest,
        end: Any,
        known: dict[Hashable, MotionProblem],
        friction: FrictionModes | None,
    ) -> None:
        self.whole, self.pattern, self.precision = problem, pattern, request.numbers
        self.time_events, self.friction = time_events, friction
        analytic = problem_in(problem, pattern)
        if any(sign.by is DependsOn.TIME for sign in problem.signs):
            analytic = sharing_programs(analytic, known)
        self.matrices, self._inputs = MotionMatrices(analytic), Inputs(analytic, self.precision)
        obstruction = analytic.obstruction or dependence(analytic, MotionState(self.matrices, *start_of(analytic)))
        self.problem = replace(analytic, obstruction=obstruction)
        energy = self.matrices.nominal.energy(self.matrices(*start_of(analytic)).mass)
        self.balance = EnergyBalance(self.problem, self._multipliers, self.precision, energy)
        dense = bool(request.samples != FINAL_STATE_ALONE or self.balance.inner_states)
        dense = None if problem.signs or problem.tables else dense
        self.engine = FallbackEngine(Task(self.problem, request, end, self.matrices), dense)
        self._start, self._end = float(problem.start["t"]), float(end)
        self.span = self._end - self._start
        self._gradients = VanishingGradients(self.problem, self.matrices, laws_of(problem), self._end)
        to_come = (float(event.t) for name, event in time_events.items() if pattern[name] != event.to)
        until = min([self._end, *to_come])
        self.by_time = time_dependence_of_motion(
            self.problem, lambda program: program_with_values(self.problem, program), self._start, until
        ).ended_by(self._dependence_of_signs(until))
        ends = () if self.by_time.end is None else (self.by_time.end,)
        self.stops = sorted({*self.by_time.stops, *ends, *self._gradients.stops})

    def _dependence_of_signs(self, until: float) -> TimeDependence:
        """Return the dependence of switching functions of time, but of time events."""
        whole = self.whole
        signs = {f"switch[{i}]": sign for i, sign in enumerate(whole.signs, 1) if sign.by is DependsOn.TIME}
        names = {output for output, sign in signs.items() if sign.name not in self.time_events}
        if not names:
            return TimeDependence()
        functions = program_in(whole, computing(whole.switching, names), self.pattern)
        found = time_dependence(program_with_values(whole, functions), self._start, until, whole.tables)
        return found if found.unresolved is None else TimeDependence(end=found.unresolved, reason=TOO_OFTEN)

    @cached_property
    def switching_functions(self) -> SwitchingFunctions:
        """The switching surfaces on which the pattern ends."""
        return SwitchingFunctions(self)

    @property
    def reactions_of_rounding(self) -> Mapping[str, float]:
        """By the names of signs, multipliers so small that rounding decides about them."""
        sizes = self._reaction_sizes() if self.whole.reacting else {}
        return {sign.name: FREE * sizes[sign.of] for sign in self.whole.signs if sign.by is DependsOn.REACTION}

    def _reaction_sizes(self) -> Mapping[str, float]:
        """Nominal sizes of the multipliers."""
        t, state = start_of(self.whole)
        at, nominal = self.matrices(t, state), self.matrices.nominal
        work = max(nominal.energy(at.mass), float(np.max(np.abs(at.force) * nominal.coordinates)))
        ways = np.max(np.abs(at.jacobian) * nominal.coordinates, axis=1)
        return dict(zip(self.whole.multipliers, work / ways, strict=True))

    @cached_property
    def momentum_program(self) -> Program:
        """The program of dL/d dot(q)."""
        switching = self.whole.switching
        wanted = {name for name in switching.outputs if name.startswith("momentum[")}
        key = "momentum program", frozenset(self.pattern.items())
        return self.whole.once(
            key, switching, lambda: program_in(self.whole, computing(switching, wanted), self.pattern)
        )

    def momenta_at(self, t: Any, state: Numbers) -> Numbers:
        """Return dL/d dot(q) at one state.

        Parameters
        ----------
        t : number
            Time of the state.
        state : ndarray, shape (2n,)
            Coordinates, then velocities.

        Returns
        -------
        ndarray, shape (n,)
        """
        momenta = evaluation_once(self.whole, self.momentum_program, self.precision)
        return as_floats(momenta(Inputs(self.whole, self.precision)(t, state)))

    def controls(self, times: Numbers, states: Numbers) -> Numbers:
        """Return the observed controls.

        Parameters
        ----------
        times : ndarray, shape (k,)
            Times of the states.
        states : ndarray, shape (2n, k)
            Coordinates, then velocities.

        Returns
        -------
        ndarray, shape (controls, k)

        Raises
        ------
        HolonomError
            One has no value at one of the times.
        """
        if self.problem.controls is None:
            return np.empty((0, len(times)))
        found = self._controls(self._inputs(times, states))
        _require_values(self.problem.controls, times, found)
        return found

    @cached_property
    def _controls(self) -> Evaluation:
        return evaluation_once(self.problem, self.problem.controls, self.precision)

    def outputs(self, times: Numbers, states: Numbers, solutions: Solutions) -> Numbers:
        """Return the outputs of the scene.

        Parameters
        ----------
        times : ndarray, shape (k,)
            Times of the states.
        states : ndarray, shape (2n, k)
            Coordinates, then velocities.
        solutions : Solutions
            Accelerations and multipliers at these states.

        Returns
        -------
        ndarray, shape (outputs, k)

        Raises
        ------
        HolonomError
            One has no value at one of the times.
        """
        if self.problem.outputs is None:
            return np.empty((0, len(times)))
        inputs = self._inputs(times, states, solutions.multipliers, accelerations=solutions.accelerations)
        found = self._outputs(inputs)
        _require_values(self.problem.outputs, times, found)
        return found

    @cached_property
    def _outputs(self) -> Evaluation:
        return evaluation_once(self.problem, self.problem.outputs, self.precision)

    def settled(self, t: Any, state: Numbers) -> Numbers:
        """Return the nearest state that satisfies the constraints.

        Parameters
        ----------
        t : number
            Time of the state.
        state : ndarray, shape (2n,)
            Coordinates, then velocities.

        Returns
        -------
        ndarray, shape (2n,)
            In the precision of the run, or in double precision if the mass matrix is singular.
        """
        if self.problem.projection is None:
            return settle(self.matrices, float(t), as_floats(state))[0]
        moved = state.copy()
        self._projection.project(t, moved)
        return moved

    @cached_property
    def _projection(self) -> ProgramProjection:
        return ProgramProjection(self.problem, self.precision)

    def integrate(self, until: Any) -> Iterator[Step]:
        """Integrate until the controls of servo-constraints have no values.

        Parameters
        ----------
        until : number
            Last time.

        Yields
        ------
        Step
            With this mode. The last step ends where the controls are lost.

        Raises
        ------
        HolonomError
            The controls have no values from a time on, or as `FallbackEngine.integrate`.
        """
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
        return ControlMatrix(self.problem, self.precision, self.span)

    @cached_property
    def radicands(self) -> Radicands | None:
        """The arguments of roots that may touch zero, None without any."""
        program = self.whole.once("radicands", self.whole.matrices, lambda: radicands(self.whole))
        if program is None:
            return None
        return Radicands(self.whole, self.pattern, program, self.precision, self.span, self.engine.tol)

    def require_way_on(self, until: Any) -> None:
        """Reject a vanishing constraint gradient or a nonsmooth expression of time.

        Parameters
        ----------
        until : number
            Last time that is requested.

        Raises
        ------
        HolonomError
            The motion cannot continue from the time of the engine.
        """
        now = self.engine.time
        if self.by_time.end is not None and float(now) >= self.by_time.end and now != until:
            raise HolonomError(ErrorKind.NO_WAY_ON, detail=place_and_reason(self.by_time.end, self.by_time.reason))
        if float(now) in self._gradients.stops:
            self._gradients.require(float(now), as_floats(self.engine.state))

    def energy_at(self, t: Any, state: Numbers) -> Any:
        """Return the energy at one state.

        Parameters
        ----------
        t : number
            Time of the state.
        state : ndarray, shape (2n,)
            Coordinates, then velocities.

        Returns
        -------
        number
            Energy, in the scene's unit.
        """
        return self.balance.energy(np.array([t]), state[:, None])[0]

    def _multipliers(self, times: Numbers, states: Numbers) -> Numbers:
        return self.engine.solutions(times, states).multipliers


def _require_values(program: Program, times: Numbers, found: Numbers) -> None:
    """Raise if one of the values, shape (outputs, k), is not a finite number."""
    missing = np.argwhere(~np.isfinite(as_floats(found)).T)
    if len(missing):
        point, place = missing[0]
        reason = translatable("%(name)s has no value", name=list(program.outputs)[place])
        raise HolonomError(ErrorKind.NO_WAY_ON, detail=place_and_reason(times[point], reason))
