"""A row of a sweep gets the verdict that `simulate` gives on the same motion, with every integrator."""

import re
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from holonom.failures import HolonomError
from holonom.program.c_function import load_c
from holonom.program.motion_problem import motion_problem
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.simulation.engines import fallback, runge_kutta
from holonom.simulation.engines.choice import Choice
from holonom.simulation.initial_state import at_values
from holonom.simulation.request import EngineName, SimulationRequest
from holonom.simulation.simulate import simulate
from holonom.sweeps.axes import read_axes
from holonom.sweeps.outputs import read_quantities
from holonom.sweeps.request import TOLERANCE
from holonom.sweeps.rows import Plan, RowMaker, Status


def scene(coordinates: str, kinetic: str, potential: str, start: str, end: str, more: str = "constraints = []") -> str:
    return f"""load("holonom.mac")$
system : holonomic_system(coordinates = [{coordinates}], parameters = [k],
  kinetic_energy = {kinetic}, potential_energy = {potential}, {more})$
motion : holonomic_scene(system, parameter_values = [k = 1], initial_state = [{start}], time_span = [0, {end}])$"""


PLANE = "(dot(x)^2 + dot(y)^2)/2"
LEDGE = "k*atan(10^13*(x - 1/2))"  # too steep for the Taylor coefficients of a step that begins before it
FRICTION = ", ".join(f"-k*{v}/sqrt(dot(x)^2 + dot(y)^2)" for v in ("dot(x)", "dot(y)"))
OK, INACCURATE, BROKEN_OFF = Status.OK, Status.INACCURATE, Status.BROKEN_OFF
SCENES = {
    "a ledge": (
        scene("x", "dot(x)^2/2", LEDGE, "x = 0, dot(x) = 1", "1"),
        ("0:1/10:3", [OK, INACCURATE, INACCURATE]),
    ),
    "a ledge, and back": (
        scene("x", "dot(x)^2/2", f"x^2/2 + {LEDGE}", "x = 0, dot(x) = 1", "44/7"),
        ("0:1/20:2", [OK, INACCURATE]),
    ),
    "nearly a collision": (
        scene("x, y", PLANE, "-1/sqrt(x^2 + y^2)", "x = 1, y = 0, dot(x) = 0, dot(y) = k", "4"),
        ("1e-7:1:3", [BROKEN_OFF, OK, OK]),
    ),
    "friction in a plane": (
        scene("x, y", PLANE, "0", "x = 0, y = 0, dot(x) = 3, dot(y) = 4", "4", f"forces = [{FRICTION}]"),
        ("1:63/50:3", [OK, OK, BROKEN_OFF]),
    ),
    "an angle beyond its cut": (
        scene("x, y", PLANE, "0", "x = 1, y = 1, dot(x) = -2, dot(y) = -1", "3", "forces = [-k*atan2(y, x), 0]"),
        ("-3:1:3", [OK, BROKEN_OFF, BROKEN_OFF]),
    ),
}
LONG = {
    "an oscillator": (scene("x", "dot(x)^2/2", "k*x^2/2", "x = 1, dot(x) = 0", "30"), ("1:25:3", [OK] * 3)),
    "a saddle": (scene("x", "dot(x)^2/2", "-k*x^2/2", "x = 1, dot(x) = -1", "20"), ("1:9:3", [OK] * 3)),
    "a fall to rest": (
        scene("x", "dot(x)^2/2", "0", "x = 0, dot(x) = 1", "60", "forces = [-k*dot(x)]"),
        ("0:3:3", [OK] * 3),
    ),
    "a narrow well": (
        scene("x, y", PLANE, "-k*exp(-(1000*(x - 1/2))^2)", "x = 0, dot(x) = 1", "1", "constraints = [y - x^2]"),
        ("0:1/10:2", [OK, OK]),
    ),
    "dry friction": (
        scene("x", "dot(x)^2/2", "0", "x = 0, dot(x) = 1", "3", "forces = [-k*signum(dot(x))]"),
        ("1/2:2:3", [OK] * 3),
    ),
    "a pendulum": (
        scene("x, y", PLANE, "10*k*y", "x = 3/5, y = -4/5, dot(x) = 0", "10", "constraints = [x^2 + y^2 - 1]"),
        ("1:3:3", [OK] * 3),
    ),
    "a lengthening pendulum": (
        scene("x, y", PLANE, "k*y", "x = 0, y = -1, dot(x) = 1", "10", "constraints = [x^2 + y^2 - 1 - t^2]"),
        ("1:3:3", [OK] * 3),
    ),
}


class OneByOne(RowMaker):
    """Integrates no row beside others."""

    _batched = False


def verdict(problem, k: Fraction) -> str:
    try:
        motion = simulate(at_values(problem, {"k": k}), SimulationRequest(tol=TOLERANCE))
    except HolonomError:
        return Status.BROKEN_OFF
    return Status.OK if motion.report.trusted else Status.INACCURATE


