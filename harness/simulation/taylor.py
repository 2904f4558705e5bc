"""The Taylor engine: heyoka's adaptive integrator on the motion program.

The integrator takes its steps in blocks, without Python in between. After a block the projection program tells how far
the state has left the constraints, and it is projected where that is more than `DRIFT`; blocks grow while it is less
and shrink where it is more. The last state is always projected.

A block whose steps have shrunk suddenly is taken back and repeated step by step, under watch: steps shrink in
proportion to the distance of a singularity, and a singular configuration of the constraints is one for the fixed
pivots of the motion program, although the motion itself goes through it.
"""

import time
from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from harness.failures import Failure, HolonomError
from harness.motion.heyoka_function import import_heyoka
from harness.motion.precision import Precision, read_precision
from harness.motion.problem import MotionProblem, computing
from harness.simulation.advice import HardCase
from harness.simulation.code import Code, better_code, pays
from harness.simulation.constraint_keeper import ConstraintKeeper
from harness.simulation.evaluation import Numbers
from harness.simulation.pieces import Piece
from harness.simulation.request import Drift
from harness.simulation.stabilisation import Equations, equations_of_motion, stabilised_equations
from harness.simulation.vanishing import no_gradient
from harness.simulation.watch import Watch

DRIFT = 100  # times what rounding does to a number: how far inside a block a state may miss the constraints
FIRST_BLOCK, LONGEST_BLOCK = 128, 1024  # steps; what surrounds a block takes as long as a few small steps
SHRUNK = 32  # times shorter than the longest: a step that calls for a closer look; 16 occurs in quiet motions
SHORTEST = 1e-10  # of the longest: a step that leads nowhere
DECAYS_IN_A_RUN = 50.0  # gamma of Baumgarte's cure and Gear's, times the length of the time span


class TaylorObstacle(HolonomError):
    """The motion program fails ahead, while pivots may lead on.

    Parameters
    ----------
    t : float
        The instant that is reached.
    case : HardCase
    reason : str
        A clause about that instant.
    """

    def __init__(self, t: float, case: HardCase, reason: str) -> None:
        super().__init__(Failure.NO_WAY_ON, detail=f"{t:.10g}, where {reason}")
        self.case, self.reason = case, reason


