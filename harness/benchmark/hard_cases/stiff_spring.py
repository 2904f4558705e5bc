"""A spring 10^6 times stiffer than the other, ringing on the third body of a rail.

With a rod of controlled length u between bodies 1 and 2, the deviations p = x1 and s = x3 - u - r obey

    2 m p'' = -k p + K (s - p),   m s'' = -K (s - p),

a linear system, whose motion is a sum of two oscillations.
"""

from mpmath import cos, eigsy, matrix, mpf, sqrt

from ...simulation.diagnosis import HardCase
from .case import Case, Extent, Findings, found, ours, theirs
from .digits import certified, digits_kept, digits_of_error
from .plain import PLAIN, plain_motion
from .scenes import problem, simulated

FILE = "hard/stiff_spring.mac"
INSTANTS = {Extent.SHORT: 1, Extent.FULL: 10}  # seconds; 195 oscillations of the stiff spring each
NEEDED = 10.0

with certified:
    SOFT, STIFF, LENGTH, SPEED, REST = mpf(1), mpf(10) ** 6, mpf(1), mpf(1) / 10, mpf(1)  # k, K, l0, v, r; m = 1
    P, S = mpf(1) / 10, mpf(101) / 1000  # at the start, at rest
    ENERGY = (SOFT * P**2 + STIFF * (S - P) ** 2) / 2


@certified
def coordinates(t: mpf) -> list[mpf]:
    """Coordinates x1, x2, x3 at an instant: with y = (sqrt(2) p, s) the masses are one, and the stiffness symmetric."""
    root = sqrt(mpf(2))
    stiffness = matrix([[(SOFT + STIFF) / 2, -STIFF / root], [-STIFF / root, STIFF]])
    squares, modes = eigsy(stiffness)
    amplitudes = modes.T * matrix([root * P, S])
    y = modes * matrix([a * cos(sqrt(square) * t) for a, square in zip(amplitudes, squares, strict=True)])
    p, s, u = y[0] / root, y[1], LENGTH + SPEED * t
    return [p, p + u, s + u + REST]


def examine(extent: Extent) -> Findings:
    """Digits of the coordinates, by the plain way and by ours."""
    until = INSTANTS[extent]
    truth = coordinates(mpf(until))
    motion, plain = simulated(problem(FILE), until=until), plain_motion(problem(FILE), until)
    return found(
        theirs(PLAIN, f"coordinates at t = {until}", digits_kept(plain[: len(truth)], truth), NEEDED),
        ours(motion.engine, f"coordinates at t = {until}", digits_kept(motion.coordinates, truth), NEEDED),
        ours(motion.engine, "energy", digits_of_error(motion.energy_error, ENERGY), NEEDED),
    )


CASE = Case(
    name="spring 1e6 times stiffer",
    kind=HardCase.STIFF,
    truth="two coupled oscillators, in closed form",
    examine=examine,
)
