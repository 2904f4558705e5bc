"""Batch integration by heyoka, with parameters for each element of a batch.

Each element takes its own steps. Its result does not depend on the other elements, on their number or on the division
of the rows into chunks, because batches are always full: elements that are missing repeat others. An element that fails
would end the steps of the others, so its batch is integrated again without it.

After a block of steps the states are projected onto the constraints. `holonom.sweeps.single` integrates an element

- whose steps shrink suddenly,
- that leaves the constraints too far inside a block,
- that takes too many steps, or steps too long for the quantities that are looked at.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..program.heyoka_function import dynamics, import_heyoka, zero_multipliers
from ..program.motion_problem import MotionProblem
from ..program.motion_program import Expression, Name
from ..program.rewriting import computing
from ..simulation.constraints.program_projection import distance, nearest_state
from ..simulation.engines.program_engine import SHRUNK
from ..simulation.evaluation import batch_evaluation
from ..simulation.inputs import Inputs
from ..simulation.nominal import nominal_of
from .extremes import Steps
from .polynomials import rates_of
from .quantities import along_motion, expressions_of

ELEMENTS = 16  # of a batch: its states fit into the caches nearest to the processor, and calls are few
ELEMENTS_WITH_CALLBACK = 32  # where Python is called after each step
BLOCK = 512  # steps between projections
MOST_BLOCKS = 64
ROOM = 64  # steps for which there is room at first
STRAYED = 1e-8  # relative distance from the constraints after a block that projection alone does not remove
SMALL = 2.0**-200  # in which what is looked at along the motion is integrated: a power of two loses no digit
ACCURACY_INTEGRALS = ("work", "squared_error")  # integrals behind the state
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


class _Batch(NamedTuple):
    """The state of a batch of m motions."""

    reached: Floats  # shape (stops, 2n + 2, m)
    well: NDArray[np.bool_]  # shape (m,)
    shortest: Floats  # shape (m,): step
    taken: NDArray[np.int64]  # shape (m,): steps
    steps: list[Steps]

    def of(self, elements: slice) -> "_Batch":
        """Return some of the motions."""
        steps = [part.of(elements) for part in self.steps]
        return _Batch(
            self.reached[:, :, elements], self.well[elements], self.shortest[elements], self.taken[elements], steps
        )


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
    elements : int or None
        Of a batch, 2 or more, or None for the number that is fastest.
    """

    def __init__(
        self,
        problem: MotionProblem,
        tol: float,
        projects: bool,
        along: Sequence[Expression],
        look: Look,
        elements: int | None = None,
    ) -> None:
        heyoka = import_heyoka()
        self._start, self._nominal = float(problem.start["t"]), nominal_of(problem)
        elements = self._elements = elements or (ELEMENTS_WITH_CALLBACK if along else ELEMENTS)
        self._along, self._look, self._size = len(along), look, len(problem.state)
        outcome = heyoka.taylor_outcome
        self._unharmed = {outcome.time_limit, outcome.step_limit, outcome.success}
        program = computing(problem.motion, {f"ddot({name})" for name in problem.coordinates})
        parameters = {name: heyoka.par[place] for place, name in enumerate(problem.parameters)}
        equations = dynamics(program, parameters | zero_multipliers(problem.multipliers, 0.0))
        known = {"t": heyoka.time, **{name: heyoka.expression(name) for name in problem.state}, **parameters}
        wanted = [Name("energy"), Name("power"), *along]
        energy, power, *rates = expressions_of(wanted, along_motion(problem, known))
        work, squared_error = map(heyoka.expression, ACCURACY_INTEGRALS)
        error = energy - heyoka.par[len(parameters)] - work / SMALL
        equations += [(work, SMALL * power), (squared_error, SMALL * error * error)]
        equations += [(heyoka.expression(f"along[{k}]"), SMALL * rate) for k, rate in enumerate(rates)]
        self._integrator = heyoka.taylor_adaptive_batch(
            equations,
            np.zeros((len(equations), elements)),
            tol=tol * self._nominal.absolute(),
            compact_mode=problem.motion.operations * elements >= COMPACT_FROM,
        )
        self._state, self._time = self._integrator.state, self._integrator.time
        self._pars = np.zeros((len(problem.parameters) + 1, elements))  # the last one is the energy at the initial time
        self._moving, self._behind = self._state[: self._size], self._size + len(ACCURACY_INTEGRALS)
        self._looking = _StepRecorder(self._integrator, self._behind) if along else None
        self._inputs = Inputs(problem)
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
        found, arrived, seen = np.empty((len(stops), self._behind, k)), np.empty(k, dtype=bool), []
        shortest, taken = np.empty(k), np.empty(k, dtype=int)
        starts = np.concatenate([states, np.zeros((len(ACCURACY_INTEGRALS) + self._along, k))])
        begun = self._energies(self._start, states, values)
        pars = np.concatenate([values, begun[None]])
        for first in range(0, k, elements):
            here = slice(first, min(first + elements, k))
            batch = self._batch(starts[:, here], pars[:, here], _of(stops, here))
            found[:, :, here], arrived[here], shortest[here], taken[here], steps = batch
            if self._along:
                seen.append(self._look(steps))
                arrived[here] &= ~np.isinf(seen[-1]).any(axis=0)
        reached = self._on_constraints(found[:, : self._size], values, stops, arrived)
        works, squares = np.moveaxis(found[:, self._size :], 1, 0) / SMALL
        gained = np.array([self._energies(*at, values) for at in zip(stops, reached, strict=True)]) - begun
        error = np.maximum(np.max(np.abs(gained - works), axis=0), np.sqrt(squares[-1] / shortest))
        exchanged = np.max(np.maximum(np.abs(gained), np.abs(works)), axis=0)
        numbers = np.concatenate(seen, axis=1) if seen else np.empty((0, k))
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
                return self._nothing(len(stops), count)
            chosen[np.isin(chosen, failed)] = np.flatnonzero(active)[0]

    def _run(self, starts: Floats, pars: Floats, stops: Stops) -> tuple[NDArray[np.bool_] | None, _Batch | None]:
        """Integrate a full batch through all stops. Return failed elements or the result."""
        integrator, along, options = self._integrator, self._looking, {}
        if along is not None:
            along.clear()
            options = {"callback": along, "write_tc": True}
        integrator.set_time(self._start)
        self._state[...], self._pars[...] = starts, pars
        integrator.pars[...] = pars
        reached, well = np.empty((len(stops), self._behind, self._elements)), np.ones(self._elements, dtype=bool)
        shortest, longest = np.full(self._elements, np.inf), np.zeros(self._elements)
        taken = np.zeros(self._elements, dtype=int)
        for place, stop in enumerate(stops):
            for _ in range(MOST_BLOCKS):
                integrator.propagate_until(stop, max_steps=BLOCK, **options)
                ends, ended = integrator.propagate_res, self._time == stop
                arrived = ended.all()
                if not arrived and (failing := np.array([end[0] not in self._unharmed for end in ends])).any():
                    return failing, None
                least, greatest, count = np.array([end[1:] for end in ends]).T
                shortest, longest = np.minimum(shortest, least), np.maximum(longest, greatest)
                well &= least * SHRUNK >= longest
                taken += count.astype(int)
                if arrived:
                    break
                self._keep(~ended, well)
            else:
                return ~ended, None
            reached[place] = self._state[: self._behind]
        return None, _Batch(reached, well, shortest, taken, along.steps() if along is not None else [])

    def _keep(self, elements: NDArray[np.bool_], well: NDArray[np.bool_]) -> None:
        """Project the elements whose block has ended before their motion."""
        if self._corrections is not None:
            projected, strayed = self._projected(self._time, self._moving, self._pars[:-1])
            self._moving[:, elements] = projected[:, elements]
            well &= ~(elements & strayed)

    def _nothing(self, stops: int, count: int) -> _Batch:
        empty, none = np.full((2, 1, count), np.nan), np.zeros(count, dtype=int)
        steps = [Steps(empty, empty[0], empty[0], 0.0) for _ in range(self._along)]
        return _Batch(np.full((stops, self._behind, count), np.nan), none == 1, empty[0, 0], none, steps)


