"""Stiff springs: a stiff spring next to a soft one, and those of the car axis.

With a rod of controlled length u between bodies 1 and 2 of a rail, the deviations p = x1 and s = x3 - u - r obey

    2 m p'' = -k p + K (s - p),   m s'' = -K (s - p),

a linear system, whose motion is a sum of two oscillations.
"""

from mpmath import cos, eigsy, matrix, mpf, sqrt

from ...language import translatable
from .case import Extent, Findings, certified, digits_of_error, holonom_result
from .runs import baseline_motion, place_digits, problem, simulated

TIMES = {Extent.SHORT: 1, Extent.FULL: 10}  # seconds; 195 oscillations of the stiff spring each

with certified:
    SOFT, STIFF, LENGTH, SPEED, REST = mpf(1), mpf(10) ** 6, mpf(1), mpf(1) / 10, mpf(1)  # k, K, l0, v, r; m = 1
    P, S = mpf(1) / 10, mpf(101) / 1000  # at the initial time, at rest
    ENERGY = (SOFT * P**2 + STIFF * (S - P) ** 2) / 2


@certified
def coordinates(t: mpf) -> list[mpf]:
    """Return the coordinates x1, x2, x3.

    With y = (sqrt(2) p, s) the masses are one, and the stiffness symmetric.

    Parameters
    ----------
    t : mpf
        Time since the initial time, in seconds.

    Returns
    -------
    list of mpf, shape (3,)
    """
    root = sqrt(mpf(2))
    stiffness = matrix([[(SOFT + STIFF) / 2, -STIFF / root], [-STIFF / root, STIFF]])
    squares, modes = eigsy(stiffness)
    amplitudes = modes.T * matrix([root * P, S])
    y = modes * matrix([a * cos(sqrt(square) * t) for a, square in zip(amplitudes, squares, strict=True)])
    p, s, u = y[0] / root, y[1], LENGTH + SPEED * t
    return [p, p + u, s + u + REST]


def stiff_spring(extent: Extent) -> Findings:
    """Yield digits of the coordinates and of the energy.

    Parameters
    ----------
    extent : Extent
        Decides about the final time.

    Yields
    ------
    Result or Sweep
        A method's digits.
    """
    rail, until, needed = problem("hard/stiff_spring.mac"), TIMES[extent], 10.0
    motion, baseline = simulated(rail, until), baseline_motion(rail, until)
    yield from place_digits(
        translatable("coordinates at t = %(t)s", t=until), baseline, motion, coordinates(mpf(until)), needed
    )
    yield holonom_result(motion.engine, translatable("energy"), digits_of_error(motion.energy_error, ENERGY), needed)


PUBLISHED = tuple(
    map(
        mpf,
        ("0.0493455784275402809122", "0.496989460230171153861", "1.04174252488542151681", "0.373911027265361256927"),
    )
)
"""xl, yl, xr, yr of the car axis at t = 3."""


def car_axis(extent: Extent) -> Findings:
    """Yield digits of the published positions of an axis on a bumpy road.

    One of its two constraints is rheonomic.

    Parameters
    ----------
    extent : Extent
        Without effect. The values are published for one time.

    Yields
    ------
    Result or Sweep
        A method's digits.

    References
    ----------
    Mazzia & Magherini, Test Set for Initial Value Problem Solvers, problem caraxis. The values are those of the package
    deTestSet for R, which are right to about twelve decimals.
    """
    axis, until, needed = problem("car_axis.mac"), 3, 10.0
    motion, baseline = simulated(axis, until, tol=1e-14), baseline_motion(axis, until)
    yield from place_digits(translatable("places at t = %(t)s", t=until), baseline, motion, PUBLISHED, needed, scale=1)
