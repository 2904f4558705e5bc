"""Derivatives of a motion by parameters and initial values: variational equations.

With the state x = (q, dot q), dx/dt = F(t, x, p) and X = dx/dp,

    dX/dt = F_x X + F_p    (`variational_equations`).

Where a switching surface s(t, x, p) = 0 changes F, X jumps with the time of the switching (Hiskens & Pai, Trajectory
sensitivity analysis of hybrid systems, IEEE Trans. Circuits Syst. I 47 (2000) 204):

    X+ = X- + (F- - F+) dt/dp,    dt/dp = -(s_x X- + s_p)/(s_t + s_x F-).

If the velocities jump there as well, the first X- and F- are changed by the impulse (`impulses`).

X satisfies the constraints' derivative, J dq/dp = -f_p and its time derivative, from which rounding lets it go.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Mapping, Sequence
from copy import copy
from functools import partial
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ..language import translatable
from ..program.differentiation import derivative_name
from ..program.friction import SLIDING
from ..program.heyoka_function import import_heyoka
from ..program.motion_problem import MotionProblem, Sign
from ..program.motion_program import Program
from ..program.precision import read_precision
from ..program.sign_pattern import problem_in, program_with_values, switching_function
from .branch_points import DOUBLINGS
from .engines.code import codes_for, worthwhile_code
from .engines.engine import Step
from .engines.taylor import states_of
from .evaluation import Numbers
from .events import values_in
from .impulses import moves_behind_impulse
from .initial_tangents import initial_tangents
from .matrices import start_of
from .mode import Mode
from .nominal import Nominal, first_order_changes, nominal_of
from .recording import SampleBlock
from .time_dependence import time_dependence
from .variation import TIME, Variation, no_sensitivity, size_of
from .variational_equations import VariationalEquations, largest

DOUBLE = read_precision("double")
BLOCK = 128  # steps of the motion after which X is put back onto the constraints
# largest distance of the state that X is integrated with from the motion's: relative, and in tolerances
DISTANCE, TOLERATED = 1e-6, 1e4
ON_SURFACE = 1e-9  # of the change of a switching function with the nominal sizes: what is none
CONTINUOUS = 1e-9  # relative change of a state that is none


class _Segment(NamedTuple):
    """A part of the motion with its derivatives."""

    start: float
    end: float
    mode: "_ModeVariation"
    moves: Callable[[Numbers], Numbers]  # takes times, shape (k,), to derivatives of the state, shape (2n, p, k)


class _Polynomials:
    """Taylor polynomials of steps, recorded by heyoka's callback.

    heyoka's continuous output compiles a function at each call, which takes as long as a hundred steps.
    """

    def __init__(self, first: int, start: float) -> None:
        self._first, self._start = first, start  # row that is recorded first, and time of the first step
        self._steps: list[tuple[float, float, Numbers]] = []

    def __call__(self, integrator: Any) -> bool:
        self._steps.append((integrator.time, integrator.last_h, integrator.tc[self._first :].copy()))
        return True

    def __len__(self) -> int:
        return len(self._steps)

    @property
    def last(self) -> float:
        """The end of the last step with finite numbers, the start without any."""
        finite = (end for end, _, rows in reversed(self._steps) if np.isfinite(rows).all())
        return next(finite, self._start)

    def at(self, times: Numbers) -> Numbers:
        """Return the recorded rows at times, shape (rows, k)."""
        ends, lengths, coefficients = (np.array(each) for each in zip(*self._steps, strict=True))
        place = np.minimum(np.searchsorted(ends, times), len(ends) - 1)
        return states_of((ends - lengths)[place], 0.0, 1.0, coefficients[place].T, times)


class _Zero(NamedTuple):
    """The zero of an output of one of a motion's programs."""

    problem: MotionProblem
    program: Program
    output: str


