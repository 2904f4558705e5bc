"""Hard cases with a pendulum's angle in elliptic functions: phi'' = -w^2 sin(phi).

References
----------
Whittaker, Analytical Dynamics, section 44.
"""

from mpmath import ellipfun, ellipk, mpf, pi, sin, sqrt

from ...language import translatable
from ...simulation.hard_cases import Difficulty
from .case import (
    Extent,
    Findings,
    certified,
    correct_digits,
    digits_of_error,
    holonom_result,
    reference_result,
    required,
)
from .runs import BASELINE, baseline_motion, place_digits, problem, simulated

with certified:
    GRAVITY = mpf("9.81")
    FREQUENCY = sqrt(GRAVITY)  # of small oscillations of a pendulum of length 1


@certified
def swing(amplitude: mpf, frequency: mpf, t: mpf) -> tuple[mpf, mpf]:
    """Return sin(phi) and cos(phi) of a pendulum released at rest.

    Parameters
    ----------
    amplitude : mpf
        Angle at the release, in radians, below pi.
    frequency : mpf
        Angular frequency w of small oscillations, in rad/s.
    t : mpf
        Time since the release, in seconds.

    Returns
    -------
    sine, cosine : mpf
        Those of phi, measured from the lowest place.
    """
    modulus = sin(amplitude / 2)
    half = modulus * ellipfun("sn", ellipk(modulus**2) + frequency * t, m=modulus**2)
    return 2 * half * sqrt(1 - half**2), 1 - 2 * half**2


@certified
def period(amplitude: mpf, frequency: mpf) -> mpf:
    """Return the period of a pendulum released at rest.

    Parameters
    ----------
    amplitude : mpf
        Angle at the release, in radians, below pi.
    frequency : mpf
        Angular frequency of small oscillations, in rad/s.

    Returns
    -------
    mpf
        In seconds.
    """
    return 4 * ellipk(sin(amplitude / 2) ** 2) / frequency


@certified
def turning(frequency: mpf, t: mpf) -> tuple[mpf, mpf]:
    """Return sin(phi) and cos(phi) of a rotating pendulum.

    The angle is measured from the top. The motion starts at phi = 0 with the velocity 1.

    Parameters
    ----------
    frequency : mpf
        Angular frequency of small oscillations about the lowest place, in rad/s.
    t : mpf
        Time since the initial time, in seconds.

    Returns
    -------
    sine, cosine : mpf
        Those of phi.
    """
    rate = sqrt(1 + 4 * frequency**2)
    m = (2 * frequency / rate) ** 2
    argument = rate * t / 2 - ellipk(m)
    sn, cn = ellipfun("sn", argument, m=m), ellipfun("cn", argument, m=m)
    return -2 * sn * cn, 2 * sn**2 - 1


@certified
def revolution(frequency: mpf) -> mpf:
    """Return the time of one revolution of the pendulum of `turning`.

    Parameters
    ----------
    frequency : mpf
        Angular frequency of small oscillations about the lowest place, in rad/s.

    Returns
    -------
    mpf
        In seconds.
    """
    rate = sqrt(1 + 4 * frequency**2)
    return 4 * ellipk((2 * frequency / rate) ** 2) / rate


