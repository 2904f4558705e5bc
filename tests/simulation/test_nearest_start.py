"""Starts near a guess: the nearest root in the mass metric, by Maxima and for parameters that are set afterwards."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import holonom

SYSTEM = """
system : holonomic_system(coordinates = [x, y], parameters = [p], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  constraints = [{constraint}])$
motion : holonomic_scene(system, parameter_values = [p = 1], initial_state = [x = 0, dot(x) = 0],
  initial_guess = [y = {guess}, dot(y) = 0], time_span = [0, 1/100])$
"""
ROOTS = {  # constraint with x = 0, guess: the nearest root
    ("p*(y^3 - 3*y) - x", "99/100"): math.sqrt(3),
    ("p*(y^3 - 3*y) - x", "4/10"): 0,
    ("p*sin(20*y) - x", "795/10000"): math.pi / 20,
    ("p*sin(20*y) - x", "78/1000"): 0,
    ("p*(exp(y) - 1) - x", "10"): 0,
    ("p*atan(y - 3) - x", "50"): 3,
    ("p*tan(y) - x", "157/100"): 0,
    ("p*(y - 1)*(y - 2)*(y - 5) - x", "38/10"): 5,
    ("p*(y - 1)*(y - 2)*(y - 5) - x", "31/10"): 2,
    ("p*log(y) - x", "4"): 1,
    ("p*(y^5 - y - 1) - x", "0"): brentq(lambda y: y**5 - y - 1, 1, 2),  # beyond a minimum of the residual
    ("p*(cos(y) - 1/2) - x", "1/1000"): math.pi / 3,
}


@pytest.mark.parametrize("settings", [{}, {"p": 2}], ids=["maxima", "set"])
@pytest.mark.parametrize(("constraint", "guess"), ROOTS)
def test_start_is_the_root_nearest_to_the_guess(constraint, guess, settings):
    motion = holonom.system(SYSTEM.format(constraint=constraint, guess=guess), **settings).simulate(samples=2)
    root = ROOTS[constraint, guess]
    assert motion["y"][0] == pytest.approx(root, abs=1e-12)
    name, size = motion.report.moved
    assert name == "y"
    first, *second = guess.split("/")
    assert float(size) == pytest.approx(abs(root - float(first) / float(second[0] if second else 1)), rel=1e-2)


LINKAGE = """
system : holonomic_system(coordinates = [a, b], parameters = [l], kinetic_energy = {heavy}*dot(a)^2/2 + dot(b)^2/2,
  constraints = [l*cos(a) + l*cos(b) - 1, l*sin(a) + l*sin(b)])$
motion : holonomic_scene(system, parameter_values = [l = 1], initial_guess = [a = {a}, b = {b}, dot(a) = 0, dot(b) = 0],
  initial_state = [], time_span = [0, 1/100])$
"""


@pytest.mark.parametrize("settings", [{}, {"l": 1.001}], ids=["maxima", "set"])
@pytest.mark.parametrize(("a", "b"), [("2/100", "-1/100"), ("15/10", "12/10"), ("-3/10", "2/10"), ("3", "1/2")])
def test_linkage_starts_in_the_nearer_of_its_two_positions(a, b, settings):
    """Two rods of unit length over a unit distance: a = -b = pi/3 or -pi/3, but for turns."""
    motion = holonom.system(LINKAGE.format(heavy=1, a=a, b=b), **settings).simulate(samples=2)
    guess = np.array([float(n) / float(d or 1) for n, _, d in (text.partition("/") for text in (a, b))])
    angle = math.acos(0.5 / settings.get("l", 1))
    turns = 2 * math.pi * np.array([[i, j] for i in (-1, 0, 1) for j in (-1, 0, 1)])
    roots = np.concatenate([np.array([angle, -angle]) + turns, np.array([-angle, angle]) + turns])
    nearest = roots[np.argmin(np.linalg.norm(roots - guess, axis=1))]
    assert [motion["a"][0], motion["b"][0]] == pytest.approx(list(nearest), abs=1e-9)


def test_sweep_starts_each_row_at_its_nearest_root():
    scene = holonom.system(SYSTEM.format(constraint="sin(20*p*y) - x", guess="795/10000"))
    rows = holonom.sweep(scene, values={"p": [1, 2, 3]}, keep=["at(y,0)"]).to_pandas()
    spacing = math.pi / 20 / np.array([1, 2, 3])
    nearest = spacing * np.round(0.0795 / spacing)
    assert rows["at(y,0)"].to_numpy() == pytest.approx(nearest, abs=1e-12)


def test_distance_from_the_guess_is_published():
    """Speeds of two masses that a constraint makes equal: (4, 10) becomes (7, 7)."""
    from holonom.simulation.output import report_document

    motion = holonom.system("""
