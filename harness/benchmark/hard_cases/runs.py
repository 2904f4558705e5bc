"""Motions of the hard cases: by Holonom and by a baseline method.

The baseline solves the bordered system at every call and has no stabilization.
"""

import warnings
from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import cache
from typing import NamedTuple

import numpy as np

from ...files import shared
from ...language import translatable
from ...program.motion_problem import MotionProblem, motion_problem
from ...program.request import Request, Solve
from ...sandbox import Limits
from ...simulation.hard_cases import Difficulty
from ...simulation.matrices import Matrix, MotionMatrices, Vector, start_of
from ...simulation.request import FINAL_STATE_ALONE, SimulationRequest
from ...simulation.simulate import simulate
from .case import Result, correct_digits, graded

EXAMPLES = shared("examples")
TOLERANCE = 1e-12  # of the baseline
BASELINE = translatable("bordered system, DOP853")
EVALUATIONS = 1_000_000  # after them it counts as stuck


class Arrived(NamedTuple):
    """The final state of a simulated motion, and the report on it."""

    engine: str  # those that integrated it, each once
    state: Vector  # shape (2n,): coordinates, then velocities
    # coordinates, constraint_forces: shape (n,): no constraint forces where the scene does not observe them
    coordinates: Vector
    constraint_forces: Vector
    multipliers: Vector  # shape (g,)
    residual: float  # of the constraints
    energy_error: float  # its size
    cases: tuple[Difficulty, ...]


@cache
def problem(file: str, scene: str | None = None, solve: Solve = Solve.DIRECT) -> MotionProblem:
    """Return the motion of a scene of the examples, by default of the last scene.

    Parameters
    ----------
    file : str
        Path below the folder of examples.
    scene : str or None
        Name of the scene, or None for the file's last one.
    solve : Solve
        Solve for the multipliers.

    Returns
    -------
    MotionProblem
        The motion, cached for later calls.
    """
    return motion_problem(EXAMPLES / file, Request(scene, solve), Limits())


def simulated(motion: MotionProblem, until: float, **asked: object) -> Arrived:
    """Integrate a motion with the default engine and further fields of the request.

    Parameters
    ----------
    motion : MotionProblem
    until : float
        Final time, in the scene's unit.
    **asked : object
        Further fields of `SimulationRequest`.

    Returns
    -------
    Arrived
        The final state.

    Raises
    ------
    HolonomError
        The motion cannot be continued so far.
    """
    simulation = simulate(motion, SimulationRequest(until=Fraction(until), samples=FINAL_STATE_ALONE, **asked))
    report = simulation.report
    coordinates, velocities = _numbers(report.coordinates), _numbers(report.velocities)
    return Arrived(
        ", ".join(dict.fromkeys(segment.engine for segment in report.segments)),
        np.concatenate([coordinates, velocities]),
        coordinates,
        _numbers({name: forces[-1] for name, forces in simulation.constraint_forces.items()}),
        _numbers(report.multipliers),
        report.residuals["position"],
        abs(report.energy_error),
        report.cases,
    )


def _numbers(values: Mapping[str, float]) -> Vector:
    return np.array([float(value) for value in values.values()])


def place_digits(
    quantity: str, baseline: Vector, motion: Arrived, truth: list[float], needed: float, scale: float | None = None
) -> Iterator[Result]:
    """Yield the digits of the first coordinates, by the baseline and by Holonom.

    Parameters
    ----------
    quantity : str
        Name of the quantity.
    baseline : Vector, shape (2n,)
        Final state by the baseline.
    motion : Arrived
        Final state by Holonom.
    truth : list of float
        True values of the first coordinates.
    needed : float
        Number of correct digits required of Holonom.
    scale : float or None
        Size to which errors are relative, or None for the largest true value.

    Yields
    ------
    Result
        One method's digits.
    """
    first = slice(len(truth))
    yield graded(BASELINE, quantity, correct_digits(baseline[first], truth, scale), needed, compared=True)
    yield graded(motion.engine, quantity, correct_digits(motion.coordinates[first], truth, scale), needed)


class Stuck(ArithmeticError):
    """The integrator asks for ever smaller steps."""


def baseline_motion(motion: MotionProblem, until: float) -> Vector:
    """Integrate the bordered system by SciPy's DOP853 without stabilization.

    Parameters
    ----------
    motion : MotionProblem
    until : float
        Final time, in the scene's unit.

    Returns
    -------
    Vector, shape (2n,)
        The last state, nan if the integration fails.
    """
    from scipy.integrate import solve_ivp

    matrices, n = MotionMatrices(motion), len(motion.coordinates)
    left = iter(range(EVALUATIONS))

    def rate(t: float, state: Vector) -> Vector:
        if next(left, None) is None:
            raise Stuck
        return np.concatenate([state[n:], _bordered_accelerations(*matrices(t, state)[:4])])

    begin, start = start_of(motion)
    try:
        with warnings.catch_warnings(action="ignore"):
            found = solve_ivp(rate, (begin, until), start, "DOP853", rtol=TOLERANCE, atol=TOLERANCE)
    except (Stuck, np.linalg.LinAlgError):
        return np.full(2 * n, np.nan)
    return found.y[:, -1] if found.success else np.full(2 * n, np.nan)


def _bordered_accelerations(A: Matrix, h: Vector, J: Matrix, c: Vector) -> Vector:
    """Return the accelerations from A a - J^T lambda = h and J a = -c."""
    n, size = len(A), len(A) + len(J)
    bordered = np.zeros((size, size))
    bordered[:n, :n], bordered[:n, n:], bordered[n:, :n] = A, -J.T, J
    return np.linalg.solve(bordered, np.concatenate([h, -c]))[:n]