@pytest.fixture(scope="module")
def verdicts(rows_of, tmp_path_factory):
    def of(text: str, grid: str) -> list[list[str]]:
        file: Path = tmp_path_factory.mktemp("scene") / "scene.mac"
        file.write_text(text)
        batch = rows_of(file, "final", f"k={grid}")
        rows = batch.plan.axes.rows
        tables = [maker.table(0, rows) for maker in (batch, OneByOne(batch.plan))]
        single = [verdict(batch.plan.problem, Fraction(k)) for k in tables[0]["k"].to_pylist()]
        return [*(table["status"].to_pylist() for table in tables), single]

    return of


@pytest.mark.parametrize("name", [*SCENES, *(pytest.param(name, marks=pytest.mark.long) for name in LONG)])
def test_rows_in_batches_single_rows_and_simulate_agree(verdicts, name):
    text, (grid, expected) = {**SCENES, **LONG}[name]
    assert verdicts(text, grid) == [expected] * 3


@pytest.mark.usefixtures("c_compiler")
def test_rows_that_are_integrated_alone_left_their_libraries_open(rows_of, tmp_path, monkeypatch):
    """Truth: as many open libraries and functions after six rows, one of them broken off, as after one."""
    loaded = []
    monkeypatch.setattr(runge_kutta, "load_c", lambda *asked: loaded.append(asked) or load_c(*asked))
    monkeypatch.setattr(fallback, "quicker_engine", lambda *asked: Choice(EngineName.RUNGE_KUTTA, 0, 0, {}))
    monkeypatch.setattr(fallback, "TRIAL", 1)
    file = tmp_path / "scene.mac"
    file.write_text(scene("x", "dot(x)^2/2", "exp(-x^2)/k", "x = 0, dot(x) = 1", "1"))
    maker, found = rows_of(file, "final", "k=-1:2:4"), []
    for first, last in ((3, 4), (0, 4), (1, 3)):
        maker.table(first, last)
        libraries = re.findall(r"\S*/motion\.so", Path("/proc/self/maps").read_text(encoding="utf-8"))
        found.append((len(set(libraries)), len(maker.plan.problem._compiled)))
    assert len(loaded) >= 5
    assert found[1:] == found[:-1]


ENDED = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], parameters = [a, b, c, d],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2, potential_energy = x^2/2 + y^2 + x^2*y/4)$
motion : holonomic_scene(system, parameter_values = [a = 1, b = 1, c = 1, d = 1],
  initial_state = [x = 1, y = 1/2, dot(x) = 0, dot(y) = 0], time_span = [0, 6], until = [{until}])$"""
ENDS = {
    "near misses": "(x - c/2)^2 + (y - b/2)^2 - (a*d)^2/500",
    "several": "x*y - d*(t - 1), a*dot(x) - c + b",
    "waves": "sin(a*x) + b*y - c + d/10",
    "touches": "(x - c)^2*(y - d) + a*b*x",
    "from zero": "dot(x)^2 + dot(y)^2 - c*a, x - 1",
    "poles": "1/(x - c) - a - d + b/8",
    "roots": "sqrt(4 + x*a) - d - 2, exp(-30*(x - c)^2) - b",
}


@pytest.mark.parametrize("ends", ["waves", *(pytest.param(e, marks=pytest.mark.long) for e in ENDS if e != "waves")])
def test_the_end_of_a_random_row_does_not_depend_on_who_integrates_it(ends, tmp_path):
    """Truth: the row that is integrated alone. Waves that steps barely resolve ended one of 40 rows 5e-9 too late."""
    file, names, rows = tmp_path / "scene.mac", ("a", "b", "c", "d"), 40
    file.write_text(ENDED.format(until=ENDS[ends]))
    samples = ["a=uniform(1,8)", "b=uniform(-1,1)", "c=uniform(-1,1)", "d=uniform(0,1)"]
    axes = read_axes([], [], samples, rows, 29)
    motion = motion_problem(file, Request(), Limits(), open_parameters=names)
    plan = Plan(motion, axes, read_quantities(["final,t,max(x)"]))
    batch, alone = (maker(plan).table(0, rows) for maker in (RowMaker, OneByOne))
    assert batch["status"].to_pylist() == alone["status"].to_pylist()
    for name in ("t", "x", "dot(x)", "y", "dot(y)", "max(x)"):
        found, truth = (table[name].to_numpy(zero_copy_only=False).astype(float) for table in (batch, alone))
        assert found == pytest.approx(truth, abs=1e-9, nan_ok=True), name
    ended = batch["t"].to_numpy(zero_copy_only=False).astype(float)
    assert np.unique(np.round(ended, 6)).size > 3
