"""Integration of one motion of a sweep as `holonom simulate` integrates it.

It is used if a batch element is not enough: for singular configurations, switchings, redundant constraints and
localized features. A motion that cannot be integrated to its end has the message of its error.
"""

from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import NDArray

from ..program.heyoka_function import import_heyoka
from ..program.motion_problem import MotionProblem
from ..program.motion_program import Expression
from ..simulation.engines.engine import Step
from ..simulation.evaluation import in_full_vectors
from ..simulation.mode import Mode
from ..simulation.request import SimulationRequest
from ..simulation.result import Report
from ..simulation.simulate import integrate
from .extremes import Steps
from .quantities import expressions_of, observed_names, solved_names

PARTS, MOST_PARTS, FINER = 4, 4096, 4  # of a step, each with a polynomial of its own; that are tried next
NODES = -np.cos(np.pi * (np.arange(9) + 0.5) / 9)  # of Chebyshev
TO_POWERS = np.linalg.inv(polynomial.polyvander(NODES, len(NODES) - 1))

Floats = NDArray[np.float64]


class SingleMotions:
    """An integrator of single motions of a problem.

    Parameters
    ----------
    along, points : sequence of Expression
        Quantities to look at along the motion, and at the times asked for.
    """

    def __init__(
        self,
        problem: MotionProblem,
        request: SimulationRequest,
        along: Sequence[Expression],
        points: Sequence[Expression],
    ) -> None:
        self._request, self._along = request, len(along)
        heyoka = import_heyoka()
        n, g = len(problem.coordinates), len(problem.multipliers)
        self._solved = len(solved_names(problem))
        fields = [f"h[{s}]" for s in range(1, n + 1)]
        fields += [f"J[{beta},{s}]" for beta in range(1, g + 1) for s in range(1, n + 1)]
        solved, observed = solved_names(problem), observed_names(problem)
        names = ["t", *problem.state, *solved, "energy", *observed, *fields, *problem.parameters]
        inputs = [heyoka.expression(f"x{place}") for place in range(len(names))]
        known = dict(zip(names, inputs, strict=True))  # ddot(u) may be among the accelerations and the controls
        quantities = expressions_of([*along, *points], known) if along or points else []
        self._quantities = in_full_vectors(heyoka.cfunc(quantities, vars=inputs, opt_level=0)) if quantities else None

    def integrate(self, problem: MotionProblem, stops: Sequence[float]) -> "SingleMotion":
        """Integrate one motion.

        Parameters
        ----------
        problem : MotionProblem
            The motion, with a number for each parameter.
        stops : sequence of float
            Times at which to evaluate the points, in the scene's unit.

        Returns
        -------
        SingleMotion

        Raises
        ------
        HolonomError
            The motion cannot be continued to the end.
        """
        look = _Look(partial(self._values, problem), self._along, stops)
        report = integrate(problem, self._request, lambda samples: None, watch=look.take)
        return look.motion(report)

    def _values(self, problem: MotionProblem, mode: Mode, times: Floats, states: Floats) -> Floats:
        """Return all quantities at states of a mode, shape (quantities, k)."""
        if self._quantities is None:
            return np.empty((0, len(times)))
        solutions = mode.engine.solutions(times, states)
        solved = np.concatenate(solutions)[: self._solved]
        observed = mode.controls(times, states), mode.outputs(times, states, solutions)
        others = np.array([mode.balance.energy(times, states), *np.concatenate(observed)])
        at = mode.matrices(times, states.T)
        fields = np.hstack([at.force, at.jacobian.reshape(len(at.force), -1)]).T
        parameters = np.repeat(np.array(problem.numbers)[:, None], len(times), axis=1)
        inputs = [times[None], states, solved, others, fields, parameters.reshape(-1, len(times))]
        return self._quantities(np.concatenate(inputs))


class SingleMotion(NamedTuple):
    """The result of one motion."""

    report: Report
    state: Floats  # shape (2n,): the last one
    points: Floats  # shape (stops, quantities): at the times asked for; after the end, as they are there
    steps: list[Steps]  # each quantity along the motion, with one element


class _Look:
    """Looks at quantities along a motion, step by step, and records states at stops."""

    def __init__(self, values: Callable[[Mode, Floats, Floats], Floats], along: int, stops: Sequence[float]) -> None:
        self._values, self._along, self._stops = values, along, stops
        self._taken: list[tuple] = []
        self._points: dict[float, Floats] = {}
        self._reached = -np.inf

    def take(self, step: Step) -> None:
        """Look at a step."""
        if self._along:
            self._taken += self._polynomials(step)
        here = np.array([stop for stop in self._stops if self._reached < stop <= step.end])
        if len(here):
            self._points |= zip(here, self._values(step.mode, here, step.states(here))[self._along :].T, strict=True)
        self._reached, self._mode = step.end, step.mode

    def motion(self, report: Report) -> SingleMotion:
        """Return the result of the motion."""
        end, state = float(report.t), np.array([*report.coordinates.values(), *report.velocities.values()])
        last = self._values(self._mode, np.array([end]), state[:, None])[self._along :, 0]
        points = np.array([self._points[stop] if stop < end else last for stop in self._stops])
        return SingleMotion(report, state, points, _steps(self._taken))

    def _polynomials(self, step: Step) -> list[tuple]:
        """Return the quantities on parts of a step so short that coefficients fall off.

        Middle, half length, coefficients.
        """
        count, found = PARTS, self._in_parts(step, PARTS)
        while count < MOST_PARTS and not all(each.resolved().all() for each in _steps(found)):
            count *= FINER
            found = self._in_parts(step, count)
        return found

    def _in_parts(self, step: Step, count: int) -> list[tuple]:
        edges = np.linspace(float(step.start), float(step.end), count + 1)
        middles, half = (edges[1:] + edges[:-1]) / 2, np.diff(edges) / 2
        times = (middles[:, None] + half[:, None] * NODES).ravel()
        values = self._values(step.mode, times, step.states(times))[: self._along]
        parts = values.reshape(self._along, count, len(NODES)) @ TO_POWERS.T
        return list(zip(middles, half, np.moveaxis(parts, 1, 0), strict=True))


def _steps(taken: list[tuple]) -> list[Steps]:
    if not taken:
        return []
    middle, half = (np.array([part[k] for part in taken])[:, None] for k in (0, 1))
    coefficients = np.moveaxis(np.array([part[2] for part in taken]), 0, 2)  # quantities, powers, steps
    return [Steps(each[:, :, None], middle, half, -1.0) for each in coefficients]
