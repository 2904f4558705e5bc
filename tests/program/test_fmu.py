"""A scene as an FMI 3 unit: valid, and in FMPy's hands the motion that `holonom simulate` finds."""

import re
import subprocess
import zipfile
from pathlib import Path

import fmpy
import numpy as np
import pytest
from click.testing import CliRunner
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu
from refusing import failing
from scipy.integrate import solve_ivp

from holonom.cli import holonom
from holonom.failures import ErrorKind
from holonom.program.model import scene_model
from holonom.program.motion_problem import motion_problem
from holonom.program.request import Request
from holonom.program.targets import fmu
from holonom.sandbox import Limits
from holonom.simulation.request import SimulationRequest
from holonom.simulation.simulate import simulate

PENDULUM = Path(__file__).parents[2] / "examples" / "pendulum.mac"
UNTIL, SAMPLES = 5, 51


@pytest.fixture(scope="module")
def unit(tmp_path_factory, c_compiler) -> Path:
    """The pendulum paid out at constant speed, m open, as the command writes it."""
    file = tmp_path_factory.mktemp("fmu") / "bob.fmu"
    options = ["--scene", "lengthening_scene", "--to", "fmu", "--name", "bob", "--parameters", "m", "-o", str(file)]
    result = CliRunner().invoke(holonom, ["program", str(PENDULUM), *options], standalone_mode=False)
    assert result.exception is None
    return file


def follow(unit: Path, **start_values: float) -> np.ndarray:
    length = np.array(
        [(t, 1 + t / 10, 1 / 10, 0) for t in (0, UNTIL)],
        dtype=[(name, float) for name in ("time", "u", "dot(u)", "ddot(u)")],
    )
    return fmpy.simulate_fmu(
        str(unit),
        fmi_type="ModelExchange",
        stop_time=UNTIL,
        output_interval=UNTIL / (SAMPLES - 1),
        relative_tolerance=1e-11,
        input=length,
        output=["x", "y", "lambda1"],
        start_values=start_values,
    )


def test_the_unit_is_valid(unit):
    assert list(validate_fmu(str(unit))) == []


def test_an_importer_finds_the_motion_that_simulate_finds(unit):
    problem = motion_problem(PENDULUM, Request("lengthening_scene"), Limits())
    motion = simulate(problem, SimulationRequest(until=UNTIL, samples=SAMPLES))
    found = follow(unit)
    assert found["time"] == pytest.approx(motion.times, abs=1e-12)
    assert found["x"] == pytest.approx(motion.coordinates["x"], abs=1e-7)
    assert found["y"] == pytest.approx(motion.coordinates["y"], abs=1e-7)
    assert found["lambda1"] == pytest.approx(motion.multipliers["lambda1"], abs=1e-6)


def test_a_heavier_bob_moves_the_same_and_pulls_the_more(unit):
    light, heavy = follow(unit), follow(unit, m=3.0)
    assert heavy["x"] == pytest.approx(light["x"], abs=1e-7)
    assert heavy["lambda1"] == pytest.approx(3 * light["lambda1"], abs=1e-6)


def test_the_inputs_begin_where_the_law_does(unit):
    described = fmpy.read_model_description(str(unit))
    variables = {v.name: v for v in described.modelVariables}
    assert float(described.defaultExperiment.startTime) == 0
    assert [float(variables[name].start) for name in ("u", "dot(u)", "ddot(u)")] == [1.0, 0.1, 0.0]
    assert [name for name, v in variables.items() if v.causality == "input"] == ["u", "dot(u)", "ddot(u)"]


def test_the_sources_compile_in_silence(unit, tmp_path):
    with zipfile.ZipFile(unit) as archive:
        archive.extractall(tmp_path)
    command = ["cc", "-std=c11", "-O2", "-Wall", "-Wextra", "-pedantic", "-c", "bob.c", "fmi3.c"]
    compiled = subprocess.run(command, cwd=tmp_path / "sources", capture_output=True, text=True, check=False)
    assert (compiled.returncode, compiled.stderr) == (0, "")


def test_the_same_scene_gives_the_same_description_and_sources():
    model = scene_model(PENDULUM, Request(), (), Limits())
    assert fmu.write_model(model, "bob") == fmu.write_model(model, "bob")


def test_what_has_no_value_to_start_from_is_refused(write_scene):
    text = re.sub(r"load\(.*\)\$", 'load("holonom.mac")$', PENDULUM.read_text(), count=1)
    file = write_scene(text.replace("m = 1, ", ""))
    with failing(ErrorKind.INPUT_MISSING, "m"):
        fmu.write_model(scene_model(file, Request(), (), Limits()), "bob")


OBSERVING = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [m], potential_energy = [gravity = 10*m*y],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, constraints = [x^2 + y^2 - u^2])$
swing : holonomic_scene(system, control_law = [u = 1], parameter_values = [m = 2], time_span = [0, 1],
  initial_state = [x = 3/5, y = -4/5, dot(x) = 0], observe = [trajectory, pull = -2*lambda1*u, a = [ddot(x), ddot(y)]])$
