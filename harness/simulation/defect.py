"""Defect control: detection of localized forces that a step has missed.

The length of a step follows from the motion at its beginning or at its stages. Exponentials and high powers can be lost
to rounding there and be strong inside the step: a well of the potential that is entered and left within one step does
not even change the energy. If the equations of motion contain such functions of the state, the dense output of each
step is compared with them: in each part of it the velocities must change by the integral of the accelerations.

If such a function acts for longer than 1/4096 of the time span, and changes the velocities by more than the tolerance
lets expect, it is reported.
"""

from math import ceil
from typing import Any

import numpy as np
from numpy.polynomial.legendre import leggauss

from ..program.precision import Precision
from .engines.engine import Step
from .evaluation import Numbers, as_floats

PARTS = 1024  # of the time span: longer steps are looked into
AT_ONCE = 64  # parts of a step
NODES, WEIGHTS = leggauss(10)


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
        self._span = float(span)
        self._nodes, self._weights = map(precision.numbers, (NODES, WEIGHTS))
        self.error = 0.0

    def take(self, step: Step) -> None:
        """Compare the states of a step with its accelerations if the step is long.

        Parameters
        ----------
        step : Step
            A step with its mode.
        """
        length = step.end - step.start
        parts = ceil(float(length) / self._span * PARTS)
        if parts > 1:
            for first in range(0, parts, AT_ONCE):
                edges = step.start + length * np.arange(first, min(first + AT_ONCE, parts) + 1) / parts
                self.error = float(np.maximum(self.error, self.between(edges, step)))  # nan stays

    def between(self, edges: Numbers, step: Step) -> float:
        """Return the largest error of the velocities in parts of a step.

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
        half = (edges[1:] - edges[:-1]) / 2
        times = (edges[:-1, None] + half[:, None] * (1 + self._nodes)).ravel()
        accelerations = step.mode.engine.solutions(times, step.states(times)).accelerations
        n = len(accelerations)
        gained = half * (accelerations.reshape(n, len(half), -1) * self._weights).sum(axis=2)
        velocities = step.states(edges)[n:]
        sizes = step.mode.matrices.nominal.velocities[:, None]
        error = as_floats(np.diff(velocities, axis=1) - gained) / sizes
        largest = np.max(np.abs(as_floats(velocities) / sizes), initial=1.0)
        return float(np.max(np.abs(error), initial=0.0) / largest)
