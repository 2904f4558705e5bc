"""A pendulum whose constraint is given twice: the motion is the pendulum's, each multiplier half of its own."""

from mpmath import mpf, pi, sqrt

from ...simulation.diagnosis import HardCase
from .case import Case, Extent, Findings, found, ours, required, theirs
from .digits import certified, digits_kept
from .elliptic import swing
from .plain import PLAIN, plain_motion
from .scenes import problem, simulated

FILE, UNTIL = "hard/repeated_constraint.mac", 10
NEEDED = 10.0

with certified:
    GRAVITY = mpf("9.81")
    AMPLITUDE, FREQUENCY = pi / 2, sqrt(GRAVITY)


def examine(extent: Extent) -> Findings:
    """Digits of the motion, of the unique constraint force, and of the multipliers of smallest norm."""
    x, depth = swing(AMPLITUDE, FREQUENCY, mpf(UNTIL))
    multiplier = -3 * GRAVITY * depth  # m g cos(phi) + m l phi'^2, phi'^2 = 2 g/l cos(phi), towards the hinge
    place, force = [x, -depth], [multiplier * x, -multiplier * depth]
    motion, plain = simulated(problem(FILE), until=UNTIL), plain_motion(problem(FILE), UNTIL)
    return found(
        theirs(PLAIN, "coordinates", digits_kept(plain[:2], place), NEEDED),
        ours(motion.engine, "coordinates", digits_kept(motion.coordinates, place), NEEDED),
        ours(motion.engine, "constraint force", digits_kept(motion.constraint_forces, force), NEEDED),
        ours(motion.engine, "least multipliers", digits_kept(motion.multipliers, 2 * [multiplier / 2]), NEEDED),
        required(motion.engine, "redundancy reported", HardCase.REDUNDANT in motion.cases),
    )


CASE = Case(
    name="constraint given twice",
    kind=HardCase.REDUNDANT,
    truth="the pendulum with one constraint, in elliptic functions; half of its multiplier for each",
    examine=examine,
)
