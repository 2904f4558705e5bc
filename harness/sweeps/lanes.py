"""Many motions at once: heyoka's batch integrator, its parameters those of each lane.

Each lane takes its own steps; what comes out for it does not hang on its neighbours, on how many they are or on where
the rows are cut, because batches are always full: what is missing is filled up with a lane that is there anyway. A lane
that fails would end the steps of the others, so its batch is followed again without it.

Quantities that are looked at along the motion are integrated with it, so small that they decide about no step: the
polynomial of each step tells their values, and the last state their means.

After a block of steps the states are projected onto the constraints. A lane whose steps shrink suddenly, that leaves
the constraints too far inside a block, or that takes too many steps, is left to `holonom.sweeps.single`.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..program.heyoka_function import dynamics, import_heyoka, zero_multipliers
from ..program.motion_problem import MotionProblem, computing
from ..program.motion_program import Expression
from ..program.precision import read_precision
from ..simulation.constraints.program_projection import nearest_state
from ..simulation.engines.program_engine import SHRUNK
from ..simulation.evaluation import in_full_vectors
from .extremes import Steps
from .quantities import along_motion, expressions_of

LANES = 32  # of a batch: as fast as 8, and a quarter of the calls
BLOCK = 512  # steps between projections
MOST_BLOCKS = 64
STRAYED = 1e-8  # relative distance from the constraints after a block that projection alone does not cure
SMALL = 2.0**-200  # in which what is looked at along the motion is integrated: a power of two loses no digit
COMPACT_FROM = 300  # operations; heyoka's other mode compiles in their square, and runs a third faster

Floats = NDArray[np.float64]


class Followed(NamedTuple):
    """Motions as far as they were followed.

    Attributes
    ----------
    states : ndarray, shape (stops, 2n, k)
        At each instant asked for; the last is the end.
    arrived : ndarray of bool, shape (k,)
        Where the states mean something.
    steps : list of (slice, list of Steps)
        For each batch, which motions it holds, and each quantity along them.
    """

    states: Floats
    arrived: NDArray[np.bool_]
    steps: list[tuple[slice, list[Steps]]]


class LaneEngine:
    """Follows many motions of one problem.

    Parameters
    ----------
    problem : MotionProblem
        With open parameters, without signs and obstacle.
    tol : float
        Tolerance of a step.
    projects : bool
        Whether the states are kept on the constraints.
    along : sequence of Expression
        Quantities to look at along the motion.
    lanes : int
        Of a batch; 2 or more.
    """

    def __init__(
        self, problem: MotionProblem, tol: float, projects: bool, along: Sequence[Expression], lanes: int = LANES
    ) -> None:
        heyoka = import_heyoka()
        self._start, self._n, self._lanes = float(problem.start["t"]), len(problem.coordinates), lanes
        self._along, self._size = len(along), len(problem.state)
        outcome = heyoka.taylor_outcome
        self._unharmed = {outcome.time_limit, outcome.step_limit, outcome.success}
        program = computing(problem.motion, {f"ddot({name})" for name in problem.coordinates})
        parameters = {name: heyoka.par[place] for place, name in enumerate(problem.parameters)}
        equations = dynamics(program, parameters | zero_multipliers(problem.multipliers, 0.0))
        if along:
            known = {"t": heyoka.time, **{name: heyoka.expression(name) for name in problem.state}, **parameters}
            rates = expressions_of(along, along_motion(problem, known))
            equations += [(heyoka.expression(f"along[{k}]"), SMALL * rate) for k, rate in enumerate(rates)]
        self._integrator = heyoka.taylor_adaptive_batch(
            equations,
            np.zeros((len(equations), lanes)),
            tol=tol,
            pars=np.zeros((len(problem.parameters), lanes)),
            compact_mode=problem.motion.operations >= COMPACT_FROM,
        )
        self._nearest = None
        if projects and problem.multipliers:
            self._nearest = in_full_vectors(nearest_state(problem, read_precision("double")))

    def follow(self, states: Floats, values: Floats, stops: Sequence[float]) -> Followed:
        """Follow motions from their starts.

        Parameters
        ----------
        states : ndarray, shape (2n, k)
        values : ndarray, shape (p, k)
            Of the open parameters.
        stops : sequence of float
            Instants to stop at, in order; the last is the end.
        """
        k, lanes = states.shape[1], self._lanes
        found, arrived, steps = np.full((len(stops), self._size, k), np.nan), np.zeros(k, dtype=bool), []
        for first in range(0, k, lanes):
            here = slice(first, min(first + lanes, k))
            reached, well, along = self._batch(states[:, here], values[:, here], stops)
            found[:, :, here], arrived[here] = reached, well
            if self._along:
                steps.append((here, along))
        return Followed(self._on_constraints(found, values, stops, arrived), arrived, steps)

    def _on_constraints(
        self, states: Floats, values: Floats, stops: Sequence[float], arrived: NDArray[np.bool_]
    ) -> Floats:
        """States at the stops, projected; a lane that strayed has not arrived."""
        if self._nearest is None or not arrived.any():
            return states
        for place, stop in enumerate(stops):
            states[place], strayed = self._projected(np.full((1, states.shape[2]), stop), states[place], values)
            arrived &= ~strayed
        return states

    def _projected(self, instants: Floats, states: Floats, values: Floats) -> tuple[Floats, NDArray[np.bool_]]:
        found = self._nearest(np.concatenate([instants, states, values]))
        return found[:-1], ~(found[-1] <= STRAYED**2)

    def _batch(
        self, states: Floats, values: Floats, stops: Sequence[float]
    ) -> tuple[Floats, NDArray[np.bool_], list[Steps]]:
        """A batch, and again without lanes that fail: shapes (stops, 2n, m), (m,)."""
        count = states.shape[1]
        chosen, well = np.arange(self._lanes), np.ones(count, dtype=bool)
        chosen[count:] = 0
        while True:
            failing, reached, sound, steps = self._run(states[:, chosen], values[:, chosen], stops)
            failed = np.unique(chosen[failing]) if failing.any() else ()
            if not len(failed):
                return reached[:, :, :count], well & sound[:count], [_first(part, count) for part in steps]
            well[failed] = False
            if not well.any():
                return np.full((len(stops), *states.shape), np.nan), well, self._nothing(count)
            chosen[np.isin(chosen, failed)] = np.flatnonzero(well)[0]

    def _run(
        self, states: Floats, values: Floats, stops: Sequence[float]
    ) -> tuple[NDArray[np.bool_], Floats, NDArray[np.bool_], list[Steps]]:
        """Full lanes through all stops: which fail, their states, which are sound, what was looked at."""
        integrator, along = self._integrator, _Along(self._size) if self._along else None
        integrator.set_time(self._start)
        integrator.state[: self._size] = states
        integrator.state[self._size :] = 0.0
        integrator.pars[:] = values[: len(integrator.pars)]
        options = {"callback": along, "write_tc": True} if along else {}
        reached, sound = np.empty((len(stops), self._size, self._lanes)), np.ones(self._lanes, dtype=bool)
        longest = np.zeros(self._lanes)
        for place, stop in enumerate(stops):
            for _ in range(MOST_BLOCKS):
                integrator.propagate_until(stop, max_steps=BLOCK, **options)
                ends, ended = integrator.propagate_res, integrator.time == stop
                if not ended.all():
                    failing = np.array([end[0] not in self._unharmed for end in ends])
                    if failing.any():
                        return failing, reached, sound, []
                _, shortest, taken, _ = zip(*ends, strict=True)
                longest = np.maximum(longest, np.array(taken))
                sound &= np.array(shortest) * SHRUNK >= longest
                if ended.all():
                    break
                self._keep(~ended, values, sound)
            sound &= ended
            reached[place] = integrator.state[: self._size]
            if not ended.all():
                return ~ended, reached, sound, []
        return np.zeros(self._lanes, dtype=bool), reached, sound, along.steps() if along else []

    def _keep(self, lanes: NDArray[np.bool_], values: Floats, sound: NDArray[np.bool_]) -> None:
        """Project the lanes whose block has ended before their motion."""
        if self._nearest is not None:
            state = self._integrator.state[: self._size]
            projected, strayed = self._projected(self._integrator.time[None, :], state, values)
            state[:, lanes] = projected[:, lanes]
            sound &= ~(lanes & strayed)

    def _nothing(self, count: int) -> list[Steps]:
        empty = np.full((1, 1, count), np.nan)
        return [Steps(empty, empty[0], empty[0], 0.0) for _ in range(self._along)]


class _Along:
    """Keeps the polynomials of what is looked at, step by step, as heyoka's callback.

    Parameters
    ----------
    first : int
        Place in the state of the first of them.
    """

    def __init__(self, first: int) -> None:
        self._first = first
        self._series: list[Floats] = []
        self._lengths: list[Floats] = []
        self._ends: list[Floats] = []

    def __call__(self, integrator: Any) -> bool:
        """Take what the last step leaves."""
        self._series.append(integrator.tc[self._first :].copy())
        self._lengths.append(integrator.last_h.copy())
        self._ends.append(integrator.time.copy())
        return True

    def steps(self) -> list[Steps]:
        """Each quantity along the lanes."""
        length = np.array(self._lengths)
        begin, series = np.array(self._ends) - length, np.moveaxis(np.array(self._series), 2, 0)[1:]
        coefficients = np.empty_like(series)
        power = np.ones_like(length)
        for order, rate in enumerate(series):  # the integral's coefficients, differentiated
            coefficients[order] = rate * ((order + 1) / SMALL) * power[:, None]
            power = power * length
        return [
            Steps(np.moveaxis(coefficients[:, :, k], 0, 1), begin, length, 0.0) for k in range(coefficients.shape[2])
        ]


def _first(steps: Steps, count: int) -> Steps:
    """The first lanes of a batch."""
    return steps._replace(
        coefficients=steps.coefficients[:, :, :count],
        middle=steps.middle[:, :count],
        length=steps.length[:, :count],
    )
