"""The truths of the hard cases: closed forms, quadratures, and solutions with many digits.

Run it to write the values to the package: ``.venv/bin/python tests/benchmark/hard_cases/hard_truths.py``.
"""

import json
from itertools import product
from pathlib import Path

import mpmath
import numpy as np
from mpmath import asin, cos, eigsy, ellipfun, ellipk, exp, findroot, lu_solve, matrix, mp, mpf, pi, quad, sin, sqrt

import holonom
from holonom.benchmark.hard_cases.runs import problem
from holonom.simulation.matrices import MotionMatrices

FILE = Path(holonom.__file__).parent / "benchmark/hard_cases/references.json"

certified = mp.workdps(40)
"""Decorates what computes a truth; as a context, what its constants are made in."""

with certified:
    GRAVITY = mpf("9.81")
    FREQUENCY = sqrt(GRAVITY)  # of small oscillations of a pendulum of length 1


@certified
def swing(amplitude: mpf, frequency: mpf, t: mpf) -> tuple[mpf, mpf]:
    """sin(phi) and cos(phi) of a pendulum released at rest, phi'' = -w^2 sin(phi) (Whittaker, section 44)."""
    modulus = sin(amplitude / 2)
    half = modulus * ellipfun("sn", ellipk(modulus**2) + frequency * t, m=modulus**2)
    return 2 * half * sqrt(1 - half**2), 1 - 2 * half**2


@certified
def period(amplitude: mpf, frequency: mpf) -> mpf:
    return 4 * ellipk(sin(amplitude / 2) ** 2) / frequency


@certified
def turning(frequency: mpf, t: mpf) -> tuple[mpf, mpf]:
    """sin(phi) and cos(phi) of a rotating pendulum, from the top, where its velocity is 1."""
    rate = sqrt(1 + 4 * frequency**2)
    m = (2 * frequency / rate) ** 2
    argument = rate * t / 2 - ellipk(m)
    sn, cn = ellipfun("sn", argument, m=m), ellipfun("cn", argument, m=m)
    return -2 * sn * cn, 2 * sn**2 - 1


@certified
def revolution(frequency: mpf) -> mpf:
    """The time of one revolution of the pendulum of `turning`."""
    rate = sqrt(1 + 4 * frequency**2)
    return 4 * ellipk((2 * frequency / rate) ** 2) / rate


def circling() -> dict:
    """States and accelerations of a pendulum on the circle that the two rods of the swing leave free."""
    sideways, slanting = np.array([2, 1, -2]) / 3, np.array([2, -2, 1]) / 3  # span the plane of the circle
    weight, rate = np.array([0, 0, -9.81]), 0.7
    states, accelerations = [], []
    for place in (0.3, 1.1, 2.9):  # in radians
        outward = sideways * np.cos(place) + slanting * np.sin(place)
        along = slanting * np.cos(place) - sideways * np.sin(place)
        states.append([*outward, *rate * along])
        accelerations.append(list((weight @ along) * along - rate**2 * outward))
    return {"states": states, "accelerations": accelerations}


@certified
def given_twice(until: int) -> dict:
    x, depth = swing(pi / 2, FREQUENCY, mpf(until))
    multiplier = -3 * GRAVITY * depth  # m g cos(phi) + m l phi'^2, phi'^2 = 2 g/l cos(phi), towards the hinge
    forces = [multiplier * x, -multiplier * depth]
    return {
        "until": until,
        "coordinates": [x, -depth],
        "constraint forces": forces,
        "multipliers": [multiplier, 0],
    }


