"""Defect control: detection of localized forces that a step has missed.

The length of a step follows from the motion at its beginning or at its stages. Exponentials and high powers can be lost
to rounding there and be strong inside the step: a well of the potential that is entered and left within one step does
not even change the energy. If the equations of motion contain such functions of the state, the dense output of each
step is compared with them: in each part of it the velocities must change by the integral of the accelerations.

A step is missed if such a function acts for longer than 1/4096 of the time span and changes the velocities by more than
the tolerance allows. Engines on the motion program repeat it with half its length, and those of other engines are
reported.
"""

from collections.abc import Callable, Sequence
from functools import cached_property
from math import ceil
from typing import Any

import numpy as np

from ..program.precision import Precision
from .engines.engine import Engine, Step
from .evaluation import Numbers, as_floats
from .matrices import Vector
from .nominal import Nominal
from .quadrature import Rule, gauss_legendre, gauss_lobatto, points_for

PARTS = 1024  # of the time span: longer steps are looked at part by part
ROUNDED = 4.0  # times the last bit of a time: how far off it may be
SHORTEST = 1e-9  # of the time span: a step that is not shortened further
AT_ONCE = 64  # parts of a step

States = Callable[[Numbers], Numbers]


class DefectControl:
    """The largest difference between velocity changes and integrated accelerations.

    Parameters
    ----------
    span : number
        Length of the time span.

    Attributes
    ----------
    error : float
        Relative to the largest velocity where that is more than its nominal size.
    """

    def __init__(self, span: Any, precision: Precision) -> None:
        self._span, self._rounding = float(span), ROUNDED * float(precision.rounding)
        self._precision, self.error = precision, 0.0

    @cached_property
    def _open(self) -> Rule:
        return gauss_legendre(points_for(self._precision), self._precision)

    @cached_property
    def _closed(self) -> Rule:
        # with both ends: a step may end just behind the place where a force begins
        return gauss_lobatto(points_for(self._precision) + 2, self._precision)

    def take(self, step: Step) -> None:
        """Compare the states of a step with its accelerations if the step is long.

        Parameters
        ----------
        step : Step
            A step with its mode.
        """
        edges = self._edges(step)
        if len(edges) > 2:
            self.error = float(np.maximum(self.error, self.between(edges, step)))  # nan stays

    def errors(self, steps: Sequence[Step], states: States, engine: Engine, nominal: Nominal) -> Vector:
        """Return the error of each step.

        Parameters
        ----------
        steps : sequence of Step
            At least one.
        states : callable
            As for `Step`, for times of all the steps.
        engine : Engine
            The engine that took them.
        nominal : Nominal
            Sizes of the motion's quantities.

        Returns
        -------
        ndarray, shape (steps,)
            As `error`.
        """
        edges = [self._edges(step) for step in steps]
        starts, ends = (np.concatenate([each[place] for each in edges]) for place in (np.s_[:-1], np.s_[1:]))
        found = self._of_parts(self._closed, starts, ends, states, engine, nominal)
        return np.maximum.reduceat(found, np.cumsum([0, *(len(each) - 1 for each in edges[:-1])]))

    def between(self, edges: Numbers, step: Step) -> float:
        """Return the largest error in parts of a step.

        Parameters
        ----------
        edges : ndarray, shape (k,)
            Times between which the parts are.
        step : Step
            A step with its mode.

        Returns
        -------
        float
            As `error`.
        """
        mode = step.mode
        found = self._of_parts(self._open, edges[:-1], edges[1:], step.states, mode.engine, mode.matrices.nominal)
        return float(np.max(found, initial=0.0))

    def shortens(self, step: Step) -> bool:
        """Return True if a step is long enough to be repeated with a shorter one.

        Parameters
        ----------
        step : Step

        Returns
        -------
        bool
        """
        return float(step.end - step.start) > SHORTEST * self._span

    def _edges(self, step: Step) -> Numbers:
        """Return the times between which the parts of a step are."""
        length = step.end - step.start
        parts = max(1, ceil(float(length) / self._span * PARTS))
        return step.start + length * np.arange(parts + 1) / parts

    def _of_parts(self, rule: Rule, starts: Numbers, ends: Numbers, *given: Any) -> Vector:
        """Return the error of the velocities in each part, some parts at once."""
        pieces = [slice(first, first + AT_ONCE) for first in range(0, len(starts), AT_ONCE)]
        return np.concatenate([self._of_some(rule, starts[piece], ends[piece], *given) for piece in pieces])

    def _of_some(
        self, rule: Rule, starts: Numbers, ends: Numbers, states: States, engine: Engine, nominal: Nominal
    ) -> Vector:
        """Return the error of the velocities in each part.

        What rounding of the times makes does not count.
        """
        half = (ends - starts) / 2
        nodes, weights = rule
        times = (starts[:, None] + half[:, None] * (1 + nodes)).ravel()
        accelerations = engine.solutions(times, states(times)).accelerations
        n = len(accelerations)
        gained = half * (accelerations.reshape(n, len(half), -1) * weights).sum(axis=2)
        first, last = states(starts)[n:], states(ends)[n:]
        sizes = nominal.velocities[:, None]
        error, velocities = np.abs(as_floats(last - first - gained)) / sizes, np.abs(as_floats(last)) / sizes
        fastest = np.max(np.abs(as_floats(accelerations)).reshape(n, len(half), -1), axis=2, initial=0.0) / sizes
        rounding = self._rounding * np.abs(as_floats(ends)) * fastest
        largest = np.max(error - rounding, axis=0, initial=0.0)  # nan stays
        return largest / np.max(velocities, axis=0, initial=1.0)
