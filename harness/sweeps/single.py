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

from ..failures import HolonomError
from ..program.heyoka_function import import_heyoka
from ..program.motion_problem import MotionProblem
from ..program.motion_program import Expression
from ..program.precision import read_precision
from ..simulation.engines.engine import Step
from ..simulation.evaluation import in_full_vectors
from ..simulation.events import STAY, Events, Sides
from ..simulation.mode import Mode
from ..simulation.request import SimulationRequest
from ..simulation.result import Report
from ..simulation.simulate import integrate
from .extremes import RESOLVED, Steps, zeros_with_end
from .polynomials import LAST
from .quantities import expressions_of, observed_names, solved_names

PARTS, MOST_PARTS = 4, 4096  # of a step, each with a polynomial of its own, and of a part that is too long; at most
NODES = -np.cos(np.pi * (np.arange(9) + 0.5) / 9)  # of Chebyshev
DOUBLE = read_precision("double")
TO_POWERS = np.linalg.inv(polynomial.polyvander(NODES, len(NODES) - 1))
ROUNDED = np.finfo(float).eps * np.abs(TO_POWERS[-LAST:]).sum(axis=1).max()  # of a time, in the last coefficients

Floats = NDArray[np.float64]


class SingleMotions:
    """An integrator of single motions of a problem.

    Parameters
    ----------
    along, zeros, points : sequence of Expression
        Quantities to look at along the motion, to find the first zero of, and to record at the times asked for.
    """

    def __init__(
        self,
        problem: MotionProblem,
        request: SimulationRequest,
        along: Sequence[Expression],
        zeros: Sequence[Expression],
        points: Sequence[Expression],
    ) -> None:
        self._request, self._counts = request, (len(along), len(zeros))
        heyoka = import_heyoka()
        n, g = len(problem.coordinates), len(problem.multipliers)
        self._solved = len(solved_names(problem))
        fields = [f"h[{s}]" for s in range(1, n + 1)]
        fields += [f"J[{beta},{s}]" for beta in range(1, g + 1) for s in range(1, n + 1)]
        solved, observed = solved_names(problem), observed_names(problem)
        names = ["t", *problem.state, *solved, "energy", *observed, *fields, *problem.parameters]
        inputs = [heyoka.expression(f"x{place}") for place in range(len(names))]
        known = dict(zip(names, inputs, strict=True))  # ddot(u) may be among the accelerations and the controls
        quantities = expressions_of([*along, *zeros, *points], known) if along or zeros or points else []
        self._quantities = in_full_vectors(heyoka.cfunc(quantities, vars=inputs, opt_level=0)) if quantities else None

    def integrate(self, problem: MotionProblem, stops: Sequence[float]) -> "SingleMotion":
        """Integrate one motion.

        Parameters
        ----------
        problem : MotionProblem
            The motion, with a number for each parameter.
        stops : sequence of float
            Times at which to evaluate the points, in the scene's unit. The last is the end.

        Returns
        -------
        SingleMotion

        Raises
        ------
        HolonomError
            The motion cannot be continued to the end.
        """
        span = stops[-1] - float(problem.start["t"])
        look = _Look(partial(self._values, problem), *self._counts, stops, span)
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
    zeros: Floats  # shape (zeros,): the first time of each, nan without one, inf where it has no value before


