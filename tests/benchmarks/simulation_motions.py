"""The five motions of the simulation benchmark, and each of them written by hand for heyoka.

`simulation_motions.c` is the same by hand in C, by the same formulas.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

import heyoka as hy
import mpmath

EXAMPLES = Path(__file__).parents[2] / "examples"
LINKS = 8
GRAVITY = 9.81

Expressions = Sequence[Any]


@dataclass(frozen=True)
class Motion:
    """A motion that every method follows from the scene's start.

    Attributes
    ----------
    name : str
        Also of its function in `simulation_motions.c`.
    file : Path
    scene : str
    until : Fraction
    by_hand : callable
        Takes coordinates and velocities, heyoka's expressions, to the accelerations.
    settings : mapping of str to str
    """

    name: str
    file: Path
    scene: str
    until: Fraction
    by_hand: Callable[[Expressions, Expressions], Expressions]
    settings: Mapping[str, str] = field(default_factory=dict)


def paper(q: Expressions, v: Expressions) -> Expressions:
    """Chen, Guo & Mei (2019), eq. (14), under u = 3/10 + t."""
    u, rate = 0.3 + hy.time, v[0] + v[1]
    spring, damping = -(q[0] + q[1]), -2.0 * rate
    multiplier = (2.0 * rate + u * (spring + damping)) / (1.0 + 2.0 * u**2)
    return [spring - u * multiplier, damping - u * multiplier, multiplier]


def paper_in_mpmath(t: Any, y: Expressions) -> Expressions:
    """The rate of the state for `mpmath.odefun`, which works with as many digits as mpmath does."""
    u, rate = t + mpmath.mpf(3) / 10, y[3] + y[4]
    spring, damping = -(y[0] + y[1]), -2 * rate
    multiplier = (2 * rate + u * (spring + damping)) / (1 + 2 * u * u)
    return [y[3], y[4], y[5], spring - u * multiplier, damping - u * multiplier, multiplier]


def pendulum(q: Expressions, v: Expressions) -> Expressions:
    """A bob on a string of length 1 + t/10."""
    pull = (GRAVITY * q[1] + 0.01 - v[0] ** 2 - v[1] ** 2) / (q[0] ** 2 + q[1] ** 2)
    return [q[0] * pull, q[1] * pull - GRAVITY]


def chain(q: Expressions, v: Expressions) -> Expressions:
    """Eight masses, the first link of length 1 - t/10: Thomas' algorithm, as `chain.c` explains."""
    u, paid_out = 1.0 - 0.1 * hy.time, -0.1
    d = [(q[0], q[1]), *((x - x0, y - y0) for (x0, y0), (x, y) in pairwise(zip(q[::2], q[1::2], strict=True)))]
    e = [(v[0], v[1]), *((x - x0, y - y0) for (x0, y0), (x, y) in pairwise(zip(v[::2], v[1::2], strict=True)))]
    pivots, sides, factors = [u**2], [GRAVITY * q[1] + paid_out**2 - e[0][0] ** 2 - e[0][1] ** 2], []
    for k in range(1, LINKS):
        coupling = d[k][0] * d[k - 1][0] + d[k][1] * d[k - 1][1]
        factors.append(coupling / pivots[-1])
        pivots.append(2.0 - factors[-1] * coupling)
        sides.append(factors[-1] * sides[-1] - e[k][0] ** 2 - e[k][1] ** 2)
    multipliers = [sides[-1] / pivots[-1]]
    for k in reversed(range(LINKS - 1)):
        multipliers.insert(0, sides[k] / pivots[k] + factors[k] * multipliers[0])
    pulls = [(x * multiplier, y * multiplier) for (x, y), multiplier in zip(d, multipliers, strict=True)]
    pairs = [*((x - x1, y - y1 - GRAVITY) for (x, y), (x1, y1) in pairwise(pulls))]
    pairs.append((pulls[-1][0], pulls[-1][1] - GRAVITY))
    return [component for pair in pairs for component in pair]


