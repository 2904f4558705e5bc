"""Cases whose truth is a pendulum's angle in elliptic functions: phi'' = -w^2 sin(phi).

References
----------
Whittaker, Analytical Dynamics, section 44.
"""

from mpmath import ellipfun, ellipk, mpf, pi, sin, sqrt

from ...language import translatable
from ...simulation.hard_cases import HardCase
from .case import Extent, Findings, certified, digits_kept, digits_of_error, ours, required, theirs
from .runs import PLAIN, places_kept, plain_motion, problem, simulated

with certified:
    GRAVITY = mpf("9.81")
    FREQUENCY = sqrt(GRAVITY)  # of small oscillations of a pendulum of length 1


@certified
def swing(amplitude: mpf, frequency: mpf, t: mpf) -> tuple[mpf, mpf]:
    """sin(phi) and cos(phi) of a pendulum released at rest at an amplitude below pi; w is its frequency near zero."""
    modulus = sin(amplitude / 2)
    half = modulus * ellipfun("sn", ellipk(modulus**2) + frequency * t, m=modulus**2)
    return 2 * half * sqrt(1 - half**2), 1 - 2 * half**2


@certified
def period(amplitude: mpf, frequency: mpf) -> mpf:
    """Period of a pendulum released at rest."""
    return 4 * ellipk(sin(amplitude / 2) ** 2) / frequency


@certified
def turning(frequency: mpf, t: mpf) -> tuple[mpf, mpf]:
    """sin(phi) and cos(phi) of the angle from above, which turns over from phi = 0 at the rate 1."""
    rate = sqrt(1 + 4 * frequency**2)
    m = (2 * frequency / rate) ** 2
    argument = rate * t / 2 - ellipk(m)
    sn, cn = ellipfun("sn", argument, m=m), ellipfun("cn", argument, m=m)
    return -2 * sn * cn, 2 * sn**2 - 1


@certified
def revolution(frequency: mpf) -> mpf:
    """Time of one revolution of the angle that turns over."""
    rate = sqrt(1 + 4 * frequency**2)
    return 4 * ellipk((2 * frequency / rate) ** 2) / rate


def constraint_given_twice(extent: Extent) -> Findings:
    """Digits of the motion, of the unique constraint force, and of the multipliers that are zero where redundant."""
    swinging, until, needed = problem("hard/repeated_constraint.mac"), 10, 10.0
    x, depth = swing(pi / 2, FREQUENCY, mpf(until))
    multiplier = -3 * GRAVITY * depth  # m g cos(phi) + m l phi'^2, phi'^2 = 2 g/l cos(phi), towards the hinge
    force = [multiplier * x, -multiplier * depth]
    motion, plain = simulated(swinging, until), plain_motion(swinging, until)
    yield from places_kept(translatable("coordinates"), plain, motion, [x, -depth], needed)
    yield ours(motion.engine, translatable("constraint force"), digits_kept(motion.constraint_forces, force), needed)
    yield ours(motion.engine, translatable("multipliers"), digits_kept(motion.multipliers, [multiplier, 0]), needed)
    yield required(motion.engine, translatable("redundancy reported"), HardCase.REDUNDANT in motion.cases)


REVOLUTIONS = {Extent.SHORT: 5, Extent.FULL: 50}


def dead_centres(extent: Extent) -> Findings:
    """Digits of the first tip's place after many revolutions, and of the energy.

    Twice a revolution all rods are in line. There the parallelogram may turn into an antiparallelogram; the motion
    goes on as the pendulum it has been.
    """
    with certified:
        frequency = sqrt(GRAVITY * 2 / (mpf(2) / 3 + 1))  # of small oscillations about the lowest place
        energy = mpf(2) / 3 / 2 + mpf(1) / 2 + 2 * GRAVITY  # two rods and a coupler, upright at 1 m/s
    linkage, turns, needed = problem("linkage.mac"), REVOLUTIONS[extent], 6.0
    until = round(turns * revolution(frequency))
    motion, plain = simulated(linkage, until), plain_motion(linkage, until)
    tip = turning(frequency, mpf(until))
    yield from places_kept(
        translatable("place after %(turns)s revolutions", turns=turns), plain, motion, tip, needed, scale=1
    )
    yield ours(motion.engine, translatable("energy"), digits_of_error(motion.energy_error, energy), needed)
    yield required(motion.engine, translatable("passage reported"), HardCase.SINGULAR_PASSAGE in motion.cases)


PERIODS = 10_000
PLAIN_PERIODS = {Extent.SHORT: 50, Extent.FULL: 1_000}  # the plain way takes 20 ms for one


def long_run(extent: Extent) -> Findings:
    """Digits of the place, of the constraint and of the energy, which drift, after many periods."""
    swinging = problem("pendulum.mac", "swing_scene")
    needed, needed_of_drift = 9.0, 12.0  # of the place rounding alone leaves eleven
    energy = GRAVITY  # to turn upright takes twice as much
    periods = PLAIN_PERIODS[extent]
    until, place = _after(periods)
    state = plain_motion(swinging, until)
    yield theirs(
        PLAIN, translatable("place after %(periods)s periods", periods=periods), digits_kept(state[:2], place), needed
    )
    yield theirs(
        PLAIN, translatable("constraint"), digits_of_error(abs(state[0] ** 2 + state[1] ** 2 - 1), 1), needed_of_drift
    )
    until, place = _after(PERIODS)
    motion = simulated(swinging, until)
    yield ours(
        motion.engine,
        translatable("place after %(periods)s periods", periods=PERIODS),
        digits_kept(motion.coordinates, place),
        needed,
    )
    yield ours(motion.engine, translatable("constraint"), digits_of_error(motion.residual, 1), needed_of_drift)
    yield ours(motion.engine, translatable("energy"), digits_of_error(motion.energy_error, energy), needed_of_drift)


@certified
def _after(periods: int) -> tuple[int, list[mpf]]:
    """Return the second nearest to the end of so many periods, and x and y of the pendulum then."""
    amplitude = pi / 13
    until = round(periods * period(amplitude, FREQUENCY))
    x, depth = swing(amplitude, FREQUENCY, mpf(until))
    return until, [x, -depth]
