"""Motions of the register's scenes: followed as a user would, and the plain way, for comparison.

The plain way solves the bordered system at every call and leaves an integrator to itself.
"""

import warnings
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cache
from typing import NamedTuple

import numpy as np
from mpmath import mpf
from scipy.integrate import solve_ivp

from ...files import shared
from ...language import translatable
from ...program.motion_problem import MotionProblem, motion_problem
from ...program.request import Request, Solve
from ...sandbox import Limits
from ...simulation.hard_cases import HardCase
from ...simulation.matrices import Matrix, MotionMatrices, Vector
from ...simulation.request import FINAL_STATE_ALONE, SimulationRequest
from ...simulation.simulate import simulate
from .case import Result, digits_kept, ours, theirs

EXAMPLES = shared("examples")
TOLERANCE = 1e-12  # of the plain way
PLAIN = translatable("bordered system, DOP853")
EVALUATIONS = 1_000_000  # after them it counts as stuck


class Arrived(NamedTuple):
    """Where a simulated motion ends, and what the engine says of it."""

    engine: str  # those that followed it, each once
    state: Vector  # shape (2n,): coordinates, then velocities
    # coordinates, constraint_forces: shape (n,): no constraint forces where the scene does not observe them
    coordinates: Vector
    constraint_forces: Vector
    multipliers: Vector  # shape (g,)
    residual: float  # of the constraints
    energy_error: float  # its size
    cases: tuple[HardCase, ...]


@cache
def problem(file: str, scene: str | None = None, solve: Solve = Solve.DIRECT) -> MotionProblem:
    """Return the motion of a scene among the examples; without a name, of the last one in the file."""
    return motion_problem(EXAMPLES / file, Request(scene, solve), Limits())


def simulated(motion: MotionProblem, until: float, **asked: object) -> Arrived:
    """Follow a motion with the default engine, and what else a `SimulationRequest` takes.

    Raises
    ------
    HolonomError
        The motion cannot be followed so far.
    """
    simulation = simulate(motion, SimulationRequest(until=Fraction(until), samples=FINAL_STATE_ALONE, **asked))
    report = simulation.report
    coordinates, velocities = _numbers(report.coordinates), _numbers(report.velocities)
    return Arrived(
        ", ".join(dict.fromkeys(leg.engine for leg in report.legs)),
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


def places_kept(
    quantity: str, plain: Vector, motion: Arrived, truth: Sequence[mpf], needed: float, scale: float | None = None
) -> Iterator[Result]:
    """Yield what the plain way and ours keep of the first coordinates."""
    first = slice(len(truth))
    yield theirs(PLAIN, quantity, digits_kept(plain[first], truth, scale), needed)
    yield ours(motion.engine, quantity, digits_kept(motion.coordinates[first], truth, scale), needed)


class Stuck(ArithmeticError):
    """The integrator asks for ever smaller steps."""


def plain_motion(motion: MotionProblem, until: float) -> Vector:
    """State to which SciPy's DOP853 carries the plain bordered system, without any cure of drift.

    Nans where it does not arrive.
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
