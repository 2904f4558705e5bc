"""Ten systems linearised: SymPy's Linearizer, and differences of motions that begin beside each other.

``python tests/stability/test_linearized_truths.py`` prints the largest relative errors as a table.
"""

import re
from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import LagrangesMethod, Point, ReferenceFrame, dynamicsymbols

import holonom

STEP = 1e-3  # of a disturbance, for differences of order six
WEIGHTS = {1: 3 / 4, 2: -3 / 20, 3: 1 / 60}
AGREED = 1e-8


class System(NamedTuple):
    """Energies and the rest in SymPy's notation, with dx for the rate of x, and F for the control."""

    coordinates: str
    kinetic: str
    potential: str
    constraints: list[str]
    start: dict[str, str]  # of independent coordinates, then of their velocities
    guess: Mapping[str, str] = MappingProxyType({})
    forces: list[str] | None = None  # beside the potential's
    control: str = "0"  # law

    @property
    def pushes(self):
        """The forces; the control pushes the first coordinate if nothing else does."""
        return self.forces or ["F", *("0" for _ in self.coordinates.split()[1:])]


SYSTEMS = {
    "cart and pendulum": System(
        "s x y",
        "ds**2 + (dx**2 + dy**2)/2",
        "10*y",
        ["(x - s)**2 + y**2 - 1"],
        {"s": "1/10", "x": "7/10", "ds": "1/3", "dx": "-1/2"},
        {"y": "-4/5", "dy": "0"},
        ["F - ds/2", "-dx/3", "0"],
        "sin(t)",
    ),
    "double pendulum": System(
        "x y z w",
        "(dx**2 + dy**2)/2 + (dz**2 + dw**2)",
        "10*y + 20*w",
        ["x**2 + y**2 - 1", "(z - x)**2 + (w - y)**2 - 2"],
        {"x": "3/5", "z": "1/5", "dx": "1/2", "dz": "-1"},
        {"y": "-4/5", "w": "-2", "dy": "0", "dw": "0"},
    ),
    "bead on a parabola, with drag": System(
        "x y",
        "(dx**2 + dy**2)/2",
        "9*y",
        ["y - x**2/2"],
        {"x": "1/2", "dx": "1"},
        {"y": "1/8", "dy": "1/2"},
        ["F - dx*(1 + dx**2)/5", "-dy/7"],
        "cos(2*t)",
    ),
    "Foucault's pendulum": System(
        "x y z",
        "((dx - 3*y/10)**2 + (dy + 3*x/10)**2 + dz**2)/2",
        "10*z",
        ["x**2 + y**2 + z**2 - 4"],
        {"x": "1/2", "y": "1/5", "dx": "1/3", "dy": "-1"},
        {"z": "-2", "dz": "0"},
    ),
    "slider-crank": System(
        "p r x",
        "dp**2/6 + dx**2/2 + dr**2/3",
        "2*sin(p)",
        ["x - cos(p) - 2*cos(r)", "sin(p) - 2*sin(r)"],
        {"p": "1/2", "dp": "2"},
        {"r": "1/4", "x": "3", "dr": "0", "dx": "0"},
        ["F", "0", "-dx/4"],
        "1/2",
    ),
    "point on an ellipsoid": System(
        "x y z",
        "(dx**2 + 2*dy**2 + dz**2)/2",
        "x**2 + y*z",
        ["x**2/4 + y**2 + z**2/2 - 1"],
        {"x": "1/2", "y": "1/3", "dx": "1", "dy": "1/2"},
        {"z": "1", "dz": "0"},
    ),
    "spinning top": System(
        "x y z",
        "(dx**2 + dy**2 + dz**2)/2 + 3*(x*dy - y*dx)/(1 + z)",
        "2*z",
        ["x**2 + y**2 + z**2 - 1"],
        {"x": "1/5", "y": "1/10", "dx": "1/2", "dy": "0"},
        {"z": "1", "dz": "0"},
    ),
    "swinging Atwood machine": System(
        "h r x y",
        "3*dh**2/2 + (dx**2 + dy**2)/2",
        "30*h + 10*y",
        ["x**2 + y**2 - r**2", "r - h - 2"],
        {"x": "1/2", "h": "-1", "dx": "1/4", "dh": "0"},
        {"r": "1", "y": "-4/5", "dr": "0", "dy": "0"},
    ),
    "rod that slides in a corner": System(
        "a x y",
        "(dx**2 + dy**2)/2 + da**2/6",
        "10*y",
        ["x - cos(a)", "y - sin(a)"],
        {"a": "4/5", "da": "-1/2"},
        {"x": "7/10", "y": "7/10", "dx": "0", "dy": "0"},
        ["-dx", "F", "0"],
        "1 + t",
    ),
    "coupled masses of variable inertia": System(
        "x y",
        "(1 + x**2)*dx**2/2 + dy**2 + y*dx*dy/3",
        "x**4/4 + x*y + y**2",
        [],
        {"x": "1/2", "y": "1", "dx": "0", "dy": "-1"},
        {},
        ["F*x", "-dy**3"],
        "t",
    ),
}


