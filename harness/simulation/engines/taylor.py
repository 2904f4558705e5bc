"""The Taylor engine: heyoka's adaptive integrator on the motion program.

After a block of steps the state is projected onto the constraints. The next block is as long as the way back to them is
short.
"""

import time
from copy import copy
from functools import partial
from itertools import pairwise
from math import ceil, inf, log10
from typing import Any

import numpy as np

from ...failures import ErrorKind, HolonomError
from ...language import translatable
from ...program.expense import HIGH_ORDER, order_for, require_means
from ...program.heyoka_function import import_heyoka
from ...program.precision import GUARD_DIGITS, Precision
from ...program.rewriting import computing
from ...program.sign_pattern import at_start
from ..constraints.program_projection import ProgramProjection
from ..constraints.stabilization import equations_of_motion, stabilized
from ..evaluation import Numbers
from ..request import EngineName, Stabilization
from .code import Code, codes_for, expected_seconds, worthwhile_code
from .engine import Block, Step, Task
from .program_engine import FIRST_BLOCK, ProgramEngine, Taken
from .scaled_time import ScaledTime, in_unit, unit_of

DRIFT = 100  # times what rounding does to a number: how far a state may leave the constraints inside a block
FINE, FINE_BLOCK = 1e-7, 512  # a tolerance whose steps leave the constraints so slowly that a first block may be long
SHORT, OPERATIONS = 16, 200_000  # steps of a first block at least; operations of its steps at most, beyond these
LONGEST_BLOCK = 1024  # steps
GROWTH = 8  # from block to block, at most
FEW = 16  # steps whose polynomials are evaluated here in less time than heyoka takes to compile that, a millisecond


