"""Matrix of the controls of servo-constraints, and its rank along a motion.

The controls solve M u = r. M is examined along the whole motion like a switching function: the determinant of as many
of its rows as there are controls is evaluated. If it changes its sign or touches zero, the rank of M decides.
"""

import numpy as np

from ..program.motion_problem import MotionProblem
from ..program.motion_program import names_in
from ..program.precision import Precision
from .engines.engine import Step
from .evaluation import Numbers, as_floats, evaluation_once
from .inputs import Inputs
from .matrices import INDEXED, Vector
from .zeros import BETWEEN, TO_COEFFICIENTS, SignedFunctions, minima

TOUCHED = 1e-9  # of a determinant's largest size nearby: a minimum that is a zero
ZERO = 1e-14  # of the same: a zero at a sample
LOST = 1e-3  # of the least singular value nearby: rank is lost
BEHIND = 1e-9  # of the part that is looked at: how far behind a zero of the determinant alone to continue


def controls_may_fail(problem: MotionProblem) -> bool:
    """Return True if servo-constraints find controls by a matrix that changes.

    Parameters
    ----------
    problem : MotionProblem
        The motion.

    Returns
    -------
    bool
    """
    if problem.servo.matrix is None:
        return False
    known = {*problem.parameters}
    for name, expression in problem.servo.matrix.assignments:
        if names_in(expression) <= known:
            known.add(name)
    return any(not names_in(value) <= known for value in problem.servo.matrix.outputs.values())


class ControlMatrix(SignedFunctions):
    """The matrix of the controls of servo-constraints along one mode of a motion.

    Parameters
    ----------
    problem : MotionProblem
        With servo-constraints, without signs.
    span : float
        Length of the time span.
    """

    def __init__(self, problem: MotionProblem, precision: Precision, span: float) -> None:
        super().__init__(precision, span)
        places = [INDEXED.fullmatch(name).groups()[1:] for name in problem.servo.matrix.outputs]
        self._shape = tuple(max(map(int, numbers)) for numbers in zip(*places, strict=True))
        self._inputs = Inputs(problem, precision)
        self._evaluate = evaluation_once(problem, problem.servo.matrix, precision)
        self._matrix_rows: Vector | None = None  # the rows whose determinant is computed along the motion
        self._scale: Numbers | float = 1.0  # of each row

    def lost(self, step: Step) -> float | None:
        """Return the first time of a step at which the matrix loses rank, or None.

        Parameters
        ----------
        step : Step
            A step of the mode.

        Returns
        -------
        float or None
        """
        while True:
            self._choose_rows(step)
            found = self._first_zero(step)
            if found is None:
                return None
            zero, nearby = found
            if self._loses_rank(zero, nearby, step):
                return zero
            behind = zero + self._precision.number(repr(BEHIND * float(nearby.end - nearby.start)))
            if not behind < step.end:
                return None
            step = step._replace(start=behind)

    def values(self, times: Numbers, states: Numbers) -> Numbers:
        """Return the determinant of the rows that are watched.

        Parameters
        ----------
        times : ndarray, shape (k,)
            Times of the states.
        states : ndarray, shape (2n, k)
            Coordinates, then velocities.

        Returns
        -------
        ndarray, shape (1, k)
        """
        return np.linalg.det(self._matrices(times, states)[:, self._matrix_rows])[None]

    def _matrices(self, times: Numbers, states: Numbers) -> Numbers:
        found = as_floats(np.array(self._evaluate(self._inputs(times, states))))
        return found.T.reshape(-1, *self._shape) / self._scale

    def _choose_rows(self, step: Step) -> None:
        """Choose the rows with the largest pivots at the beginning of a step."""
        from scipy.linalg import qr

        at = np.array([step.start])
        self._scale = 1.0
        matrix = self._matrices(at, step.states(at))[0]
        if not np.isfinite(matrix).all():
            matrix = np.ones(self._shape)
        sizes = np.max(np.abs(matrix), axis=1, keepdims=True)
        self._scale = np.where(sizes > 0, sizes, 1.0)
        self._matrix_rows = np.sort(qr((matrix / self._scale).T, mode="r", pivoting=True)[1][: self._shape[1]])

    def _first_zero(self, step: Step) -> tuple[float, Step] | None:
        """Return the first zero of the determinant in a step, and the part around it."""
        self._rows = [("", -1, 1)]
        for part, places, values in self._looked_at(step):
            zeros = [t for t in self._zeros_in(part, places, values[0]) if t is not None]
            if zeros:
                return min(zeros), part
        return None

    def _zeros_in(self, part: Step, places: Numbers, values: Vector) -> list[float | None]:
        """Return candidates for zeros: samples, changes of sign, minima between samples."""
        largest = float(np.max(np.abs(values), where=np.isfinite(values), initial=0.0))
        near_zero = np.flatnonzero(np.abs(values) <= ZERO * largest)
        changes = np.flatnonzero(values[:-1] * values[1:] < 0)
        return [
            *(places[i] for i in near_zero[:1]),
            *(self._changed(part, places[i], places[i + 1]) for i in changes[:1]),
            *(self._touched(part, place, places, values, largest) for place in _minima(values)),
        ]

    def _changed(self, part: Step, before: float, after: float) -> float | None:
        """Return the sign change of the determinant between two times.

        None where it does so through infinity.
        """
        side = 1 if self._value(part, before) > 0 else -1
        bound = max(abs(self._value(part, t)) for t in (before, after))
        zero = self._last_inside(lambda at: side * self.values(at, part.states(at))[0], before, after)
        return zero if abs(self._value(part, zero)) <= bound else None

    def _touched(self, part: Step, place: float, places: Numbers, values: Vector, largest: float) -> float | None:
        """Return a minimum of the determinant's size if it is zero, or the zero before it."""
        time = part.start + (part.end - part.start) * self._precision.number(repr(float(place)))
        value = self._value(part, time)
        before = places[places <= time][-1]
        if value * self._value(part, before) < 0:
            return self._changed(part, before, time)
        return time if abs(value) <= TOUCHED * largest else None

    def _value(self, part: Step, time: float) -> float:
        at = np.array([time])
        return float(self.values(at, part.states(at))[0, 0])

    def _loses_rank(self, zero: float, nearby: Step, step: Step) -> bool:
        """Return True if the rank of the matrix at a zero is less than nearby."""
        around = np.array([zero, nearby.start, (nearby.start + nearby.end) / 2, nearby.end])
        matrices = self._matrices(around, step.states(around))
        here, *others = (float(np.linalg.svd(each, compute_uv=False)[-1]) for each in matrices)
        return here <= LOST * max(others)


def _minima(values: Vector) -> list[float]:
    """Return places between 0 and 1 of the minima of a function's size.

    They are found by the polynomial through its samples.
    """
    inner = values[1:-1]
    if not np.isfinite(inner).all() or np.min(np.abs(inner)) > np.ptp(inner):
        return []
    coefficients = TO_COEFFICIENTS @ inner
    return [(1 + place) / 2 for _, place in minima(coefficients, np.abs(BETWEEN @ coefficients), above_zero=False)]
