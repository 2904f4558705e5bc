"""The paper's free motion until the square of its control overflows: u^2 = (0.3 exp(t))^2 does so before t = 357.

The multiplier is a quotient by 1 + 2 u^2: it should stay zero rather than become infinity by infinity.
"""

from collections.abc import Iterator

from mpmath import mpf

from ...simulation.diagnosis import HardCase
from .case import Case, Extent, Findings, Result, found, ours, theirs
from .digits import digits_kept, digits_of_error
from .paper_motion import FILE, SCENE, constraint_force, coordinates, forces
from .plain import PLAIN, plain_motion
from .scenes import problem, simulated

BEFORE, BEHIND = 355, 360  # instants on both sides of the overflow
NEEDED = 11.0
INITIAL_FORCE = max(map(abs, forces(mpf(0))))


def examine(extent: Extent) -> Findings:
    """Digits of the coordinates, and to which the multiplier vanishes, before the overflow and behind it."""
    return found(*results_at(BEFORE), *results_at(BEHIND))


def results_at(t: int) -> Iterator[Result]:
    """What is kept at an instant."""
    truth = coordinates(mpf(t))
    plain = plain_motion(problem(FILE, SCENE), t)
    motion = simulated(problem(FILE, SCENE), t)
    reaction = constraint_force(motion.multipliers[0], mpf(t))
    yield theirs(PLAIN, f"coordinates at t = {t}", digits_kept(plain[: len(truth)], truth), NEEDED)
    yield ours(motion.engine, f"coordinates at t = {t}", digits_kept(motion.coordinates, truth), NEEDED)
    yield ours(motion.engine, f"zero multiplier at t = {t}", digits_of_error(reaction, INITIAL_FORCE), NEEDED)


CASE = Case(
    name="overflowing control",
    kind=HardCase.OVERFLOW,
    truth="the paper's free motion, in closed form; its multiplier is zero",
    examine=examine,
)
