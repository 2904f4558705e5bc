"""Continue a motion around a complex time.

The equations may be singular there. Along a motion that is regular inside a circle, the accelerations and reactions
return to their values after one turn, and have no negative powers there.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.complex128]
Evaluate = Callable[[complex, Numbers], Numbers]  # accelerations, then reactions, at a time and in a state
Path = Callable[[float], tuple[complex, complex]]  # place and velocity at s from 0 to 1

WIDTHS = (0.1, 0.02, 0.004)  # of circles, relative to the distance of their centre, the widest first
POINTS = 32
ACCURACY, IRREGULAR = 1e-12, 1e-5  # of the integration, and relative to outputs on a circle: more than its errors
MOST_EVALUATIONS = 20_000


def ends_at(evaluate: Evaluate, start: Numbers, place: complex, width: float) -> bool:
    """Return True if a motion is singular at a place, as far as circles show.

    False also if it cannot be continued on the ray to the place.

    Parameters
    ----------
    evaluate : callable
        Accelerations, then other outputs, of t - t0 and a state.
    start : ndarray, shape (2n,)
        Initial state.
    place : complex
        t - t0 there.
    width : float
        Largest radius of a circle around it.

    Returns
    -------
    bool
    """
    with np.errstate(all="ignore"):
        try:
            return all(_ends_inside(evaluate, start, place, min(width, each * abs(place))) for each in WIDTHS)
        except ArithmeticError:
            return False


def _ends_inside(evaluate: Evaluate, start: Numbers, place: complex, radius: float) -> bool:
    ray, turns = place * (1 - radius / abs(place)), np.exp(2j * np.pi * np.arange(POINTS + 1) / POINTS)
    arm = ray - place
    (near,) = _continued(evaluate, start, lambda s: (s * ray, ray), [1.0])

    def around(s: float) -> tuple[complex, complex]:
        turned = arm * np.exp(2j * np.pi * s)
        return place + turned, 2j * np.pi * turned

    states = _continued(evaluate, near, around, np.linspace(0, 1, POINTS + 1))
    found = np.array([evaluate(place + arm * turn, state) for turn, state in zip(turns, states, strict=True)])
    powers = [np.abs(turns[:-1] ** power @ found[:-1]) / POINTS for power in (1, 2, 3)]
    moved = np.abs(near).reshape(2, -1).max(axis=1) / abs(place) ** np.array([2, 1])  # as accelerations
    return bool(np.max([np.abs(found[-1] - found[0]), *powers]) > IRREGULAR * max(np.abs(found).max(), *moved))


def _continued(evaluate: Evaluate, start: Numbers, path: Path, times: list[float]) -> list[Numbers]:
    """Return states along a path.

    Raise ArithmeticError if the integration does not succeed.
    """
    from scipy.integrate import solve_ivp

    n, evaluations = len(start) // 2, iter(range(MOST_EVALUATIONS))

    def rates(s: float, state: Numbers) -> Numbers:
        if next(evaluations, None) is None:
            raise ArithmeticError
        place, velocity = path(s)
        return velocity * np.concatenate([state[n:], evaluate(place, state)[:n]])

    found = solve_ivp(rates, (0, 1), start, "DOP853", times, rtol=ACCURACY, atol=ACCURACY * np.abs(start).max())
    if not found.success or not np.isfinite(found.y).all():
        raise ArithmeticError
    return list(found.y.T)