class TaylorMotion:
    """A motion followed by heyoka.

    Parameters
    ----------
    problem : MotionProblem
        Without an obstacle.
    tol : float or None
        Tolerance of a step; None for the precision of the numbers.
    precision : Precision or str
    drift : Drift
    compact : bool or None
        Whether to compile in compact mode; None to begin with code that is quickly compiled, and to compile better
        code when what is left of a run earns that back.
    decay : float or None
        gamma of Baumgarte's cure and Gear's; None for `DECAYS_IN_A_RUN` by the length of the scene's time span.

    Attributes
    ----------
    precision : Precision
    steps : int
    tol : float
    code : Code
    compile_seconds : float

    Raises
    ------
    HolonomError
        The precision is none, or cannot hold the tolerance; heyoka is not installed.
    """

    def __init__(
        self,
        problem: MotionProblem,
        tol: float | None = None,
        precision: Precision | str = "double",
        drift: Drift = Drift.PROJECTION,
        compact: bool | None = None,
        decay: float | None = None,
    ) -> None:
        self.precision = read_precision(precision) if isinstance(precision, str) else precision
        self._tolerance = {} if tol is None else {"tol": self.precision.number(repr(held(tol, self.precision)))}
        self._problem, self._chosen = problem, compact is not None
        self._program = computing(problem.motion, {f"ddot({name})" for name in problem.coordinates})
        self._failed = import_heyoka().taylor_outcome.err_nf_state
        code = Code.QUICK if compact is None else Code.COMPACT if compact else Code.UNROLLED
        self.steps, self._longest, self._usual = 0, 0.0, 0.0
        self._obstacle: HolonomError | None = None
        begun, number = time.perf_counter(), self.precision.number
        self._equations = self._equations_with(drift, decay)
        start = np.array([number(problem.start[name]) for name in problem.state])
        self._set_up(code, number(problem.start["t"]), start)
        kept = drift is Drift.PROJECTION and problem.multipliers
        self._keeper = ConstraintKeeper(problem, self.precision) if kept else None
        self.compile_seconds = time.perf_counter() - begun
        self.tol = float(self._integrator.tol)
        self._allowed = max(DRIFT * 10.0**-self.precision.sure_digits, self.tol)

    @property
    def time(self) -> Any:
        """The instant that is reached, a number of the precision."""
        return self._integrator.time

    @property
    def state(self) -> Numbers:
        """Coordinates, then velocities, at that instant: shape (2n,)."""
        return self._state

    @cached_property
    def watch(self) -> Watch:
        """What looks at the constraints where steps shrink."""
        return Watch(self._problem)

    def restart(self, instant: Any, state: Numbers) -> None:
        """Go on from another instant and state.

        Parameters
        ----------
        instant : number
        state : array_like, shape (2n,)
        """
        self._go_back(instant, state)
        self._usual, self._obstacle = 0.0, None

    def advance(self, until: Any) -> None:
        """Follow the motion to an instant.

        Parameters
        ----------
        until : number
            In the numbers of the precision.

        Raises
        ------
        TaylorObstacle
            The motion program fails ahead; time and state are those before it does.
        HolonomError
            The motion itself ends.
        """
        self._begin()
        while self._integrator.time != until:
            self._block(until, dense=False)
        self._project()

    def pieces(self, until: Any) -> Iterator[Piece]:
        """Follow the motion to an instant, with its states between the steps.

        Parameters
        ----------
        until : number

        Yields
        ------
        Piece
            One for each step.

        Raises
        ------
        HolonomError
            As `advance`.
        """
        self._begin()
        while self._integrator.time != until:
            for dense in self._block(until, dense=True):
                for start, end in pairwise(dense.times):
                    yield Piece(start, end, lambda instants, dense=dense: dense(instants).T.copy())
        self._project()

    def _begin(self) -> None:
        self._length = FIRST_BLOCK
        if not self._chosen:
            self._clock = time.perf_counter(), self.time

    def _block(self, until: Any, dense: bool) -> Sequence[Any]:
        """Take a block of steps, and return its dense outputs where they are asked for."""
        if self._obstacle is not None:
            raise self._obstacle
        integrator = self._integrator
        instant, before = integrator.time, self._state.copy()
        _, shortest, longest, steps, output, _ = integrator.propagate_until(
            until, max_steps=self._length, c_output=dense
        )
        ended = integrator.time == until
        broken_off = steps < self._length and not ended
        if broken_off or shortest * SHRUNK < max(self._usual, longest):
            reached = until if broken_off else integrator.time
            self._go_back(instant, before)
            return self._watched(reached, dense)
        self.steps += steps
        self._usual = max(self._usual, longest)
        if not ended:
            self._prepare_next(until)
        return [output]

    def _prepare_next(self, until: Any) -> None:
        """Choose the next block's length, project where drift asks for it, and compile better code where that pays."""
        if self._keeper is None or not self._keeper.project_if(self.time, self.state, self._allowed):
            self._length = min(2 * self._length, LONGEST_BLOCK)
        else:
            self._length = max(1, self._length // 2)
        self._compile_if_it_pays(until)

    def _watched(self, until: Any, dense: bool) -> Sequence[Any]:
        """The block in single steps, until it ends or the motion program is about to fail."""
        self.watch.begin(self.time, self.state)
        outputs = []
        for _ in range(self._length):
            if self.time == until or self._obstacle is not None:
                break
            outputs += self._watched_step(until, dense)
        self._length = FIRST_BLOCK
        return outputs

    def _watched_step(self, until: Any, dense: bool) -> Sequence[Any]:
        instant, before = self.time, self.state.copy()
        outcome, _, step, _, output, _ = self._integrator.propagate_until(until, max_steps=1, c_output=dense)
        if outcome == self._failed:
            self._go_back(instant, before)
            reason = f"numbers leave the range of {self.precision.name} precision"
            self._obstacle = TaylorObstacle(float(instant), HardCase.OVERFLOW, reason)
            return []
        self.steps += 1
        self._project()
        self._longest, self._usual = max(self._longest, self._usual, step), step or self._usual
        self._obstacle = self._found_ahead(until)
        return [output]

    def _found_ahead(self, until: Any) -> HolonomError | None:
        """What the constraints' directions, the gradients and the length of the last step say about the next ones."""
        t = float(self.time)
        if self.watch.singular_ahead(t, self.state):
            return TaylorObstacle(t, HardCase.SINGULAR_PASSAGE, "the configuration nears a singular one")
        if self.time == until or abs(self._integrator.last_h) >= SHORTEST * self._longest:
            return None
        vanished = self.watch.vanished(t, self.state)
        if vanished is None:
            return HolonomError(Failure.NO_WAY_ON, detail=f"{t:.10g}, where steps become too short")
        return no_gradient(t, vanished)

    def _go_back(self, instant: Any, state: Numbers) -> None:
        self._integrator.time = instant
        self._state[:] = state

    def _project(self) -> None:
        if self._keeper is not None:
            self._keeper.project(self.time, self.state)

    def _compile_if_it_pays(self, until: Any) -> None:
        """Compile better code, if what is left of the run earns that back, by how long it has taken so far."""
        better = None if self._chosen else better_code(self.code, self.precision)
        if better is None:
            return
        now, (begun, instant) = time.perf_counter(), self._clock
        left = (now - begun) * float((until - self.time) / (self.time - instant))
        if pays(better, self._program.operations, left):
            self._set_up(better, self.time, self.state)
            self._clock = time.perf_counter(), self.time
            self.compile_seconds += self._clock[0] - now

    def _set_up(self, code: Code, instant: Any, state: Numbers) -> None:
        self.code = code
        self._integrator = import_heyoka().taylor_adaptive(
            self._equations, state, time=instant, **self._tolerance, **code.options, **self.precision.options
        )
        self._state = self._integrator.state  # a view: what the integrator does shows in it

    def _equations_with(self, drift: Drift, decay: float | None) -> Equations:
        if drift in (Drift.BAUMGARTE, Drift.GGL) and self._problem.multipliers:
            gamma = DECAYS_IN_A_RUN / _length(self._problem) if decay is None else decay
            return stabilised_equations(self._problem, self._program, self.precision, drift, gamma)
        return equations_of_motion(self._problem, self._program, self.precision)


def held(tol: float, precision: Precision) -> float:
    """A tolerance that the numbers can hold.

    Parameters
    ----------
    tol : float
    precision : Precision

    Returns
    -------
    float
        The same.

    Raises
    ------
    HolonomError
        It is finer than rounding, or it is none.
    """
    finest = f"1e-{precision.sure_digits + 1}"
    if not float(finest) <= tol < 1:
        raise HolonomError(
            Failure.TOLERANCE_UNHELD,
            detail=f"{precision.name} precision holds tolerances from {finest} to 1, not {tol:g}",
        )
    return tol


def _length(problem: MotionProblem) -> float:
    """Length of the time span; a unit of time where the scene names none."""
    first, last = map(float, problem.time_span or (0, 1))
    return last - first
