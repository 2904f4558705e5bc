"""The robust engine: SciPy's integrators, pivoted solves, projection of each step.

It works if the fixed pivots of the motion program fail. For redundant constraints, the rank of J is determined at
states that satisfy the constraints. Between them it does not change, because rounding or a stage off the constraints
would raise it. For singular configurations, the least singular value that counts is monitored. If it runs to zero, one
collocation step spans the zero (`collocation`), and all steps before end at half of the distance.

DOP853 takes the steps, of order 8. Two of its stages are at the end of a step: the difference of the time derivatives
between them, relative to that of the states, estimates the stiffness (Hairer & Wanner, Solving Ordinary Differential
Equations II, section IV.2). If steps stay at the boundary of its stability, Radau's method replaces it, of order 5 and
stable for stiff motions.
"""

from collections.abc import Iterator
from functools import cache

import numpy as np
from scipy.integrate import DOP853, OdeSolver, Radau

from ...failures import ErrorKind, HolonomError
from ...language import translatable
from ..constraints.directions import EPSILON, rank_of, weighted_constraints
from ..constraints.factorization import factored_constraints
from ..constraints.projection import InconsistentConstraints, settle
from ..constraints.singularity import extrapolated_zero, least_of, probed, singular_values_at
from ..matrices import Matrices, Matrix, Vector, start_of
from ..place_and_reason import SHORT_STEPS, place_and_reason
from ..request import EngineName
from .collocation import NODES, Collocation, collocated
from .engine import Solutions, Step, Task, require_reach

TOLERANCE = 1e-11
TIGHTEST = 100 * EPSILON  # relative tolerance that SciPy's integrators hold
SHORTEST = 1e-8  # of the longest step so far: a step that leads nowhere
SINGULAR = translatable("the configuration is singular")
SINGULAR_START = translatable("it starts from a singular configuration")
REACH = 5.0  # steps ahead within which a singular configuration calls for collocation
COLLOCATION_ERROR = 1e-12  # relative error of a collocation step's coordinates that will do at any tolerance
OFF_BRANCH = 1e-7  # relative distance from the constraints at the end of a collocation step that is not rounding
# lengths of a collocation step that are tried, in terms of one that reaches as far after as before
LONGER = (1.0, 1.5, 2.25)
CLEAR = 0.5  # least singular value at the end of a collocation step, in terms of the one at its start
SHORTER = 0.7  # share of the way to the singular configuration left after which a rejected step is tried again
CLOSEST = 1e-7  # such a way, relative to the time or to its nominal size, at which the search is given up
UNTRUSTED = 1e-6  # relative singular values in which no digits are left
FIRST, LEAST_FIRST, UNFELT = 0.01, 1e-6, 1e-5  # of the estimate of a first step
RADAU_ORDER = 4  # of its error estimate in terms of the step
NEARLY_SINGULAR = 1e-3  # relative singular values that are left out where a motion starts from such a configuration
BOUNDARY = 6.1  # of DOP853's stability on the negative real axis
MOST_AT_BOUNDARY = 15  # steps there, one after the other, before a motion counts as stiff
# lengths of collocation steps away from a singular configuration, as nominal ways
FIRST_LENGTHS = 1.0 / 2.0 ** np.arange(12)