class Sarrus:
    """A closed spatial mechanism with one redundant constraint, reduced to the angle phi of the legs with the ground.

    T = m l^2 (1 + 6 cos(phi)^2) phi'^2, V = 8 m g l sin(phi), with m = l = 1.
    """

    FILE = "hard/sarrus_linkage.mac"
    with certified:
        UNTIL, START = mpf(3) / 10, asin(mpf(4) / 5)

    @staticmethod
    @certified
    def fallen(t: mpf) -> mpf:
        """The angle of the legs, released at rest: the time is a quadrature over it, by conservation of energy."""

        def time_to(phi: mpf) -> mpf:
            return quad(
                lambda x: sqrt((1 + 6 * cos(x) ** 2) / (8 * GRAVITY * (sin(Sarrus.START) - sin(x)))),
                [phi, Sarrus.START],
            )

        return findroot(lambda phi: time_to(phi) - t, (Sarrus.START / 2, Sarrus.START * mpf(3) / 4))

    @staticmethod
    @certified
    def coordinates(phi: mpf) -> list[mpf]:
        """Those of the elbows and of the table's corners."""
        c, s = cos(phi), sin(phi)
        return [-c, -1, s, 1, c, s, 0, -1, 2 * s, 1, 0, 2 * s, 0, 0, 2 * s]

    @staticmethod
    @certified
    def constraint_forces(phi: mpf) -> list[mpf]:
        """Mass times acceleration without gravity, of every point."""
        c, s = cos(phi), sin(phi)
        square = 8 * GRAVITY * (sin(Sarrus.START) - s) / (1 + 6 * c**2)
        second = (6 * c * s * square - 4 * GRAVITY * c) / (1 + 6 * c**2)
        across, up = -s * second - c * square, c * second - s * square
        elbows, corner = [-across, 0, up + GRAVITY, 0, across, up + GRAVITY], [0, 0, 2 * up + GRAVITY]
        return elbows + 3 * corner


def sarrus() -> dict:
    """Motion, forces, and multipliers that are zero for the constraints that the program leaves out."""
    motion, phi = problem(Sarrus.FILE), Sarrus.fallen(Sarrus.UNTIL)
    places, forces = Sarrus.coordinates(phi), Sarrus.constraint_forces(phi)
    state = np.array([*map(float, places), *np.zeros(len(places))])
    jacobian = MotionMatrices(motion).independent(float(Sarrus.UNTIL), state).jacobian
    multipliers = np.zeros(len(motion.multipliers))
    with certified:  # the normal equations; LAPACK in doubles rounds otherwise on other processors
        multipliers[list(motion.independent)] = lu_solve(matrix(jacobian.T.tolist()), matrix(forces))
    until = float(Sarrus.UNTIL)
    return {"until": until, "coordinates": places, "constraint forces": forces, "multipliers": multipliers.tolist()}


@certified
def parallelogram() -> dict:
    """The rods' common angle; two rods and a coupler start upright at 1 m/s."""
    frequency = sqrt(GRAVITY * 2 / (mpf(2) / 3 + 1))  # of small oscillations about the lowest place
    spans = {}
    for extent, revolutions in (("short", 5), ("full", 50)):
        until = round(revolutions * revolution(frequency))
        tip = turning(frequency, mpf(until))
        spans[extent] = {"revolutions": revolutions, "until": until, "coordinates": list(tip)}
    return {**spans, "energy": mpf(2) / 3 / 2 + mpf(1) / 2 + 2 * GRAVITY}


class Springs:
    """With a rod of controlled length u between bodies 1 and 2 of a rail, p = x1 and s = x3 - u - r obey

    2 m p'' = -k p + K (s - p),   m s'' = -K (s - p).
    """

    with certified:
        SOFT, STIFF, LENGTH, SPEED, REST = mpf(1), mpf(10) ** 6, mpf(1), mpf(1) / 10, mpf(1)  # k, K, l0, v, r; m = 1
        P, S = mpf(1) / 10, mpf(101) / 1000  # at the initial time, at rest
        ENERGY = (SOFT * P**2 + STIFF * (S - P) ** 2) / 2

    @classmethod
    @certified
    def coordinates(cls, t: mpf) -> list[mpf]:
        """x1, x2, x3. With y = (sqrt(2) p, s) the masses are one, and the stiffness symmetric."""
        root = sqrt(mpf(2))
        stiffness = matrix([[(cls.SOFT + cls.STIFF) / 2, -cls.STIFF / root], [-cls.STIFF / root, cls.STIFF]])
        squares, modes = eigsy(stiffness)
        amplitudes = modes.T * matrix([root * cls.P, cls.S])
        y = modes * matrix([a * cos(sqrt(square) * t) for a, square in zip(amplitudes, squares, strict=True)])
        p, s, u = y[0] / root, y[1], cls.LENGTH + cls.SPEED * t
        return [p, p + u, s + u + cls.REST]


