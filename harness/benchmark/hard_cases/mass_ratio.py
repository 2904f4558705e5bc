"""A heavy bob on a light chain, with a mass ratio of 10^12.

The light mass moves by the difference of two large reactions. The reference accelerations come from the equations of
two masses on two rods, written by hand and solved with many more digits. In the reference motion the heavy bob falls
freely to within 1e-12, and the light mass moves out of its way.
"""

from itertools import product

import mpmath
import numpy as np
from mpmath import mp, mpf, sqrt

from ...language import translatable
from ...simulation.matrices import Vector
from .case import Extent, Findings, correct_digits, holonom_result
from .runs import problem, simulated
from .solves import SolveAt, every_solve, solve_digits

FILE = "hard/heavy_bob.mac"
DIGITS = 60  # of the truth
NEEDED = 12.0  # digits of the accelerations
UNTIL, NEEDED_PLACES = 0.3, 10.0
LIGHT, HEAVY, GRAVITY = mpf("1e-6"), mpf("1e6"), mpf("9.81")
DIRECTIONS, BENDS, RATES = (
    (-0.6, -1.4),
    (1.0, 1e-3),
    (0.5, -2.0),
)  # of the upper rod, of the lower against it; rad, rad/s


def mass_ratio(extent: Extent) -> Findings:
    """Yield digits of each solve's accelerations and of the positions.

    The reference accelerations have sixty digits.

    Parameters
    ----------
    extent : Extent
        Without effect. The motion is short.

    Yields
    ------
    Result or Sweep
        A method's digits.
    """
    digits = {name: _worst(solve) for name, solve in every_solve(FILE).items()}
    yield from solve_digits(translatable("accelerations"), digits, NEEDED)
    motion = simulated(problem(FILE), UNTIL)
    places = correct_digits(motion.coordinates, falling(mpf(UNTIL)))
    yield holonom_result(motion.engine, translatable("places at t = %(t)s", t=UNTIL), places, NEEDED_PLACES)


def _worst(solve: SolveAt) -> float:
    """Fewest correct digits of the accelerations by a solve, over states of the chain."""
    states = [hanging(*at) for at in product(DIRECTIONS, BENDS)]
    return min(correct_digits(solve(0.0, state).accelerations, certified_accelerations(state)) for state in states)


def falling(t: mpf) -> list[mpf]:
    """Return the positions of both masses: the heavy one in free fall from (1, -1).

    The light mass is at the bend of the rods.

    Parameters
    ----------
    t : mpf
        Time since the initial time, in seconds.

    Returns
    -------
    list of mpf, shape (4,)
        x1, y1 of the light mass, x2, y2 of the heavy one.
    """
    drop = 1 + GRAVITY * t**2 / 2
    half = (1 + drop**2) / 4  # square of half of the way from the hinge to the bob
    bend = sqrt((1 - half) / (4 * half))
    return [mpf(1) / 2 + bend * drop, bend - drop / 2, mpf(1), -drop]


def hanging(direction: float, bend: float) -> Vector:
    """Return positions and velocities of both masses.

    Parameters
    ----------
    direction : float
        Direction of the upper rod, in radians.
    bend : float
        Angle of the lower rod against the upper one, in radians.

    Returns
    -------
    Vector, shape (8,)
        x1, y1, x2, y2 and their time derivatives.
    """
    upper, lower = np.exp(1j * direction), np.exp(1j * (direction + bend))
    places = np.array([upper, upper + lower])
    velocities = 1j * np.array([RATES[0] * upper, RATES[0] * upper + RATES[1] * lower])
    return np.concatenate([places.view(float), velocities.view(float)])


def certified_accelerations(state: Vector) -> list[mpf]:
    """Return accelerations x1, y1, x2, y2 from the bordered equations of two rods.

    Parameters
    ----------
    state : Vector, shape (8,)
        x1, y1, x2, y2 and their time derivatives.

    Returns
    -------
    list of mpf, shape (4,)
    """
    with mp.workdps(DIGITS):
        x1, y1, x2, y2, vx1, vy1, vx2, vy2 = map(mpf, map(float, state))
        mass = mpmath.diag([LIGHT, LIGHT, HEAVY, HEAVY])
        jacobian = mpmath.matrix([[x1, y1, 0, 0], [x1 - x2, y1 - y2, x2 - x1, y2 - y1]])
        bordered = mpmath.zeros(6)
        bordered[:4, :4], bordered[:4, 4:], bordered[4:, :4] = mass, -jacobian.T, jacobian
        squares = [vx1**2 + vy1**2, (vx2 - vx1) ** 2 + (vy2 - vy1) ** 2]
        sides = [0, -LIGHT * GRAVITY, 0, -HEAVY * GRAVITY, -squares[0], -squares[1]]
        return list(mpmath.lu_solve(bordered, mpmath.matrix(sides)))[:4]
