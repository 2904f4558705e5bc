"""Sarrus' linkage, a closed spatial mechanism with a constraint more than it needs.

Its one freedom is the angle phi of the legs with the ground: T = m l^2 (1 + 6 cos(phi)^2) phi'^2, V = 8 m g l sin(phi),
with m = l = 1.
"""

import numpy as np
from mpmath import asin, cos, findroot, mpf, quad, sin, sqrt

from ...simulation.diagnosis import HardCase
from ...simulation.matrices import MotionMatrices, Vector
from .case import Case, Extent, Findings, found, ours, required, theirs
from .digits import certified, digits_kept
from .plain import PLAIN, plain_motion
from .scenes import problem, simulated

FILE = "hard/sarrus_linkage.mac"
NEEDED = 12.0
DEPENDENT = 1e-8  # singular values of J that count as none

with certified:
    UNTIL, GRAVITY, START = mpf(3) / 10, mpf("9.81"), asin(mpf(4) / 5)


def examine(extent: Extent) -> Findings:
    """Digits of the motion, of the unique constraint forces, and of the multipliers of smallest norm."""
    phi = fallen(UNTIL)
    places, reactions = coordinates(phi), constraint_forces(phi)
    motion = simulated(problem(FILE), until=float(UNTIL))
    multipliers = least_multipliers(motion.state, reactions)
    plain = plain_motion(problem(FILE), float(UNTIL))[: len(places)]
    return found(
        theirs(PLAIN, "coordinates", digits_kept(plain, places), NEEDED),
        ours(motion.engine, "coordinates", digits_kept(motion.coordinates, places), NEEDED),
        ours(motion.engine, "constraint forces", digits_kept(motion.constraint_forces, reactions), NEEDED),
        ours(motion.engine, "least multipliers", digits_kept(motion.multipliers, multipliers), NEEDED),
        required(motion.engine, "redundancy reported", HardCase.REDUNDANT in motion.cases),
    )


@certified
def fallen(t: mpf) -> mpf:
    """Angle of the legs, released at rest: energy's conservation gives the time as a quadrature over the angle."""

    def time_to(phi: mpf) -> mpf:
        return quad(lambda x: sqrt((1 + 6 * cos(x) ** 2) / (8 * GRAVITY * (sin(START) - sin(x)))), [phi, START])

    return findroot(lambda phi: time_to(phi) - t, (START / 2, START * mpf(3) / 4))


@certified
def coordinates(phi: mpf) -> list[mpf]:
    """Coordinates of the elbows and of the table's corners."""
    c, s = cos(phi), sin(phi)
    return [-c, -1, s, 1, c, s, 0, -1, 2 * s, 1, 0, 2 * s, 0, 0, 2 * s]


@certified
def constraint_forces(phi: mpf) -> list[mpf]:
    """Mass times acceleration without gravity, of every point."""
    c, s = cos(phi), sin(phi)
    square = 8 * GRAVITY * (sin(START) - s) / (1 + 6 * c**2)
    second = (6 * c * s * square - 4 * GRAVITY * c) / (1 + 6 * c**2)
    across, up = -s * second - c * square, c * second - s * square
    elbows, corner = [-across, 0, up + GRAVITY, 0, across, up + GRAVITY], [0, 0, 2 * up + GRAVITY]
    return elbows + 3 * corner


def least_multipliers(state: Vector, forces: list[mpf]) -> Vector:
    """The multipliers of smallest norm among those that give the forces: the pseudo-inverse of J^T."""
    jacobian = MotionMatrices(problem(FILE))(float(UNTIL), state).jacobian
    return np.linalg.pinv(jacobian.T, DEPENDENT) @ np.array(forces, dtype=float)


CASE = Case(
    name="redundant spatial mechanism",
    kind=HardCase.REDUNDANT,
    truth="Sarrus' linkage reduced to the angle of its legs, a quadrature",
    examine=examine,
)
