"""Common base of the engines that use the motion program with its fixed pivots.

An integrator takes its steps in blocks, without Python in between. A block whose steps shrink suddenly is undone and
repeated step by step, with checks: steps shrink in proportion to the distance of a singularity. A singular
configuration of the constraints is a singularity for the fixed pivots of the motion program, although the motion itself
is regular there. After an obstruction the next one may be near, so the first steps are checked from the beginning.

A step that misses a force of the state (`holonom.simulation.defect`) is undone, and repeated with half its length.
"""

import time
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from math import inf, isfinite
from typing import Any, Protocol

import numpy as np

from ...failures import ErrorKind, HolonomError
from ...language import translatable
from ...program.motion_problem import require_signs_known
from ...program.motion_program import Operation, calls_of
from ..accuracy_check import finest, has_root_of, may_hide
from ..constraints.factorization import factored_constraints
from ..constraints.singularity import Watch, no_controls
from ..defect import DefectControl
from ..evaluation import Evaluation, Numbers, as_floats, evaluation_once
from ..hard_cases import Difficulty
from ..inputs import Inputs
from ..matrices import Vector
from ..nominal import share_of
from ..place_and_reason import SHORT_STEPS, place_and_reason
from ..request import EngineName
from .engine import Obstruction, Solutions, Step, Task, require_reach

FIRST_BLOCK = 128  # steps; what surrounds a block, projection above all, takes as long as some small steps
WATCHED = 32  # steps behind an obstruction
SHRUNK = 32  # times shorter than the longest: a step that calls for a closer look; 16 occurs in quiet motions
DECAYS_IN_A_RUN = 50.0  # gamma of Baumgarte's and Gear's stabilization, times the length of the time span
SHORTEST = 1e-10  # of the longest: a step that leads nowhere
SHORTER = 1e-3  # of the longest: a step that makes the program's pivots suspect
LOST, ACCURATE = 1e-11, 1e-12  # relative errors of its accelerations: a pivot vanishes; none does any more
ROUNDED = 16.0  # times what the last bit of the state changes the accelerations by: rounding
MISSED = 100.0  # times the tolerance: the defect of a step that misses a force
VANISHING_PIVOT = translatable("a pivot of the motion program vanishes")
NO_SLOPE = translatable("a force is not smooth there, so that the motion may not be unique")
NEARS_SINGULAR = translatable("the configuration nears a singular one")
CHOICE = translatable(
    "the independent constraints that come first, which are solved, become dependent and later ones do not: list "
    "those first"
)


Taken = tuple[Any, Any, Any, int]
"""An outcome, the shortest and the longest of the steps, and their number."""
NO_STEPS: Taken = (None, inf, 0.0, 0)


class Integrator(Protocol):
    """The interface of an integrator, as heyoka's integrators have it."""

    # time, last_h: the time that is reached; the length of the last step
    time: Any
    last_h: Any
    state: Numbers  # shape (2n,): at that time, in place
    tol: Any

    def propagate_until(self, until: Any, max_steps: int, **options: Any) -> tuple[Any, ...]:
        """Take steps to a time, up to a number of steps, or to a failure.

        A step that is cut at the last time counts neither as the shortest nor as the longest.

        Parameters
        ----------
        until : number
            Last time.
        max_steps : int
            Largest number of steps.
        **options : object
            Those of the integrator, such as a bound of the length of a step.

        Returns
        -------
        tuple
            `Taken`, then further results of the integrator.
        """


