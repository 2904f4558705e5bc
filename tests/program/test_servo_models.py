"""Scenes with servo-constraints as libraries in C and as FMI units: the motion and the torques that simulate finds."""

from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu

from holonom.program.model import Model, scene_model
from holonom.program.motion_problem import motion_problem
from holonom.program.numpy_function import NumpyFunction
from holonom.program.request import Request
from holonom.program.targets import fmu
from holonom.sandbox import Limits
from holonom.simulation.request import SimulationRequest
from holonom.simulation.simulate import simulate

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def arm() -> Model:
    return scene_model(EXAMPLES / "arm.mac", Request("circle_scene"), ["m"], Limits())


def test_the_torques_that_are_found_are_no_inputs(arm: Model):
    assert arm.controls == ()
    assert arm.found == ("tau1", "tau2")


def test_the_torques_are_those_of_inverse_dynamics(arm: Model):
    """The tip's acceleration is that of the circle; the multipliers of the path are zero."""
    inputs = {"t": 0.7, "a": -0.9, "b": 0.8, "dot(a)": 0.3, "dot(b)": -0.2, "m": 1.5}
    values = [inputs[name] for name in arm.motion.inputs]
    motion = dict(zip(arm.motion.outputs, NumpyFunction(arm.motion)(values), strict=True))
    torques = NumpyFunction(arm.servo)(values)
    a, b, va, vb, m, g = (*values[1:6], 9.81)
    tip = np.array([[-np.sin(a), -np.sin(b)], [np.cos(a), np.cos(b)]])
    rate = np.array([[-np.cos(a) * va, -np.cos(b) * vb], [-np.sin(a) * va, -np.sin(b) * vb]])
    wanted = np.array([-np.cos(0.7) / 4, -np.sin(0.7) / 4])
    acceleration = np.linalg.solve(tip, wanted - rate @ [va, vb])
    assert [motion["ddot(a)"], motion["ddot(b)"]] == pytest.approx(acceleration, rel=1e-12)
    cross, sine = np.cos(a - b), np.sin(a - b)
    at_a = m * (2 * acceleration[0] + cross * acceleration[1] + sine * vb**2) + 2 * m * g * np.cos(a)
    at_b = m * (acceleration[1] + cross * acceleration[0] - sine * va**2) + m * g * np.cos(b)
    assert torques == pytest.approx([at_a + at_b, at_b], rel=1e-12)
    assert [motion["lambda1"], motion["lambda2"]] == pytest.approx([0, 0], abs=1e-12)


def test_a_length_that_is_found_is_a_state():
    """No input, and no force that is found: ddot(u) is of the load that swings harmonically at one height."""
    model = scene_model(EXAMPLES / "level_load.mac", Request("swing_scene"), ["m"], Limits())
    assert (model.coordinates, model.controls, model.found) == (("x", "y", "u"), ("w",), ())
    x, vx = 0.75, 0.4
    u = np.hypot(x, 2)
    inputs = {"x": x, "y": -2, "u": u, "dot(x)": vx, "dot(u)": x * vx / u, "m": 1.5}
    values = [inputs.get(name, 0.0) for name in model.motion.inputs]
    motion = dict(zip(model.motion.outputs, NumpyFunction(model.motion)(values), strict=True))
    slope = -9.81 / 2 * x
    wanted = [slope, 0, (vx**2 + x * slope - (x * vx / u) ** 2) / u, -1.5 * 9.81 / 4, 0]
    assert [motion[name] for name in ("ddot(x)", "ddot(y)", "ddot(u)", "lambda1", "lambda2")] == pytest.approx(
        wanted, rel=1e-13, abs=1e-13
    )


@pytest.mark.parametrize(
    ("example", "scene", "until", "torques"),
    [
        ("arm.mac", "circle_scene", 1, ["tau1", "tau2"]),
        pytest.param("overhead_crane.mac", None, 1, ["F", "W"], marks=pytest.mark.long),
    ],
)
def test_fmpy_finds_what_simulate_finds(
    tmp_path: Path, example: str, scene: str | None, until: int, torques: list[str]
):
    request = Request(scene)
    model = scene_model(EXAMPLES / example, request, [], Limits())
    unit = tmp_path / "unit.fmu"
    unit.write_bytes(fmu.write_model(model, "unit"))
    assert list(validate_fmu(str(unit))) == []
    wanted = [*model.coordinates, *model.found]
    rows = fmpy.simulate_fmu(
        str(unit),
        fmi_type="ModelExchange",
        stop_time=until,
        relative_tolerance=1e-11,
        output_interval=until,
        output=wanted,
    )
    report = simulate(
        motion_problem(EXAMPLES / example, request, Limits()), SimulationRequest(until=until, samples=0)
    ).report
    assert set(model.found) == set(torques) == set(report.controls)
    for name, number in {**report.coordinates, **report.controls}.items():
        assert rows[-1][name] == pytest.approx(float(number), abs=1e-7), name
