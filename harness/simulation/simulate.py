"""Simulation of a scene's motion by engines, with recorded samples and a report."""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import replace
from fractions import Fraction
from math import inf
from typing import Any

import numpy as np

from ..failures import ErrorKind, HolonomError
from ..language import translatable
from ..program.differentiation import derivative_name
from ..program.motion_problem import MotionProblem
from ..program.motion_program import Program
from ..program.precision import Precision, read_precision
from ..program.sign_pattern import drawing_with_values, with_values_in
from ..supervisor import doing
from .accuracy_check import expected, finest, may_hide, relative_energy_error, violations
from .defect import DefectControl
from .engines.engine import ESTIMATED_AFTER, Solutions, Step, require_reach
from .engines.registry import engine_class
from .evaluation import Numbers, as_floats, one_blas_thread
from .events import Ending, first_event
from .hard_cases import Difficulty, MotionState, hard_cases
from .hybrid_motion import EventOutcome, HybridMotion
from .mode import Mode
from .recording import Recording, SampleBlock, largest
from .request import FINAL_STATE_ALONE, EngineName, SimulationRequest, Stabilization
from .residuals import condition, residuals
from .result import Report, Sampled, Samples, Simulation, joined
from .sensitivities import Sensitivities
from .uniqueness import undetermined_outputs
from .variation import no_sensitivity

Progress = Callable[[float], None]
TakeSamples = Callable[[Sampled], None]
TakeStep = Callable[[Step], None]


def simulate(problem: MotionProblem, request: SimulationRequest, progress: Progress | None = None) -> Simulation:
    """Integrate a motion and record its samples.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    request : SimulationRequest
        End, samples, numbers, engine and tolerance.
    progress : callable or None
        Takes the finished fraction, from 0 to 1, from time to time.

    Returns
    -------
    Simulation

    Raises
    ------
    HolonomError
        As `integrate`.
    """
    parts: list[Sampled] = []
    report = integrate(problem, request, parts.append, progress)
    drawing = problem.drawing and replace(drawing_with_values(problem), ends=_ends_of_shapes(problem, report))
    named = {"scene": problem.scene, "title": problem.title, "drawing": drawing}
    return Simulation(**named, report=report, **vars(joined(parts)))


def _ends_of_shapes(problem: MotionProblem, report: Report) -> dict[int, float]:
    """Return the time after which each shape is absent, as its joint is released."""
    ends, shapes = {}, problem.joint_shapes
    for switching in report.switchings:
        if switching.outcome is EventOutcome.JOINT_RELEASED:
            release = next(each for each in problem.ends.released if each.of == switching.function)
            ends |= {shape: switching.t for name in release.multipliers for shape in shapes.get(name, ())}
            problem = release.after
    return ends


def integrate(
    problem: MotionProblem,
    request: SimulationRequest,
    take: TakeSamples,
    progress: Progress | None = None,
    watch: TakeStep | None = None,
) -> Report:
    """Integrate a motion and pass on its samples in blocks of some thousands.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    request : SimulationRequest
        End, samples, numbers, engine and tolerance.
    take : callable
        Takes a `Sampled`.
    progress : callable or None
        Takes the finished fraction, from 0 to 1, from time to time.
    watch : callable or None
        Takes each step.

    Returns
    -------
    Report

    Raises
    ------
    HolonomError
        The request cannot be met: its precision, tolerance, engine or end, or the motion cannot be continued so far.
    """
    with one_blas_thread(), np.errstate(all="ignore"):  # numbers that leave their range are rejected in the report
        _require_steps(problem, request)
        parametrized = _parametrized_problem(problem, request)
        _require_derivatives(problem, parametrized, request)
        end, ending = _end_of(problem, request)
        with doing("compiling the motion"):
            prepared = _Simulation(parametrized, request, take, end, ending)
        with doing("integrating the motion"), closing(prepared.motion):
            return prepared.run(progress, watch)


