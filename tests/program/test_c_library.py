"""A scene as a library in C11: clean, linkable, and with the numbers that the closed forms have."""

import ctypes
import re
import shutil
import subprocess
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from exported import model_of_program
from programs import program
from refusing import failing
from scipy.interpolate import CubicSpline

from holonom.cli import holonom
from holonom.failures import ErrorKind
from holonom.program import c_source
from holonom.program.identifiers import default_name, identifiers
from holonom.program.model import scene_model
from holonom.program.request import Request
from holonom.program.targets import c
from holonom.sandbox import Limits

EXAMPLES = Path(__file__).parents[2] / "examples"
STRICT = ["-Wall", "-Wextra", "-Wconversion", "-pedantic", "-O2"]
DOUBLES = np.ctypeslib.ndpointer(dtype=float, flags="C_CONTIGUOUS")


def write_library(directory: Path, scene: str, name: str, *parameters: str) -> Path:
    model = scene_model(EXAMPLES / scene, Request(), parameters, Limits())
    directory.mkdir(exist_ok=True)
    for file, text in c.write_model(model, name).items():
        (directory / file).write_text(text, encoding="utf-8")
    return directory


def run(*command: str | Path, directory: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, cwd=directory, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def pendulum(tmp_path_factory, c_compiler) -> ctypes.CDLL:
    """The pendulum of controlled length, m and g open."""
    directory = write_library(tmp_path_factory.mktemp("c"), "pendulum.mac", "bob", "m", "g")
    run("cc", "-std=c11", "-O2", "-shared", "-fPIC", "bob.c", "-o", "bob.so", "-lm", directory=directory)
    library = ctypes.CDLL(str(directory / "bob.so"))
    double = ctypes.c_double
    library.bob_motion.argtypes = [double, *[DOUBLES] * 6]
    library.bob_motion_batch.argtypes = [ctypes.c_size_t, *[DOUBLES] * 7]
    library.bob_residual.argtypes = [double, *[DOUBLES] * 6]
    library.bob_jacobian.argtypes = [double, *[DOUBLES] * 5]
    library.bob_project.argtypes = [double, *[DOUBLES] * 4]
    library.bob_law.argtypes = [double, *[DOUBLES] * 2]
    library.bob_values.argtypes = [DOUBLES]
    return library


def random_inputs(points: int) -> tuple[np.ndarray, ...]:
    """q, v, u with its rates, and (m, g), one column a point."""
    rng = np.random.default_rng(7)
    q, v, u = rng.normal(size=(2, points)), rng.normal(size=(2, points)), rng.normal(size=(3, points))
    return q, v, u, rng.uniform(1, 2, size=(2, points))


@pytest.mark.parametrize(
    ("scene", "parameters"),
    [
        ("paper/paper.mac", ["u0"]),
        ("pendulum.mac", ["m", "g"]),
        ("car_axis.mac", []),
        ("prescribed_tension.mac", []),
        ("level_load.mac", []),
        ("spherical_pendulum.mac", []),
        ("andrews.mac", []),
    ],
)
def test_compilers_have_nothing_to_say(tmp_path, scene, parameters, c_compiler):
    directory = write_library(tmp_path / "library", scene, "system", *parameters)
    compiled = run("cc", "-std=c11", *STRICT, "system.c", "system_driver.c", "-lm", "-o", "driver", directory=directory)
    assert (compiled.returncode, compiled.stderr) == (0, "")
    ran = run("./driver", directory=directory)
    assert ran.returncode == 0
    assert ("pull = " in ran.stdout) == (scene == "level_load.mac")
    assert "nan" not in ran.stdout


@pytest.mark.skipif(shutil.which("g++") is None, reason="no C++ compiler is installed")
def test_the_header_serves_cpp(tmp_path, c_compiler):
    directory = write_library(tmp_path / "library", "pendulum.mac", "bob")
    program = '#include "bob.h"\nint main() { double p[1]; bob_values(p); return BOB_COORDINATE_y - 1; }\n'
    (directory / "main.cpp").write_text(program)
    assert run("cc", "-std=c11", "-c", "bob.c", directory=directory).returncode == 0
    linked = run("g++", *STRICT, "main.cpp", "bob.o", "-o", "main", directory=directory)
    assert (linked.returncode, linked.stderr) == (0, "")
    assert run("./main", directory=directory).returncode == 0


def test_two_systems_link_into_one_program(tmp_path, c_compiler):
    directory = write_library(tmp_path / "library", "pendulum.mac", "bob")
    write_library(directory, "car_axis.mac", "axis")
    program = '#include "bob.h"\n#include "axis.h"\nint main(void) { return AXIS_COORDINATES - 2*BOB_COORDINATES; }\n'
    (directory / "main.c").write_text(program)
    linked = run("cc", *STRICT, "main.c", "bob.c", "axis.c", "-lm", "-o", "main", directory=directory)
    assert (linked.returncode, linked.stderr) == (0, "")
    assert run("./main", directory=directory).returncode == 0


@pytest.mark.skipif(shutil.which("cmake") is None, reason="CMake is not installed")
def test_cmake_builds_the_driver(tmp_path, c_compiler):
    directory = write_library(tmp_path / "library", "pendulum.mac", "bob")
    assert run("cmake", "-S", ".", "-B", "build", directory=directory).returncode == 0
    assert run("cmake", "--build", "build", directory=directory).returncode == 0
    printed = run("build/bob_driver", directory=directory).stdout
    # released at rest at the angle pi/13 from the vertical: lambda = m g y/(2 l^2)
    assert float(printed.split("lambda1 = ")[1]) == pytest.approx(-9.81 * np.cos(np.pi / 13) / 2, rel=1e-14)


def test_motion_has_the_pendulums_closed_form(pendulum):
    # lambda = m (g y + u ddot(u) + dot(u)^2 - v^2)/(2 r^2), A a = Q + 2 lambda q
    for point in range(5):
        q, v, u, p = (np.ascontiguousarray(array[:, point]) for array in random_inputs(5))
        a, multiplier = np.empty(2), np.empty(1)
        pendulum.bob_motion(0.0, q, v, u, p, a, multiplier)
        m, g = p
        expected = m * (g * q[1] + u[0] * u[2] + u[1] ** 2 - v @ v) / (2 * q @ q)
        assert multiplier[0] == pytest.approx(expected, rel=1e-13)
        assert a == pytest.approx(2 * expected * q / m - [0, g], rel=1e-12)


def test_a_batch_has_the_numbers_of_its_points(pendulum):
    points = 11
    q, v, u, p = random_inputs(points)
    a, multipliers = np.empty((2, points)), np.empty((1, points))
    pendulum.bob_motion_batch(points, np.zeros(points), q, v, u, p, a, multipliers)
    for point in range(points):
        alone, multiplier = np.empty(2), np.empty(1)
        arrays = (np.ascontiguousarray(array[:, point]) for array in (q, v, u, p))
        pendulum.bob_motion(0.0, *arrays, alone, multiplier)
        assert a[:, point] == pytest.approx(alone, rel=1e-13)
        assert multipliers[:, point] == pytest.approx(multiplier, rel=1e-13)


def test_constraints_and_jacobian_are_those_of_the_circle(pendulum):
    q, v, u, p = (np.ascontiguousarray(array[:, 0]) for array in random_inputs(1))
    f, rate, jacobian = np.empty(1), np.empty(1), np.empty(2)
    pendulum.bob_residual(0.0, q, v, u, p, f, rate)
    pendulum.bob_jacobian(0.0, q, v, u, p, jacobian)
    assert f[0] == pytest.approx(q @ q - u[0] ** 2, rel=1e-13)
    assert rate[0] == pytest.approx(2 * q @ v - 2 * u[0] * u[1], rel=1e-13)
    assert jacobian == pytest.approx(2 * q, rel=1e-15)


def test_the_jacobian_of_a_chain_is_zero_where_it_has_no_entry(tmp_path, c_compiler):
    directory = write_library(tmp_path / "c", "chain.mac", "chain")
    run("cc", "-std=c11", "-shared", "-fPIC", "chain.c", "-o", "chain.so", "-lm", directory=directory)
    jacobian = ctypes.CDLL(str(directory / "chain.so")).chain_jacobian
    jacobian.argtypes = [ctypes.c_double, *[DOUBLES] * 5]
    q, found = np.random.default_rng(3).normal(size=8), np.full((4, 8), np.nan)
    jacobian(0.0, q, np.zeros(8), np.array([1.0, 0.0, 0.0]), np.zeros(1), found)
    expected = np.zeros((4, 8))
    for k, link in enumerate(np.diff(np.vstack([np.zeros(2), q.reshape(4, 2)]), axis=0)):
        expected[k, 2 * k : 2 * k + 2] = link
        if k > 0:
            expected[k, 2 * k - 2 : 2 * k] = -link
    assert np.array_equal(found, expected)


def test_a_library_in_pieces_has_the_same_numbers(tmp_path, monkeypatch, c_compiler):
    """Bit for bit, without contractions, which may not cross from one piece into the next."""
    found = []
    for longest in (c_source.LONGEST, 4):
        monkeypatch.setattr(c_source, "LONGEST", longest)
        monkeypatch.setattr(c_source, "PIECE", 3)
        directory = write_library(tmp_path / str(longest), "chain.mac", "links", "m", "g", "l")
        assert ("PIECE void motion_2(" in (directory / "links.c").read_text(encoding="utf-8")) == (longest == 4)
        options = ["-std=c11", *STRICT, "-ffp-contract=off", "-shared", "-fPIC"]
        compiled = run("cc", *options, "links.c", "-o", "links.so", "-lm", directory=directory)
        assert (compiled.returncode, compiled.stderr) == (0, "")
        found.append(numbers_of_chain(ctypes.CDLL(str(directory / "links.so"))))
    assert all(np.isfinite(numbers).all() and numbers.any() for numbers in found[0])
    assert all(map(np.array_equal, *found))


def numbers_of_chain(library: ctypes.CDLL) -> list[np.ndarray]:
    """What the functions of a library of four masses compute of nine points near the hanging chain."""
    points, rng = 9, np.random.default_rng(3)
    hanging = np.ravel([(0.0, -k) for k in range(1, 5)])[:, None]
    q, v = hanging + rng.normal(scale=0.01, size=(8, points)), rng.normal(size=(8, points))
    u, p = np.outer([1.0, 0.1, 0.2], np.ones(points)), np.ones((3, points))
    a, multipliers, f, rate = (np.zeros((rows, points)) for rows in (8, 4, 4, 4))
    t, J = np.zeros(points), np.zeros((points, 32))
    arrays = [array.ctypes.data_as(ctypes.c_void_p) for array in (t, q, v, u, p, a, multipliers)]
    library.links_motion_batch(ctypes.c_size_t(points), *arrays)
    one_point = [np.ascontiguousarray(array.T) for array in (q, v, u, p, a, multipliers, f, rate)]
    for row, entries in zip(zip(*one_point, strict=True), J, strict=True):
        q1, v1, u1, p1, a1, l1, f1, rate1, J1 = (x.ctypes.data_as(ctypes.c_void_p) for x in (*row, entries))
        time = ctypes.c_double(0)
        library.links_motion(time, q1, v1, u1, p1, a1, l1)
        library.links_residual(time, q1, v1, u1, p1, f1, rate1)
        library.links_jacobian(time, q1, v1, u1, p1, J1)
        assert library.links_project(time, q1, v1, u1, p1) == 0
    return [a, multipliers, *one_point, J]


def test_projection_goes_along_the_radius(pendulum):
    q, v, u, p = np.array([0.9, -1.2]), np.array([0.4, 0.3]), np.array([1.0, 0.25, 0.0]), np.array([2.0, 9.81])
    assert pendulum.bob_project(0.0, q, v, u, p) == 0
    assert q == pytest.approx([0.6, -0.8], rel=1e-14)
    assert v == pytest.approx([0.4 + 0.15, 0.3 - 0.2], rel=1e-13)  # v is tangent; dot(u) goes along the radius


def test_what_cannot_be_projected_is_left_as_it_was(pendulum):
    q, v = np.zeros(2), np.array([0.4, 0.3])  # the centre is as far from every point of the circle
    assert pendulum.bob_project(0.0, q, v, np.array([1.0, 0.0, 0.0]), np.ones(2)) == 1
    assert q.tolist() == [0.0, 0.0]
    assert v.tolist() == [0.4, 0.3]


@pytest.mark.parametrize(("scene", "n"), [("car_axis.mac", 4), ("hard/sarrus_linkage.mac", 15)])
def test_constraints_whose_terms_all_vanish_have_the_rounding_errors_of_others(tmp_path, c_compiler, scene, n):
    directory = write_library(tmp_path / "library", scene, "system")
    run("cc", "-std=c11", "-shared", "-fPIC", "system.c", "-lm", "-o", "system.so", directory=directory)
    library = ctypes.CDLL(str(directory / "system.so"))
    library.system_project.argtypes = [ctypes.c_double, *[DOUBLES] * 4]
    library.system_start.argtypes = [DOUBLES] * 3
    library.system_law.argtypes = [ctypes.c_double, *[DOUBLES] * 2]
    t, q, v, u, none = np.zeros(1), np.zeros(n), np.zeros(n), np.zeros(30), np.zeros(0)
    library.system_start(t, q, v)
    library.system_law(t[0], none, u)
    rng = np.random.default_rng(3)
    for size in (1e-14, 1e-9, 1e-5, 1e-3):
        moved = q + size * rng.normal(size=n)
        assert library.system_project(t[0], moved, v.copy(), u, none) == 0


@pytest.mark.parametrize("far", [1.0, 1e9])
def test_a_coordinate_elsewhere_is_no_measure_for_an_angle(write_scene, tmp_path, c_compiler, far):
    """Where sin(a) = 3/2 was to hold, the angle counted as found, for it is small beside 1e9."""
    file = write_scene("""load("holonom.mac")$
system : holonomic_system(coordinates = [x, a, y], parameters = [s], kinetic_energy = dot(x)^2 + dot(a)^2 + dot(y)^2,
  potential_energy = x, constraints = [sin(a) - s, y - 1 + cos(a)])$
scene : holonomic_scene(system, initial_state = [x = 0, dot(x) = 0], parameter_values = [s = 0],
  initial_guess = [a = 0, y = 0, dot(a) = 0, dot(y) = 0])$""")
    directory = write_library(tmp_path / "library", file, "turn", "s")
    run("cc", "-std=c11", "-shared", "-fPIC", "turn.c", "-lm", "-o", "turn.so", directory=directory)
    project = ctypes.CDLL(str(directory / "turn.so")).turn_project
    project.argtypes = [ctypes.c_double, *[DOUBLES] * 4]
    for s in (0.9, 1e-3, 1e-6, 1e-9, 0.0):
        q, v = np.array([far, 1.1 * s, 0.0]), np.zeros(3)
        assert project(0.0, q, v, np.zeros(0), np.array([s])) == 0
        assert q == pytest.approx([far, np.arcsin(s), 1 - np.sqrt(1 - s * s)], rel=1e-13, abs=1e-15)
    q, v = np.array([far, 0.5, 0.1]), np.zeros(3)
    assert project(0.0, q, v, np.zeros(0), np.array([1.5])) == 1
    assert q.tolist() == [far, 0.5, 0.1]


def test_where_all_coordinates_are_zero_newtons_steps_underflow(write_scene, tmp_path, c_compiler):
    file = write_scene("""load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], kinetic_energy = dot(x)^2 + 3*dot(y)^2,
  constraints = [4*x + 6*y, (t + 2)^(1/3)*x + 3*y])$
scene : holonomic_scene(system, initial_state = [])$""")
    directory = write_library(tmp_path / "library", file, "rest")
    run("cc", "-std=c11", "-shared", "-fPIC", "rest.c", "-lm", "-o", "rest.so", directory=directory)
    project = ctypes.CDLL(str(directory / "rest.so")).rest_project
    project.argtypes = [ctypes.c_double, *[DOUBLES] * 4]
    for size in (1.0, 1e-4, 1e-160, 1e-300, 1e-320):
        for angle in range(8):
            q, v = size * np.array([np.cos(angle), np.sin(angle)]), np.zeros(2)
            assert project(0.0, q, v, np.zeros(0), np.zeros(0)) == 0
            assert q == pytest.approx([0, 0], abs=1e-150)


@pytest.mark.parametrize(
    ("constraint", "control"), [("sin(x + l) - u", np.sin), ("(x + l)^2 - u^2", np.abs), ("exp(x + l) - u", np.exp)]
)
def test_a_place_that_is_zero_by_other_inputs_was_never_near_enough(
    write_scene, tmp_path, c_compiler, constraint, control
):
    file = write_scene(f"""load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [l],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2, constraints = [{constraint}])$
scene : holonomic_scene(system, control_law = [u = 1/2], parameter_values = [l = 3/10],
  initial_state = [y = 1, dot(y) = 0], initial_guess = [x = 1/2, dot(x) = 0])$""")
    directory = write_library(tmp_path / "library", file, "zero", "l")
    run("cc", "-std=c11", "-shared", "-fPIC", "zero.c", "-lm", "-o", "zero.so", directory=directory)
    project = ctypes.CDLL(str(directory / "zero.so")).zero_project
    project.argtypes = [ctypes.c_double, *[DOUBLES] * 4]
    rng = np.random.default_rng(1)
    for length, size in product(rng.uniform(0.05, 1.2, 100), (0.0, 1e-17, 1e-9, 0.01)):
        q = np.array([size * rng.normal(), rng.integers(2)], dtype=float)
        assert project(0.0, q, np.zeros(2), np.array([control(length), 0.0, 0.0]), np.array([length])) == 0
        assert q[0] == pytest.approx(0, abs=1e-15)


def test_the_law_and_the_values_are_those_of_the_scene(pendulum):
    p, u = np.empty(2), np.full(3, np.nan)
    pendulum.bob_values(p)
    pendulum.bob_law(5.0, p, u)
    assert p.tolist() == [1.0, 9.81]
    assert u.tolist() == [1.0, 0.0, 0.0]


def test_the_law_of_a_table_is_the_spline_between_all_its_points(write_scene, tmp_path, c_compiler):
    rows = [(0, 0), (1, 2), (1.3, 0.5), (3.5, 1), (4, -1)]
    file = write_scene(f"""load("holonom.mac")$
system : holonomic_system(coordinates = [x], controls = [u], kinetic_energy = dot(x)^2/2, forces = [u])$
drive : holonomic_scene(system, control_law = [u = u0*table({list(map(list, rows))})], parameter_values = [u0 = 2],
  initial_state = [x = 0, dot(x) = 0], time_span = [0, 4])$""")
    directory = write_library(tmp_path / "library", file, "winch", "u0")
    compiled = run(
        "cc", "-std=c11", *STRICT, "-shared", "-fPIC", "winch.c", "-lm", "-o", "winch.so", directory=directory
    )
    assert (compiled.returncode, compiled.stderr) == (0, "")
    library = ctypes.CDLL(str(directory / "winch.so"))
    library.winch_law.argtypes = [ctypes.c_double, *[DOUBLES] * 2]
    spline = CubicSpline(*np.array(rows).T, bc_type="natural")
    for t in (0.0, 0.2, 1.0, 1.1, 1.3, 2.0, 3.5, 3.75, 4.0, 4.1):
        u = np.empty(3)
        library.winch_law(t, np.array([3.0]), u)
        expected = [3 * spline(t, rate) if t <= 4 else np.nan for rate in range(3)]
        assert u == pytest.approx(expected, rel=1e-13, abs=1e-13, nan_ok=True)


def test_a_title_that_begins_a_comment_is_no_warning(tmp_path, c_compiler):
    (tmp_path / "title.c").write_text(c_source.c_source(program(["/*/ */*"], [], {"/*": "/*/ */*"})))
    compiled = run("cc", "-std=c11", *STRICT, "-c", "title.c", directory=tmp_path)
    assert (compiled.returncode, compiled.stderr) == (0, "")


def test_the_sign_of_what_is_no_number_is_none(tmp_path, c_compiler):
    """It was zero, and dry friction at such a velocity that of rest."""
    (tmp_path / "sign.c").write_text(c_source.c_source(program(["v"], [("w", ["Sign", "v"])], {"w": "w"})))
    run("cc", "-std=c11", "-O2", "-shared", "-fPIC", "sign.c", "-o", "sign.so", "-lm", directory=tmp_path)
    library = ctypes.CDLL(str(tmp_path / "sign.so"))
    library.motion_batch.argtypes = [ctypes.c_size_t, *[DOUBLES] * 2]
    v = np.array([-2, 0, 3, np.nan, np.nan, -0.0, 1e-320, -np.inf, np.nan])
    found = np.empty(9)
    library.motion_batch(9, v, found)
    assert found == pytest.approx(np.sign(v), rel=0, abs=0, nan_ok=True)


@pytest.mark.parametrize("name", ["string", "Math", "features", "m", "install"])
def test_a_library_has_no_name_of_a_header_or_a_target(name):
    """The C library's <string.h> was the scene's string.h then, and CMake refused a target m."""
    with failing(ErrorKind.NAME_TAKEN, name):
        c.write_model(model_of_program(program(["t"], [], {"w": "t"})), name)


def test_no_name_of_a_library_makes_a_function_one_that_it_has(tmp_path):
    """A library named rough had a function rough_residual, and another one."""
    text = (write_library(tmp_path, "pendulum.mac", "bob") / "bob.c").read_text()
    public = set(re.findall(r"^(?:void|int|const char \*const) bob(_\w+)", text, re.MULTILINE))
    own = set(re.findall(r"^static (?:inline )?(?:double|void|lanes) (\w+)\(", text, re.MULTILINE))
    assert {"_motion", "_project", "_outputs"} < public
    assert {"lengths_of", "square", "lanes_at"} < own
    assert [(name, end) for name in own for end in public if name.endswith(end)] == []


def test_names_that_c_does_not_know_stay_apart():
    assert identifiers(["q1", "Q1", "x_1", "x 1", "φ", "é"]) == ["q1", "Q1", "x_1", "x_1_", "_", "e"]
    assert default_name(Path("3-link arm.mac")) == "scene_3_link_arm"


@pytest.mark.parametrize(
    ("options", "fact"),
    [
        (["--to", "c"], "-o DIR"),
        (["--to", "c", "--name", "a-b", "-o", "lib"], "a-b"),
        (["--to", "c", "--parameters", "m,k", "-o", "lib"], "'k'"),
        (["--to", "c", "--parameters", "m;", "-o", "lib"], "'m;'"),
        (["--to", "python", "--name", "bob"], "--name"),
    ],
)
def test_what_cannot_be_written_is_an_error_and_nothing_is_written(tmp_path, monkeypatch, options, fact):
    monkeypatch.chdir(tmp_path)
    scene = str(EXAMPLES / "pendulum.mac")
    result = CliRunner().invoke(holonom, ["program", scene, *options], standalone_mode=False)
    assert result.return_value == 2
    assert fact in result.output
    assert list(tmp_path.iterdir()) == []