class RobustEngine:
    """The engine with pivoted solves, in double precision (see `Engine`).

    Parameters
    ----------
    task : Task

    Attributes
    ----------
    rank : int
        How many of the constraints are independent.
    stiff : bool
        Whether the motion was found to be stiff.
    """

    name, fixed_pivots, open_parameters = EngineName.ROBUST, False, True
    code, compile_seconds, finest = "", 0.0, TIGHTEST

    def __init__(self, task: Task) -> None:
        problem, request, _, self.matrices = task
        if request.numbers.name != "double":
            raise HolonomError(
                ErrorKind.ROBUST_IS_DOUBLE, detail=problem.obstruction or translatable("--engine asks for it")
            )
        self.tol = TOLERANCE if request.tol is None else request.tol
        if not TIGHTEST <= self.tol < 1:
            holds = translatable(
                "the robust engine holds tolerances from %(finest)s to 1, not %(tol)s",
                finest=f"{TIGHTEST:.1e}",
                tol=f"{self.tol:g}",
            )
            raise HolonomError(ErrorKind.TOLERANCE_OUT_OF_RANGE, detail=holds, option="--tol")
        self.n, self.steps = len(problem.coordinates), 0
        self._max_step = request.max_step or np.inf
        self.stiff, self._at_boundary = False, 0  # the steps at the boundary of stability, one after the other
        self._multipliers, self._independent = problem.multipliers, problem.independent
        self._collocations: list[Collocation] = []
        self.restart(*start_of(problem))

    def restart(self, time_point: float, state: Vector) -> None:
        """Continue from another time and state (see `Engine.restart`)."""
        self._collocation: Collocation | None = None
        self.rank, until_singular = probed(self.matrices, time_point, state)
        if until_singular == 0:
            self.time, self.state = time_point, state
            self._collocation = self._collocation_away()
        else:
            self._begin(time_point, state)
            self._vanishing = time_point + until_singular

    def integrate(self, until: float, dense: bool = True) -> Iterator[Step]:
        """Integrate to a time, step by step (see `Engine.integrate`)."""
        steps, begun = self.steps, self.time
        while self.time < until:
            yield (
                self._along_collocation(until) if self._collocation or self._collocation_found() else self._step(until)
            )
            self.steps += 1
            require_reach(self.steps - steps, self.time - begun, until - self.time)

    def close(self) -> None:
        """Release nothing: all memory is Python's."""

    @property
    def near_singularity(self) -> bool:
        """True if a singular configuration is near or on the current collocation step."""
        return self._collocation is not None or self._vanishing - self.time <= REACH * self._solver.h_abs

    def solutions(self, times: Vector, states: Matrix) -> Solutions:
        """Return the unknowns of states on the constraints (see `Engine.solutions`)."""
        at = self.matrices(times, states.T)
        singular_values = weighted_constraints(at.mass, at.jacobian).singular_values()
        ranks = np.array([min(self.rank, rank_of(each, UNTRUSTED)) for each in singular_values])
        accelerations, multipliers = np.empty_like(at.force), np.empty_like(at.curvature)
        for rank in np.unique(ranks):
            chosen = ranks == rank
            here = Matrices(*(each[chosen] for each in at))
            accelerations[chosen], multipliers[chosen] = self._unknowns(times[chosen], here, rank)
        forces = np.vecmat(multipliers, at.jacobian)
        return Solutions(accelerations.T, self._as_in_the_program(at.jacobian, multipliers, forces).T, forces.T)

    def _unknowns(self, times: Vector, at: Matrices, rank: int) -> tuple[Matrix, Matrix]:
        """Return accelerations and multipliers at several states."""
        factored = factored_constraints(at.mass, at.jacobian, rank)
        accelerations, multipliers = factored.unknowns(at.force, at.curvature)
        for collocation in self._collocations:
            inside = (collocation.start < times) & (times < collocation.end)
            if inside.any():
                accelerations[inside] = collocation.accelerations(times[inside]).T
                missed = at.force - np.matvec(at.mass, accelerations)
                multipliers[inside] = factored.unknowns(missed, np.zeros_like(at.curvature))[1][inside]
        return accelerations, multipliers

    def _as_in_the_program(self, jacobian: Matrix, multipliers: Matrix, forces: Matrix) -> Matrix:
        """Return the multipliers, shape (k, g), that are zero for redundant constraints.

        They give the same constraint forces.
        """
        settled = list(self._independent)
        if len(settled) == multipliers.shape[-1]:
            return multipliers
        chosen, acting = np.zeros_like(multipliers), np.matrix_transpose(jacobian[:, settled])
        chosen[:, settled] = np.matvec(np.linalg.pinv(acting, rtol=EPSILON * max(acting.shape[1:])), forces)
        return chosen

    # ---- steps ----

    def _step(self, until: float) -> Step:
        """Take one step, at most half of the distance to a singular configuration."""
        start, solver, length = self.time, self._solver, self._solver.h_abs
        solver.t_bound, solver.status = min(until, (start + self._vanishing) / 2), "running"
        solver.step()
        self._longest = max(self._longest, solver.h_abs)
        cut_short = solver.status == "finished" and solver.t == until
        if solver.status == "failed" or (solver.h_abs < SHORTEST * self._longest and not cut_short):
            raise HolonomError(ErrorKind.NO_WAY_ON, detail=place_and_reason(start, SHORT_STEPS))
        if solver.status == "finished":
            solver.h_abs = max(solver.h_abs, length)
        if not self.stiff:
            self._at_boundary = self._at_boundary + 1 if _is_at_boundary(solver) else 0
            self.stiff = self._at_boundary >= MOST_AT_BOUNDARY
        self._move(solver.t, solver.y)
        if self.stiff and isinstance(solver, DOP853):
            self._begin(self.time, self.state)
        between = cache(solver.dense_output)  # it takes three evaluations
        return Step(start, self.time, lambda times: self._projected(times, between()(times)))

    def _projected(self, times: Vector, states: Matrix) -> Matrix:
        """States between two steps, on the constraints."""
        return settle(self.matrices, times, states.T, self.rank)[0].T

    def _rates(self, t: float, state: Vector) -> Vector:
        at = self.matrices(t, state)
        if not at.finite:
            return np.full_like(state, np.nan)
        factored = factored_constraints(at.mass, at.jacobian, self.rank)
        accelerations = factored.accelerations(at.force, at.curvature)
        if not np.all(np.isfinite(accelerations)):
            self._met = t
        return np.concatenate([state[self.n :], accelerations])

    def _begin(self, t: float, state: Vector) -> None:
        settled = self._settled(t, state)[0]
        self._least = self._least_at(t, settled)
        integrator, nominal = Radau if self.stiff else DOP853, self.matrices.nominal
        self._solver: OdeSolver = integrator(
            self._rates,
            t,
            settled,
            np.inf,
            rtol=self.tol,
            atol=self.tol * nominal.state,
            first_step=self._first_step(t, settled),
            max_step=self._max_step,
        )
        self.time, self.state, self._vanishing, self._failed_at, self._met = t, settled, np.inf, np.inf, np.inf
        self._longest = self._solver.h_abs

    def _first_step(self, t: float, state: Vector) -> float:
        """Return SciPy's estimate of the first step, scaled by the nominal time.

        It is that of Hairer, Norsett & Wanner I, section II.4.
        """
        nominal, order = self.matrices.nominal, RADAU_ORDER if self.stiff else DOP853.order
        scale = self.tol * (nominal.state + np.abs(state))
        slope = self._rates(t, state) * nominal.time
        value, speed = (float(np.sqrt(np.mean((each / scale) ** 2))) for each in (state, slope))
        length = FIRST * value / speed if value >= UNFELT and UNFELT <= speed < np.inf else LEAST_FIRST
        later = self._rates(t + length * nominal.time, state + length * slope) * nominal.time
        steepest = max(speed, float(np.sqrt(np.mean(((later - slope) / scale) ** 2))) / length)
        if steepest > 0 and np.isfinite(steepest):
            length = min(100 * length, (FIRST / steepest) ** (1 / order))
        return length * nominal.time

    def _move(self, t: float, state: Vector) -> None:
        """Project the result of a step, and continue from there."""
        before, last = self.time, self._least
        self.state, accelerations = self._settled(t, state)
        self._least = self._least_at(t, self.state)
        self._solver.y, self._solver.f = self.state, np.concatenate([self.state[self.n :], accelerations])
        self.time, self._vanishing = t, extrapolated_zero(before, last, t, self._least)
        if t < self._met < self._vanishing:  # if a step that was rejected found no accelerations
            self._vanishing = self._met

    def _settled(self, t: float | Vector, state: Vector) -> tuple[Vector, Vector]:
        """Return the nearest state that satisfies the constraints, and its accelerations.

        Of states, shape (k, 2n), each.
        """
        try:
            settled, factored = settle(self.matrices, t, state, self.rank)
        except InconsistentConstraints:
            self._require_rank(t, state)
            raise
        if self.rank < len(self._multipliers):
            self._require_rank(t, settled)
        at = self.matrices(t, settled)
        return settled, factored.accelerations(at.force, at.curvature)

    def _least_at(self, t: float, state: Vector) -> float:
        """Return the least singular value that counts."""
        return least_of(singular_values_at(self.matrices, t, state), self.rank)

    def _require_rank(self, t: float | Vector, state: Vector) -> None:
        """No constraint that depended on the others at the initial time may come to count."""
        for at in zip(np.atleast_1d(t), np.atleast_2d(state), strict=True):
            if rank_of(singular_values_at(self.matrices, *at), UNTRUSTED) > self.rank:
                raise HolonomError(ErrorKind.NO_WAY_ON, detail=place_and_reason(at[0], SINGULAR_START))

    # ---- singular configurations ----

    def _collocation_found(self) -> bool:
        """Look for a collocation step across the singular configuration ahead."""
        ahead = self._vanishing - self.time
        if ahead > min(REACH * self._solver.h_abs, SHORTER * self._failed_at):
            return False
        self._collocation, self._failed_at = self._collocation_over(ahead), ahead
        if self._collocation is None and ahead < CLOSEST * max(self.matrices.nominal.time, abs(self.time)):
            raise HolonomError(ErrorKind.NO_WAY_ON, detail=place_and_reason(self.time + ahead, SINGULAR))
        return self._collocation is not None

    def _collocation_over(self, ahead: float) -> Collocation | None:
        """Return a collocation step across the singular configuration, or None."""
        guess = np.tile(self._solver.f[self.n :], (NODES, 1))
        for longer in LONGER:
            collocation = collocated(
                self._accelerations,
                self.time,
                self.time + 2 * longer * ahead,
                self.state,
                guess,
                self.matrices.nominal.coordinates,
            )
            if collocation is None or not self._trusted(collocation):
                return None
            if (
                self._least_at(collocation.end, self._settled(collocation.end, collocation.last)[0])
                > CLEAR * self._least
            ):
                return self._taken(collocation)
        return None

    def _collocation_away(self) -> Collocation:
        """Return a collocation step from a singular configuration, along the velocities."""
        rank = rank_of(singular_values_at(self.matrices, self.time, self.state), NEARLY_SINGULAR)
        state, factored = settle(self.matrices, self.time, self.state, rank)
        at = self.matrices(self.time, state)
        guess = np.tile(factored.accelerations(at.force, at.curvature), (NODES, 1))
        sizes = self.matrices.nominal.coordinates
        speed = np.max(np.abs(state[self.n :]) / sizes)
        for length in FIRST_LENGTHS / speed if speed else ():
            collocation = collocated(self._accelerations, self.time, self.time + length, state, guess, sizes)
            if collocation is not None and self._trusted(collocation):
                return self._taken(collocation)
        raise HolonomError(ErrorKind.NO_WAY_ON, detail=place_and_reason(self.time, SINGULAR_START))

    def _taken(self, collocation: Collocation) -> Collocation:
        self._collocations.append(collocation)
        return collocation

    def _trusted(self, collocation: Collocation) -> bool:
        """Return True if a step is smooth to the tolerance and ends on the constraints."""
        if collocation.error(self.matrices.nominal.coordinates) > max(self.tol, COLLOCATION_ERROR):
            return False
        try:
            settled = self._settled(collocation.end, collocation.last)[0]
        except InconsistentConstraints:
            return False
        return self.matrices.nominal.share(settled - collocation.last, settled) <= OFF_BRANCH

    def _accelerations(self, times: Vector, states: Matrix) -> Matrix:
        return self._settled(times, states)[1]

    def _along_collocation(self, until: float) -> Step:
        """Step along the collocation polynomial, to its end or to a time."""
        start, collocation = self.time, self._collocation
        until = min(until, start + self._max_step)
        if until < collocation.end:
            self.time, self.state = until, collocation(np.array([until]))[:, 0]
        else:
            self._collocation = None
            self._begin(collocation.end, collocation.last)
        return Step(start, self.time, collocation)


def _is_at_boundary(solver: DOP853) -> bool:
    """Return True if the last step was as long as the method's stability allows."""
    step, last = solver.t - solver.t_old, solver.n_stages - 1
    before = solver.y_old + step * (solver.K[:last].T @ solver.A[last, :last])
    states, rates = np.linalg.norm(solver.y - before), np.linalg.norm(solver.f - solver.K[last])
    return bool(states > 0 and step * rates > BOUNDARY * states)