def _of(stops: Stops, elements: Any) -> Stops:
    """Return the stops of some of the elements."""
    return [stop if isinstance(stop, float) else stop[elements] for stop in stops]


class _StepRecorder:
    """A heyoka callback that records the polynomials of the quantities at each step.

    Parameters
    ----------
    first : int
        Place in the state of the first of them.
    """

    def __init__(self, integrator: Any, first: int) -> None:
        self._rates = integrator.tc[first:, 1:]  # views of what the last step leaves
        self._last_length, self._last_time = integrator.last_h, integrator.time
        quantities, powers, elements = self._rates.shape
        self._series = np.empty((quantities, powers, ROOM, elements))
        self._length, self._time = np.empty((2, ROOM, elements))
        self._rescaled, self._taken = rates_of(powers, 1 / SMALL), 0

    def clear(self) -> None:
        """Forget the steps."""
        self._taken = 0

    def __call__(self, integrator: Any) -> bool:
        """Record the polynomials, the length and the time of the last step."""
        taken = self._taken
        if taken == len(self._time):
            stored = self._series, self._length, self._time
            twice = (np.concatenate([each, np.empty_like(each)], axis=-2) for each in stored)
            self._series, self._length, self._time = twice
        self._series[:, :, taken] = self._rates
        self._length[taken], self._time[taken] = self._last_length, self._last_time
        self._taken = taken + 1
        return True

    def steps(self) -> list[Steps]:
        """Return each quantity along the elements."""
        length, time = self._length[: self._taken], self._time[: self._taken]
        made = []
        for each in self._series[:, :, : self._taken]:
            coefficients = self._rescaled(np.concatenate([each, length[None]]).reshape(len(each) + 1, -1))
            made.append(Steps(coefficients.reshape(each.shape), time - length, length, 0.0))
        return made