@certified
def stiff_spring() -> dict:
    spans = {
        extent: {"until": until, "coordinates": Springs.coordinates(mpf(until))}  # 195 oscillations a second
        for extent, until in (("short", 1), ("full", 10))
    }
    return {**spans, "energy": Springs.ENERGY}


@certified
def car_axis() -> dict:
    """xl, yl, xr, yr at t = 3, as published.

    Mazzia & Magherini, Test Set for Initial Value Problem Solvers, problem caraxis. The values are those of the package
    deTestSet for R, which are right to about twelve decimals.
    """
    published = "0.0493455784275402809122 0.496989460230171153861 1.04174252488542151681 0.373911027265361256927"
    return {"until": 3, "coordinates": [mpf(number) for number in published.split()]}


class Paper:
    """The paper's example under the control (15), u = u0 exp(t): an exact free motion.

    The sum s = q1 + q2 obeys s'' + 2 s' + s = 0, so that s = (a + b t) exp(-t). q1'' = -s and q3 = u s.
    """

    with certified:
        U0, Q1, Q2, V1, V2 = mpf(3) / 10, mpf(1), mpf(2), mpf(1) / 2, -mpf(1) / 3  # as in the scene
        A, B = Q1 + Q2, Q1 + Q2 + V1 + V2

    @classmethod
    @certified
    def coordinates(cls, t: mpf) -> list[mpf]:
        A, B = cls.A, cls.B
        q1 = cls.Q1 + (cls.V1 - A - B) * t + A + 2 * B - (A + 2 * B + B * t) * exp(-t)
        return [q1, (A + B * t) * exp(-t) - q1, cls.U0 * (A + B * t)]

    @classmethod
    @certified
    def velocities(cls, t: mpf) -> list[mpf]:
        A, B = cls.A, cls.B
        v1 = cls.V1 - A - B + (A + B + B * t) * exp(-t)
        return [v1, (B - A - B * t) * exp(-t) - v1, cls.U0 * B]

    @classmethod
    @certified
    def forces(cls, t: mpf) -> list[mpf]:
        """Those of the spring and of the damping."""
        A, B = cls.A, cls.B
        return [-(A + B * t) * exp(-t), -2 * (B - A - B * t) * exp(-t)]

    @classmethod
    @certified
    def gradient(cls, t: mpf) -> mpf:
        """The largest component of the constraint's gradient, (-u, -u, 1)."""
        return max(mpf(1), cls.U0 * exp(t))


@certified
def free_motion() -> list[dict]:
    return [
        {
            "t": t,
            "state": [*Paper.coordinates(mpf(t)), *Paper.velocities(mpf(t))],
            "gradient": Paper.gradient(mpf(t)),
            "force": max(map(abs, Paper.forces(mpf(t)))),
        }
        for t in range(11)  # the scene's time span
    ]


@certified
def overflowing_control() -> dict:
    motions = [
        {"until": t, "coordinates": Paper.coordinates(mpf(t)), "gradient": Paper.gradient(mpf(t))} for t in (355, 360)
    ]
    return {"motions": motions, "initial_force": max(map(abs, Paper.forces(mpf(0))))}


