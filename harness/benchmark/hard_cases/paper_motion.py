"""The paper's example under the control (15), u = u0 exp(t): an exact free motion.

The sum s = q1 + q2 obeys s'' + 2 s' + s = 0, so that s = (a + b t) exp(-t). q1'' = -s and q3 = u s.
"""

import numpy as np
from mpmath import exp, mpf

from ...language import translatable
from .case import Extent, Findings, certified, digits_of_error, holonom_result
from .runs import baseline_motion, place_digits, problem, simulated
from .solves import TEXTBOOK, SolveAt, every_solve, solve_digits

SCENE = "paper/paper.mac", "free_motion_scene"
with certified:
    U0, Q1, Q2, V1, V2 = mpf(3) / 10, mpf(1), mpf(2), mpf(1) / 2, -mpf(1) / 3  # as in the scene
A, B = Q1 + Q2, Q1 + Q2 + V1 + V2


@certified
def coordinates(t: mpf) -> list[mpf]:
    """Return the coordinates q1, q2, q3 at a given time.

    Parameters
    ----------
    t : mpf
        Time since the initial time.

    Returns
    -------
    list of mpf, shape (3,)
    """
    q1 = Q1 + (V1 - A - B) * t + A + 2 * B - (A + 2 * B + B * t) * exp(-t)
    return [q1, (A + B * t) * exp(-t) - q1, U0 * (A + B * t)]


@certified
def velocities(t: mpf) -> list[mpf]:
    """Return the velocities of q1, q2, q3 at a given time.

    Parameters
    ----------
    t : mpf
        Time since the initial time.

    Returns
    -------
    list of mpf, shape (3,)
    """
    v1 = V1 - A - B + (A + B + B * t) * exp(-t)
    return [v1, (B - A - B * t) * exp(-t) - v1, U0 * B]


@certified
def forces(t: mpf) -> list[mpf]:
    """Return the forces of the spring and of the damping at a given time.

    Parameters
    ----------
    t : mpf
        Time since the initial time.

    Returns
    -------
    list of mpf, shape (2,)
    """
    return [-(A + B * t) * exp(-t), -2 * (B - A - B * t) * exp(-t)]


def constraint_force(multiplier: float, t: mpf) -> mpf:
    """Return the largest component of the force lambda (-u, -u, 1).

    Parameters
    ----------
    multiplier : float
        The multiplier lambda.
    t : mpf
        Time since the initial time, which determines u.

    Returns
    -------
    mpf
    """
    return abs(mpf(float(multiplier))) * max(1, U0 * exp(t))


def free_motion(extent: Extent) -> Findings:
    """Yield digits to which the multiplier vanishes, for each solve and at the end.

    Parameters
    ----------
    extent : Extent
        Without effect. The motion has the scene's time span.

    Yields
    ------
    Result or Sweep
        A method's digits.
    """
    last, needed = 10, 13.0  # the scene's time span; the constraint force below 1e-13 of the others
    digits = {
        name: min(_vanishing(solve, mpf(t)) for t in range(last + 1)) for name, solve in every_solve(*SCENE).items()
    }
    yield from solve_digits(translatable("zero multiplier"), digits, needed, compared=(TEXTBOOK,))
    motion = simulated(problem(*SCENE), last)
    yield holonom_result(
        motion.engine,
        translatable("zero multiplier at t = %(t)s", t=last),
        _zero(motion.multipliers[0], last),
        needed,
    )


def _vanishing(solve: SolveAt, t: mpf) -> float:
    """Digits to which the constraint force vanishes among the forces, at a given time."""
    state = np.array([float(x) for x in (*coordinates(t), *velocities(t))])
    multiplier = solve(float(t), state).multipliers[0]
    return digits_of_error(constraint_force(multiplier, t), max(map(abs, forces(t))))


def _zero(multiplier: float, t: float) -> float:
    """Digits to which the initial constraint force vanishes among the forces."""
    return digits_of_error(constraint_force(multiplier, mpf(t)), max(map(abs, forces(mpf(0)))))


def overflowing_control(extent: Extent) -> Findings:
    """Yield digits before and after the overflow of u^2 = (0.3 exp(t))^2 at t = 357.

    They are digits of the coordinates and of the zero multiplier. The multiplier is a quotient by 1 + 2 u^2: it should
    stay zero rather than become infinity by infinity.

    Parameters
    ----------
    extent : Extent
        Without effect. Both motions pass the overflow.

    Yields
    ------
    Result or Sweep
        A method's digits.
    """
    needed = 11.0
    for t in (355, 360):
        motion, baseline = simulated(problem(*SCENE), t), baseline_motion(problem(*SCENE), t)
        yield from place_digits(
            translatable("coordinates at t = %(t)s", t=t), baseline, motion, coordinates(mpf(t)), needed
        )
        yield holonom_result(
            motion.engine, translatable("zero multiplier at t = %(t)s", t=t), _zero(motion.multipliers[0], t), needed
        )