def holonom_scene(system):
    """The scene, whose independent initial values all move with e, each by another factor."""

    def written(text):
        for name in system.coordinates.split():
            text = re.sub(rf"\bd{name}\b", f"dot({name})", text)
        return text.replace("**", "^")

    moved = [f"{written(name)} = {value} + {k}*e/3" for k, (name, value) in enumerate(system.start.items(), start=1)]
    guess = [f"{written(name)} = {value}" for name, value in system.guess.items()]
    names = system.coordinates.split()
    constraints = f", constraints = [{', '.join(map(written, system.constraints))}]" if system.constraints else ""
    return holonom.system(f"""
system : holonomic_system(coordinates = [{", ".join(names)}], controls = [F], parameters = [e],
  kinetic_energy = {written(system.kinetic)}, potential_energy = {written(system.potential)},
  forces = [{", ".join(map(written, system.pushes))}]{constraints})$
s : holonomic_scene(system, parameter_values = [e = 0], control_law = [F = {system.control}], time_span = [0, 1/2],
  initial_state = [{", ".join(moved)}], initial_guess = [{", ".join(guess)}], observe = [trajectory, multipliers,
  {", ".join(f"a{name} = ddot({name})" for name in names)}])$""")


def by_sympy(system, start, accelerations, multipliers):
    """The accelerations of the independent coordinates by these, their velocities, and F."""
    names = system.coordinates.split()
    q = dynamicsymbols(" ".join(names), real=True)
    v, force = [sp.diff(s, dynamicsymbols._t) for s in q], dynamicsymbols("F")
    known = dict(zip(names, q, strict=True)) | {f"d{name}": rate for name, rate in zip(names, v, strict=True)}

    def read(text):
        return sp.sympify(text, locals=known | {"F": force})

    frame = ReferenceFrame("N")
    forces = []
    for k, text in enumerate(system.pushes):
        point = Point(f"P{k}")
        point.set_vel(frame, v[k] * frame.x)
        forces.append((point, read(text) * frame.x))
    lagrangian = read(system.kinetic) - read(system.potential)
    holonomic = {"hol_coneqs": list(map(read, system.constraints))} if system.constraints else {}
    method = LagrangesMethod(lagrangian, q, forcelist=forces, frame=frame, **holonomic)
    method.form_lagranges_equations()
    free = [name for name in names if name in system.start]
    split = {
        "q_ind": [known[name] for name in free],
        "qd_ind": [known[f"d{name}"] for name in free],
        "q_dep": [known[name] for name in names if name not in free],
        "qd_dep": [known[f"d{name}"] for name in names if name not in free],
    }
    linearizer = method.to_linearizer(**split)
    at = dict(zip((*q, *v), start, strict=True)) | {force: float(sp.sympify(system.control).subs("t", 0))}
    at |= {sp.diff(s, dynamicsymbols._t, 2): a for s, a in zip(q, accelerations, strict=True)}
    at |= {symbol: -value for symbol, value in zip(getattr(method, "lam_vec", []), multipliers, strict=False)}
    mass, a, b = (np.array(part, dtype=float) for part in linearizer.linearize(op_point=at))
    order = np.array(linearizer.perm_mat, dtype=float).T
    return free, [(order @ np.linalg.solve(mass, part))[len(free) : 2 * len(free)] for part in (a, b)]


