"""A simulation: engines follow the motion, a recording keeps what is wanted of it, a report says how well it went."""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

from ..failures import Failure, HolonomError
from ..program.motion_problem import MotionProblem
from ..program.precision import Precision, read_precision
from ..threads import one_blas_thread
from .constraints.singularity import require_gradient, shortly_before, vanishing_instants
from .diagnosis import HardCase, Instant, dependence, hard_cases
from .diagnostics import EnergyBalance, condition, residuals
from .engines.engine import Piece, Solutions
from .engines.switching import SwitchingEngine
from .evaluation import Numbers, as_floats
from .matrices import MotionMatrices, Vector, start_of
from .recording import Recording
from .request import FINAL_STATE_ALONE, SimulationRequest
from .result import Report, Samples, Simulation

Progress = Callable[[float], None]


def simulate(problem: MotionProblem, request: SimulationRequest, progress: Progress | None = None) -> Simulation:
    """Follow a motion.

    Parameters
    ----------
    problem : MotionProblem
    request : SimulationRequest
    progress : callable or None
        Told the fraction that is done, now and then.

    Returns
    -------
    Simulation

    Raises
    ------
    HolonomError
        The request cannot be met: its precision, tolerance, engine or end; or the motion cannot be followed so far.
    """
    with one_blas_thread():
        return _Simulation(problem, request).run(progress)


def last_instant(problem: MotionProblem, until: Fraction | None, precision: Precision) -> Any:
    """The instant at which a simulation ends.

    Parameters
    ----------
    problem : MotionProblem
    until : Fraction or None
        What is asked for; None for the end of the scene's time span.
    precision : Precision

    Returns
    -------
    number

    Raises
    ------
    HolonomError
        There is none, or it is not after the start.
    """
    if until is None and problem.time_span is None:
        raise HolonomError(Failure.NO_END, problem.scene)
    end = precision.number(problem.time_span[1]) if until is None else precision.ratio(until)
    if not end > precision.number(problem.start["t"]):
        raise HolonomError(Failure.NOT_AFTER_START, detail=f"{float(end):g} is not after {problem.start['t']}")
    return end


