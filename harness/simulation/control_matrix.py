"""Matrix of the controls of servo-constraints, and its rank along a motion.

The controls solve M u = r. The determinant of as many rows of M as there are controls is examined along the whole
motion, as switching functions are (`zeros.py`). If it changes its sign or touches zero, the rank of M decides.
"""

import numpy as np

from ..program.motion_problem import MotionProblem
from ..program.motion_program import names_used
from ..program.precision import Precision
from ..program.rewriting import computing
from .constraints.directions import or_one
from .engines.engine import Step
from .evaluation import Numbers, as_floats, evaluation_once
from .inputs import Inputs
from .matrices import INDEXED, Vector
from .zeros import PARTS, SignedFunctions

LOST = 1e-3  # of the least singular value nearby: rank is lost
BEHIND = 1e-9  # of the time nearby: how far behind a zero of the determinant alone to continue


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
    matrix = problem.servo.matrix
    if matrix is None:
        return False
    return bool(names_used(computing(matrix, matrix.outputs)) & set(matrix.inputs) - set(problem.parameters))


class ControlMatrix(SignedFunctions):
    """The matrix of the controls of servo-constraints along one mode of a motion.

    Parameters
    ----------
    problem : MotionProblem
        With servo-constraints, without signs.
    span : float
        Length of the time span.
    """

    touching = 1e-9

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
        step = step._replace(block=None)  # each step has its rows
        while True:
            self._choose_rows(step)
            zero = self.first_crossing(step, {})
            if zero is None:
                return None
            if self._loses_rank(zero.t, step):
                return zero.t
            behind = self._moved(zero.t, step, BEHIND)
            if not zero.t < behind < step.end:
                return None
            step = step._replace(start=behind)

    def values(self, times: Numbers, states: Numbers) -> Numbers:
        """Return the determinant of the chosen rows (see `SignedFunctions.values`)."""
        ((*_, side),) = self._rows
        return side * np.linalg.det(self._matrices(times, states)[:, self._matrix_rows])[None]

    def _matrices(self, times: Numbers, states: Numbers) -> Numbers:
        found = as_floats(np.array(self._evaluate(self._inputs(times, states))))
        return found.T.reshape(-1, *self._shape) / self._scale

    def _choose_rows(self, step: Step) -> None:
        """Choose the rows with the largest pivots at the beginning of a step.

        Their sizes nearby weigh them.
        """
        from scipy.linalg import qr

        at = np.array([step.start, self._moved(step.start, step, 1)])
        self._scale = 1.0
        matrices = self._matrices(at, step.states(at))
        matrices = np.where(np.isfinite(matrices).all(axis=(1, 2), keepdims=True), matrices, 1.0)
        self._scale = or_one(np.max(np.abs(matrices), axis=(0, 2))[:, None])
        first = matrices[0] / self._scale
        self._matrix_rows = np.sort(qr(first.T, mode="r", pivoting=True)[1][: self._shape[1]])
        side = -1 if np.linalg.det(first[self._matrix_rows]) < 0 else 1
        self._rows, self._sizes = [("determinant", -side, side)], {}

    def _moved(self, t: float, step: Step, share: float) -> float:
        """Return a time of a step that is later by a share of what is nearby."""
        nearby = min(self._span / PARTS, float(step.end - step.start))
        return min(max(t + self._precision.number(repr(share * nearby)), step.start), step.end)

    def _loses_rank(self, zero: float, step: Step) -> bool:
        """Return True if the rank of the matrix at a zero is less than nearby."""
        around = np.array([self._moved(zero, step, share) for share in (0, -1, 1)])
        here, *others = np.linalg.svd(self._matrices(around, step.states(around)), compute_uv=False)[:, -1]
        return bool(here <= LOST * max(others))