class TaylorEngine(ProgramEngine):
    """The Taylor engine of heyoka (see `Engine`).

    Parameters
    ----------
    task : Task
        Its request may ask for compact mode or against it, by ``compact``. None is to begin with code that is quickly
        compiled, and to compile better code when what is left of a run earns that back.

    Raises
    ------
    HolonomError
        The precision cannot hold the tolerance, or an expansion exceeds the memory, or heyoka is not installed.
    """

    name, fixed_pivots, open_parameters = EngineName.TAYLOR, True, True

    def __init__(self, task: Task) -> None:
        super().__init__(task, import_heyoka().taylor_outcome.err_nf_state)
        problem, request, _, matrices = task
        precision, tol, number = self.precision, request.tol, self.precision.number
        digits = precision.digits + GUARD_DIGITS if tol is None else -log10(checked_tolerance(tol, precision))
        require_means(at_start(problem), precision, order_for(digits))
        self._tolerance = {} if tol is None else {"tol": number(repr(tol))}
        nominal = matrices.nominal
        self._unit = unit_of(problem, nominal.time) if precision.name == "double" else number("1")
        self._finer = nominal.in_unit(float(self._unit)).absolute()
        if self._finer < 1:
            self._tolerance["tol"] = self._tolerance.get("tol", precision.rounding) * number(repr(self._finer))
        self._chosen = request.compact is not None
        self._longest_step = None if request.max_step is None else number(repr(request.max_step))
        self._bound_steps(None)
        self._program = computing(problem.motion, problem.accelerations)
        code = Code.COMPACT if request.compact else Code.UNROLLED
        if not self._chosen:
            code = codes_for(self._program.operations, precision)[0]
        self._stabilization = request.stabilization if problem.multipliers else Stabilization.NONE
        begun = time.perf_counter()
        start = np.array([number(problem.start[name]) for name in problem.state])
        self._counted = number(problem.start["t"]), 0  # since this time, and the steps until then
        self._set_up(code, self._counted[0], start)
        projects = self._stabilization is Stabilization.PROJECTION
        self._keeper = ProgramProjection(problem, precision) if projects else None
        self.compile_seconds = time.perf_counter() - begun
        self.tol = float(self._integrator.tol) / self._finer
        longest = FINE_BLOCK if self.tol <= FINE else FIRST_BLOCK
        self._first_block = min(longest, max(SHORT, OPERATIONS // max(1, self._program.operations)))
        self._longest_block = LONGEST_BLOCK
        if self._integrator.order > HIGH_ORDER:  # one step is long enough to report
            self._first_block = self._longest_block = 1
        self._allowed = max(DRIFT * 10.0**-self.precision.sure_digits, self.tol)

    @classmethod
    def comparable(cls, tol: float | None) -> bool:
        """Return True for every tolerance (see `Engine.comparable`)."""
        return True

    @classmethod
    def expected_seconds(cls, steps: int, operations: int, tol: float, dense: bool) -> float:
        """Return the time with worthwhile code (see `Engine.expected_seconds`)."""
        return expected_seconds(operations, steps, tol)

    def steps_ahead(self, until: Any, trial: int) -> int | None:
        """Estimate the number of steps to a time by the length of the first ones.

        The first steps are taken, and taken back.

        Parameters
        ----------
        until : number
            Last time.
        trial : int
            Number of first steps.

        Returns
        -------
        int or None
            None if these steps reach the time or fail.
        """
        begun, state = self.time, self.state.copy()
        (outcome, *_), _ = self._take(until, trial, dense=False)
        covered = float(self.time - begun)
        self._integrator.time, self._integrator.state[:] = begun, state
        if outcome != import_heyoka().taylor_outcome.step_limit:
            return None
        return ceil(trial * float(until - begun) / covered)

    def _bound_steps(self, length: Any) -> None:
        bounds = [bound for bound in (length, self._longest_step) if bound is not None]
        self._bound = {"max_delta_t": min(bounds)} if bounds else {}

    def _with_states(self, until: Any, most: int) -> tuple[Taken, list[Step]]:
        """Take steps with states between: a few one by one, or many at once.

        For many, heyoka compiles a function of the states.
        """
        longest = max(self._usual, self._integrator.last_h)
        few = most < FEW or until - self.time < FEW * longest
        return self._one_by_one(until, most) if few else self._at_once(until, most)

    def _at_once(self, until: Any, most: int) -> tuple[Taken, list[Step]]:
        *taken, between, _ = self._integrator.propagate_until(until, most, c_output=True, **self._bound)
        unit, scaled = self._unit, self._unit != 1
        times = [] if between is None else [time * unit for time in between.times]
        sizes = self._integrator.sizes if scaled else None

        def states(times: Numbers) -> Numbers:
            found = between(times / unit)
            return (found / sizes if scaled else found.copy()).T

        block = Block(times, states)
        return tuple(taken), [Step(*ends, states, block=block) for ends in pairwise(times)]

    def _one_by_one(self, until: Any, most: int) -> tuple[Taken, list[Step]]:
        """Return each step with its Taylor polynomials."""
        integrator, dense_steps = self._integrator, []
        shortest, longest, outcome = inf, 0, None
        for _ in range(most):
            begun, rest = integrator.dtime
            outcome, least, greatest, taken, *_ = integrator.propagate_until(until, 1, write_tc=True, **self._bound)
            if outcome == self._failed or not taken:
                break
            shortest, longest = min(shortest, least), max(longest, greatest)
            dense_steps.append(
                Step(
                    begun,
                    integrator.time,
                    partial(states_of, begun, rest, self._unit, integrator.tc.T[..., None].copy()),
                )
            )
            if integrator.time == until:
                break
        return (outcome, shortest, longest, len(dense_steps)), dense_steps

    def restart(self, time_point: Any, state: Numbers) -> None:
        """Continue from another time and state (see `Engine.restart`)."""
        super().restart(time_point, state)
        if time_point <= self._counted[0]:
            self._counted = time_point, self.steps

    def _set_values(self) -> None:
        contained = len(self._integrator.pars)
        if contained:
            self._integrator.pars[:] = self.inputs.open_values(self._integrator.time, "right")[:contained]

    def _block(self, until: Any, dense: bool) -> tuple[bool, list[Step]]:
        self._compile_if_worthwhile(until)
        return super()._block(until, dense)

    def _prepare_next(self, until: Any) -> None:
        """Project, and choose the next block's length, in which the drift stays allowed."""
        if self._keeper is None:
            self._length = self._longest_block
        else:
            drift = self._keeper.project(self.time, self.state)
            # the error of a velocity grows with the time, that of a position with its square
            growth = min((self._allowed / drift) ** 0.5, GROWTH) if drift > 0 else GROWTH
            self._length = max(1, min(int(self._length * growth), self._longest_block))

    @property
    def _is_finite(self) -> bool:
        return self._keeper is None or super()._is_finite  # heyoka reports steps that do not end in finite numbers

    def _keep_constraints(self) -> None:
        if self._keeper is not None:
            self._keeper.project(self._integrator.time, self.state)

    def _compile_if_worthwhile(self, until: Any) -> None:
        """Compile better code if the remaining steps justify it.

        Their number is estimated by the steps so far.
        """
        begun, before = self._counted
        if self._chosen or self.steps == before:
            return
        end = until if self._end is None else self._end
        left = (self.steps - before) * float((end - self.time) / (self.time - begun))
        asked = self._program.operations, self.precision, left, float(self._integrator.tol)
        if better := worthwhile_code(self.code, *asked):
            begun = time.perf_counter()
            self._set_up(better, self.time, self.state)
            self.compile_seconds += time.perf_counter() - begun

    @property
    def _pulls(self) -> bool:
        """True if terms in the equations pull the state to the constraints."""
        return self._stabilization in (Stabilization.BAUMGARTE, Stabilization.GGL)

    def _set_up(self, code: Code, time_point: Any, state: Numbers) -> None:
        self.code = code
        numbers = self.precision.name, float(self._unit), *self._tolerance.values()
        kind = "taylor", code, self._stabilization, self.decay if self._pulls else None, *numbers
        built = self._problem.once(kind, self._problem.motion, lambda: self._compiled(code, state))
        built = copy(built) if self._problem.open_inputs else built
        self._integrator = built if self._unit == 1 else ScaledTime(built, self._unit)
        self._integrator.time = time_point
        self._integrator.state[:] = state
        self._set_values()
        self.state = self._integrator.state  # a view: what the integrator does shows in it

    def _compiled(self, code: Code, state: Numbers) -> Any:
        equations = equations_of_motion(self._problem, self._program, self.precision)
        if self._pulls:
            equations = stabilized(equations, self._problem, self.precision, self._stabilization, self.decay)
        if self._unit != 1:
            velocities = [variable for variable, _ in equations[len(state) // 2 :]]
            equations = in_unit(equations, self._unit, velocities)
        return import_heyoka().taylor_adaptive(
            equations, state, **self._tolerance, **code.options, **self.precision.options
        )


def states_of(begun: Any, rest: Any, unit: Any, coefficients: Numbers, times: Numbers) -> Numbers:
    """Return states at times of a step, or of a step each, by Taylor polynomials.

    Parameters
    ----------
    begun, rest : number, or ndarray of shape (k,)
        Beginning of the step: their sum, in twice the digits of a number.
    unit : number
        Unit of the time in the polynomials.
    coefficients : ndarray, shape (order + 1, 2n, 1) or (order + 1, 2n, k)
        Those of powers of the time since the beginning.
    times : ndarray, shape (k,)
        Times of the step.

    Returns
    -------
    ndarray, shape (2n, k)
    """
    since = (times - begun - rest) / unit
    states = coefficients[-1] * since
    for coefficient in coefficients[-2:0:-1]:
        states += coefficient
        states *= since
    states += coefficients[0]
    return states


def checked_tolerance(tol: float, precision: Precision) -> float:
    """Return a tolerance, if the numbers can hold it.

    Parameters
    ----------
    tol : float
        Relative tolerance of a step.
    precision : Precision
        Numbers of the integrator.

    Returns
    -------
    float
        The same tolerance.

    Raises
    ------
    HolonomError
        The tolerance is finer than rounding, or not below one.
    """
    finest = f"1e-{precision.sure_digits + 1}"
    if not float(finest) <= tol < 1:
        raise HolonomError(
            ErrorKind.TOLERANCE_OUT_OF_RANGE,
            option="--tol",
            detail=translatable(
                "%(precision)s precision holds tolerances from %(finest)s to 1, not %(tol)s",
                precision=precision.name,
                finest=finest,
                tol=f"{tol:g}",
            ),
        )
    return tol