system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2, constraints = [x - y])$
motion : holonomic_scene(system, initial_state = [x = 0, y = 0], initial_guess = [dot(x) = 4, dot(y) = 10],
  time_span = [0, 1])$""").simulate(samples=2)
    moved = report_document(motion.report)["moved"]
    assert moved["name"] in ("dot(x)", "dot(y)")
    assert float(moved["size"]) == pytest.approx(3)


def test_start_without_a_guess_is_at_no_distance():
    motion = holonom.system("""
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2)$
motion : holonomic_scene(system, initial_state = [x = 0, dot(x) = 1], time_span = [0, 1])$""").simulate(samples=2)
    assert motion.report.moved is None


IN_UNITS = """
system : holonomic_system(coordinates = [x, y], parameters = [p], kinetic_energy = {mass}*(dot(x)^2 + dot(y)^2)/2,
  constraints = [p*({function}) - x/({length})])$
motion : holonomic_scene(system, parameter_values = [p = 1], initial_state = [x = 0, dot(x) = 0],
  initial_guess = [y = 0, dot(y) = 0], time_span = [0, 1/100])$
"""


@pytest.mark.parametrize(
    ("function", "root"),
    [
        ("q^5 - q - 1", brentq(lambda q: q**5 - q - 1, 1, 2)),
        ("q^3 - 2*q + 2", brentq(lambda q: q**3 - 2 * q + 2, -2, -1)),
    ],
)
@pytest.mark.parametrize(("mass", "length", "unit"), [("1/10^27", "1/10^10", 1e-10), ("10^24", "10^9", 1e9)])
def test_start_beyond_a_minimum_is_found_in_all_units(function, root, mass, length, unit):
    """Around a guess of zero the search began at a distance of one, by Maxima and in each row."""
    function = function.replace("q", f"(y/({length}))")
    scene = holonom.system(IN_UNITS.format(mass=mass, length=length, function=function))
    assert scene.simulate(samples=2)["y"][0] / unit == pytest.approx(root, rel=1e-12)
    rows = holonom.sweep(scene, values={"p": [1, 2]}, keep=["at(y,0)"]).to_pandas()
    assert rows["at(y,0)"].to_numpy() / unit == pytest.approx(root, rel=1e-12)


PARALLEL_CRANKS = """
P : [[x1, y1], [x2, y2], [x3, y3]]$  O : [[0, 0], [1, 0], [1, 1]]$
squared(v) := v . v$
apart(Q, i, k) := squared(Q[i] - Q[k])$
system : holonomic_system(coordinates = flatten(P), parameters = [p],
  kinetic_energy = apply("+", map(squared, dot(P)))/2,
  constraints = append(p*makelist(squared(P[i] - O[i]) - 1, i, 3),
    makelist(apart(P, i, mod(i, 3) + 1) - apart(O, i, mod(i, 3) + 1), i, 3)))$
motion : holonomic_scene(system, parameter_values = [p = 1], initial_state = [], time_span = [0, 1/100],
  initial_guess = [x1 = 62/100, y1 = 79/100, x2 = 161/100, y2 = 81/100, x3 = 158/100, y3 = 181/100,
    dot(x1) = -8/10, dot(y1) = 6/10, dot(x2) = -8/10, dot(y2) = 6/10, dot(x3) = -8/10, dot(y3) = 6/10])$
"""


@pytest.mark.parametrize("settings", [{}, {"p": 2}], ids=["maxima", "set"])
def test_start_of_redundant_constraints_is_near_the_guess(settings):
    """A plate on three parallel cranks, whose gradients are dependent where the constraints hold, not at the guess."""
    motion = holonom.system(PARALLEL_CRANKS, **settings).simulate(samples=2)
    assert motion["x1"][0] == pytest.approx(0.60055, abs=1e-3)  # the mean of the cranks, scaled to length 1
    assert motion["y3"][0] - 1 == pytest.approx(0.79961, abs=1e-3)