class _ModeVariation:
    """The variational equations of one mode."""

    def __init__(self, mode: Mode, directions: tuple[str, ...], tol: float | None, end: float) -> None:
        self.mode, self.problem, self._directions, self._tol = mode, mode.problem, directions, tol
        self.variation = VariationalEquations(self.problem, directions, mode.matrices)
        numbers = program_with_values(self.problem, self.variation.program)
        by_time = time_dependence(numbers, float(self.problem.start["t"]), end, self.problem.tables)
        self._stops = sorted({*mode.stops, *by_time.stops})
        self._code = codes_for(self.variation.program.operations, DOUBLE)[0]
        self._integrator = self._compiled()

    def _compiled(self) -> Any:
        options = self._tolerance | self._code.options
        units = self.variation.units
        kind = *self.variation.kind, float(units.time), *units.state.tolist(), *options.items()
        return copy(self.problem.once(kind, self.problem.motion, partial(self._made, options)))

    @property
    def _tolerance(self) -> dict[str, float]:
        """Option of the integrator: relative to the largest number in its units."""
        nominal, units = nominal_of(self.problem), self.variation.units
        near = Nominal(nominal.time / units.time, nominal.state / units.state).absolute()
        return {"tol": (float(np.finfo(float).eps) if self._tol is None else self._tol) * near}

    def _made(self, options: Mapping[str, object]) -> Any:
        equations = self.variation.equations()
        return import_heyoka().taylor_adaptive(equations, [0.0] * len(equations), **options)

    def integrate(
        self, start: float, state: Numbers, moves: Numbers, end: float, left: float
    ) -> tuple[list[_Segment], Numbers, Numbers]:
        """Integrate the derivatives through a part, with steps that end at pulses.

        These are functions of the time, also in the derivatives alone. `left` is the remaining time of the motion at
        the start of the part.
        """
        between = self._stops[bisect_right(self._stops, start) : bisect_left(self._stops, end)]
        segments: list[_Segment] = []
        for one, other in pairwise((start, *between, end)):
            found, state, moves = self._integrate_smooth(one, state, moves, other, left - (one - start))
            segments += found
        return segments, state, moves

    def _integrate_smooth(
        self, start: float, state: Numbers, moves: Numbers, end: float, left: float
    ) -> tuple[list[_Segment], Numbers, Numbers]:
        """Integrate the derivatives through a part, or its halves if they grow much.

        It is smooth in the time. `left` is as above. The state and the projected derivatives at its end are returned
        with it.
        """
        (unit, sizes), half = self.variation.units, (start + end) / 2
        scaled, rows = state / sizes, sizes[:, None]
        units = self.variation.columns(scaled, moves / rows)
        steps = self._propagated(start, scaled, moves / rows / units, end, units)
        reached, grown = np.split(self._integrator.state.copy(), [len(state)])
        # derivatives, not the state, would decide about steps
        if len(steps) > 1 and start < half < end and np.max(np.abs(grown)) > largest(scaled, reached):
            first, *there = self._integrate_smooth(start, state, moves, half, left)
            second, *there = self._integrate_smooth(half, *there, end, left)
            return first + second, *there

        def derivatives(times: Numbers) -> Numbers:
            found = np.reshape(steps.at(times / unit), (*moves.shape, len(times)))
            return (rows * units)[:, :, None] * found

        self._compile_if_worthwhile(len(steps) * left / (end - start))
        there = sizes * reached, rows * units * grown.reshape(moves.shape)
        if self.variation.defect(end, *there) > DISTANCE:
            raise no_sensitivity(
                translatable(
                    "they leave the constraints before t = %(time)s, where those that the equations are solved with "
                    "become dependent",
                    time=f"{end:.10g}",
                )
            )
        return [_Segment(start, end, self, derivatives)], there[0], self.variation.corrected(end, *there)

    def _propagated(self, start: float, state: Numbers, moves: Numbers, end: float, units: Numbers) -> _Polynomials:
        """Integrate numbers in their units.

        They begin where they have a Taylor polynomial. A contact with the force of Hertz has none at its edge.
        """
        integrator, unit, n = self._integrator, self.variation.units.time, len(state) // 2
        integrator.pars[:] = self.variation.values(start, units)[: len(integrator.pars)]
        shortest = np.finfo(float).eps * max(abs(start), nominal_of(self.problem).time) / unit
        for late in (0.0, *(shortest * 2**k for k in range(DOUBLINGS))):
            steps = _Polynomials(len(state), start / unit)
            integrator.time = start / unit
            integrator.state[:] = np.concatenate([state[:n] + late * state[n:], state[n:], moves.ravel()])
            outcome, *_ = integrator.propagate_until(end / unit, write_tc=True, callback=steps)
            finite = np.isfinite(integrator.state).all()
            if outcome == import_heyoka().taylor_outcome.time_limit and finite:
                return steps
            if steps.last > start / unit:
                break
        raise no_sensitivity(
            translatable(
                "their integration gives no finite numbers beyond t = %(time)s", time=f"{steps.last * unit:.6g}"
            )
        )

    def rates(self, t: float, state: Numbers) -> Numbers:
        """Return the time derivative of the state, shape (2n,)."""
        solved = self.mode.engine.solutions(np.array([t]), state[:, None])
        return np.concatenate([state[len(self.problem.coordinates) :], solved.accelerations[:, 0]])

    def derivatives(self, times: Numbers, states: Numbers, moves: Numbers, *more: str) -> dict[str, Numbers]:
        """Return the derivatives of state, multipliers and outputs by name.

        Each has the shape (p, k).

        Parameters
        ----------
        moves : ndarray, shape (2n, p, k)
            Derivatives of the state.
        *more : str
            Directions behind the others.
        """
        problem, directions = self.problem, (*self._directions, *more)
        solved = (*problem.multipliers, *problem.accelerations)
        moves = np.concatenate([moves, Variation(problem, problem.motion, solved, directions)(times, states, moves)])
        found = dict(zip((*problem.state, *problem.multipliers), moves, strict=False))
        if problem.outputs is None:
            return found
        values, names = self.mode.engine.solutions(times, states), tuple(problem.outputs.outputs)
        variation = Variation(problem, problem.outputs, names, directions, solved)
        rows = variation(times, states, moves, values.multipliers, values.accelerations)
        return found | dict(zip(names, rows, strict=True))

    def delays(self, zero: "_Zero", t: float, state: Numbers, moves: Numbers) -> Numbers:
        """Return the derivatives of the time of a zero, shape (p,)."""
        times, states, along_it = self._along_motion(t, state, moves)
        derivatives, multipliers = self.derivatives(times, states, along_it, TIME), self.problem.multipliers
        along_it = np.concatenate([along_it, *(derivatives[name][None] for name in multipliers)])
        variation = Variation(zero.problem, zero.program, (zero.output,), (*self._directions, TIME), multipliers)
        solved = self.mode.engine.solutions(times, states).multipliers
        *changes, rate = variation(times, states, along_it, solved)[0, :, 0]
        if not rate:
            raise no_sensitivity(translatable("a zero is only touched at t = %(time)s", time=f"{t:.10g}"))
        return -np.array(changes) / rate

    def at_moving_time(self, t: float, state: Numbers, moves: Numbers, delays: Numbers) -> dict[str, Numbers]:
        """Return `derivatives` at a given time that moves, each of shape (p,)."""
        found = self.derivatives(*self._along_motion(t, state, moves), TIME)
        return {name: rows[:-1, 0] + rows[-1, 0] * delays for name, rows in found.items()}

    def _along_motion(self, t: float, state: Numbers, moves: Numbers) -> tuple[Numbers, Numbers, Numbers]:
        """Return time, state, X and their time derivatives, for `derivatives`."""
        moves = np.concatenate([moves, self.rates(t, state)[:, None]], axis=1)
        return np.array([t]), state[:, None], moves[:, :, None]

    def _compile_if_worthwhile(self, steps: float) -> None:
        asked = self.variation.program.operations, DOUBLE, steps, self._integrator.tol
        if better := worthwhile_code(self._code, *asked):
            self._code = better
            self._integrator = self._compiled()


