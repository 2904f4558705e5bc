"""Motions of a sweep that need their own integration because of functions of time.

`holonom.simulation.time_dependence` finds the times at which steps are to end, and `holonom.simulation.constraints.
singularity` the times at which a controlled length may vanish. Both take one motion. They are evaluated once if they do
not depend on the varying parameters, else once for each set of the parameters that they depend on. Polynomials of low
degree in the time have no localized features, so they are not examined.
"""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from ..program.motion_problem import MotionProblem
from ..program.motion_program import names_in
from ..program.rewriting import with_numbers
from ..simulation.constraints.singularity import laws_of, zeros_of_controls
from ..simulation.time_dependence import (
    TimeDependence,
    largest_parts,
    time_dependence_of_motion,
    time_programs,
)
from ..simulation.time_events import DEGREE

LOW = 2  # degree in the time up to which a polynomial rises or falls all over a time span as it does at its beginning

Floats = NDArray[np.float64]


class TimeWatch:
    """A classifier of motions that batches can integrate.

    Parameters
    ----------
    problem : MotionProblem
        With open parameters.
    end : float
        The last time.
    """

    def __init__(self, problem: MotionProblem, end: float) -> None:
        self._problem, self._start, self._end = problem, float(problem.start["t"]), end
        degrees, involved = _in_time(problem)
        self._involved = [problem.parameters.index(name) for name in involved]
        self._smooth = all(degree <= LOW for degree in degrees)
        self._laws = laws_of(problem)
        self._known: dict[tuple[float, ...], tuple[bool, tuple[float, ...]]] = {}

    def look(self, values: Floats) -> tuple[NDArray[np.bool_], tuple[float, ...]]:
        """Look at motions.

        Parameters
        ----------
        values : ndarray, shape (p, k)
            Open parameters of k motions.

        Returns
        -------
        ndarray of bool, shape (k,)
            Rows to integrate one by one.
        tuple of float
            Times at which the others are to stop.
        """
        if not self._involved:
            alone, stops = self._of(values[:, 0])
            return np.full(values.shape[1], alone), stops
        chosen, first, which = np.unique(values[self._involved], axis=1, return_index=True, return_inverse=True)
        found = [self._of(values[:, place]) for place in first]
        alone = np.array([apart or bool(stops) for apart, stops in found])
        return alone[which.ravel()], ()

    def _of(self, row: Floats) -> tuple[bool, tuple[float, ...]]:
        """Return True if a motion needs its own integration, and else its stops."""
        key = tuple(row[self._involved])
        if key not in self._known:
            numbers = {name: Fraction(float(x)) for name, x in zip(self._problem.parameters, row, strict=True)}
            by_time = self._dependence(numbers)
            crossing = zeros_of_controls(replace(self._problem, values=numbers), self._laws, self._start, self._end)
            alone = bool(crossing) or by_time.end is not None or by_time.unresolved is not None
            self._known[key] = alone, by_time.stops
        return self._known[key]

    def _dependence(self, numbers: Mapping[str, Fraction]) -> TimeDependence:
        if self._smooth:
            return TimeDependence()
        return time_dependence_of_motion(
            self._problem, lambda program: with_numbers(program, numbers), self._start, self._end
        )


def _in_time(problem: MotionProblem) -> tuple[list[float], tuple[str, ...]]:
    """Return the degrees in time of the functions of time, and their parameters.

    Functions of time and parameters alone count.
    """
    known = {"t": 1} | dict.fromkeys(problem.parameters, 0)  # degrees of these functions
    within: dict[str, set[str]] = {"t": set()} | {name: {name} for name in problem.parameters}  # their parameters
    degrees, involved = [0.0], set()
    for program in time_programs(problem):
        for name, expression in (*program.assignments, *program.outputs.items()):
            for part in largest_parts(expression, known.keys()):
                if degree := DEGREE.value(part, known):
                    degrees.append(degree)
                    involved.update(*(within[each] for each in names_in(part)))
            if names_in(expression) <= known.keys():
                known[name] = DEGREE.value(expression, known)
                within[name] = set().union(*(within[each] for each in names_in(expression)))
    return degrees, tuple(name for name in problem.parameters if name in involved)
