"""Systems in motion, drawn: what is drawn keeps the constraints, frame by frame, and is the same every time."""

from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from refusing import refused

from holonom.figures.drawing import FRAMES, POSITIONS, animation, film_of, strip
from holonom.program.drawing import Shape
from holonom.program.motion_problem import MotionProblem, motion_problem
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.simulation.request import SimulationRequest
from holonom.simulation.result import Simulation
from holonom.simulation.simulate import simulate

EXAMPLES = Path(__file__).parents[2] / "examples"
SCENES = sorted(file for file in EXAMPLES.rglob("*.mac") if file.name not in ("by_hand.mac", "printed.mac"))
SLOW = {"bricard_linkage", "stewart_platform"}
SVG = "{http://www.w3.org/2000/svg}"
PENDULUM = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [g],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2, potential_energy = g*y, constraints = [x^2 + y^2 - u^2]{drawing})$
swing : holonomic_scene(system, control_law = [u = 1 + t/10], parameter_values = [g = 981/100],
  initial_state = [x = 3/5, y = -4/5, dot(x) = 3/50], time_span = [0, {end}])$
"""


def simulated(file: Path, until: int | None = None, samples: int = 1801) -> tuple[MotionProblem, Simulation]:
    problem = motion_problem(file, Request(), Limits())
    return problem, simulate(problem, SimulationRequest(until=until, samples=samples))


def numbers_at_start(file: Path) -> tuple[MotionProblem, dict[Shape, list[np.ndarray]]]:
    """The numbers of each kind of shape at the start of the last scene."""
    problem = motion_problem(file, Request(), Limits())
    start = {name: np.array([float(value)]) for name, value in problem.start.items()}
    rows = problem.drawing.numbers(start["t"], start)
    return problem, {
        kind: [row[0] for shape, row in zip(problem.drawing.shapes, rows, strict=True) if shape is kind]
        for kind in Shape
    }


@pytest.fixture
def pendulum(write_scene):
    def write(drawing: str = ", drawing = [segment([0, 0], [x, y]), point([0, 0]), point([x, y])]", end: str = "2"):
        return write_scene(PENDULUM.format(drawing=drawing, end=end))

    return write


@pytest.fixture
def film(pendulum):
    problem, motion = simulated(pendulum())
    return film_of(motion, problem.drawing)


def animated(svg: str) -> list[ElementTree.Element]:
    return list(ElementTree.fromstring(svg).iter(f"{SVG}animate"))


@pytest.mark.parametrize(
    "file",
    [pytest.param(file, id=file.stem, marks=[pytest.mark.long] if file.stem in SLOW else []) for file in SCENES],
)
def test_every_example_says_how_it_looks(file):
    problem, _ = numbers_at_start(file)
    assert problem.drawing.shapes


def test_the_string_drawn_is_as_long_as_the_control_says(film):
    string = film.numbers[film.shapes.index(Shape.SEGMENT)]
    lengths = np.linalg.norm(string[:, 2:] - string[:, :2], axis=1)
    assert lengths == pytest.approx(1 + film.times / 10, abs=1e-13)


def test_links_of_the_chain_are_drawn_in_their_lengths():
    problem, motion = simulated(EXAMPLES / "chain.mac", samples=61)
    film = film_of(motion, problem.drawing)
    nodes = film.numbers[film.shapes.index(Shape.POLYLINE)].reshape(len(film.times), -1, 2)
    lengths = np.linalg.norm(np.diff(nodes, axis=1), axis=2)
    assert lengths[:, 0] == pytest.approx(1 - film.times / 10, abs=1e-12)
    assert lengths[:, 1:] == pytest.approx(1, abs=1e-12)


def test_loops_of_the_squeezing_mechanism_are_drawn_closed():
    """The arms from A meet the crank's coupler at P: bars of 28, 20 and 40 mm (Schiehlen 1990)."""
    _, shapes = numbers_at_start(EXAMPLES / "andrews.mac")
    crank, triangle, arms = (row.reshape(-1, 2) for row in shapes[Shape.POLYLINE])
    P = crank[-1]
    assert triangle[1] == pytest.approx(P, abs=1e-14)
    assert arms[2] == pytest.approx(P, abs=1e-14)
    assert np.linalg.norm(np.diff(crank, axis=0), axis=1) == pytest.approx([0.007, 0.028])
    assert np.linalg.norm(np.diff(arms, axis=0), axis=1) == pytest.approx([0.04, 0.02, 0.02, 0.04])
    assert np.linalg.norm(triangle[1] - triangle[0]) == pytest.approx(0.035)


