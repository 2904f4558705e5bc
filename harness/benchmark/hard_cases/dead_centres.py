"""A parallelogram four-bar linkage through its dead centres: all rods in line, twice a revolution.

There the parallelogram may turn into an antiparallelogram; the motion goes on as the pendulum it has been.
"""

from mpmath import mpf, sqrt

from ...simulation.diagnosis import HardCase
from .case import Case, Extent, Findings, found, ours, required, theirs
from .digits import certified, digits_kept, digits_of_error
from .elliptic import revolution, turning
from .plain import PLAIN, plain_motion
from .scenes import problem, simulated

FILE = "linkage.mac"
REVOLUTIONS = {Extent.SHORT: 5, Extent.FULL: 50}
NEEDED = 6.0

with certified:
    GRAVITY = mpf("9.81")
    FREQUENCY = sqrt(GRAVITY * 2 / (mpf(2) / 3 + 1))  # of small oscillations about the lowest place
    ENERGY = mpf(2) / 3 / 2 + mpf(1) / 2 + 2 * GRAVITY  # two rods and a coupler, upright at 1 m/s


def examine(extent: Extent) -> Findings:
    """Digits of the first tip's place after many revolutions, and of the energy."""
    turns = REVOLUTIONS[extent]
    until = round(turns * revolution(FREQUENCY))
    tip = turning(FREQUENCY, mpf(until))
    motion, plain = simulated(problem(FILE), until=until), plain_motion(problem(FILE), until)
    return found(
        theirs(PLAIN, f"place after {turns} revolutions", digits_kept(plain[:2], tip, 1), NEEDED),
        ours(motion.engine, f"place after {turns} revolutions", digits_kept(motion.coordinates[:2], tip, 1), NEEDED),
        ours(motion.engine, "energy", digits_of_error(motion.energy_error, ENERGY), NEEDED),
        required(motion.engine, "passage reported", HardCase.SINGULAR_PASSAGE in motion.cases),
    )


CASE = Case(
    name="parallelogram through its dead centres",
    kind=HardCase.SINGULAR_PASSAGE,
    truth="the rods' common angle, in elliptic functions",
    examine=examine,
)
