"""What is particular to the Taylor engine: blocks, rolling back, the choice of code."""

import time
from fractions import Fraction
from itertools import count

import numpy as np
import pytest
from problems import problem

from holonom.program.motion_problem import motion_problem
from holonom.program.precision import read_precision
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.simulation.constraints.program_projection import ProgramProjection
from holonom.simulation.engines import code
from holonom.simulation.engines.code import Code, _is_worthwhile, _running, codes_for
from holonom.simulation.engines.engine import Task, advance
from holonom.simulation.engines.taylor import TaylorEngine
from holonom.simulation.request import SimulationRequest, Stabilization
from holonom.simulation.simulate import simulate


def test_better_code_for_long_runs():
    """What is compiled quickly first; better code is worthwhile for long runs, and in hardware numbers alone."""
    assert TaylorEngine(Task.of(problem("pendulum.mac"))).code is Code.PLAIN
    assert TaylorEngine(Task.of(problem("pendulum.mac"), precision="extended")).code is Code.QUICK
    assert TaylorEngine(Task.of(problem("pendulum.mac"), compact=True)).code is Code.COMPACT
    assert TaylorEngine(Task.of(problem("pendulum.mac"), compact=False)).code is Code.UNROLLED
    long = TaylorEngine(Task.of(problem("pendulum.mac", "swing_scene")))
    advance(long, 100_000.0)
    assert long.code is Code.UNROLLED
    second = 1 / _running(Code.QUICK, 20, 1, 1e-9)  # steps
    assert not _is_worthwhile(Code.QUICK, Code.COMPACT, 20, 1e-3 * second, 1e-9)
    assert _is_worthwhile(Code.QUICK, Code.COMPACT, 20, 10 * second, 1e-9)
    assert not _is_worthwhile(Code.COMPACT, Code.UNROLLED, 500, 10 / _running(Code.COMPACT, 500, 1, 1e-9), 1e-9)
    double = read_precision("double")
    assert codes_for(200, double) == (Code.QUICK, Code.PLAIN, Code.UNROLLED)
    assert codes_for(2000, double) == (Code.QUICK, Code.COMPACT)
    assert codes_for(20, read_precision("quadruple")) == (Code.QUICK,)


@pytest.mark.parametrize("seconds", [0.0, 1e3])
def test_the_clock_decided_which_code_computes(monkeypatch, seconds):
    """Truth: the same code and the same bits on a machine that is so busy, or so idle, that a clock goes mad."""
    monkeypatch.setattr(code, "_compilation", lambda better, operations: 1e-3)
    swing, wanted = problem("pendulum.mac", "swing_scene"), SimulationRequest(until=Fraction(2000), samples=0)
    truth = simulate(swing, wanted).report
    clock = count()
    monkeypatch.setattr(time, "perf_counter", lambda: seconds * next(clock))
    found = simulate(swing, wanted).report
    assert found.code == truth.code == Code.UNROLLED
    assert (found.coordinates, found.steps) == (truth.coordinates, truth.steps)


def test_a_run_with_many_stops_uses_the_code_that_is_quickly_compiled(monkeypatch, write_scene):
    """Each point of a table is a stop, and began a count of its own."""
    monkeypatch.setattr(code, "_compilation", lambda better, operations: 1e-3)
    points = ", ".join(f"[{t}, 1]" for t in range(201))
    scene = f"""load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  potential_energy = [gravity = 981/100*y], constraints = [x^2 + y^2 - u^2])$
swing : holonomic_scene(system, control_law = [u = table([{points}])], initial_state = [x = 3/5, dot(x) = 0],
  initial_guess = [y = -4/5], time_span = [0, 200])$
"""
    motion = motion_problem(write_scene(scene), Request(), Limits())
    assert simulate(motion, SimulationRequest(samples=0)).report.code is Code.UNROLLED


@pytest.mark.parametrize("compact", [None, True, False])
def test_the_code_does_not_change_the_motion(compact):
    motion = TaylorEngine(Task.of(problem("car_axis.mac"), compact=compact))
    advance(motion, 1.0)
    other = TaylorEngine(Task.of(problem("car_axis.mac"), stabilization=Stabilization.NONE, compact=True))
    advance(other, 1.0)
    assert motion.state == pytest.approx(other.state, abs=1e-11)


@pytest.mark.parametrize("precision", ["double", "extended", "quadruple", "50"])
def test_projection_is_quadratic_in_what_is_amiss(precision):
    """Truth: Newton's method squares an error of 1e-6 to one below 1e-11, and repeated, to rounding."""
    numbers = read_precision(precision)
    motion = problem("pendulum.mac", "swing_scene", 50)
    state = np.array([numbers.number(motion.start[name]) for name in motion.state])
    state[1] += numbers.number("1e-6")
    keeper, start = ProgramProjection(motion, numbers), numbers.number("0")
    keeper.project(start, state)
    assert 1e-15 < abs(float(state[0] ** 2 + state[1] ** 2 - numbers.number("1"))) < 1e-11
    for _ in range(3):
        keeper.project(start, state)
    assert abs(float(state[0] ** 2 + state[1] ** 2 - numbers.number("1"))) < 10.0 ** (1 - numbers.sure_digits)


SMALL = """load("holonom.mac")$
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, potential_energy = x^2/2)$
small : holonomic_scene(system, initial_state = [x = 1/10^12, dot(x) = 0], time_span = [0, 10])$
"""


@pytest.mark.parametrize("tol", [1e-6, 1e-12])
def test_a_small_motion_is_as_exact_as_a_large_one(tol, write_scene):
    """Truth: cos(t). heyoka's tolerance is absolute where all numbers are below one."""
    motion = motion_problem(write_scene(SMALL), Request(), Limits())
    report = simulate(motion, SimulationRequest(engine="taylor", tol=tol, samples=0)).report
    assert report.coordinates["x"] * 1e12 == pytest.approx(np.cos(10), abs=100 * tol)