def car_axis(q: Expressions, v: Expressions) -> Expressions:
    """The car axis of the Test Set for IVP Solvers."""
    mass, radius, frequency, rest, gravity = 5e-4, 0.1, 10.0, 0.5, 1.0
    (xl, yl, xr, yr), (vxl, vyl, vxr, vyr) = q, v
    b, db = radius * hy.sin(frequency * hy.time), frequency * radius * hy.cos(frequency * hy.time)
    a = hy.sqrt(1.0 - b**2)
    da, ddb = -b * db / a, -(frequency**2) * b
    dda = -(db**2 + b * ddb + da**2) / a
    xs, ys = xr - a, yr - b
    left, right = (rest / hy.sqrt(xl**2 + yl**2) - 1.0) / mass, (rest / hy.sqrt(xs**2 + ys**2) - 1.0) / mass
    h1, h2, h3, h4 = left * xl, left * yl - gravity, right * xs, right * ys - gravity
    dx, dy = xl - xr, yl - yr
    c1, c2 = 2.0 * (vxl * da + vyl * db) + xl * dda + yl * ddb, (vxl - vxr) ** 2 + (vyl - vyr) ** 2
    g11, g12, g22 = a**2 + b**2, a * dx + b * dy, 2.0 * (dx**2 + dy**2)
    r1, r2 = -(c1 + a * h1 + b * h2), -(c2 + dx * (h1 - h3) + dy * (h2 - h4))
    determinant = g11 * g22 - g12**2
    l1, l2 = (g22 * r1 - g12 * r2) / determinant, (g11 * r2 - g12 * r1) / determinant
    return [h1 + a * l1 + dx * l2, h2 + b * l1 + dy * l2, h3 - dx * l2, h4 - dy * l2]


def andrews(q: Expressions, v: Expressions) -> Expressions:
    """Andrews' squeezing mechanism: Schiehlen (1990), as in Hairer & Wanner II, section VII.7."""
    m1, m2, m3, m4, m5, m6, m7 = 0.04325, 0.00365, 0.02373, 0.00706, 0.0705, 0.00706, 0.05498
    i1, i2, i3, i4, i5, i6, i7 = 2.194e-6, 4.41e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5
    xb, yb, xc, yc, c0, l0, moment = -0.03635, 0.03273, 0.014, 0.072, 4530.0, 0.07785, 0.033
    d, da, e, ea, rr, ra, ss, sa, sb = 0.028, 0.0115, 0.02, 0.01421, 0.007, 0.00092, 0.035, 0.01874, 0.01043
    sc, sd, ta, tb, u, ua, ub, zf, zt, fa = 0.018, 0.02, 0.02308, 0.00916, 0.04, 0.01228, 0.00449, 0.02, 0.04, 0.01421
    sin_b, sin_th, sin_ga, sin_ph, sin_de, sin_om, sin_ep = map(hy.sin, q)
    cos_b, cos_th, cos_ga, cos_ph, cos_de, cos_om, cos_ep = map(hy.cos, q)
    sums = (q[0] + q[1], q[3] + q[4], q[5] + q[6])
    (sin_bth, sin_phde, sin_omep), (cos_bth, cos_phde, cos_omep) = map(hy.sin, sums), map(hy.cos, sums)

    crank = (
        m1 * ra**2 + m2 * (rr**2 - 2 * da * rr * cos_th + da**2) + i1 + i2,
        m2 * (da**2 - da * rr * cos_th) + i2,
        m2 * da**2 + i2,
    )
    triangle = m3 * (sa**2 + sb**2) + i3
    upper = (
        m4 * (e - ea) ** 2 + i4,
        m4 * ((e - ea) ** 2 + zt * (e - ea) * sin_ph) + i4,
        m4 * (zt**2 + 2 * zt * (e - ea) * sin_ph + (e - ea) ** 2) + m5 * (ta**2 + tb**2) + i4 + i5,
    )
    lower = (
        m6 * (zf - fa) ** 2 + i6,
        m6 * ((zf - fa) ** 2 - u * (zf - fa) * sin_om) + i6,
        m6 * ((zf - fa) ** 2 - 2 * u * (zf - fa) * sin_om + u**2) + m7 * (ua**2 + ub**2) + i6 + i7,
    )
    x_spring, y_spring = sd * cos_ga + sc * sin_ga + (xb - xc), sd * sin_ga - sc * cos_ga + (yb - yc)
    pull = -c0 * (1.0 - l0 / hy.sqrt(x_spring**2 + y_spring**2))
    h = [
        moment - m2 * da * rr * v[1] * (v[1] + 2.0 * v[0]) * sin_th,
        m2 * da * rr * v[0] ** 2 * sin_th,
        pull * (x_spring * (sc * cos_ga - sd * sin_ga) + y_spring * (sd * cos_ga + sc * sin_ga)),
        m4 * zt * (e - ea) * v[4] ** 2 * cos_ph,
        -m4 * zt * (e - ea) * v[3] * (v[3] + 2.0 * v[4]) * cos_ph,
        -m6 * u * (zf - fa) * v[6] ** 2 * cos_om,
        m6 * u * (zf - fa) * v[5] * (v[5] + 2.0 * v[6]) * cos_om,
    ]
    x1, x2, y1, y2 = d * sin_bth - rr * sin_b, d * sin_bth, rr * cos_b - d * cos_bth, -d * cos_bth
    jacobian = [
        {0: x1, 1: x2, 2: -ss * cos_ga},
        {0: y1, 1: y2, 2: -ss * sin_ga},
        {0: x1, 1: x2, 3: -e * cos_phde, 4: zt * sin_de - e * cos_phde},
        {0: y1, 1: y2, 3: -e * sin_phde, 4: -zt * cos_de - e * sin_phde},
        {0: x1, 1: x2, 5: zf * sin_omep, 6: zf * sin_omep - u * cos_ep},
        {0: y1, 1: y2, 5: -zf * cos_omep, 6: -zf * cos_omep - u * sin_ep},
    ]
    bth, phde, omep = (v[0] + v[1]) ** 2, (v[3] + v[4]) ** 2, (v[5] + v[6]) ** 2
    cx, cy = d * cos_bth * bth - rr * cos_b * v[0] ** 2, d * sin_bth * bth - rr * sin_b * v[0] ** 2
    c = [
        cx + ss * sin_ga * v[2] ** 2,
        cy - ss * cos_ga * v[2] ** 2,
        cx + e * sin_phde * phde + zt * cos_de * v[4] ** 2,
        cy - e * cos_phde * phde + zt * sin_de * v[4] ** 2,
        cx + zf * cos_omep * omep + u * sin_ep * v[6] ** 2,
        cy + zf * sin_omep * omep - u * cos_ep * v[6] ** 2,
    ]
    divide = lambda row: _divided_by_mass(row, crank, triangle, upper, lower)  # noqa: E731
    unconstrained = divide(dict(enumerate(h)))
    weighted = [divide(row) for row in jacobian]
    matrix = [[_dot(weighted[i], jacobian[k]) if i >= k else None for k in range(len(c))] for i in range(len(c))]
    sides = [-(c[i] + _dot(jacobian[i], unconstrained)) for i in range(len(c))]
    multipliers = _solved(matrix, sides)
    return [
        unconstrained[s] + hy.sum([row[s] * m for row, m in zip(weighted, multipliers, strict=True) if s in row])
        for s in range(len(q))
    ]


