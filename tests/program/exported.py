"""What tests of exported models share: a model of one program, and the module of a text."""

from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
from scipy.interpolate import CubicSpline

from holonom.described import SystemTitle
from holonom.program.model import Model, scene_model
from holonom.program.motion_program import Program
from holonom.program.numpy_function import NumpyFunction
from holonom.program.request import Request
from holonom.program.table_numbers import pieces_of_tables
from holonom.program.targets import target
from holonom.sandbox import Limits

POINTS = [(0, 0), (1, 2), (2, 1), (3, 3), (5, 2), (7, 4), (8, 3), (9, 5)]
EXAMPLES = Path(__file__).parents[2] / "examples"


def model_of_program(written: Program) -> Model:
    """A model whose motion is a program: its first input is the time, the others are parameters."""
    nothing = replace(written, assignments=(), outputs={})
    return Model(
        system=SystemTitle("", None),
        scene="scene",
        title="",
        coordinates=(),
        multipliers=(),
        controls=(),
        parameters=written.inputs[1:],
        values={},
        start=None,
        law=None,
        tables=(),
        motion=written,
        constraints=None,
        projection=nothing,
    )


def example(name: str, *parameters: str) -> Model:
    """The model of an example, with parameters open."""
    return scene_model(EXAMPLES / name, Request(), parameters, Limits())


def module_of(model: Model, package: str) -> ModuleType:
    """The module that Python makes of the written text."""
    module = ModuleType(package)
    exec(target(f"python_{package}").write_model(model, "scene"), vars(module))
    return module


def random_arguments(model: Model, points: int = 7) -> tuple[np.ndarray, ...]:
    """t, y, u, p at random points, one column a point."""
    rng = np.random.default_rng(11)
    lengths = (len(model.state), len(model.histories), len(model.parameters))
    return rng.uniform(0, 2, points), *(rng.uniform(0.5, 2, (length, points)) for length in lengths)


def values_of(program: Program, t: np.ndarray, *vectors: np.ndarray) -> np.ndarray:
    """What the project's own NumPy function makes of them."""
    return NumpyFunction(program)([t, *(row for vector in vectors for row in vector)])


def law_of(model: Model, t: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Controls with their rates by the project's own function, at one time after the other."""
    tables = pieces_of_tables(model.tables)
    found = [
        [*NumpyFunction(model.law)([now, *values, *(row for each in tables for row in each.at(now, "right"))])]
        for now, *values in zip(t, *p, strict=True)
    ]
    places = [tuple(model.law.outputs).index(name) for name in model.histories]
    return np.array(found).T[places]


PROGRAMS = {
    "motion": lambda model: model.motion,
    "constraints": lambda model: model.constraints,
    "projection": lambda model: model.projection,
    "servo": lambda model: model.servo,
    "observe": lambda model: model.outputs,
}
"""The program of each function of a model."""


def lift_by_a_table(file: Path, *parameters: str) -> Model:
    """A mass whose height is the table `POINTS`; the scene is written into a file."""
    table = [list(point) for point in POINTS]
    file.write_text(
        f"""load("holonom.mac")$
system : holonomic_system(coordinates = [z], controls = [u], parameters = [m, g], kinetic_energy = m*dot(z)^2/2,
  potential_energy = m*g*z, constraints = [z - u])$
drive : holonomic_scene(system, control_law = [u = table({table})], parameter_values = [m = 2, g = 981/100],
  initial_state = [z = 0], time_span = [0, 9])$""",
        encoding="utf-8",
    )
    return scene_model(file, Request(), parameters, Limits())


def spline_of_lift() -> CubicSpline:
    """The natural spline through its points, by SciPy."""
    return CubicSpline(*zip(*POINTS, strict=True), bc_type="natural")
