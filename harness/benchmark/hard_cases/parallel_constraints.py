"""Two constraints that become parallel: the rods of a swing, hung from hinges that come together.

However near the hinges are, the bob moves on the circle that both rods leave to it, as a pendulum does.
"""

from math import cos, sin

import numpy as np

from ...simulation.diagnosis import HardCase
from ...simulation.matrices import Vector
from .case import Case, Extent, Findings, Sweep, ours, theirs
from .digits import digits_kept
from .solves import DIRECT, ORTHOGONAL, PIVOTED, TEXTBOOK, SolveAt, every_solve

FILE = "hard/swing.mac"
ANGLES = tuple(10.0**-k for k in range(1, 12))  # between the rods, of length 1: the hinges are as far apart
JUDGED = 1e-7
NEEDED = 8.0  # digits of the accelerations at that angle

SIDEWAYS, SLANTING = np.array([2, 1, -2]) / 3, np.array([2, -2, 1]) / 3  # span the plane of the circle
GRAVITY = np.array([0, 0, -9.81])
PLACES, RATE = (0.3, 1.1, 2.9), 0.7  # on the circle, in radians, and per second


def examine(extent: Extent) -> Findings:
    """Digits of the accelerations by each solve, against the pendulum's."""
    digits = {name: tuple(worst(solve, angle) for angle in ANGLES) for name, solve in every_solve(FILE).items()}
    judged = {name: row[ANGLES.index(JUDGED)] for name, row in digits.items()}
    quantity = f"accelerations at the angle {JUDGED:g}"
    return Findings(
        (
            theirs(TEXTBOOK, quantity, judged[TEXTBOOK], NEEDED),
            theirs(DIRECT, quantity, judged[DIRECT], NEEDED),
            ours(ORTHOGONAL, quantity, judged[ORTHOGONAL], NEEDED),
            ours(PIVOTED, quantity, judged[PIVOTED], NEEDED),
        ),
        Sweep("angle between the constraints", ANGLES, digits),
    )


def worst(solve: SolveAt, angle: float) -> float:
    """Fewest digits that a solve keeps of the accelerations, over places on the circle."""
    digits = []
    for place in PLACES:
        outward = SIDEWAYS * cos(place) + SLANTING * sin(place)
        along = SLANTING * cos(place) - SIDEWAYS * sin(place)
        state = np.concatenate([outward, RATE * along])
        digits.append(digits_kept(solve(angle, state).accelerations, pendulum(outward, along)))
    return min(digits)


def pendulum(outward: Vector, along: Vector) -> Vector:
    """Acceleration of the bob: gravity's part along the circle, and towards its centre."""
    return (GRAVITY @ along) * along - RATE**2 * outward


CASE = Case(
    name="parallel constraints",
    kind=HardCase.NEARLY_DEPENDENT,
    truth="a pendulum on the circle that the two rods leave free, in closed form",
    examine=examine,
)
