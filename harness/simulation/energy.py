"""The balance of energy.

`MotionProblem.energy` calls the time derivative of the energy function power. Energy that was gained beyond the
integral of the power is an error of the motion (Goldstein, Poole & Safko, section 2.7).
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from ..program.motion_problem import MotionProblem
from ..program.motion_program import names_used
from ..program.precision import Precision, read_precision
from ..program.rewriting import computing
from .accuracy_check import may_hide
from .engines.engine import Step
from .evaluation import Numbers, as_floats, evaluation_once, zeros
from .inputs import Inputs
from .quadrature import gauss_legendre, points_for

LAST = 2  # coefficients of the power as a function of time that show whether it is resolved
MOST_PARTS = 1024  # of an interval
PROBES = 3  # random states that show whether power vanishes


class EnergyBalance:
    """The energy of a motion, and its input power.

    It takes times of shape (k,) and states of shape (2n, k).

    Parameters
    ----------
    multipliers : callable
        Takes these to multipliers, shape (g, k). It is called only where constraints move, and do work, or where forces
        contain multipliers.
    size : float
        Energy of the nominal velocities. Work that is a rounding error of it needs no resolution.

    Attributes
    ----------
    conservative : bool
        Whether the power vanishes: then there is nothing to integrate. Power that may hide is not taken for none.
    """

    def __init__(
        self,
        problem: MotionProblem,
        multipliers: Callable[[Numbers, Numbers], Numbers],
        precision: Precision | str = "double",
        size: float = 0.0,
    ) -> None:
        self._precision = read_precision(precision) if isinstance(precision, str) else precision
        self._evaluate = evaluation_once(problem, problem.energy, self._precision)
        self._inputs = Inputs(problem, self._precision)
        self._rows = {name: row for row, name in enumerate(problem.energy.outputs)}
        self._multipliers, self._size = multipliers, size
        self._with_multipliers = bool(problem.reacting) or _constraints_move(problem)
        power = computing(problem.energy, {"power"})
        hidden = bool(problem.tables) or may_hide(power, problem.parameters)
        self._of_time = "t" in names_used(power)
        self.conservative = (
            not self._with_multipliers and not hidden and self._without_power(2 * len(problem.coordinates))
        )

    @property
    def inner_states(self) -> int:
        """Number of states that `works` needs within an interval."""
        return 0 if self.conservative else points_for(self._precision)

    @cached_property
    def _quadrature(self) -> tuple[Numbers, Numbers]:
        """Points in [-1, 1] and weights."""
        return gauss_legendre(self.inner_states, self._precision)

    def energy(self, times: Numbers, states: Numbers) -> Numbers:
        """Return the energy function at states of the motion.

        Parameters
        ----------
        times : ndarray, shape (k,)
            Times of the states.
        states : ndarray, shape (2n, k)
            Coordinates, then velocities.

        Returns
        -------
        ndarray, shape (k,)
            Energy, in the scene's unit.
        """
        return self._output("energy", times, states, None)

    def _power(self, times: Numbers, states: Numbers) -> Numbers:
        """Return the power of non-conservative forces and controls at states."""
        return self._output(
            "power", times, states, self._multipliers(times, states) if self._with_multipliers else None
        )

    def times_between(self, starts: Sequence[Any], ends: Sequence[Any]) -> Numbers:
        """Return the times at which `works` needs the motion, interval by interval.

        Parameters
        ----------
        starts : sequence of number
            First time of each interval.
        ends : sequence of number
            Last time of each interval.

        Returns
        -------
        ndarray
            `inner_states` times for each interval, empty if the power is zero.
        """
        if self.conservative:
            return zeros(self._precision, 0)
        begins = np.array(starts)
        return (begins[:, None] + (np.array(ends) - begins)[:, None] / 2 * (1 + self._quadrature[0])).ravel()

    def parts(self, step: Step, ends: Sequence[Any]) -> list[list[Any]]:
        """Return the ends of parts of intervals, short enough for the quadrature.

        A step is as long as the state is smooth. The power as a function of the time may change faster.

        Parameters
        ----------
        step : Step
            A step. The state at its initial time is taken.
        ends : sequence of number
            Ends of the intervals, in order.

        Returns
        -------
        list of list of number
            Those of each interval. The last is the end of the interval.
        """
        if self.conservative or not self._of_time:
            return [[end] for end in ends]
        state, found = step.states(np.array([step.start])), []
        for start, end in pairwise([step.start, *ends]):
            waiting, parts = [(start, end)], []
            while waiting:
                start, end = waiting.pop()
                middle = start + (end - start) / 2
                fine = len(parts) + len(waiting) >= MOST_PARTS or self._is_resolved(start, end, state)
                if fine or not start < middle < end:
                    parts.append(end)
                else:
                    waiting += [(middle, end), (start, middle)]
            found.append(parts)
        return found

    def _is_resolved(self, start: Any, end: Any, state: Numbers) -> bool:
        """Return True if the points of an interval resolve the power at one state.

        Gauss's quadrature is exact for twice as many coefficients as there are points.
        """
        times = self.times_between([start], [end])
        power = self._power(times, np.repeat(state, len(times), axis=1))
        sizes = np.abs(as_floats((self._to_coefficients * power).sum(axis=1)))
        rounding = 10.0**-self._precision.sure_digits * self._size / float(end - start)
        enough = np.max(sizes[-LAST:]) <= max(10.0 ** (-self._precision.sure_digits / 2) * np.max(sizes), rounding)
        return bool(enough or not np.isfinite(sizes).all())

    @cached_property
    def _to_coefficients(self) -> Numbers:
        """From values at the points to coefficients of Legendre's polynomials."""
        (points, weights), ratio = self._quadrature, self._precision.ratio
        columns = [points * 0 + ratio(Fraction(1)), points]
        for k in range(2, len(points)):
            columns.append(
                ratio(Fraction(2 * k - 1, k)) * points * columns[-1] - ratio(Fraction(k - 1, k)) * columns[-2]
            )
        return np.array([ratio(Fraction(2 * k + 1, 2)) * column * weights for k, column in enumerate(columns)])

    def works(
        self, starts: Numbers, ends: Numbers, between: Sequence[tuple[Numbers, Numbers]]
    ) -> tuple[Numbers, float]:
        """Return the integrals of the power over k intervals of the motion.

        A pulse within a step may give energy and take it back.

        Parameters
        ----------
        starts, ends : ndarray, shape (k,)
            First and last time of each interval.
        between : sequence of (ndarray, ndarray)
            In all the `times_between` of these intervals, and the states at these times, shape (2n, ...).

        Returns
        -------
        works : ndarray, shape (k,)
            Work, in the scene's unit of energy.
        largest : float
            The largest in a part of an interval.
        """
        if self.conservative:
            return zeros(self._precision, len(starts)), 0.0
        times, states = (np.concatenate(each, axis=-1) for each in zip(*between, strict=True))
        power = self._power(times, states).reshape(len(starts), -1)
        parts = ((ends - starts) / 2)[:, None] * (power * self._quadrature[1])
        return parts.sum(axis=1), float(np.max(np.abs(as_floats(np.cumsum(parts, axis=1))), initial=0.0))

    def _output(self, name: str, times: Numbers, states: Numbers, multipliers: Numbers | None) -> Numbers:
        return self._evaluate(self._inputs(times, states, multipliers))[self._rows[name]]

    def _without_power(self, size: int) -> bool:
        """Return True if no force or constraint does work at probe states."""
        drawn = self._precision.numbers(np.random.default_rng(0).uniform(-1, 1, (size + 1) * PROBES))
        times, *states = drawn.reshape(size + 1, PROBES)
        return not any(self._output("power", times, np.array(states), None))


def _constraints_move(problem: MotionProblem) -> bool:
    """Return True if time, a control or a servo-constraint moves a constraint."""
    if problem.servo.constraints:
        return True
    residuals_alone = {name for name in problem.matrices.outputs if name.startswith("residual[")}
    return "t" in names_used(computing(problem.matrices, residuals_alone))
