"""Laws of a wire that a control turns, and another one may shift, against a scan of all directions.

The verdicts all and none must name each direction along which random forces push the bead to no side, or equally in all
states of the bead where the wire may be shifted with them.
"""

import random

import numpy as np
import pytest

from holonom.free_motion import free_motion
from holonom.sandbox import Limits

FORCES = {  # components, and as functions of x, y, dot(x), dot(y)
    "weight": ("{a}", "{b}", lambda a, b, x, y, v, w: (a, b)),
    "spring": ("-{a}*x", "-{b}*y", lambda a, b, x, y, v, w: (-a * x, -b * y)),
    "magnet": ("{a}*dot(y)", "-{a}*dot(x)", lambda a, b, x, y, v, w: (a * w, -a * v)),
    "drag": ("-{a}*dot(x)", "-{b}*dot(y)", lambda a, b, x, y, v, w: (-a * v, -b * w)),
    "shear": ("{a}*y", "{b}*x", lambda a, b, x, y, v, w: (a * y, b * x)),
}
ANGLES = {"u": lambda u: u, "2*u": lambda u: 2 * u, "(u + 1)": lambda u: u + 1, "-u": lambda u: -u}
DIRECTIONS = np.linspace(-np.pi, np.pi, 1440, endpoint=False) + 0.001
STATES = ((0.3, 0.7), (-1.1, 0.4), (1.7, -1.3))  # place along the wire, and speed


def side_forces(controls, angle, offset, forces):
    """Forces across the wire, shape (states, controls)."""
    c, s = np.cos(angle(controls)), np.sin(angle(controls))
    sides = []
    for r, v in STATES:
        x, y = r * c + offset * s, r * s - offset * c
        pushes = [(f(a, b, x, y, v * c, v * s)) for f, a, b in forces]
        sides.append(sum(p[0] for p in pushes) * s - sum(p[1] for p in pushes) * c + 0 * controls)
    return np.array(sides)


def side_force(controls, *wire):
    """The largest force across the wire in some states, shape of the controls."""
    return np.abs(side_forces(controls, *wire)).max(axis=0)


def difference(controls, *wire):
    """By how much forces across the wire differ from state to state, shape of the controls."""
    return np.ptp(side_forces(controls, *wire), axis=0)


def zeros_of(size, *wire):
    """Controls of a period under which what forces do across the wire is zero."""
    found, step = [], DIRECTIONS[1] - DIRECTIONS[0]
    values = size(DIRECTIONS, *wire)
    for place in np.flatnonzero((values <= np.roll(values, 1)) & (values <= np.roll(values, -1))):
        low, high = DIRECTIONS[place] - step, DIRECTIONS[place] + step
        for _ in range(8):
            near = np.linspace(low, high, 41)
            best = int(np.argmin(size(near, *wire)))
            low, high = near[max(best - 1, 0)], near[min(best + 1, 40)]
        if size(np.array([low, high]), *wire).min() < 1e-8:
            found.append((low + high) / 2)
    return found


def is_same(one, other):
    return abs((one - other + np.pi) % (2 * np.pi) - np.pi) < 1e-6


@pytest.mark.long
@pytest.mark.parametrize("seed", range(12))
def test_directions_of_all_and_none_are_those_of_a_scan(seed, write_scene):
    chance = random.Random(seed)
    angle, offset = chance.choice(list(ANGLES)), chance.choice([0, 0, 1])
    compare_laws(side_force, chance, list(FORCES), angle, offset, str(offset), ["u"], write_scene)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(12))
def test_directions_of_a_shifted_wire_are_those_of_a_scan(seed, write_scene):
    chance = random.Random(seed)
    angle, forces = chance.choice(["u", "-u", "(u + 1)"]), ["weight", "spring", "shear"]
    compare_laws(difference, chance, forces, angle, 0, "w", ["u", "w"], write_scene)


def compare_laws(size, chance, forces, angle, offset, shift, controls, write_scene):
    chosen = [(FORCES[name], chance.choice([1, 2, 3]), chance.choice([-1, 0, 2])) for name in chance.sample(forces, 2)]
    written = [" + ".join(f[k].format(a=a, b=f"({b})") for f, a, b in chosen) for k in (0, 1)]
    scene = write_scene(f"""load("holonom.mac")$
      wire : holonomic_system(coordinates = [x, y], controls = [{", ".join(controls)}],
        kinetic_energy = (dot(x)^2 + dot(y)^2)/2, forces = [{written[0]}, {written[1]}],
        constraints = [x*sin({angle}) - y*cos({angle}) - {shift}])$
      turned : holonomic_scene(wire, control_law = [{", ".join(f"{u} = 1 + t" for u in controls)}],
        initial_state = [x = 1, dot(x) = 0], initial_guess = [y = 0, dot(y) = 0], time_span = [0, 1])$""")
    found = free_motion(scene, None, {}, Limits(seconds=300)).universal
    if found.verdict not in ("all", "none"):
        pytest.skip(found.verdict)
    wire = (ANGLES[angle], offset, [(f[2], a, b) for f, a, b in chosen])
    laws = [law.controls["u"] for law in found.laws]
    if size(DIRECTIONS, *wire).max() < 1e-12:
        assert any(law.is_Symbol for law in laws)
        return
    listed, scanned = [float(law) for law in laws if law.is_number], zeros_of(size, *wire)
    assert all(any(is_same(one, other) for other in listed) for one in scanned)
    assert all(any(is_same(one, other) for other in scanned) for one in listed)