def _require_derivatives(problem: MotionProblem, parametrized: MotionProblem, request: SimulationRequest) -> None:
    """Reject sensitivities that the request excludes.

    They are those in other precisions, and by parameters that are constants of the integration.
    """
    if not request.sensitivities:
        return
    if request.numbers.name != "double":
        detail = translatable("they are integrated in double precision alone")
        raise no_sensitivity(detail)
    constants = set(problem.parameters) - set(parametrized.parameters)
    if constants & set(request.sensitivities):
        detail = translatable("this engine, or this stabilization, integrates with constant parameters")
        raise no_sensitivity(detail)


def _require_steps(problem: MotionProblem, request: SimulationRequest) -> None:
    """Reject a longest step that is not positive, or too short to reach the end."""
    step = request.max_step
    if step is None:
        return
    if not 0 < step < inf:
        raise HolonomError(ErrorKind.NOT_A_STEP, detail=f"{step:g}")
    span = float(last_time(problem, request.until, read_precision("double"))) - float(problem.start["t"])
    require_reach(ESTIMATED_AFTER, ESTIMATED_AFTER * step, span)


def _end_of(problem: MotionProblem, request: SimulationRequest) -> tuple[Any, Ending | None]:
    """Return the last time of a motion and the event that sets it, None without one."""
    end = last_time(problem, request.until, request.numbers)
    if not problem.ends.until:
        return end, None
    with (
        doing("looking for the end of the motion"),
        closing(HybridMotion(_parametrized_problem(problem, request), request, end)) as motion,
    ):
        event = first_event(motion, end)
    if event is None:
        return end, Ending(problem.ends.until, None)
    return event.t, Ending(problem.ends.until, event.name)


def _parametrized_problem(problem: MotionProblem, request: SimulationRequest) -> MotionProblem:
    """Return the motion with open parameters if possible, else with their values.

    Engines of double precision take open parameters, with projection or without stabilization. They are compiled once
    for all values.
    """
    open_ = (
        request.precision == "double"
        and (request.engine == EngineName.AUTO or engine_class(request.engine).open_parameters)
        and request.stabilization in (Stabilization.PROJECTION, Stabilization.NONE)
    )
    return problem if open_ else with_values_in(problem)


def last_time(problem: MotionProblem, until: Fraction | None, precision: Precision) -> Any:
    """Return the last time of a motion without events.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    until : Fraction or None
        Requested last time, in the scene's unit, or None for the end of the scene's time span.
    precision : Precision
        Numbers of the result.

    Returns
    -------
    number

    Raises
    ------
    HolonomError
        There is none, it is not after the initial time, or a table of the control law ends before it.
    """
    if until is None and problem.time_span is None:
        raise HolonomError(ErrorKind.NO_END, problem.scene)
    end = precision.number(problem.time_span[1]) if until is None else precision.ratio(until)
    if not end > precision.number(problem.start["t"]):
        raise HolonomError(
            ErrorKind.NOT_AFTER_START,
            detail=translatable("%(end)s is not after %(start)s", end=f"{float(end):g}", start=problem.start["t"]),
        )
    if problem.law_span is not None and end > precision.number(problem.law_span[1]):
        raise HolonomError(ErrorKind.LAW_ENDS, detail=f"{float(problem.law_span[1]):.10g}")
    return end


