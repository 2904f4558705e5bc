"""A scene as an FMI 3 unit: valid, and in FMPy's hands the motion that `holonom simulate` finds."""

import re
import subprocess
import zipfile
from pathlib import Path

import fmpy
import numpy as np
import pytest
from click.testing import CliRunner
from fmpy.validation import validate_fmu
from refusing import failing

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