def error_against_sympy(name):
    system = SYSTEMS[name]
    scene = holonom_scene(system)
    motion = scene.simulate(samples=2)
    names = system.coordinates.split()
    start = [motion[each][0] for each in (*names, *(f"dot({each})" for each in names))]
    accelerations = [motion[f"a{each}"][0] for each in names]
    multipliers = [motion[f"lambda{k + 1}"][0] for k in range(len(system.constraints))]
    free, (a, b) = by_sympy(system, start, accelerations, multipliers)
    found = scene.linearize(at=0)
    rows = {each: found.output_row(each) for each in found.outputs}
    moved = np.array([*(rows[each] for each in free), *(rows[f"dot({each})"] for each in free)])
    forced = found.D["u"][[found.outputs.index(f"a{each}") for each in free]]
    ours = np.array([rows[f"a{each}"] for each in free]) @ np.linalg.inv(moved)
    return max(np.abs(ours - a).max(), np.abs(forced - b).max()) / max(1.0, np.abs(a).max())


def error_against_differences(name):
    """Of coordinates, velocities and multipliers at three times, disturbed at the start."""
    scene = holonom_scene(SYSTEMS[name])
    n, g = len(SYSTEMS[name].coordinates.split()), len(SYSTEMS[name].constraints)

    def numbers(e):
        motion = scene.simulate(samples=3, tol=1e-16, e=e)
        return np.array([*motion.coordinates.values(), *motion.velocities.values(), *motion.multipliers.values()]).T

    truth = sum(w * (numbers(k * STEP) - numbers(-k * STEP)) for k, w in WEIGHTS.items()) / STEP
    along = scene.linearize_along(samples=3)
    first = along[0]
    start = np.concatenate([first.basis.T @ first.mass @ part for part in (truth[0, :n], truth[0, n : 2 * n])])
    found = np.array([each.C[: 2 * n + g] @ phi @ start for each, phi in zip(along.at, along.transition, strict=True)])
    return np.abs(found - truth).max() / max(1.0, np.abs(truth).max())


@pytest.mark.parametrize("name", SYSTEMS)
def test_accelerations_of_a_moving_state_against_sympys_linearizer(name):
    assert error_against_sympy(name) < AGREED


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[] if k < 2 else pytest.mark.long) for k, name in enumerate(SYSTEMS)]
)
def test_motion_beside_a_motion_against_differences(name):
    assert error_against_differences(name) < AGREED


TOP = """system : holonomic_system(coordinates = [x, y, z], parameters = [L],
  kinetic_energy = (dot(x)^2 + dot(y)^2 + dot(z)^2)/2, constraints = [x^2 + y^2 + z^2 - 1],
  potential_energy = [gravity = 2*z, spin = -L*(x*dot(y) - y*dot(x))/(1 + z)])$
s : holonomic_scene(system, parameter_values = [L = 3], time_span = [0, 1], initial_state =
  [x = 0, y = 0, z = 1, dot(x) = 0, dot(y) = 0, dot(z) = 0])$
"""


@pytest.mark.parametrize("spin", [2, 2.8, 2.9, 4])
def test_sleeping_top_is_upset_below_its_limit(spin):
    """I w^2 - L w + m g l = 0, whose roots are complex for L^2 < 4 I m g l = 8 (Landau & Lifshitz, section 35)."""
    found = holonom.system(TOP).with_settings(L=spin).linearize()
    roots = np.roots([1, -spin, 2])
    truth = np.concatenate([1j * roots, np.conj(1j * roots)])
    apart = np.abs(found.eigenvalues[:, None] - truth)
    assert max(apart.min(axis=0).max(), apart.min(axis=1).max()) < 1e-9
    assert (found.eigenvalues.real.max() > 0.1) == (spin**2 < 8)


if __name__ == "__main__":
    for name in SYSTEMS:
        print(f"{name:36} {error_against_sympy(name):8.1e} {error_against_differences(name):8.1e}", flush=True)