def test_an_animation_has_as_many_frames_as_times(film):
    found = animated(animation(film))
    assert len(film.times) == FRAMES + 1
    assert {len(each.get("values").split(";")) for each in found} == {len(film.times)}
    assert {each.get("repeatCount") for each in found} == {"indefinite"}


def test_what_stands_still_is_drawn_once(film):
    """The hinge: of the circles only the bob and the clock's mark move, along x; the bob along y, too."""
    attributes = sorted(each.get("attributeName") for each in animated(animation(film)))
    assert attributes == ["cx", "cx", "cy", "points"]


def test_a_strip_holds_still_and_shows_the_positions_ever_stronger(film):
    svg = strip(film)
    assert animated(svg) == []
    groups = [each for each in ElementTree.fromstring(svg).iter(f"{SVG}g") if each.get("opacity")]
    opacities = [float(each.get("opacity")) for each in groups]
    assert len(opacities) == POSITIONS
    assert opacities == sorted(opacities)
    assert opacities[-1] == 1


def test_same_motion_same_bytes(film):
    again = replace(film, numbers=tuple(each.copy() for each in film.numbers))
    assert animation(film) == animation(again)
    assert strip(film) == strip(again)


def test_a_long_motion_is_filmed_from_its_beginning(pendulum):
    problem, motion = simulated(pendulum(end="100"))
    film = film_of(motion, problem.drawing)
    assert film.times[0] == 0
    assert film.times[-1] < 20
    assert np.diff(film.times) == pytest.approx(film.times[1], rel=1e-9)


@pytest.mark.parametrize(
    ("end", "pace"), [("1/10", 0.1 / 4), ("6", 1), ("16", 16 / 12)], ids=["slowed", "in its time", "quickened"]
)
def test_a_film_takes_from_four_to_twelve_seconds(pendulum, end, pace):
    problem, motion = simulated(pendulum(drawing=", drawing = [circle([t, 0], 1)]", end=end))
    film = film_of(motion, problem.drawing)
    assert film.pace == pytest.approx(pace)


def test_tall_pictures_stand_side_by_side_and_flat_ones_in_a_column(pendulum):
    def shifts(drawing):
        problem, motion = simulated(pendulum(drawing=f", drawing = [{drawing}]"), samples=61)
        found = ElementTree.fromstring(strip(film_of(motion, problem.drawing))).iter(f"{SVG}g")
        pairs = [each.get("transform")[10:-1].split(",") for each in found if each.get("transform")]
        return {tuple(float(shift) != 0 for shift in pair) for pair in pairs}

    assert shifts("segment([0, 0], [0, u])") == {(True, False), (False, False)}
    assert shifts("segment([0, 0], [u, 0])") == {(False, True), (False, False)}
    assert shifts("segment([0, 0], [x, y])") == set()


def test_a_system_need_not_say_how_it_looks(pendulum):
    assert motion_problem(pendulum(drawing=""), Request(), Limits()).drawing is None


@pytest.mark.parametrize(
    ("drawing", "refusal"),
    [
        ("line([0, 0], [x, y])", "unknown_shape"),
        ("segment([0, 0])", "unknown_shape"),
        ("point([x, y, 0])", "unknown_shape"),
        ("circle([x, y])", "unknown_shape"),
        ("polyline([x, y])", "unknown_shape"),
        ("x", "unknown_shape"),
        ("point([x, z])", "undeclared_name"),
        ("point([x, dot(y)])", "rate_not_allowed"),
    ],
)
def test_what_is_no_drawing_is_refused(pendulum, drawing, refusal):
    with refused(refusal):
        motion_problem(pendulum(drawing=f", drawing = [{drawing}]"), Request(), Limits())


def test_a_drawing_that_is_no_list_is_refused(pendulum):
    with refused("entry_not_list"):
        motion_problem(pendulum(drawing=", drawing = point([x, y])"), Request(), Limits())


def test_a_parameter_may_be_called_like_a_shape(pendulum):
    file = pendulum(drawing=", drawing = [circle([x, y], g)]")
    file.write_text(file.read_text().replace("[g", "[circle").replace(" g)]", " circle)]").replace("g*y", "circle*y"))
    assert motion_problem(file, Request(), Limits()).drawing.shapes == (Shape.CIRCLE,)