class _Simulation:
    """A simulation in progress, with the shared data of the steps of `simulate`."""

    def __init__(
        self, problem: MotionProblem, request: SimulationRequest, take: TakeSamples, end: Any, ending: Ending | None
    ) -> None:
        self.problem, self.samples, self.take = problem, request.samples, take
        self.precision, self.end, self.ending = request.numbers, end, ending
        self.finest = finest(self.precision)
        self.start = self.precision.number(problem.start["t"])
        begun = time.perf_counter()
        self.motion = HybridMotion(problem, request, self.end)
        self.first, self.begun = self.motion.state.copy(), self.motion.mode
        self.compile_seconds = time.perf_counter() - begun - self.motion.compile_seconds
        zero = self.precision.number("0")
        self.recording = Recording(self.begun, self._wanted_times(), zero, self._process)
        self.energy_statistics = _EnergyStatistics()
        self.reactions = np.zeros(len(problem.multipliers))  # the largest multipliers so far
        self.sensitivities = (
            Sensitivities(self.motion.problem, request.sensitivities, self.begun, request.tol, float(self.end))
            if request.sensitivities
            else None
        )
        self.steps = (
            DefectControl(self.end - self.start, self.precision)
            if may_hide(problem.matrices, ("t", *problem.parameters))
            else None
        )

    def run(self, progress: Progress | None, watch: TakeStep | None) -> Report:
        begun, compiled = time.perf_counter(), self.motion.compile_seconds
        self.recording.begin(self.start, self.first)
        self._integrate(self._take(progress, watch))
        self.recording.end(self.end, self.motion.state)
        seconds = time.perf_counter() - begun - (self.motion.compile_seconds - compiled)
        self.recording.flush()
        return self._report(seconds)

    def _process(self, block: SampleBlock) -> None:
        """Compute observed quantities at samples, and the data of the report."""
        found = [mode.engine.solutions(t, states) for mode, t, states in block.by_mode()]
        parts = list(zip(block.by_mode(), found, strict=True))
        own = [mode.outputs(t, states, each) for (mode, t, states), each in parts]
        self.outputs = _named(self.problem.outputs, own)
        found = [self._with_ended(each, mode) for (mode, *_), each in parts]
        self.solutions = Solutions(*map(_side_by_side, zip(*found, strict=True)))
        self.reactions = np.array(
            [largest(row, known) for row, known in zip(self.solutions.multipliers, self.reactions, strict=True)]
        )
        energies, self.controls = self._energies(block), self._controls(block)
        self.energy_statistics.add(energies["energy"], energies["energy_error"])
        self.take(
            Sampled(
                times=block.times,
                **self._motion(block.states, self.solutions),
                energy=energies if "energy" in self.problem.observe else {},
                residuals=self._residual_samples(block, self.solutions),
                controls=self.controls,
                outputs=self.outputs,
                sensitivities=self._sensitivity_samples(block),
            )
        )

    def _with_ended(self, solutions: Solutions, mode: Mode) -> Solutions:
        """Return solutions in a mode, with zero multipliers for ended constraints."""
        known = dict(zip(mode.problem.multipliers, solutions.multipliers, strict=True))
        none = np.zeros_like(solutions.accelerations[0])
        rows = [known.get(name, none) for name in self.problem.multipliers]
        return solutions._replace(multipliers=np.array(rows).reshape(len(rows), len(none)))

    def _integrate(self, take: TakeStep | None) -> None:
        for step in self.motion.integrate(self.end, dense=take is not None):
            if take is not None:
                take(step)

    def _wanted_times(self) -> Iterator[Any] | None:
        """Return the times to record, or None for the times of the steps.

        The last time is recorded in any case.
        """
        if self.samples is None:
            return None
        inner = range(self.samples - 1) if self.samples != FINAL_STATE_ALONE else ()
        return (self.start + (self.end - self.start) * i / (self.samples - 1) for i in inner)

    def _take(self, progress: Progress | None, watch: TakeStep | None) -> TakeStep | None:
        """Receiver of each step, or None."""
        one_mode = not self.problem.signs and not self.problem.ends.released
        nothing_to_integrate = one_mode and self.begun.balance.conservative and self.steps is None
        if (
            self.samples == FINAL_STATE_ALONE
            and nothing_to_integrate
            and progress is watch is self.sensitivities is None
        ):
            return None
        takers = [each.take for each in (self.sensitivities, self.recording, self.steps) if each is not None]
        takers += [] if watch is None else [watch]

        def take(step: Step) -> None:
            for each in takers:
                each(step)
            if progress is not None:
                progress(float((step.end - self.start) / (self.end - self.start)))

        return take

    def _energies(self, block: SampleBlock) -> Samples:
        """Return the energies at the samples, and their errors.

        An error is the difference from the initial energy and the work done since.
        """
        energy = np.concatenate([mode.balance.energy(t, states) for mode, t, states in block.by_mode()])
        return {"energy": energy, "energy_error": energy - self.begun.energy_at(self.start, self.first) - block.works}

    def _controls(self, block: SampleBlock) -> Samples:
        return _named(self.problem.controls, [mode.controls(t, states) for mode, t, states in block.by_mode()])

    def _motion(self, states: Numbers, solutions: Solutions) -> Mapping[str, Samples]:
        """Return samples of the quantities that the scene observes."""
        observe, names = self.problem.observe, self.problem.coordinates
        visited = states if "trajectory" in observe else states[:0]
        reactions = solutions.multipliers if "multipliers" in observe else solutions.multipliers[:0]
        forces = solutions.constraint_forces if "constraint_forces" in observe else solutions.constraint_forces[:0]
        return {
            "coordinates": dict(zip(names, visited, strict=False)),
            "velocities": dict(zip(self.problem.state[len(names) :], visited[len(names) :], strict=False)),
            "multipliers": dict(zip(self.problem.reactions, reactions, strict=False)),
            "constraint_forces": {f"Lambda[{s}]": row for s, row in enumerate(forces, start=1)},
        }

    def _sensitivity_samples(self, block: SampleBlock) -> Samples:
        """Return derivatives of the quantities that the scene observes."""
        if self.sensitivities is None:
            return {}
        found = self._observed_derivatives(self.sensitivities.samples(block))
        self.last_derivatives = {name: row[-1] for name, row in found.items()}
        return found

    def _observed_derivatives(self, found: Mapping[str, Numbers]) -> Samples:
        observe, outputs = self.problem.observe, self.problem.outputs
        observed = [*(self.problem.state if "trajectory" in observe else ())]
        observed += self.problem.reactions if "multipliers" in observe else ()
        observed += () if outputs is None else outputs.outputs
        names = (derivative_name(name, k) for name in ("t", *observed) for k in self.sensitivities.directions)
        return {name: found[name] for name in names if name in found}

    def _derivatives_at_end(self) -> Mapping[str, float]:
        if self.sensitivities is None:
            return {}
        if self.ending is None or self.ending.crossed is None:
            return self.last_derivatives
        return self._observed_derivatives(self.sensitivities.at_event(self.ending.crossed))

    def _residual_samples(self, block: SampleBlock, solutions: Solutions) -> Samples:
        if "residuals" not in self.problem.observe:
            return {}
        columns = zip(block.modes, block.times, block.states.T, solutions.accelerations.T, strict=True)
        found = [
            _residuals(MotionState(mode.matrices, float(t), as_floats(state)), accelerations)
            for mode, t, state, accelerations in columns
        ]
        return {name: np.array([each[name] for each in found]) for name in found[0]}

    def _report(self, seconds: float) -> Report:
        state, n, mode = self.motion.state.copy(), len(self.problem.coordinates), self.recording.mode
        start = MotionState(self.begun.matrices, float(self.start), as_floats(self.first))
        end = MotionState(mode.matrices, float(self.end), as_floats(state))
        observed = self.problem.reactions if "multipliers" in self.problem.observe else ()
        multipliers = self.solutions.multipliers[:, -1]
        left = _residuals(end, self.solutions.accelerations[:, -1])
        return Report(
            t=self.end,
            coordinates=dict(zip(self.problem.coordinates, state[:n], strict=True)),
            velocities=dict(zip(self.problem.state[n:], state[n:], strict=True)),
            multipliers=dict(zip(observed, multipliers, strict=False)),
            residuals=left,
            energy_error=self.energy_statistics.last_error,
            condition=condition(end.here.under(mode.problem.independent)),
            steps=self.motion.steps,
            segments=tuple(self.motion.segments),
            code=self.begun.engine.code,
            precision=self.precision.name,
            digits=self.precision.digits,
            tol=self.begun.engine.tol,
            compile_seconds=self.compile_seconds + self.motion.compile_seconds,
            run_seconds=seconds,
            correction=self.problem.initial.correction,
            moved=self.problem.initial.moved,
            cases=self._cases(start, end),
            switchings=tuple(self.motion.switchings),
            ending=self.ending,
            unreleased=tuple(release.of for release in self.motion.problem.ends.released),
            choice=self.begun.engine.choice,
            controls={name: values[-1] for name, values in self.controls.items()},
            outputs={name: values[-1] for name, values in self.outputs.items()},
            undetermined=self._undetermined(end, mode),
            joints={name: joint for name, joint in self.problem.joints.items() if name in observed},
            relative_degrees=self.problem.servo.relative_degrees,
            unresolved=self.motion.unresolved,
            sensitivities=self._derivatives_at_end(),
            violations=tuple(
                violations(self._errors(left, start, end), self.begun.engine.tol, self.motion.steps, self.finest)
            ),
        )

    def _undetermined(self, end: MotionState, mode: Mode) -> tuple[str, ...]:
        """Return the outputs that are not unique at the end.

        Neither are those that contacts which stick together share. Some constraints may have ended by then.
        """
        known = dict(zip(self.problem.multipliers, self.solutions.multipliers[:, -1], strict=True))
        multipliers = as_floats(np.array([known[name] for name in mode.problem.multipliers]))
        accelerations = as_floats(self.solutions.accelerations[:, -1])
        at_end = undetermined_outputs(mode.problem, end, accelerations, multipliers)
        return tuple(dict.fromkeys((*self.motion.undetermined, *at_end)))

    def _errors(self, left: Mapping[str, float], start: MotionState, end: MotionState) -> Mapping[str, float]:
        """Return the errors of the quantities that the tolerance limits.

        They are relative to the size of each quantity.
        """
        within = {} if self.steps is None else {"acceleration": self.steps.error}
        errors = {name: left[name] for name in ("position", "velocity")}
        if not np.isfinite(self.reactions).all():
            errors["multipliers"] = np.nan
        ends = (start.here, start.state), (end.here, end.state)
        energy = self.energy_statistics
        change = max(self.recording.largest_work, energy.largest_change)
        small = expected(self.begun.engine.tol, self.motion.steps, self.finest) * self.motion.nominal.velocities
        return {**errors, "energy": float(relative_energy_error(*ends, energy.error, change, small)), **within}

    def _cases(self, start: MotionState, end: MotionState) -> tuple[Difficulty, ...]:
        """Return the hard cases of the robust engine, then those of both ends, each once."""
        called_for = [segment.case for segment in self.motion.segments if segment.case is not None]
        if self.problem.ends.released:
            end = start  # other constraints may hold at the end
        found = hard_cases(self.problem.independent, start, end, self.reactions, self.motion.steps)
        # servo-constraints have no reaction by themselves
        answering = self.problem.reactions or not self.problem.servo.constraints
        found = (case for case in found if answering or case is not Difficulty.FREE_CANCELLATION)
        return tuple(dict.fromkeys([*called_for, *found]))


def _named(program: Program | None, parts: Sequence[Numbers]) -> Samples:
    """Return samples by the names of a program's outputs."""
    return dict(zip(() if program is None else program.outputs, np.concatenate(parts, axis=1), strict=True))


def _residuals(at: MotionState, accelerations: Numbers) -> Mapping[str, float]:
    return residuals(at.here, at.state, as_floats(accelerations), at.matrices.nominal)


def _side_by_side(parts: Sequence[Numbers]) -> Numbers:
    """Return the rows that all parts have.

    The robust engine adds constraint forces that the scene does not observe.
    """
    shared = min(len(rows) for rows in parts)
    return np.concatenate([rows[:shared] for rows in parts], axis=1)


class _EnergyStatistics:
    """The largest change of the energy and its largest error, block by block."""

    def __init__(self) -> None:
        self.largest_change = self.error = self.last_error = 0.0
        self._first: Any = None

    def add(self, energy: Numbers, error: Numbers) -> None:
        """Add samples of the energy, and of what was gained beyond the work done."""
        if self._first is None:
            self._first = energy[0]
        self.largest_change = largest(energy - self._first, self.largest_change)
        self.error = largest(error, self.error)
        self.last_error = float(error[-1])
