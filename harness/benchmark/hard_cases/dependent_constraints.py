"""Constraints that are nearly or exactly dependent: a swing, and Sarrus' linkage.

The rods of the swing become parallel. For any distance of its hinges the bob moves on a circle, as a pendulum does.

Sarrus' linkage is a closed spatial mechanism with one redundant constraint. Its one degree of freedom is the angle phi
of the legs with the ground: T = m l^2 (1 + 6 cos(phi)^2) phi'^2, V = 8 m g l sin(phi), with m = l = 1.
"""

import numpy as np
from mpmath import asin, cos, findroot, mpf, quad, sin, sqrt

from ...language import translatable
from ...simulation.hard_cases import Difficulty
from ...simulation.matrices import MotionMatrices, Vector
from .case import Extent, Findings, Sweep, certified, correct_digits, holonom_result, required
from .runs import baseline_motion, place_digits, problem, simulated
from .solves import SolveAt, every_solve, solve_digits

ANGLES = tuple(10.0**-k for k in range(1, 12))  # between the rods, of length 1: the hinges are as far apart
COMPARED_ANGLE = 1e-7

SIDEWAYS, SLANTING = np.array([2, 1, -2]) / 3, np.array([2, -2, 1]) / 3  # span the plane of the circle
WEIGHT = np.array([0, 0, -9.81])
PLACES, RATE = (0.3, 1.1, 2.9), 0.7  # on the circle, in radians, and per second


def parallel_constraints(extent: Extent) -> Findings:
    """Yield digits of the accelerations by each solve, against the pendulum's.

    Parameters
    ----------
    extent : Extent
        Without effect. The case has no motion.

    Yields
    ------
    Result or Sweep
        A method's digits, or digits by the angle between the constraints.
    """
    solves = every_solve("hard/swing.mac")
    digits = {name: tuple(_worst(solve, angle) for angle in ANGLES) for name, solve in solves.items()}
    there = {name: row[ANGLES.index(COMPARED_ANGLE)] for name, row in digits.items()}
    yield from solve_digits(
        translatable("accelerations at the angle %(angle)g", angle=COMPARED_ANGLE), there, needed=8.0
    )
    yield Sweep(translatable("angle between the constraints"), ANGLES, digits)


def _worst(solve: SolveAt, angle: float) -> float:
    """Return the least correct digits of the accelerations over places on the circle."""
    digits = []
    for place in PLACES:
        outward = SIDEWAYS * np.cos(place) + SLANTING * np.sin(place)
        along = SLANTING * np.cos(place) - SIDEWAYS * np.sin(place)
        state = np.concatenate([outward, RATE * along])
        pendulum = (WEIGHT @ along) * along - RATE**2 * outward  # gravity along the circle, and towards its centre
        digits.append(correct_digits(solve(angle, state).accelerations, pendulum))
    return min(digits)


SARRUS = "hard/sarrus_linkage.mac"

with certified:
    UNTIL, GRAVITY, START = mpf(3) / 10, mpf("9.81"), asin(mpf(4) / 5)


def sarrus_linkage(extent: Extent) -> Findings:
    """Yield digits of the motion, of the unique constraint forces and of multipliers.

    Multipliers of redundant constraints are zero.

    Parameters
    ----------
    extent : Extent
        Without effect. The motion is short.

    Yields
    ------
    Result or Sweep
        A method's digits.
    """
    phi, needed = fallen(UNTIL), 12.0
    places, reactions = coordinates(phi), constraint_forces(phi)
    motion, baseline = simulated(problem(SARRUS), float(UNTIL)), baseline_motion(problem(SARRUS), float(UNTIL))
    multipliers = chosen_multipliers(motion.state, reactions)
    yield from place_digits(translatable("coordinates"), baseline, motion, places, needed)
    yield holonom_result(
        motion.engine, translatable("constraint forces"), correct_digits(motion.constraint_forces, reactions), needed
    )
    yield holonom_result(
        motion.engine, translatable("multipliers"), correct_digits(motion.multipliers, multipliers), needed
    )
    yield required(motion.engine, translatable("redundancy reported"), Difficulty.REDUNDANT in motion.cases)


@certified
def fallen(t: mpf) -> mpf:
    """Return the angle of the legs, released at rest.

    By conservation of energy, the time is a quadrature over the angle.

    Parameters
    ----------
    t : mpf
        Time since the release, in seconds.

    Returns
    -------
    mpf
        The angle phi, in radians.
    """

    def time_to(phi: mpf) -> mpf:
        return quad(lambda x: sqrt((1 + 6 * cos(x) ** 2) / (8 * GRAVITY * (sin(START) - sin(x)))), [phi, START])

    return findroot(lambda phi: time_to(phi) - t, (START / 2, START * mpf(3) / 4))


@certified
def coordinates(phi: mpf) -> list[mpf]:
    """Return the coordinates of the elbows and of the table's corners.

    Parameters
    ----------
    phi : mpf
        Angle of the legs with the ground, in radians.

    Returns
    -------
    list of mpf, shape (15,)
        x, y and z of five points.
    """
    c, s = cos(phi), sin(phi)
    return [-c, -1, s, 1, c, s, 0, -1, 2 * s, 1, 0, 2 * s, 0, 0, 2 * s]


@certified
def constraint_forces(phi: mpf) -> list[mpf]:
    """Return mass times acceleration without gravity, of every point.

    Parameters
    ----------
    phi : mpf
        Angle of the legs with the ground, in radians.

    Returns
    -------
    list of mpf, shape (15,)
        Components of five forces.
    """
    c, s = cos(phi), sin(phi)
    square = 8 * GRAVITY * (sin(START) - s) / (1 + 6 * c**2)
    second = (6 * c * s * square - 4 * GRAVITY * c) / (1 + 6 * c**2)
    across, up = -s * second - c * square, c * second - s * square
    elbows, corner = [-across, 0, up + GRAVITY, 0, across, up + GRAVITY], [0, 0, 2 * up + GRAVITY]
    return elbows + 3 * corner


def chosen_multipliers(state: Vector, forces: list[mpf]) -> Vector:
    """Return the multipliers of the forces that are zero for redundant constraints.

    Parameters
    ----------
    state : Vector, shape (2n,)
        Coordinates and velocities at the end of the motion.
    forces : list of mpf, shape (n,)
        Constraint forces.

    Returns
    -------
    Vector, shape (g,)
    """
    independent = list(problem(SARRUS).independent)
    jacobian = MotionMatrices(problem(SARRUS)).independent(float(UNTIL), state).jacobian
    multipliers = np.zeros(len(problem(SARRUS).multipliers))
    multipliers[independent] = np.linalg.lstsq(jacobian.T, np.array(forces, dtype=float))[0]
    return multipliers
