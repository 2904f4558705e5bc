"""Batch integration by heyoka, with parameters for each element of a batch.

Each element takes its own steps. Its result does not depend on the other elements, on their number or on the division
of the rows into chunks, because batches are always full: elements that are missing repeat others. An element that fails
would end the steps of the others, so its batch is integrated again without it.

After a block of steps the states are projected onto the constraints. `holonom.sweeps.single` integrates an element

- whose steps shrink suddenly,
- that leaves the constraints too far inside a block,
- that takes too many steps, or steps too long for the quantities that are looked at.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import chain
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..program.heyoka_function import dynamics, import_heyoka, zero_multipliers
from ..program.motion_problem import MotionProblem
from ..program.motion_program import Expression, Name
from ..program.rewriting import computing
from ..simulation.constraints.program_projection import distance, nearest_state
from ..simulation.engines.program_engine import SHRUNK
from ..simulation.engines.scaled_time import in_unit, sizes_of_state, unit_of
from ..simulation.evaluation import batch_evaluation
from ..simulation.inputs import Inputs
from ..simulation.nominal import nominal_of
from .extremes import Steps
from .polynomials import rates_of
from .quantities import along_motion, expressions_of
from .stack import FastestPlace

ELEMENTS = 16  # of a batch: its states fit into the caches nearest to the processor, and calls are few
TOGETHER = 32  # batches that are looked at together, at most; fewer of more steps than there is room for
BLOCK = 512  # steps between projections
MOST_BLOCKS = 64
ROOM = 64  # steps for which there is room at first
STRAYED = 1e-8  # relative distance from the constraints after a block that projection alone does not remove
SMALL = 2.0**-200  # in which what is looked at along the motion is integrated: a power of two loses no digit
ACCURACY_INTEGRALS = ("work", "squared_error")  # integrals behind the state
NO_STEPS = (None, np.inf, 0.0, 0)  # of a block
COMPACT_FROM = 1600  # operations by elements; heyoka's other mode compiles in their square, and runs a third faster

Floats = NDArray[np.float64]
Stops = Sequence[float | Floats]  # one for all elements, which heyoka takes faster, or one for each
Look = Callable[[list[Steps]], Floats]


class BatchResult(NamedTuple):
    """Result of a batch of motions."""

    states: Floats  # shape (stops, 2n, k): at each time asked for; the last is the end
    arrived: NDArray[np.bool_]  # shape (k,): where the states mean something, and the polynomials along the motion
    seen: Floats  # shape (numbers, k): what was made of the quantities along the motions
    # steps, energy_error, exchanged: shape (k,): taken; at most, on the way; the largest change of the energy, or work
    steps: NDArray[np.int64]
    energy_error: Floats
    exchanged: Floats


Block = Sequence[tuple[Any, float, float, int]]
"""For each element of a batch the outcome of a block, its shortest and longest step and their number."""


class _Batch(NamedTuple):
    """The state of a batch of m motions."""

    reached: Floats  # shape (stops, 2n + 2, m)
    well: NDArray[np.bool_]  # shape (m,)
    blocks: list[Block]

    def of(self, elements: slice) -> "_Batch":
        """Return some of the motions."""
        blocks = [block[elements] for block in self.blocks]
        return _Batch(self.reached[:, :, elements], self.well[elements], blocks)


class BatchEngine:
    """A batch integrator of many motions of one problem.

    Parameters
    ----------
    problem : MotionProblem
        With open parameters, without signs and obstruction.
    tol : float
        Tolerance of a step.
    projects : bool
        True if the states are projected onto the constraints.
    along : sequence of Expression
        Quantities to look at along the motion.
    look : callable
        Makes numbers of these, given step by step: shape (numbers, elements). Motions with one that is infinite have
        not arrived.
    """

    def __init__(
        self, problem: MotionProblem, tol: float, projects: bool, along: Sequence[Expression], look: Look
    ) -> None:
        heyoka = import_heyoka()
        self._start, self._nominal = float(problem.start["t"]), nominal_of(problem)
        self._unit = unit_of(problem, self._nominal.time)  # of the integrator's time
        elements = self._elements = ELEMENTS
        self._along, self._size = len(along), len(problem.state)
        outcome = heyoka.taylor_outcome
        self._unharmed = {outcome.time_limit, outcome.step_limit, outcome.success}
        program = computing(problem.motion, problem.accelerations)
        parameters = {name: heyoka.par[place] for place, name in enumerate(problem.parameters)}
        equations = dynamics(program, parameters | zero_multipliers(problem.multipliers, 0.0))
        known = {"t": heyoka.time, **{name: heyoka.expression(name) for name in problem.state}, **parameters}
        wanted = [Name("energy"), Name("power"), *along]
        energy, power, *rates = expressions_of(wanted, along_motion(problem, known))
        work, squared_error = map(heyoka.expression, ACCURACY_INTEGRALS)
        error = energy - heyoka.par[len(parameters)] - work / SMALL
        equations += [(work, SMALL * power), (squared_error, SMALL * error**2.0)]
        equations += [(heyoka.expression(f"along[{k}]"), SMALL * rate) for k, rate in enumerate(rates)]
        velocities = [variable for variable, _ in equations[self._size // 2 : self._size]]
        self._integrator = heyoka.taylor_adaptive_batch(
            in_unit(equations, self._unit, velocities),
            np.zeros((len(equations), elements)),
            tol=tol * self._nominal.in_unit(self._unit).absolute(),
            compact_mode=problem.motion.operations * elements >= COMPACT_FROM,
        )
        self._state, self._time = self._integrator.state, self._integrator.time
        self._pars = self._integrator.pars  # the last one is the energy at the initial time
        self._moving, self._behind = self._state[: self._size], self._size + len(ACCURACY_INTEGRALS)
        self._sizes = sizes_of_state(self._size, self._unit)[:, None]  # of the state in the integrator
        self._recorder = _StepRecorder(self._integrator, self._behind, self._unit, look) if along else None
        self._place, self._inputs = FastestPlace(), Inputs(problem)
        self._energy = batch_evaluation(problem, computing(problem.energy, {"energy"}))
        self._corrections = None
        if projects and problem.multipliers:
            self._corrections = batch_evaluation(problem, problem.projection)

    def integrate(self, states: Floats, values: Floats, stops: Stops) -> BatchResult:
        """Integrate motions from their initial states.

        Parameters
        ----------
        states : ndarray, shape (2n, k)
            Initial coordinates and velocities.
        values : ndarray, shape (p, k)
            Of the open parameters.
        stops : sequence of float or ndarray, shape (k,)
            Times to stop at, in order, for all motions or for each. The last is the end.

        Returns
        -------
        BatchResult
            One column for each motion.
        """
        k, elements = states.shape[1], self._elements
        found, arrived = np.empty((len(stops), self._behind, k)), np.empty(k, dtype=bool)
        blocks, recorder = [], self._recorder
        if recorder is not None:
            recorder.clear()
        starts = np.concatenate([self._sizes * states, np.zeros((len(ACCURACY_INTEGRALS) + self._along, k))])
        ends = [stop / self._unit for stop in stops]
        begun = self._energies(self._start, states, values)
        pars = np.concatenate([values, begun[None]])
        for first in range(0, k, elements):
            here = slice(first, min(first + elements, k))
            batch = self._place.call(partial(self._batch, starts[:, here], pars[:, here], _of(ends, here)))
            found[:, :, here], arrived[here], blocks_here = batch
            blocks.append(blocks_here)
            if recorder is not None:
                recorder.keep(here.stop - here.start)
        numbers = np.empty((0, k)) if recorder is None else recorder.numbers()
        steady, shortest, taken = _steps_taken(blocks)
        arrived &= steady & ~np.isinf(numbers).any(axis=0)
        reached = self._on_constraints(found[:, : self._size] / self._sizes, values, stops, arrived)
        works, squares = np.moveaxis(found[:, self._size :], 1, 0) / SMALL
        gained = np.array([self._energies(*at, values) for at in zip(stops, reached, strict=True)]) - begun
        error = np.maximum(np.max(np.abs(gained - works), axis=0), np.sqrt(squares[-1] / (self._unit * shortest)))
        exchanged = np.max(np.maximum(np.abs(gained), np.abs(works)), axis=0)
        return BatchResult(reached, arrived, numbers, taken, error, exchanged)

    def _energies(self, times: float | Floats, states: Floats, values: Floats) -> Floats:
        return self._energy(self._inputs(times, states, values=values))[0]

    def _on_constraints(self, states: Floats, values: Floats, stops: Stops, arrived: NDArray[np.bool_]) -> Floats:
        """Return the projected states at the stops, without elements that strayed."""
        if self._corrections is None or not arrived.any():
            return states
        for place, stop in enumerate(stops):
            states[place], strayed = self._projected(stop, states[place], values)
            arrived &= ~strayed
        return states

    def _projected(self, times: Floats, states: Floats, values: Floats) -> tuple[Floats, NDArray[np.bool_]]:
        found = nearest_state(self._corrections, self._inputs(times, states, values=values), len(states))
        return found, ~(distance(states, found, self._nominal.state) <= STRAYED)

    def _batch(self, starts: Floats, pars: Floats, stops: Stops) -> _Batch:
        """Return a batch, and again without elements that fail."""
        count = starts.shape[1]
        if count == self._elements:
            failing, batch = self._run(starts, pars, stops)
            if failing is None:
                return batch
        chosen, active = np.arange(self._elements), np.ones(count, dtype=bool)
        chosen[count:] = 0
        while True:
            failing, batch = self._run(starts[:, chosen], pars[:, chosen], _of(stops, chosen))
            if failing is None:
                batch = batch.of(slice(count))
                return batch._replace(well=active & batch.well)
            failed = np.unique(chosen[failing])
            active[failed] = False
            if not active.any():
                reached = np.full((len(stops), self._behind, count), np.nan)
                return _Batch(reached, active, [[NO_STEPS] * count])
            chosen[np.isin(chosen, failed)] = np.flatnonzero(active)[0]

    def _run(self, starts: Floats, pars: Floats, stops: Stops) -> tuple[NDArray[np.bool_] | None, _Batch | None]:
        """Integrate a full batch through all stops. Return failed elements or the result."""
        integrator, recorder, options = self._integrator, self._recorder, {}
        if recorder is not None:
            options = {"callback": recorder.begin(), "write_tc": True}
        integrator.set_time(self._start / self._unit)
        self._state[...], self._pars[...] = starts, pars
        reached, well = np.empty((len(stops), self._behind, self._elements)), np.ones(self._elements, dtype=bool)
        blocks = []
        for place, stop in enumerate(stops):
            for _ in range(MOST_BLOCKS):
                integrator.propagate_until(stop, max_steps=BLOCK, **options)
                blocks.append(integrator.propagate_res)
                ended = self._time == stop
                if all(ended.tolist()):
                    break
                if (failing := np.array([end[0] not in self._unharmed for end in blocks[-1]])).any():
                    return failing, None
                self._keep(~ended, well)
            else:
                return ~ended, None
            reached[place] = self._state[: self._behind]
        return None, _Batch(reached, well, blocks)

    def _keep(self, elements: NDArray[np.bool_], well: NDArray[np.bool_]) -> None:
        """Project the elements whose block has ended before their motion."""
        if self._corrections is not None:
            reached = self._unit * self._time, self._moving / self._sizes
            projected, strayed = self._projected(*reached, self._pars[:-1])
            self._moving[:, elements] = (self._sizes * projected)[:, elements]
            well &= ~(elements & strayed)


def _steps_taken(batches: Sequence[Sequence[Block]]) -> tuple[NDArray[np.bool_], Floats, NDArray[np.int64]]:
    """Return the steadiness, the shortest step and the number of steps.

    One of each for each element: False where steps shrink suddenly.
    """
    steady, shortest, longest, taken = True, np.inf, 0.0, 0
    for place in range(max(map(len, batches))):
        there = (blocks[place] if place < len(blocks) else [NO_STEPS] * len(blocks[0]) for blocks in batches)
        _, *numbers = zip(*chain.from_iterable(there), strict=True)
        least, greatest, count = map(np.array, numbers)
        shortest, longest = np.minimum(shortest, least), np.maximum(longest, greatest)
        steady, taken = steady & (least * SHRUNK >= longest), taken + count
    return steady, shortest, taken


def _of(stops: Stops, elements: Any) -> Stops:
    """Return the stops of some of the elements."""
    return [stop if isinstance(stop, float) else stop[elements] for stop in stops]


class _StepRecorder:
    """A recorder of quantities along motions, looked at for many batches at once.

    Parameters
    ----------
    integrator : heyoka.taylor_adaptive_batch
        The integrator.
    first : int
        Place in the state of the first of the quantities.
    unit : float
        Unit of the integrator's time.
    look : callable
        As for `BatchEngine`.
    """

    def __init__(self, integrator: Any, first: int, unit: float, look: Look) -> None:
        # views of what the last step leaves
        self._last = integrator.tc[first:, 1:], integrator.last_h, integrator.time
        self._unit, self._look = unit, look
        self._make_room(ROOM)
        self.clear()

    def _make_room(self, steps: int) -> None:
        """Make room for batches of a number of steps."""
        quantities, powers, elements = self._last[0].shape
        room = max(1, TOGETHER * ROOM // steps), steps
        # In `SMALL`, Taylor coefficients of the quantities' integrals, the linear one first, and lengths of the steps
        self._series = np.empty((*room, quantities, powers + 1, elements))
        self._times = np.empty((*room, elements))  # at the ends of the steps
        self._rows = [
            list(zip(series[:, :, :-1], series[:, :, -1], times, strict=True))
            for series, times in zip(self._series, self._times, strict=True)
        ]

    def clear(self) -> None:
        """Forget all batches."""
        self._taken: list[int] = [0]  # steps of each batch
        self._waiting: list[int] = []  # elements of each batch that waits to be looked at
        self._made: list[Floats] = []

    def begin(self) -> Callable[[Any], bool]:
        """Return a callback that records the steps of a batch.

        They replace those recorded since the last `keep`.
        """
        return partial(next, self._recording())  # a generator is called faster than a method

    def _recording(self) -> Iterator[bool]:
        last_series, last_length, last_time = self._last
        self._taken[-1] = 0
        while True:
            for series, length, time in self._rows[len(self._waiting)][self._taken[-1] :]:
                series[...], length[...], time[...] = last_series, last_length, last_time
                self._taken[-1] += 1
                yield True
            self._make_more_room()

    def _make_more_room(self) -> None:
        """Make room for more steps of the last batch, after a look at those before it."""
        place, taken = len(self._waiting), self._taken[-1]
        recorded = self._series[place], self._times[place]
        self._look_at_waiting()
        self._make_room(2 * taken)
        self._series[0, :taken], self._times[0, :taken] = recorded
        self._taken = [taken]

    def keep(self, elements: int) -> None:
        """Keep the first elements of the last batch, to be looked at with others."""
        if not self._taken[-1]:  # no step, and so no numbers
            self._series[len(self._waiting), 0], self._taken[-1] = np.nan, 1
        self._waiting.append(elements)
        if len(self._waiting) == len(self._series):
            self._look_at_waiting()
        self._taken.append(0)

    def numbers(self) -> Floats:
        """Return the numbers of all elements, shape (numbers, elements)."""
        self._look_at_waiting()
        return np.concatenate(self._made, axis=1)

    def _look_at_waiting(self) -> None:
        """Look at the batches that wait, steps of no length behind the shorter ones."""
        count = len(self._waiting)
        if not count:
            return
        most = max(self._taken[:count])
        for series, times, taken in zip(self._series[:count], self._times, self._taken, strict=False):
            series[taken:most], times[taken:most] = series[taken - 1], times[taken - 1]
            series[taken:most, :, -1] = 0.0
        series = self._series[:count, :most].transpose(2, 3, 1, 0, 4)
        times = self._times[:count, :most].swapaxes(0, 1)
        made = self._look(_steps(*(each.reshape(*each.shape[:-2], -1) for each in (series, times)), self._unit))
        parts = np.split(made, count, axis=1)
        self._made += [part[:, :elements] for part, elements in zip(parts, self._waiting, strict=True)]
        self._taken, self._waiting = [], []


def _steps(series: Floats, times: Floats, unit: float) -> list[Steps]:
    """Return each quantity along the motions, recorded with times in a unit."""
    made, rescaled = [], rates_of(series.shape[1] - 1, 1 / (SMALL * unit))
    for each in series:
        coefficients = rescaled(each.reshape(len(each), -1)).reshape(-1, *times.shape)
        made.append(Steps(coefficients, unit * (times - each[-1]), unit * each[-1], 0.0))
    return made
