"""The shaken, turning support against Newton's second law in axes that do not turn."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import holonom

RATE, GRAVITY, DRAG = 0.5, 9.81, 0.1  # Omega, g, c of the scene; m = l = 1
AXIS = np.array([0.0, 0.0, RATE])


def turned(t, vector):
    """From the turning axes to those at rest."""
    cos, sin = np.cos(RATE * t), np.sin(RATE * t)
    return np.array([cos * vector[0] - sin * vector[1], sin * vector[0] + cos * vector[1], vector[2]])


def support(t):
    """Place, velocity and acceleration in the axes at rest, as components along the turning ones."""
    place = np.array([np.sin(3 * t) / 10, 0.0, np.cos(7 * t) / 20])
    rate = np.array([3 * np.cos(3 * t) / 10, 0.0, -7 * np.sin(7 * t) / 20])
    second = np.array([-9 * np.sin(3 * t) / 10, 0.0, -49 * np.cos(7 * t) / 20])
    along = rate + np.cross(AXIS, place)
    return place, along, second + 2 * np.cross(AXIS, rate) + np.cross(AXIS, np.cross(AXIS, place))


def newton(t, y):
    """The rates of the bob's place and velocity, seen from the support in axes at rest; the rod pulls along itself."""
    rod, relative = np.split(y, 2)
    pull = turned(t, support(t)[2])
    air = relative - np.cross(AXIS, rod)
    force = np.array([0.0, 0.0, -GRAVITY]) - DRAG * air - pull
    return np.concatenate([relative, force - (relative @ relative + rod @ force) * rod])


def test_the_shaken_scene():
    rod, seen = np.array([0.6, 0.0, -0.8]), np.array([0.0, 1.0, 0.0])
    found = solve_ivp(newton, (0, 10), [*rod, *(seen + np.cross(AXIS, rod))], method="DOP853", rtol=1e-12, atol=1e-13)
    motion = holonom.load("examples/spherical_pendulum.mac", scene="shaken_scene").simulate(samples=2)
    assert [motion[name][-1] for name in "xyz"] == pytest.approx(turned(-10, found.y[:3, -1]), abs=1e-9)