def constraint_given_twice(extent: Extent) -> Findings:
    """Yield digits of the motion, of the constraint force and of the multipliers.

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
    swinging, until, needed = problem("hard/repeated_constraint.mac"), 10, 10.0
    x, depth = swing(pi / 2, FREQUENCY, mpf(until))
    multiplier = -3 * GRAVITY * depth  # m g cos(phi) + m l phi'^2, phi'^2 = 2 g/l cos(phi), towards the hinge
    force = [multiplier * x, -multiplier * depth]
    motion, baseline = simulated(swinging, until), baseline_motion(swinging, until)
    yield from place_digits(translatable("coordinates"), baseline, motion, [x, -depth], needed)
    yield holonom_result(
        motion.engine, translatable("constraint force"), correct_digits(motion.constraint_forces, force), needed
    )
    yield holonom_result(
        motion.engine, translatable("multipliers"), correct_digits(motion.multipliers, [multiplier, 0]), needed
    )
    yield required(motion.engine, translatable("redundancy reported"), Difficulty.REDUNDANT in motion.cases)


REVOLUTIONS = {Extent.SHORT: 5, Extent.FULL: 50}


def dead_centres(extent: Extent) -> Findings:
    """Yield digits of the first tip's place after many revolutions, and of the energy.

    Twice a revolution all rods are in line. There the parallelogram may turn into an antiparallelogram. The motion
    continues as the pendulum it has been.

    Parameters
    ----------
    extent : Extent
        Decides about the number of revolutions.

    Yields
    ------
    Result or Sweep
        A method's digits.
    """
    with certified:
        frequency = sqrt(GRAVITY * 2 / (mpf(2) / 3 + 1))  # of small oscillations about the lowest place
        energy = mpf(2) / 3 / 2 + mpf(1) / 2 + 2 * GRAVITY  # two rods and a coupler, upright at 1 m/s
    linkage, turns, needed = problem("linkage.mac"), REVOLUTIONS[extent], 6.0
    until = round(turns * revolution(frequency))
    motion, baseline = simulated(linkage, until), baseline_motion(linkage, until)
    tip = turning(frequency, mpf(until))
    yield from place_digits(
        translatable("place after %(turns)s revolutions", turns=turns), baseline, motion, tip, needed, scale=1
    )
    yield holonom_result(motion.engine, translatable("energy"), digits_of_error(motion.energy_error, energy), needed)
    yield required(
        motion.engine,
        translatable("singular configuration reported"),
        Difficulty.SINGULAR_CONFIGURATION in motion.cases,
    )


PERIODS = 10_000
BASELINE_PERIODS = {Extent.SHORT: 50, Extent.FULL: 1_000}  # the baseline takes 20 ms for one


def long_run(extent: Extent) -> Findings:
    """Yield digits of the position, the constraint and the energy after many periods.

    Parameters
    ----------
    extent : Extent
        Decides about the number of periods of the baseline method.

    Yields
    ------
    Result or Sweep
        A method's digits.
    """
    swinging = problem("pendulum.mac", "swing_scene")
    needed, needed_of_residual = 9.0, 12.0  # of the place rounding alone leaves eleven
    energy = GRAVITY  # to turn upright takes twice as much
    periods = BASELINE_PERIODS[extent]
    until, place = _after(periods)
    state = baseline_motion(swinging, until)
    yield reference_result(
        BASELINE,
        translatable("place after %(periods)s periods", periods=periods),
        correct_digits(state[:2], place),
        needed,
    )
    yield reference_result(
        BASELINE,
        translatable("constraint"),
        digits_of_error(abs(state[0] ** 2 + state[1] ** 2 - 1), 1),
        needed_of_residual,
    )
    until, place = _after(PERIODS)
    motion = simulated(swinging, until)
    yield holonom_result(
        motion.engine,
        translatable("place after %(periods)s periods", periods=PERIODS),
        correct_digits(motion.coordinates, place),
        needed,
    )
    yield holonom_result(
        motion.engine, translatable("constraint"), digits_of_error(motion.residual, 1), needed_of_residual
    )
    yield holonom_result(
        motion.engine, translatable("energy"), digits_of_error(motion.energy_error, energy), needed_of_residual
    )


@certified
def _after(periods: int) -> tuple[int, list[mpf]]:
    """Return the integer time nearest to the end of some periods, and x and y then."""
    amplitude = pi / 13
    until = round(periods * period(amplitude, FREQUENCY))
    x, depth = swing(amplitude, FREQUENCY, mpf(until))
    return until, [x, -depth]