class Sensitivities:
    """The derivatives of one motion, integrated with it.

    Parameters
    ----------
    problem : MotionProblem
        With its parameters open.
    directions : sequence of str
        Parameters. Coordinates and velocities, for their initial values.
    begun : Mode
        In which the motion begins.
    tol : float or None
        Tolerance of a step, or None for the precision of the numbers.
    end : float
        The last time.

    Raises
    ------
    HolonomError
        A direction is neither, the initial state cannot be adapted to it, or no motion program solves the equations.
    """

    def __init__(
        self, problem: MotionProblem, directions: Sequence[str], begun: Mode, tol: float | None, end: float
    ) -> None:
        self._problem, self.directions, self._tol, self._end = problem, tuple(directions), tol, end
        if unknown := [name for name in directions if name not in (*problem.parameters, *problem.state)]:
            raise no_sensitivity(
                translatable(
                    "%(name)s is none of %(names)s, and no declared parameter, or has a special value, such as a mass "
                    "of zero",
                    name=unknown[0],
                    names=", ".join(problem.state),
                )
            )
        if problem.reacting:
            raise no_sensitivity(translatable("forces contain multipliers"))
        self._sizes = np.array([float(size_of(problem, name)) for name in directions])
        self._modes: dict[Mode, _ModeVariation] = {}
        self._nominal = nominal_of(begun.problem)
        self._here = self._of(begun)
        self._time, self._state = float(problem.start["t"]), None
        self._moves = initial_tangents(problem, begun.problem, self.directions)
        self._steps, self._reached, self._last = 0, self._time, None
        self._pieces: list[_Segment] = []
        self._begin_on_surfaces(begun)

    def take(self, step: Step) -> None:
        """Take a step of the motion. Integrate the derivatives block by block.

        Parameters
        ----------
        step : Step
            A step with its mode, which begins at the end of the last one.
        """
        if step.mode is not self._here.mode:
            self._advance()
            self._switch(step)
        elif self._steps >= BLOCK or self._at_knot(step):
            self._advance()
        if not self._steps:
            state = step.states(np.array([step.start]))[:, 0]
            self._require_same_motion(state)
            self._state = state
        self._steps, self._reached = self._steps + 1, float(step.end)
        if self._problem.signs or self._problem.ends.released:
            self._last = step.states(np.array([step.end]))[:, 0]

    def samples(self, block: SampleBlock) -> dict[str, Numbers]:
        """Return the derivatives at samples by name, such as ``d(x, m)``.

        Derivatives of multipliers of ended constraints are zero.

        Parameters
        ----------
        block : SampleBlock
            Consecutive samples of the motion.

        Returns
        -------
        dict of str to ndarray, shape (k,)
        """
        self._advance()
        parts = list(block.by_mode())
        found = [self._in_mode(self._of(mode), t, states) for mode, t, states in parts]
        if block.times[-1] == self._time:
            self._require_same_motion(block.states[:, -1])
        self._pieces = [piece for piece in self._pieces if piece.end >= block.times[-1]]
        none = [np.zeros((len(self.directions), len(t))) for _, t, _ in parts]
        return self._named({
            name: np.concatenate([part.get(name, zero) for part, zero in zip(found, none, strict=True)], axis=1)
            for name in found[0] | found[-1]
        })  # fmt: skip

    def at_event(self, event: str) -> dict[str, float]:
        """Return the derivatives at a final event, and those of its time, ``d(t, m)``.

        Parameters
        ----------
        event : str
            Expression that has crossed zero, as Maxima prints it.

        Returns
        -------
        dict of str to float
        """
        here, place = self._here, self._problem.ends.until.index(event) + 1
        zero = _Zero(here.problem, here.problem.ends.events, f"event[{place}]")
        delays = here.delays(zero, self._time, self._state, self._moves)
        return self._named({TIME: delays} | here.at_moving_time(self._time, self._state, self._moves, delays))

    def _named(self, found: Mapping[str, Numbers]) -> dict[str, Numbers]:
        """Return rows of derivatives, one for each direction and unscaled, by their names."""
        return {
            derivative_name(name, direction): row / size
            for name, rows in found.items()
            for direction, row, size in zip(self.directions, rows, self._sizes, strict=True)
        }

    def _in_mode(self, here: _ModeVariation, times: Numbers, states: Numbers) -> dict[str, Numbers]:
        moves = np.full((*self._moves.shape, len(times)), np.nan)
        for piece in self._pieces:
            inside = (piece.start <= times) & (times <= piece.end) & (piece.mode is here)
            if inside.any():
                moves[:, :, inside] = piece.moves(times[inside])
        if np.isnan(moves).any():
            raise no_sensitivity(translatable("they are not known to t = %(time)s", time=f"{times[-1]:.10g}"))
        return here.derivatives(times, states, moves)

    def _of(self, mode: Mode) -> _ModeVariation:
        if mode not in self._modes:
            self._modes[mode] = _ModeVariation(mode, self.directions, self._tol, self._end)
        return self._modes[mode]

    def _advance(self) -> None:
        """Integrate the derivatives to the time of the motion and project them."""
        if not self._steps:
            return
        pieces, self._state, self._moves = self._here.integrate(
            self._time, self._state, self._moves, self._reached, self._end - self._reached
        )
        self._pieces += pieces
        self._time, self._steps = self._reached, 0

    def _require_same_motion(self, state: Numbers) -> None:
        """Reject derivatives if their motion differs from the recorded one."""
        allowed = max(DISTANCE, TOLERATED * (self._tol or 0.0))
        if self._state is not None and self._nominal.share(state - self._state, state) > allowed:
            raise no_sensitivity(translatable("steps become too coarse at t = %(time)s", time=f"{self._time:.10g}"))

    def _at_knot(self, step: Step) -> bool:
        """Return True if a table's next polynomial begins with a step."""
        values = self._here.variation.inputs.open_values
        start = np.array(float(step.start))
        return bool(self._problem.tables) and not np.array_equal(values(start, "left"), values(start, "right"))

    # ---- switching ----

    def _switch(self, step: Step) -> None:
        """Jump with the time of a switching."""
        before, after = self._here, self._of(step.mode)
        t, old, state = self._time, self._last, step.states(np.array([step.start]))[:, 0]
        self._require_same_motion(old)
        surface = self._surface(before.mode, after.mode)
        if surface is not None:
            delays = before.delays(surface, t, old, self._moves)
            moves = np.column_stack([self._moves, before.rates(t, old)])
            if self._nominal.share(state - old, state) > CONTINUOUS:
                directions = *self.directions, TIME
                moves = moves_behind_impulse(before.mode, after.mode, directions, t, (old, state), moves)
            self._moves = moves[:, :-1] + np.outer(moves[:, -1] - after.rates(t, state), delays)
        self._state, self._moves, self._here = state, after.variation.corrected(t, state, self._moves), after

    def _surface(self, before: Mode, after: Mode) -> _Zero | None:
        """Return the zero between one mode and the next.

        None if a motion leaves a switching surface on which it was sliding: the derivatives do not jump there.
        """
        ended = set(before.problem.multipliers) - set(after.problem.multipliers)
        if ended:
            releases = before.problem.ends.released
            place = next(i for i, each in enumerate(releases, start=1) if set(each.multipliers) == ended)
            return _Zero(before.problem, before.problem.ends.releases, f"event[{place}]")
        changed = [name for name, value in after.pattern.items() if before.pattern[name] != value]
        if len(changed) > 1:  # the others jump with it, or with its impulse
            at = np.array([self._time]), self._last[:, None]
            crossed = [name for name in changed if before.pattern[name] != SLIDING]
            changed = [name for name in crossed if np.less_equal(*_sizes_of_zero(before, name, *at))]
        if len(changed) != 1:
            raise no_sensitivity(translatable("several signs change at t = %(time)s", time=f"{self._time:.10g}"))
        if before.pattern[changed[0]] == SLIDING:
            return None
        return _switching_zero(before, changed[0])

    def _begin_on_surfaces(self, begun: Mode) -> None:
        """Begin on switching surfaces that some directions leave.

        A motion that stays on one returns at once: as behind a switching, X jumps along that of the accelerations.
        A motion that leaves it has derivatives if the accelerations on both sides are the same.
        """
        for sign in begun.whole.signs:
            if not self._leaves(begun, sign).any():
                continue
            jump = _jump_between_sides(begun, sign.name)
            if begun.pattern[sign.name] == SLIDING:
                self._moves = self._moves - np.outer(jump, self._leaves(begun, sign) / _surface_rate(begun, sign, jump))
            elif jump.any():
                self._reject_start(sign)
        for sign in begun.whole.signs:
            if begun.pattern[sign.name] == SLIDING and self._leaves(begun, sign).any():
                self._reject_start(sign)

    def _leaves(self, begun: Mode, sign: Sign) -> Numbers:
        """Return the changes of a sign's argument that is zero at the start, shape (p,).

        Elsewhere these are zeros.
        """
        zero, at = _switching_zero(begun, sign.name), _start_of(begun)
        found = Variation(*zero[:2], (zero.output,), self.directions)(*at, self._moves[:, :, None])[0, :, 0]
        size, least = _sizes_of_zero(begun, sign.name, *at)
        is_there = begun.pattern[sign.name] == SLIDING or size <= least
        return np.where(is_there & (np.abs(found * self._sizes) > least), found, 0.0)

    def _reject_start(self, sign: Sign) -> None:
        raise no_sensitivity(
            translatable("they depend on the side, as the motion starts where %(of)s is zero", of=sign.of)
        )


