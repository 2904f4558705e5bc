"""Motions through zeros of the arguments of roots, against motions in a line with |x|."""

import pytest
from refusing import failing

import holonom
from holonom.failures import ErrorKind
from holonom.program.motion_problem import motion_problem
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.simulation.radicands import radicands

PLANE = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], parameters = [k, d], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  {effects})$
motion : holonomic_scene(system, parameter_values = [k = 2, d = 0], initial_state = [{start}], time_span = [0, 4])$
"""
SPEED = "sqrt((dot(x) - k*d)^2 + dot(y)^2)"
FRICTION = f"forces = [-k*(dot(x) - k*d)/{SPEED}, -k*dot(y)/{SPEED}]"
SPRING = "potential_energy = k*(sqrt(x^2 + (y - d)^2) - 1)^2/4"
VELOCITY = "sqrt((dot(x) - d)^2 + dot(y)^2)"
DRAG = "forces = [1 - k*(dot(x) - d)*abs(dot(x) - d), -k*dot(y)]"
THROWN = "x = 0, y = 0, dot(x) = 3, dot(y) = 4"
DRAWN = "x = 3/2, y = 0, dot(x) = -3, dot(y) = 0"


def plane(effects: str, start: str) -> holonom.Scene:
    return holonom.system(PLANE.format(effects=effects, start=start))


@pytest.mark.parametrize(
    ("friction", "options", "stop"),
    [
        (2, {}, 2.5),  # a power of two of the time span
        (1.26, {}, 5 / 1.26),  # behind the last samples of the only step
        (1.26, {"tol": 1e-6}, 5 / 1.26),
        (1.26, {"precision": "quadruple"}, 5 / 1.26),
        (2, {"d": 0.5}, 5**0.5),  # on a belt
    ],
)
def test_a_body_that_friction_in_a_plane_stops_was_driven_backwards(friction, options, stop):
    with failing(ErrorKind.NO_WAY_ON) as stopped:
        plane(FRICTION, THROWN).simulate(k=friction, engine="taylor", **options)
    assert float(stopped.value.detail.split(",")[0]) == pytest.approx(stop, rel=1e-8)


def test_a_spring_of_no_length_pushed_on_to_the_same_side():
    with failing(ErrorKind.NO_WAY_ON) as stopped:
        plane(SPRING, DRAWN).simulate(engine="taylor")
    assert float(stopped.value.detail.split(",")[0]) == pytest.approx(0.5001791778, rel=1e-9)


@pytest.mark.parametrize(
    ("plane_effects", "line_effects", "start"),
    [
        ("potential_energy = k*(x^2 + (y - d)^2)^(3/2)", "potential_energy = k*abs(x)^3 + (y - d)^2", DRAWN),
        (f"forces = [1 - k*(dot(x) - d)*{VELOCITY}, -k*dot(y)*{VELOCITY}]", DRAG, DRAWN),
    ],
    ids=["a cubic potential", "quadratic drag"],
)
def test_continuous_forces_turn_as_they_do_in_a_line(plane_effects, line_effects, start):
    both = [plane(effects, start).simulate(engine="taylor") for effects in (plane_effects, line_effects)]
    found, truth = (motion.report.coordinates["x"] for motion in both)
    assert both[0].report.trusted
    assert found == pytest.approx(truth, rel=1e-12)


@pytest.mark.parametrize("force", ["k*cos(3*atan2(y, x))", "k*sin(atan2(y - d, x))"])
def test_functions_of_an_angle_pass_its_cut(force):
    """Truth: steps of another engine."""
    motion = plane(f"forces = [{force}, -k*d]", "x = 1, y = 1, dot(x) = -3, dot(y) = -1")
    found, truth = (motion.simulate(engine=engine, tol=1e-13).report for engine in ("taylor", "runge-kutta"))
    assert found.trusted
    assert found.coordinates["x"] == pytest.approx(truth.coordinates["x"], rel=1e-10)


@pytest.mark.parametrize("start", ["x = 1, y = 1, dot(x) = -2, dot(y) = -1", "x = 1, y = 0, dot(x) = -1, dot(y) = 0"])
def test_an_angle_was_continued_beyond_its_cut(start):
    with failing(ErrorKind.NO_WAY_ON) as stopped:
        plane("forces = [-k*atan2(y - d, x)/2, 0]", start).simulate(engine="taylor")
    assert float(stopped.value.detail.split(",")[0]) == pytest.approx(1, rel=1 / 32)


@pytest.mark.parametrize("distance", [1e-9, 1e-6])
def test_a_spring_passes_its_end_nearby(distance):
    """Truth: the line, where the spring has the length |x|."""
    line = plane("potential_energy = k*(abs(x) - 1)^2/4 + (y - d)^2/2", DRAWN).simulate()
    near = plane(SPRING, DRAWN).simulate(d=distance)
    assert near.report.trusted
    assert near.report.coordinates["x"] == pytest.approx(line.report.coordinates["x"], abs=1e-9)


@pytest.mark.parametrize(
    ("effects", "count"),
    [(SPRING, 1), (FRICTION, 1), ("forces = [k*max(0, -x)^(3/2), -d*y]", 0), ("forces = [-d*x, sqrt(1 + k)]", 0)],
)
def test_roots_of_the_state_without_signs_are_examined(effects, count, tmp_path):
    file = tmp_path / "plane.mac"
    file.write_text(PLANE.format(effects=effects, start=THROWN))
    found = radicands(motion_problem(file, Request(), Limits(), 40))
    assert (0 if found is None else len(found.outputs)) == count
