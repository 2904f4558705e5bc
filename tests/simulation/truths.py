"""What mechanics says about motions that the tests follow."""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.special import ellipj, ellipk

GRAVITY = 9.81


def linkage_constants(bars: int) -> tuple[float, float]:
    """A and m of the four-bar linkage's elliptic functions; it turns once in 4 K(m)/A."""
    k = GRAVITY * ((bars + 1) / 2 + bars) / ((bars + 1) / 3 + bars)
    return np.sqrt(1 + 4 * k), 4 * k / (1 + 4 * k)


def linkage_period(bars: int) -> float:
    a, m = linkage_constants(bars)
    return 4 * ellipk(m) / a


def linkage_tip(bars: int, t: float) -> np.ndarray:
    """The first tip, (sin phi, cos phi) with phi'' = k sin phi, phi(0) = 0, phi'(0) = 1."""
    a, m = linkage_constants(bars)
    sn, cn, _, _ = ellipj((a * t / 2 - ellipk(m)) % (4 * ellipk(m)), m)
    return np.array([-2 * sn * cn, 2 * sn**2 - 1])


def four_bar(t: float) -> tuple[np.ndarray, np.ndarray]:
    """State and accelerations of the linkage with one bar."""
    k = GRAVITY * 2 / (2 / 3 + 1)
    x, y = linkage_tip(1, t)
    speed_squared = 1 + 2 * k * (1 - y)
    velocity = np.sqrt(speed_squared) * np.array([y, -x])
    acceleration = k * x * np.array([y, -x]) - speed_squared * np.array([x, y])
    return np.array([x, y, x + 1, y, *velocity, *velocity]), np.tile(acceleration, 2)


def sarrus_angles(times: np.ndarray) -> np.ndarray:
    """Angles of Sarrus' legs: (1 + 6 cos(phi)^2) dot(phi)^2 + 8 g sin(phi) is constant, the masses and lengths one."""

    def rates(_: float, y: np.ndarray) -> list[float]:
        sin, cos = np.sin(y[0]), np.cos(y[0])
        return [y[1], (-8 * GRAVITY * cos + 12 * sin * cos * y[1] ** 2) / (2 + 12 * cos**2)]

    span = (0.0, float(np.max(times)))
    return solve_ivp(rates, span, [np.arcsin(4 / 5), 0.0], "DOP853", times, rtol=3e-14, atol=1e-15).y[0]
