"""A pendulum for ten thousand periods: drift of the constraint and of the energy, and of the phase."""

from collections.abc import Iterator

from mpmath import mpf, pi, sqrt

from ...simulation.diagnosis import HardCase
from .case import Case, Extent, Findings, Result, found, ours, theirs
from .digits import certified, digits_kept, digits_of_error
from .elliptic import period, swing
from .plain import PLAIN, plain_motion
from .scenes import problem, simulated

FILE, SCENE = "pendulum.mac", "swing_scene"
PERIODS = 10_000
PLAIN_PERIODS = {Extent.SHORT: 50, Extent.FULL: 1_000}  # the plain way takes 20 ms for one
NEEDED = 9.0  # digits of the place: rounding alone leaves eleven
NEEDED_DRIFT = 12.0  # of the energy and of the constraint

with certified:
    AMPLITUDE, FREQUENCY = pi / 13, sqrt(mpf("9.81"))
    ENERGY = mpf("9.81")  # to turn upright takes twice as much


def examine(extent: Extent) -> Findings:
    """Digits of the place, of the energy and of the constraint, after many periods."""
    return found(*plain_results(PLAIN_PERIODS[extent]), *our_results(PERIODS))


def plain_results(periods: int) -> Iterator[Result]:
    """What the plain way keeps."""
    until, place = end(periods)
    state = plain_motion(problem(FILE, SCENE), until)
    yield theirs(PLAIN, f"place after {periods} periods", digits_kept(state[:2], place), NEEDED)
    yield theirs(PLAIN, "constraint", digits_of_error(abs(state[0] ** 2 + state[1] ** 2 - 1), 1), NEEDED_DRIFT)


def our_results(periods: int) -> Iterator[Result]:
    """What Holonom keeps."""
    until, place = end(periods)
    motion = simulated(problem(FILE, SCENE), until)
    yield ours(motion.engine, f"place after {periods} periods", digits_kept(motion.coordinates, place), NEEDED)
    yield ours(motion.engine, "constraint", digits_of_error(motion.residual, 1), NEEDED_DRIFT)
    yield ours(motion.engine, "energy", digits_of_error(motion.energy_error, ENERGY), NEEDED_DRIFT)


def end(periods: int) -> tuple[int, list[mpf]]:
    """The second nearest to the end of so many periods, and x and y of the pendulum then."""
    until = round(periods * period(AMPLITUDE, FREQUENCY))
    x, depth = swing(AMPLITUDE, FREQUENCY, mpf(until))
    return until, [x, -depth]


CASE = Case(
    name="pendulum for ten thousand periods",
    kind=HardCase.LONG_RUN,
    truth="the pendulum in elliptic functions",
    examine=examine,
)
