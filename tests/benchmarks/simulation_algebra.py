"""The five motions as kinetic energy, potential, forces and constraints, in any algebra: for peers that derive.

A description takes t, coordinates, velocities and a module with sin, cos and sqrt. The controls stand as functions of
t; numbers are those of the scenes.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from types import ModuleType
from typing import Any

LINKS = 8
GRAVITY = 9.81

Symbols = Sequence[Any]


@dataclass(frozen=True)
class Description:
    """A system under its control law."""

    kinetic: Any
    potential: Any
    forces: Symbols
    constraints: Symbols


def paper(t: Any, q: Symbols, v: Symbols, f: ModuleType) -> Description:
    del f
    forces = [-q[0] - q[1], -2 * (v[0] + v[1]), 0]
    return Description(sum(x**2 for x in v) / 2, 0, forces, [q[2] - (0.3 + t) * (q[0] + q[1])])


def pendulum(t: Any, q: Symbols, v: Symbols, f: ModuleType) -> Description:
    del f
    constraint = q[0] ** 2 + q[1] ** 2 - (1 + t / 10) ** 2
    return Description((v[0] ** 2 + v[1] ** 2) / 2, GRAVITY * q[1], [0, 0], [constraint])


def chain_8(t: Any, q: Symbols, v: Symbols, f: ModuleType) -> Description:
    del f
    points = [(0, 0), *zip(q[::2], q[1::2], strict=True)]
    squares = [(x - x0) ** 2 + (y - y0) ** 2 for (x0, y0), (x, y) in pairwise(points)]
    constraints = [(squares[0] - (1 - t / 10) ** 2) / 2, *((square - 1) / 2 for square in squares[1:])]
    return Description(sum(x**2 for x in v) / 2, GRAVITY * sum(q[1::2]), [0] * len(q), constraints)


def car_axis(t: Any, q: Symbols, v: Symbols, f: ModuleType) -> Description:
    road = 0.1 * f.sin(10 * t)
    ground = f.sqrt(1 - road**2)
    xl, yl, xr, yr = q
    left, right = f.sqrt(xl**2 + yl**2), f.sqrt((xr - ground) ** 2 + (yr - road) ** 2)
    potential = (left - 0.5) ** 2 / 2 + (right - 0.5) ** 2 / 2 + 5e-4 * (yl + yr)
    constraints = [xl * ground + yl * road, (xl - xr) ** 2 + (yl - yr) ** 2 - 1]
    return Description(5e-4 * sum(x**2 for x in v) / 2, potential, [0] * 4, constraints)


def andrews(t: Any, q: Symbols, v: Symbols, f: ModuleType) -> Description:
    del t
    m1, m2, m3, m4, m5, m6, m7 = 0.04325, 0.00365, 0.02373, 0.00706, 0.0705, 0.00706, 0.05498
    i1, i2, i3, i4, i5, i6, i7 = 2.194e-6, 4.41e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5
    xa, ya, xb, yb, xc, yc, c0, l0, moment = -0.06934, -0.00227, -0.03635, 0.03273, 0.014, 0.072, 4530, 0.07785, 0.033
    d, da, e, ea, rr, ra, ss, sa, sb = 0.028, 0.0115, 0.02, 0.01421, 0.007, 0.00092, 0.035, 0.01874, 0.01043
    sc, sd, ta, tb, u, ua, ub, zf, zt, fa = 0.018, 0.02, 0.02308, 0.00916, 0.04, 0.01228, 0.00449, 0.02, 0.04, 0.01421
    beta, theta, gamma, phi, delta, omega, epsilon = q
    v_beta, v_theta, v_gamma, v_phi, v_delta, v_omega, v_epsilon = v
    arm, elbow = e - ea, zf - fa
    kinetic = (
        (m1 * ra**2 + i1 + m2 * (rr**2 - 2 * da * rr * f.cos(theta) + da**2) + i2) * v_beta**2 / 2
        + (m2 * (da**2 - da * rr * f.cos(theta)) + i2) * v_beta * v_theta
        + (m2 * da**2 + i2) * v_theta**2 / 2
        + (m3 * (sa**2 + sb**2) + i3) * v_gamma**2 / 2
        + (m4 * arm**2 + i4) * v_phi**2 / 2
        + (m4 * (arm**2 + zt * arm * f.sin(phi)) + i4) * v_phi * v_delta
        + (m4 * (zt**2 + 2 * zt * arm * f.sin(phi) + arm**2) + m5 * (ta**2 + tb**2) + i4 + i5) * v_delta**2 / 2
        + (m6 * elbow**2 + i6) * v_omega**2 / 2
        + (m6 * (elbow**2 - u * elbow * f.sin(omega)) + i6) * v_omega * v_epsilon
        + (m6 * (elbow**2 - 2 * u * elbow * f.sin(omega) + u**2) + m7 * (ua**2 + ub**2) + i6 + i7) * v_epsilon**2 / 2
    )
    x = sd * f.cos(gamma) + sc * f.sin(gamma) + xb - xc
    y = sd * f.sin(gamma) - sc * f.cos(gamma) + yb - yc
    px = rr * f.cos(beta) - d * f.cos(beta + theta)
    py = rr * f.sin(beta) - d * f.sin(beta + theta)
    constraints = [
        px - ss * f.sin(gamma) - xb,
        py + ss * f.cos(gamma) - yb,
        px - e * f.sin(phi + delta) - zt * f.cos(delta) - xa,
        py + e * f.cos(phi + delta) - zt * f.sin(delta) - ya,
        px - zf * f.cos(omega + epsilon) - u * f.sin(epsilon) - xa,
        py - zf * f.sin(omega + epsilon) + u * f.cos(epsilon) - ya,
    ]
    return Description(kinetic, c0 / 2 * (f.sqrt(x**2 + y**2) - l0) ** 2 - moment * beta, [0] * 7, constraints)


DESCRIPTIONS: dict[str, tuple[int, Callable[..., Description]]] = {
    "paper": (3, paper),
    "pendulum": (2, pendulum),
    "chain_8": (2 * LINKS, chain_8),
    "car_axis": (4, car_axis),
    "andrews": (7, andrews),
}