class _Simulation:
    """One simulation on its way: what the steps of `simulate` share."""

    def __init__(self, problem: MotionProblem, request: SimulationRequest) -> None:
        self.problem, self.samples = problem, request.samples
        self.precision = read_precision(str(request.precision))
        self.start = self.precision.number(problem.start["t"])
        self.end = last_instant(problem, request.until, self.precision)
        begun = time.perf_counter()
        self.matrices = MotionMatrices(problem)
        obstacle = problem.obstacle or dependence(self.matrices, Instant(*start_of(problem)))
        self.doubtful = vanishing_instants(problem, self.matrices, float(self.end))
        self.engine = SwitchingEngine(replace(problem, obstacle=obstacle), request, self.precision, self.end)
        self.first = self.engine.state.copy()
        self.balance = EnergyBalance(problem, self._multipliers, self.precision)
        self.compile_seconds = time.perf_counter() - begun - self.engine.compile_seconds
        self.recording = Recording(self.balance, self._wanted_instants(), self.precision.number("0"))

    def run(self, progress: Progress | None) -> Simulation:
        begun, compiled = time.perf_counter(), self.engine.compile_seconds
        self.recording.begin(self.start, self.first)
        self._follow(self._take(progress))
        self.recording.end(self.end, self.engine.state)
        seconds = time.perf_counter() - begun - (self.engine.compile_seconds - compiled)
        instants, states = np.array(self.recording.instants), np.array(self.recording.states).T
        solutions = self.engine.solutions(instants, states)
        energies = self._energies(instants, states)
        return Simulation(
            scene=self.problem.scene,
            title=self.problem.title,
            instants=instants,
            **self._motion(states, solutions),
            energy=energies if "energy" in self.problem.observe else {},
            residuals=self._residual_samples(instants, states, solutions),
            report=self._report(solutions, float(energies["energy_error"][-1]), seconds),
        )

    def _follow(self, take: Callable[[Piece], None] | None) -> None:
        for t in self.doubtful:
            self._go_on(self.precision.number(repr(shortly_before(t, float(self.start)))), take)
            at = Instant(float(self.engine.time), as_floats(self.engine.state))
            require_gradient(self.problem, self.matrices, t, at)
        self._go_on(self.end, take)

    def _go_on(self, until: Any, take: Callable[[Piece], None] | None) -> None:
        if take is None:
            return self.engine.advance(until)
        for piece in self.engine.pieces(until):
            take(piece)

    def _wanted_instants(self) -> Sequence[Any] | None:
        """Instants to keep; None for those of the steps. The last one is kept in any case."""
        if self.samples is None:
            return None
        inner = range(self.samples - 1) if self.samples != FINAL_STATE_ALONE else ()
        return [self.start + (self.end - self.start) * i / (self.samples - 1) for i in inner]

    def _take(self, progress: Progress | None) -> Callable[[Piece], None] | None:
        """What is done with each piece; None where nothing has to be."""
        if self.samples == FINAL_STATE_ALONE and self.balance.conservative and progress is None:
            return None
        if progress is None:
            return self.recording.take

        def take(piece: Piece) -> None:
            self.recording.take(piece)
            progress(float((piece.end - self.start) / (self.end - self.start)))

        return take

    def _multipliers(self, instants: Numbers, states: Numbers) -> Numbers:
        return self.engine.solutions(instants, states).multipliers

    def _energies(self, instants: Numbers, states: Numbers) -> Samples:
        """Energies at the samples, and what they differ by from the energy at the start and the work done since."""
        start = self.balance.energy(np.array([self.start]), self.first[:, None])
        energy = self.balance.energy(instants, states)
        return {"energy": energy, "energy_error": energy - start - np.array(self.recording.works)}

    def _motion(self, states: Numbers, solutions: Solutions) -> Mapping[str, Samples]:
        """Samples of what the scene observes."""
        observe, names = self.problem.observe, self.problem.coordinates
        followed = states if "trajectory" in observe else states[:0]
        reactions = solutions.multipliers if "multipliers" in observe else solutions.multipliers[:0]
        forces = solutions.constraint_forces if "constraint_forces" in observe else solutions.constraint_forces[:0]
        return {
            "coordinates": dict(zip(names, followed, strict=False)),
            "velocities": dict(zip(self.problem.state[len(names) :], followed[len(names) :], strict=False)),
            "multipliers": dict(zip(self.problem.multipliers, reactions, strict=False)),
            "constraint_forces": {f"Lambda[{s}]": row for s, row in enumerate(forces, start=1)},
        }

    def _residual_samples(self, instants: Numbers, states: Numbers, solutions: Solutions) -> Samples:
        if "residuals" not in self.problem.observe:
            return {}
        columns = zip(instants, states.T, solutions.accelerations.T, strict=True)
        found = [self._residuals(t, state, accelerations) for t, state, accelerations in columns]
        return {name: np.array([each[name] for each in found]) for name in found[0]}

    def _residuals(self, instant: Any, state: Numbers, accelerations: Numbers) -> Mapping[str, float]:
        at = self.matrices(float(instant), as_floats(state))
        return residuals(at, as_floats(state), as_floats(accelerations))

    def _report(self, solutions: Solutions, energy_error: float, seconds: float) -> Report:
        state, n = self.engine.state.copy(), len(self.problem.coordinates)
        observed = self.problem.multipliers if "multipliers" in self.problem.observe else ()
        at = self.matrices(float(self.end), as_floats(state))
        return Report(
            t=self.end,
            coordinates=dict(zip(self.problem.coordinates, state[:n], strict=True)),
            velocities=dict(zip(self.problem.state[n:], state[n:], strict=True)),
            multipliers=dict(zip(observed, solutions.multipliers[:, -1], strict=False)),
            residuals=residuals(at, as_floats(state), as_floats(solutions.accelerations[:, -1])),
            energy_error=energy_error,
            condition=condition(at),
            steps=self.engine.steps,
            legs=tuple(self.engine.legs),
            code=self.engine.code,
            precision=self.precision.name,
            digits=self.precision.digits,
            tol=self.engine.tol,
            compile_seconds=self.compile_seconds + self.engine.compile_seconds,
            run_seconds=seconds,
            cases=self._cases(state, as_floats(solutions.multipliers[:, -1])),
        )

    def _cases(self, state: Numbers, multipliers: Vector) -> tuple[HardCase, ...]:
        """Those that the robust engine was called for, then those that the ends tell; each once."""
        start, end = Instant(float(self.start), as_floats(self.first)), Instant(float(self.end), as_floats(state))
        called_for = [leg.case for leg in self.engine.legs if leg.case is not None]
        found = hard_cases(self.matrices, start, end, multipliers, self.engine.steps)
        return tuple(dict.fromkeys([*called_for, *found]))