"""


def test_outputs_of_the_scene_are_outputs_of_the_unit(tmp_path, c_compiler):
    """The tension of a pendulum of length 1 is m v^2 - m g y, which accelerates it."""
    (tmp_path / "scene.mac").write_text(OBSERVING)
    model = scene_model(tmp_path / "scene.mac", Request(None), ["m"], Limits())
    assert model.observed == ("pull", "a[1]", "a[2]")
    unit = tmp_path / "unit.fmu"
    unit.write_bytes(fmu.write_model(model, "unit"))
    assert list(validate_fmu(str(unit))) == []
    names = ["x", "y", "dot(x)", "dot(y)", "pull", "a[1]", "a[2]"]
    rows = fmpy.simulate_fmu(str(unit), fmi_type="ModelExchange", stop_time=1, output=names)
    x, y, v, w, *found = (rows[name] for name in names)
    pull = 2 * (v**2 + w**2 - 10 * y) / (x**2 + y**2)
    assert np.array(found) == pytest.approx(np.array([pull, -pull * x / 2, -pull * y / 2 - 10]), rel=1e-12)


# ---- parameters and controls of constraints --------------------------------------------------------------------------

LENGTHS = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [m, l, g], potential_energy = m*g*y,
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, constraints = [x^2 + (y - u)^2 - l^2, (x^2 + (y - u)^2 - l^2)*u])$
swing : holonomic_scene(system, control_law = [u = 1/10], parameter_values = [m = 3, l = 1, g = 10],
  initial_state = [x = 3/5, dot(x) = 1/2], initial_guess = [y = -7/10], time_span = [0, 1])$
"""


@pytest.fixture(scope="module")
def swing(tmp_path_factory, c_compiler) -> Path:
    folder = tmp_path_factory.mktemp("lengths")
    (folder / "scene.mac").write_text(LENGTHS)
    unit = folder / "swing.fmu"
    unit.write_bytes(
        fmu.write_model(scene_model(folder / "scene.mac", Request(None), ["m", "l", "g"], Limits()), "swing")
    )
    return unit


def angle_after(time: float, length: float, phi: float, rate: float) -> float:
    solved = solve_ivp(lambda _, y: [y[1], -10 / length * np.sin(y[0])], (0, time), [phi, rate], rtol=1e-12, atol=1e-12)
    return solved.y[0, -1]


@pytest.mark.parametrize(("length", "u"), [(1, 0.1), (2, 0.1), (1, -0.3), (0.25, 0)])
def test_the_start_follows_the_parameters_and_controls(swing, length, u):
    """It satisfied the constraints of the scene's values alone, and the unit moved on those, whatever l and u were."""
    law = np.array([(0, u), (1, u)], dtype=[("time", float), ("u", float)])
    rows = fmpy.simulate_fmu(
        str(swing), fmi_type="ModelExchange", stop_time=1, output_interval=1, relative_tolerance=1e-10,
        start_values={"l": length}, input=law, output=["x", "y", "lambda1"],
    )  # fmt: skip
    x, y = rows["x"], rows["y"] - u
    assert np.hypot(x, y) == pytest.approx(length, rel=1e-7)
    assert [x[0], y[0]] == pytest.approx(np.array([0.6, -0.7 - u]) * length / np.hypot(0.6, 0.7 + u), rel=1e-12)
    phi = np.arctan2(x, -y)
    rate = (0.5 * np.cos(phi[0]) + 3 / 8 * np.sin(phi[0])) / length
    assert phi[1] == pytest.approx(angle_after(1, length, phi[0], rate), abs=1e-7)


def test_parameters_of_constraints_are_fixed(swing):
    variables = {v.name: v for v in fmpy.read_model_description(str(swing)).modelVariables}
    assert [variables[name].variability for name in ("m", "l", "g")] == ["tunable", "fixed", "tunable"]
    assert list(validate_fmu(str(swing))) == []


def test_a_start_without_a_state_nearby_is_an_error(tmp_path, c_compiler):
    (tmp_path / "scene.mac").write_text(LENGTHS.replace("- l^2", "- l"))
    unit = tmp_path / "unit.fmu"
    unit.write_bytes(fmu.write_model(scene_model(tmp_path / "scene.mac", Request(None), ["l"], Limits()), "unit"))
    with pytest.raises(FMICallException, match="fmi3ExitInitializationMode"):
        fmpy.simulate_fmu(str(unit), fmi_type="ModelExchange", stop_time=1, start_values={"l": -1})


def test_a_coordinate_may_be_named_as_the_time_is_elsewhere(write_scene, tmp_path, c_compiler):
    text = LENGTHS.replace("[x, y]", "[x, y, time]").replace("constraints = [", "constraints = [time + ")
    text = text.replace("m*(dot(x)^2", "m*(dot(time)^2 + dot(x)^2").replace("y = -7/10", "y = -7/10, time = 0")
    unit = tmp_path / "unit.fmu"
    unit.write_bytes(fmu.write_model(scene_model(write_scene(text), Request(None), [], Limits()), "unit"))
    assert list(validate_fmu(str(unit))) == []
    independent, *others = fmpy.read_model_description(str(unit)).modelVariables
    assert (independent.name, others[2].name) == ("t", "time")