class ProgramEngine:
    """An engine on the motion program (see `Engine`).

    A subclass provides the integrator and the work between the blocks.

    Parameters
    ----------
    task : Task
    failed : object
        The outcome of the integrator's steps where the last one led to no numbers.
    """

    name: EngineName
    near_singularity = False
    state: Numbers
    tol: float
    code: str = ""
    compile_seconds: float
    _integrator: Integrator
    _bound: Mapping[str, Any] = {}
    _first_block = FIRST_BLOCK

    def __init__(self, task: Task, failed: object) -> None:
        require_signs_known(task.problem)
        self.precision, self._failed, self._end = task.request.numbers, failed, task.end
        self.steps, self._longest, self._usual = 0, 0.0, 0.0
        self._problem, self._matrices = task.problem, task.matrices
        self._obstruction: HolonomError | None = None
        self._behind_obstruction = False
        self._evaluate: Evaluation | None = None
        self._defect: DefectControl | None = None
        if task.end is not None and may_hide(self._problem.matrices, ("t", *self._problem.parameters)):
            self._defect = DefectControl(task.end - self.precision.number(self._problem.start["t"]), self.precision)
        self._shorter: Any = None  # bound of the next step, where one before it missed a force

    @property
    def time(self) -> Any:
        """The time that is reached, a number of the precision."""
        return self._integrator.time

    @cached_property
    def inputs(self) -> Inputs:
        """Inputs of the programs."""
        return Inputs(self._problem, self.precision)

    @cached_property
    def watch(self) -> Watch:
        """The monitor of the constraints if steps shrink."""
        return Watch(self._problem, self._matrices)

    @property
    def decay(self) -> float:
        """Decay gamma of the stabilization, by the length of the motion.

        It is that of the scene's time span if the motion has no end, one if the scene gives none.
        """
        if self._end is None:
            first, last = map(float, self._problem.time_span or (0, 1))
            return DECAYS_IN_A_RUN / (last - first)
        return DECAYS_IN_A_RUN / float(self._end - self.precision.number(self._problem.start["t"]))

    def restart(self, time_point: Any, state: Numbers) -> None:
        """Continue from another time and state (see `Engine.restart`)."""
        self._go_back(time_point, state)
        self._behind_obstruction = self._obstruction is not None
        self._longest, self._usual, self._obstruction = 0.0, 0.0, None

    def integrate(self, until: Any, dense: bool = True) -> Iterator[Step]:
        """Integrate until the motion program fails (see `Engine.integrate`)."""
        return self._blocks(until, dense)

    def _blocks(self, until: Any, dense: bool) -> Iterator[Step]:
        self._begin()
        ended, steps, begun = self.time == until, self.steps, self.time
        while not ended:
            ended, dense_steps = self._block(until, dense)
            yield from dense_steps
            require_reach(self.steps - steps, self.time - begun, until - self.time)

    def solutions(self, times: Numbers, states: Numbers) -> Solutions:
        """Return the unknowns by the motion program (see `Engine.solutions`)."""
        n, g = len(self._problem.coordinates), len(self._problem.multipliers)
        if self._evaluate is None:
            begun = time.perf_counter()
            self._evaluate = evaluation_once(self._problem, self._problem.motion, self.precision)
            self.compile_seconds += time.perf_counter() - begun
        found = self._evaluate(self.inputs(times, states))
        return Solutions(found[:n], found[n : n + g], found[n + g :])

    def close(self) -> None:
        """Release nothing: all memory is Python's."""

    def _begin(self) -> None:
        self._length = self._first_block
        if self._problem.tables:
            self._set_values()

    def _set_values(self) -> None:
        """Set the values of open inputs in the equations from this time on."""
        raise NotImplementedError

    def _keep_constraints(self) -> None:
        """Project the state, unless the integrator does so."""

    def _prepare_next(self, until: Any) -> None:
        """Prepare the next block."""

    def _take(self, until: Any, most: int, dense: bool) -> tuple[Taken, list[Step]]:
        """Take steps as the integrator does, each with its states if `dense` is true."""
        if self._defect is not None:
            return self._controlled(until, most)
        if dense:
            return self._with_states(until, most)
        return self._integrator.propagate_until(until, most, **self._bound)[:4], []

    def _with_states(self, until: Any, most: int) -> tuple[Taken, list[Step]]:
        raise NotImplementedError

    def _bound_steps(self, length: Any) -> None:
        """Set the largest length of the next steps, None for that of the request."""
        raise NotImplementedError

    def _controlled(self, until: Any, most: int) -> tuple[Taken, list[Step]]:
        """Take steps as the integrator does, shorter ones where a step misses a force."""
        accepted, shortest, longest = [], inf, 0.0
        while True:
            begun, before, asked = self.time, self.state.copy(), most - len(accepted) if self._shorter is None else 1
            (outcome, *lengths, count), steps = self._with_states(until, asked)
            missed = self._first_missed(steps)
            if missed is not None:
                self._go_back(begun, before)
                self._shorter = (steps[missed].end - steps[missed].start) / 2
                (_, *lengths, _), steps = self._with_states(until, missed) if missed else (NO_STEPS, [])
            elif self._shorter is not None:
                self._shorter = 2 * self._shorter if abs(self._integrator.last_h) >= self._shorter else None
            self._bound_steps(self._shorter)
            accepted, shortest, longest = [*accepted, *steps], min(shortest, lengths[0]), max(longest, lengths[1])
            if missed is None and (count < asked or len(accepted) == most or self.time == until):
                return (outcome, shortest, longest, len(accepted)), accepted

    def _first_missed(self, steps: Sequence[Step]) -> int | None:
        """Return the number of the first step that misses a force, None without one."""
        if not steps:
            return None
        together = [(steps, steps[0].block.states)] if steps[0].block else [([step], step.states) for step in steps]
        errors = [self._defect.errors(*each, self, self._matrices.nominal) for each in together]
        well = np.concatenate(errors) <= MISSED * max(self.tol, finest(self.precision))
        missed = np.flatnonzero(~well & [self._defect.shortens(step) for step in steps])
        return int(missed[0]) if len(missed) else None

    def _block(self, until: Any, dense: bool) -> tuple[bool, list[Step]]:
        """Take a block of steps. Return True if it was the last, and its steps.

        The steps include their states if `dense` is true.
        """
        if self._obstruction is not None:
            raise self._obstruction
        if self._behind_obstruction:
            self._behind_obstruction = False
            dense_steps = self._watched(until, dense, WATCHED)
            return self.time == until, dense_steps
        integrator = self._integrator
        time_point, before = integrator.time, self.state.copy()
        (_, shortest, longest, steps), dense_steps = self._take(until, self._length, dense)
        ended = integrator.time == until
        broken_off = steps < self._length and not ended
        longest, reached = max(self._usual, longest), until if broken_off else integrator.time
        quiet = not broken_off and shortest * SHRUNK >= longest
        if quiet and ended:
            self._keep_constraints()
        elif quiet:
            self._prepare_next(until)
        if not quiet or not self._is_finite:
            self._go_back(time_point, before)
            dense_steps = self._watched(reached, dense, self._length)
            return self.time == until, dense_steps
        self.steps += steps
        self._usual = longest
        return ended, dense_steps

    @property
    def _is_finite(self) -> bool:
        """True if the state is finite.

        In a singular configuration no pivots project it onto the constraints.
        """
        quickly = isfinite(self.state.dot(self.state))  # a square beyond the range is looked at closely
        return quickly or bool(np.isfinite(as_floats(self.state)).all())

    def _watched(self, until: Any, dense: bool, steps: int) -> list[Step]:
        """Take single steps until a time or until the motion program is about to fail."""
        self.watch.begin(self.time, self.state)
        dense_steps = []
        for _ in range(steps):
            if self.time == until or self._obstruction is not None:
                break
            dense_steps += self._watched_step(until, dense)
        self._length = self._first_block
        return dense_steps

    def _watched_step(self, until: Any, dense: bool) -> list[Step]:
        time_point, before = self.time, self.state.copy()
        (outcome, _, step, _), dense_steps = self._take(until, 1, dense)
        if outcome == self._failed:
            self._go_back(time_point, before)
            self._obstruction = self._obstruction_here(*self._why_no_step)
            return []
        self._keep_constraints()
        if not self._is_finite:
            self._go_back(time_point, before)
            self._obstruction = self._obstruction_here(*self._why_singular)
            return []
        self.steps += 1
        self._longest, self._usual = max(self._longest, self._usual, step), step or self._usual
        try:
            self._obstruction = self._found_ahead(until)
        except HolonomError as error:  # of the state behind the step, which may end before
            self._obstruction = error
        return dense_steps

    def _found_ahead(self, until: Any) -> HolonomError | None:
        """Return the obstruction ahead, by the constraints and the last step, or None."""
        t = float(self.time)
        if self.watch.singular_ahead(t, self.state):
            return self._obstruction_here(*self._why_singular)
        if self.time == until or abs(self._integrator.last_h) >= SHORTER * self._longest:
            return None
        if self._pivots_lose(t, self.state) > LOST:
            return Obstruction(
                t, Difficulty.SINGULAR_CONFIGURATION, VANISHING_PIVOT, lambda t, q: self._pivots_lose(t, q) < ACCURATE
            )
        if abs(self._integrator.last_h) >= SHORTEST * self._longest:
            return None
        vanished = self.watch.vanished(t, self.state)
        if vanished is None:
            if self._has_roots:
                return Obstruction(t, None, SHORT_STEPS, lambda at, _: at - t > SHORTER * self._longest)
            return HolonomError(ErrorKind.NO_WAY_ON, detail=place_and_reason(t, SHORT_STEPS))
        if vanished not in self._problem.reactions:
            return no_controls(t)
        return HolonomError(ErrorKind.NO_GRADIENT, time=t, multiplier=vanished)

    @cached_property
    def _has_roots(self) -> bool:
        """True if forces may contain real roots, which have no slope at zero."""
        return any(call.operation is Operation.ABS for call in calls_of(self._problem.motion))

    def _pivots_lose(self, t: Any, state: Numbers) -> float:
        """Return the relative error of the program's accelerations beyond rounding.

        It is their difference from those with pivots that are chosen here. Rounding of the state is in both, more and
        more as the gradient of a constraint vanishes.
        """
        floats, sizes = as_floats(state), self._matrices.nominal.accelerations
        chosen, moved = (self._with_own_pivots(t, each) for each in (floats, np.nextafter(floats, np.inf)))
        fixed = as_floats(
            self.solutions(self.precision.numbers([float(t)]), np.reshape(state, (-1, 1))).accelerations[:, 0]
        )
        error, rounding = (share_of(each - chosen, chosen, sizes) for each in (fixed, moved))
        return float(error - ROUNDED * rounding) if np.isfinite([error, rounding]).all() else np.inf

    def _with_own_pivots(self, t: Any, state: Vector) -> Vector:
        """Return the accelerations with pivots chosen at a state."""
        at = self._matrices.independent(float(t), state)
        return factored_constraints(at.mass, at.jacobian).accelerations(at.force, at.curvature)

    @property
    def _why_singular(self) -> tuple[Difficulty, str]:
        """The reason of dependence: of all constraints, or of those that are solved."""
        if self.watch.chosen_alone:
            return Difficulty.REDUNDANT, CHOICE
        return Difficulty.SINGULAR_CONFIGURATION, NEARS_SINGULAR

    @property
    def _why_no_step(self) -> tuple[Difficulty | None, str]:
        """The reason of a failed step: a finite force without slope, or an overflow."""
        at, state = np.array([self.time]), np.reshape(self.state, (-1, 1))
        known = np.isfinite(as_floats(self.solutions(at, state).accelerations)).all()
        if known and has_root_of(self._problem.motion, self._problem.state):
            return None, NO_SLOPE
        return Difficulty.OVERFLOW, translatable(
            "numbers leave the range of %(precision)s precision", precision=self.precision.name
        )

    def _obstruction_here(self, case: Difficulty | None, reason: str) -> Obstruction:
        """Return an obstruction that ends when the constraints become more independent."""
        least = self.watch.least(self.time, self.state)
        return Obstruction(float(self.time), case, reason, lambda t, state: self.watch.least(t, state) > least)

    def _go_back(self, time_point: Any, state: Numbers) -> None:
        self._integrator.time = time_point
        self.state[:] = state