def _sizes_of_zero(mode: Mode, name: str, t: Numbers, state: Numbers) -> tuple[float, float]:
    """Return the size of a sign's argument, and the size up to which it is none."""
    zero = _switching_zero(mode, name)
    value = values_in(zero.problem, zero.program, DOUBLE)
    change = first_order_changes(value, t, state, nominal_of(mode.whole))[0, 0]
    return abs(value(t, state)[0, 0]), ON_SURFACE * change


def _start_of(begun: Mode) -> tuple[Numbers, Numbers]:
    """Return the initial time and state as arrays, shapes (1,) and (2n, 1)."""
    t, state = start_of(begun.whole)
    return np.array([t]), state[:, None]


def _jump_between_sides(begun: Mode, name: str) -> Numbers:
    """Return the jump of the state's rate at a switching surface, shape (2n,)."""
    sides = [problem_in(begun.whole, {**begun.pattern, name: side}) for side in (-1, 1)]
    one, other = (values_in(side, side.motion, DOUBLE)(*_start_of(begun))[: len(side.coordinates), 0] for side in sides)
    jump = one - other if np.max(np.abs(one - other)) > CONTINUOUS * np.max(np.abs([one, other])) else 0.0 * one
    return np.concatenate([np.zeros(len(one)), jump])


def _surface_rate(begun: Mode, sign: Sign, direction: Numbers) -> float:
    """Return the derivative of a switching function along a direction of the state."""
    zero = _switching_zero(begun, sign.name)
    variation = Variation(*zero[:2], (zero.output,), begun.whole.state[:1])
    return float(variation(*_start_of(begun), direction[:, None, None])[0, 0, 0])


def _switching_zero(mode: Mode, name: str) -> _Zero:
    whole, pattern = mode.whole, mode.pattern
    program = whole.once(
        ("surface", name, frozenset(pattern.items())),
        whole.switching,
        lambda: switching_function(whole, "switch", name, pattern),
    )
    return _Zero(whole, program, *program.outputs)
