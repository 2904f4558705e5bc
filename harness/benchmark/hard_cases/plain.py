"""The plain way, for comparison: the bordered system solved at every call, and an integrator left to itself."""

import warnings

import numpy as np
from scipy.integrate import solve_ivp

from ...program.motion_problem import MotionProblem
from ...simulation.matrices import Matrix, MotionMatrices, Vector

TOLERANCE = 1e-12
PLAIN = "bordered system, DOP853"
EVALUATIONS = 1_000_000  # after them it counts as stuck


class Stuck(ArithmeticError):
    """The integrator asks for ever smaller steps."""


def plain_motion(motion: MotionProblem, until: float) -> Vector:
    """State to which SciPy's DOP853 carries the plain bordered system, without any cure of drift.

    Returns
    -------
    ndarray, shape (2n,)
        Coordinates, then velocities; nans where it does not arrive.
    """
    matrices, n = MotionMatrices(motion), len(motion.coordinates)
    left = iter(range(EVALUATIONS))

    def rate(t: float, state: Vector) -> Vector:
        if next(left, None) is None:
            raise Stuck
        return np.concatenate([state[n:], bordered_accelerations(*matrices(t, state)[:4])])

    start = np.array([float(motion.start[name]) for name in motion.state])
    span = (float(motion.start["t"]), until)
    try:
        with warnings.catch_warnings(action="ignore"):
            found = solve_ivp(rate, span, start, "DOP853", rtol=TOLERANCE, atol=TOLERANCE)
    except (Stuck, np.linalg.LinAlgError):
        return np.full(2 * n, np.nan)
    return found.y[:, -1] if found.success else np.full(2 * n, np.nan)


def bordered_accelerations(A: Matrix, h: Vector, J: Matrix, c: Vector) -> Vector:
    """Accelerations from [A -J^T; J 0] (a, lambda) = (h, -c)."""
    n, size = len(A), len(A) + len(J)
    bordered = np.zeros((size, size))
    bordered[:n, :n], bordered[:n, n:], bordered[n:, :n] = A, -J.T, J
    return np.linalg.solve(bordered, np.concatenate([h, -c]))[:n]
