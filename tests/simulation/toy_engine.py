"""An engine of a few lines: the classical Runge-Kutta method on the motion program, its steps of one length."""

from math import ceil

import numpy as np

from holonom.simulation.engines.engine import Obstruction, Solutions, Step
from holonom.simulation.evaluation import evaluation_once
from holonom.simulation.hard_cases import Difficulty
from holonom.simulation.inputs import Inputs
from holonom.simulation.matrices import start_of

STEP = 0.01
STOPS_AT, GOES_ON_AT = 1.0, 1.5  # between these it needs another engine


class ToyEngine:
    """See `Engine`."""

    name, fixed_pivots, open_parameters = "toy", True, True
    code, compile_seconds, near_singularity, tol = "", 0.0, False, 1e-8

    def __init__(self, task):
        problem = task.problem
        self.time, self.state = start_of(problem)
        self.steps, self._n, self._g = 0, len(problem.coordinates), len(problem.multipliers)
        self._inputs, self._solve = Inputs(problem), evaluation_once(problem, problem.motion, task.request.numbers)

    @classmethod
    def comparable(cls, tol):
        return True

    @classmethod
    def expected_seconds(cls, steps, operations, tol, dense):
        return 0.0

    def restart(self, time, state):
        self.time, self.state = time, state.copy()

    def integrate(self, until, dense=True):
        while self.time < until:
            if STOPS_AT <= self.time < GOES_ON_AT:
                reason = "stopped"
                raise Obstruction(
                    self.time, Difficulty.SINGULAR_CONFIGURATION, reason, lambda t, state: t >= GOES_ON_AT
                )
            start, state, left = self.time, self.state, until - self.time
            self.time = until if left <= STEP else start + left / ceil(left / STEP)
            self.state = self._reached(start, state, self.time)
            self.steps += 1
            yield Step(start, self.time, lambda at, t=start, x=state: np.array([self._reached(t, x, s) for s in at]).T)

    def solutions(self, times, states):
        return Solutions(*np.split(self._solve(self._inputs(times, states)), [self._n, self._n + self._g]))

    def close(self):
        pass

    def _reached(self, t, state, until):
        h, rates = until - t, self._rates
        first = rates(t, state)
        second = rates(t + h / 2, state + h / 2 * first)
        third = rates(t + h / 2, state + h / 2 * second)
        return state + h / 6 * (first + 2 * (second + third) + rates(until, state + h * third))

    def _rates(self, t, state):
        return np.concatenate([state[self._n :], self._solve(self._inputs(t, state))[: self._n]])