class _Look:
    """Looks at quantities along a motion, step by step, and records states at stops."""

    def __init__(
        self,
        values: Callable[[Mode, Floats, Floats], Floats],
        along: int,
        zeros: int,
        stops: Sequence[float],
        span: float,
    ) -> None:
        self._values, self._along, self._stops, self._span = values, along, stops, span
        self._zeros, self._sides = np.full(zeros, np.nan), [Sides() for _ in range(zeros)]
        self._sizes = np.zeros(zeros)  # largest values at the ends of steps
        self._taken: list[tuple] = []
        self._points: dict[float, Floats] = {}
        self._reached, self._mode = -np.inf, None

    def take(self, step: Step) -> None:
        """Look at a step."""
        if self._mode is not step.mode:
            self._mode, self._events = step.mode, [self._crossings(step.mode, k) for k in range(len(self._zeros))]
        if self._along:
            self._taken += self._polynomials(step)
        for place in np.flatnonzero(np.isnan(self._zeros)):
            try:
                found = self._events[place].first_event(step, self._sides[place])
            except HolonomError:
                self._zeros[place] = np.inf
            else:
                self._zeros[place] = np.nan if found is None else found.t
        if len(self._zeros):
            ends = np.array([step.start, step.end], dtype=float)
            met = np.abs(self._at(ends, step.states(ends))[: len(self._zeros)])
            self._sizes = np.max([self._sizes, *met.T], axis=0)
        here = np.array([stop for stop in self._stops if self._reached < stop <= step.end])
        if len(here):
            self._points |= zip(here, self._at(here, step.states(here))[len(self._zeros) :].T, strict=True)
        self._reached = step.end

    def motion(self, report: Report) -> SingleMotion:
        """Return the result of the motion."""
        end, state = float(report.t), np.array([*report.coordinates.values(), *report.velocities.values()])
        crossing, last = np.split(self._at(np.array([end]), state[:, None])[:, 0], [len(self._zeros)])
        points = np.array([self._points[stop] if stop < end else last for stop in self._stops])
        zero = end if report.ending is not None and report.ending.crossed is not None else np.nan
        zeros = zeros_with_end(self._zeros, zero, crossing, self._sizes)
        return SingleMotion(report, state, points, _steps(self._taken), zeros)

    def _at(self, times: Floats, states: Floats) -> Floats:
        """Return quantities with zeros and those to record, shape (quantities, k)."""
        return self._values(self._mode, times, states)[self._along :]

    def _crossings(self, mode: Mode, place: int) -> Events:
        """Return the zeros of a quantity in a mode."""
        row = [self._along + place]

        def values(times: Floats, states: Floats) -> Floats:
            return self._values(mode, times, states)[row]

        return Events([str(place)], values, DOUBLE, self._span, STAY)

    def _polynomials(self, step: Step) -> list[tuple]:
        """Return the quantities on parts of a step so short that coefficients fall off.

        Parts are not shorter than the rounding of the time allows. Middle, half length, coefficients.
        """
        half = float(step.end - step.start) / 2 / PARTS
        middles, count = float(step.start) + half * np.arange(1, 2 * PARTS, 2), 0
        found, sizes = [], np.zeros((self._along, 1))
        while len(middles):
            coefficients = self._in_parts(step, middles, half)
            sizes = np.maximum(sizes, np.abs(coefficients[..., 0]).max(axis=1)[:, None])  # of values
            last, changes = (
                np.abs(coefficients[..., some]).max(axis=2) for some in (slice(-LAST, None), slice(1, None))
            )
            coarse = (last > np.maximum(RESOLVED * sizes, ROUNDED * np.abs(middles) / half * changes)).any(axis=0)
            count += len(middles)
            coarse &= count + PARTS * coarse.sum() <= MOST_PARTS
            fine = np.moveaxis(coefficients, 1, 0)[~coarse]
            found += zip(middles[~coarse], np.full(len(fine), half), fine, strict=True)
            half /= PARTS
            middles = (middles[coarse, None] + half * np.arange(1 - PARTS, PARTS, 2)).ravel()
        return found

    def _in_parts(self, step: Step, middles: Floats, half: float) -> Floats:
        """Return coefficients on parts of a step, shape (quantities, parts, powers)."""
        times = (middles[:, None] + half * NODES).ravel()
        values = self._values(step.mode, times, step.states(times))[: self._along]
        return values.reshape(self._along, len(middles), len(NODES)) @ TO_POWERS.T


def _steps(taken: list[tuple]) -> list[Steps]:
    if not taken:
        return []
    middle, half = (np.array([part[k] for part in taken])[:, None] for k in (0, 1))
    coefficients = np.moveaxis(np.array([part[2] for part in taken]), 0, 2)  # quantities, powers, steps
    return [Steps(each[:, :, None], middle, half, -1.0) for each in coefficients]
