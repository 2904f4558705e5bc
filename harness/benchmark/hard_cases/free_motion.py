"""The paper's free motion: its multiplier, forces less what the control asks, should vanish."""

import numpy as np
from mpmath import mpf

from ...simulation.diagnosis import HardCase
from .case import Case, Extent, Findings, found, ours, theirs
from .digits import digits_of_error
from .paper_motion import FILE, SCENE, constraint_force, coordinates, forces, velocities
from .scenes import problem, simulated
from .solves import DIRECT, ORTHOGONAL, PIVOTED, TEXTBOOK, SolveAt, every_solve

INSTANTS = tuple(range(11))  # of the scene's time span
NEEDED = 13.0  # the constraint force below 1e-13 of the others


def examine(extent: Extent) -> Findings:
    """Digits to which the constraint force vanishes, by each solve, and at the end of a simulation."""
    digits = {name: worst(solve) for name, solve in every_solve(FILE, SCENE).items()}
    motion, end = simulated(problem(FILE, SCENE), INSTANTS[-1]), mpf(INSTANTS[-1])
    reaction, greatest = constraint_force(motion.multipliers[0], end), max(map(abs, forces(mpf(0))))
    return found(
        theirs(TEXTBOOK, "zero multiplier", digits[TEXTBOOK], NEEDED),
        ours(DIRECT, "zero multiplier", digits[DIRECT], NEEDED),
        ours(ORTHOGONAL, "zero multiplier", digits[ORTHOGONAL], NEEDED),
        ours(PIVOTED, "zero multiplier", digits[PIVOTED], NEEDED),
        ours(motion.engine, f"zero multiplier at t = {INSTANTS[-1]}", digits_of_error(reaction, greatest), NEEDED),
    )


def worst(solve: SolveAt) -> float:
    """Fewest digits to which the constraint force vanishes among the forces, over the motion."""
    return min(vanishing(solve, mpf(t)) for t in INSTANTS)


def vanishing(solve: SolveAt, t: mpf) -> float:
    """Digits to which the constraint force vanishes among the forces, at an instant."""
    state = np.array([float(x) for x in (*coordinates(t), *velocities(t))])
    multiplier = solve(float(t), state).multipliers[0]
    return digits_of_error(constraint_force(multiplier, t), max(map(abs, forces(t))))


CASE = Case(
    name="cancellation along a free motion",
    kind=HardCase.FREE_CANCELLATION,
    truth="the paper's free motion under u = u0 exp(t), where every multiplier is zero",
    examine=examine,
)