class HeavyBob:
    """A heavy bob on a light chain, with a mass ratio of 10^12."""

    UNTIL = 0.3
    LIGHT, HEAVY = mpf("1e-6"), mpf("1e6")
    DIRECTIONS, BENDS, RATES = (-0.6, -1.4), (1.0, 1e-3), (0.5, -2.0)
    # of the upper rod, of the lower against it; rad, rad/s

    @classmethod
    def hanging(cls, direction: float, bend: float) -> list[float]:
        """x1, y1, x2, y2 and their time derivatives."""
        upper, lower = np.exp(1j * direction), np.exp(1j * (direction + bend))
        places = np.array([upper, upper + lower])
        velocities = 1j * np.array([cls.RATES[0] * upper, cls.RATES[0] * upper + cls.RATES[1] * lower])
        return np.concatenate([places.view(float), velocities.view(float)]).tolist()

    @classmethod
    def accelerations(cls, state: list[float]) -> list[mpf]:
        """x1'', y1'', x2'', y2'' from the bordered equations of two rods, with 60 digits."""
        with mp.workdps(60):
            gravity = mpf("9.81")
            x1, y1, x2, y2, vx1, vy1, vx2, vy2 = map(mpf, state)
            jacobian = matrix([[x1, y1, 0, 0], [x1 - x2, y1 - y2, x2 - x1, y2 - y1]])
            bordered = mpmath.zeros(6)
            bordered[:4, :4] = mpmath.diag([cls.LIGHT, cls.LIGHT, cls.HEAVY, cls.HEAVY])
            bordered[:4, 4:], bordered[4:, :4] = -jacobian.T, jacobian
            squares = [vx1**2 + vy1**2, (vx2 - vx1) ** 2 + (vy2 - vy1) ** 2]
            sides = [0, -cls.LIGHT * gravity, 0, -cls.HEAVY * gravity, -squares[0], -squares[1]]
            return list(mpmath.lu_solve(bordered, matrix(sides)))[:4]

    @staticmethod
    @certified
    def falling(t: mpf) -> list[mpf]:
        """Both places: the heavy one in free fall from (1, -1) to within 1e-12, the light one at the rods' bend."""
        drop = 1 + GRAVITY * t**2 / 2
        half = (1 + drop**2) / 4  # square of half of the way from the hinge to the bob
        bend = sqrt((1 - half) / (4 * half))
        return [mpf(1) / 2 + bend * drop, bend - drop / 2, mpf(1), -drop]


def mass_ratio() -> dict:
    states = [HeavyBob.hanging(*at) for at in product(HeavyBob.DIRECTIONS, HeavyBob.BENDS)]
    return {
        "states": states,
        "accelerations": [HeavyBob.accelerations(state) for state in states],
        "until": HeavyBob.UNTIL,
        "coordinates": HeavyBob.falling(mpf(HeavyBob.UNTIL)),
    }


@certified
def long_run() -> dict:
    """The integer times nearest to the ends of some periods, and x and y then."""
    amplitude, places = pi / 13, {}
    for periods in (50, 1_000, 10_000):
        until = round(periods * period(amplitude, FREQUENCY))
        x, depth = swing(amplitude, FREQUENCY, mpf(until))
        places[str(periods)] = {"until": until, "coordinates": [x, -depth]}
    return {**places, "energy": GRAVITY}  # to turn upright takes twice as much


def truths() -> dict:
    """Reference values of the register, by case."""
    return {
        "parallel_constraints": circling(),
        "constraint_given_twice": given_twice(10),
        "sarrus_linkage": sarrus(),
        "dead_centres": parallelogram(),
        "stiff_spring": stiff_spring(),
        "car_axis": car_axis(),
        "overflowing_control": overflowing_control(),
        "mass_ratio": mass_ratio(),
        "long_run": long_run(),
        "free_motion": free_motion(),
        "vanishing_length": {"time": 1},  # of the length 1 - t
    }


if __name__ == "__main__":
    values = {name: json.dumps(case, default=float) for name, case in truths().items()}
    FILE.write_text("{\n" + ",\n".join(f'"{name}": {value}' for name, value in values.items()) + "\n}\n", "utf-8")