def _divided_by_mass(
    row: Mapping[int, Any], crank: Expressions, triangle: float, upper: Expressions, lower: Expressions
) -> dict[int, Any]:
    """The inverse of the mass matrix, three blocks of two and one of one, times a sparse vector."""
    result = {}
    for first, (a, b, c) in ((0, crank), (3, upper), (5, lower)):
        if first in row:
            determinant = a * c - b**2
            x, y = row[first], row[first + 1]
            result |= {first: (c * x - b * y) / determinant, first + 1: (a * y - b * x) / determinant}
    return result | ({2: row[2] / triangle} if 2 in row else {})


def _dot(a: Mapping[int, Any], b: Mapping[int, Any]) -> Any:
    return hy.sum([a[s] * b[s] for s in sorted(a.keys() & b.keys())])


def _solved(matrix: list[list[Any]], sides: list[Any]) -> list[Any]:
    """LDL^T of the lower triangle."""
    size, factors = len(sides), {}
    for k in range(size):
        for i in range(k + 1, size):
            factors[i, k] = matrix[i][k] / matrix[k][k]
            for j in range(k + 1, i + 1):
                matrix[i][j] -= factors[i, k] * matrix[j][k]
            sides[i] -= factors[i, k] * sides[k]
    found = [side / matrix[k][k] for k, side in enumerate(sides)]
    for k in reversed(range(size)):
        found[k] -= hy.sum([factors[i, k] * found[i] for i in range(k + 1, size)]) if k + 1 < size else 0.0
    return found


MOTIONS = (
    Motion("paper", EXAMPLES / "paper" / "paper.mac", "initial_motion_scene", Fraction(10), paper),
    Motion("pendulum", EXAMPLES / "pendulum.mac", "lengthening_scene", Fraction(100), pendulum),
    Motion("chain_8", EXAMPLES / "chain.mac", "swing_scene", Fraction(2), chain, {"N": str(LINKS)}),
    Motion("car_axis", EXAMPLES / "car_axis.mac", "bumpy_road_scene", Fraction(3), car_axis),
    Motion("andrews", EXAMPLES / "andrews.mac", "starting_scene", Fraction(3, 100), andrews),
)
