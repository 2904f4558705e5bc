"""Programs as functions: by NumPy as long as that takes less time than a compilation, with the same results."""

from fractions import Fraction

import numpy as np
import pytest
from problems import problem as example

from holonom.program.heyoka_function import import_heyoka
from holonom.program.motion_problem import motion_problem
from holonom.program.precision import read_precision
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.simulation.constraints.program_projection import (
    ProgramProjection,
    distance,
    nearest_state,
)
from holonom.simulation.engines.engine import advance
from holonom.simulation.engines.robust import RobustEngine
from holonom.simulation.evaluation import LazyCompiledFunction, evaluation, evaluation_once, in_full_vectors
from holonom.simulation.hybrid_motion import HybridMotion
from holonom.simulation.inputs import Inputs
from holonom.simulation.nominal import nominal_of
from holonom.simulation.request import SimulationRequest

DOUBLE = read_precision("double")


@pytest.fixture(scope="module")
def problem():
    return example("pendulum.mac", "lengthening_scene")


@pytest.fixture(scope="module")
def states(problem):
    draw = np.random.default_rng(1)
    start = np.array([[float(problem.start[name])] for name in ("t", *problem.state)])
    return start + 0.1 * draw.normal(size=(len(start), 7))


def counted(problem, program, monkeypatch):
    """A program as a function, and a list that grows where it is compiled."""
    compiled = []

    def compile_(*arguments):
        compiled.append(arguments)
        return evaluation(*arguments)

    monkeypatch.setattr("holonom.simulation.evaluation.evaluation", compile_)
    return evaluation_once(problem, program, DOUBLE), compiled


def test_a_few_states_are_not_worth_a_compilation(problem, states, monkeypatch):
    function, compiled = counted(problem, problem.matrices, monkeypatch)
    inputs = np.append(states[:, 0], 0.0)
    for _ in range(20):
        function(inputs)
    assert not compiled


def test_many_calls_are_compiled_once_and_many_states_in_one_call_as_soon(problem, states, monkeypatch):
    function, compiled = counted(problem, problem.matrices, monkeypatch)
    inputs = np.append(states[:, 0], 0.0)
    for _ in range(2000):
        function(inputs)
    assert len(compiled) == 1
    function, compiled = counted(problem, problem.matrices, monkeypatch)
    function(np.repeat(inputs[:, None], 10**6, axis=1))
    assert len(compiled) == 1


@pytest.mark.parametrize("program", ["motion", "matrices", "energy"])
def test_numpy_and_heyoka_compute_the_same(problem, states, program):
    asked = getattr(problem, program)
    function, compiled = evaluation_once(problem, asked, DOUBLE), evaluation(asked, DOUBLE)
    inputs = np.vstack([states, np.ones((1, states.shape[1]))])
    assert isinstance(function, LazyCompiledFunction)
    assert np.allclose(function(inputs), compiled(inputs), rtol=1e-14, atol=1e-14)
    assert np.array_equal(function(np.ascontiguousarray(inputs[:, 3])), function(inputs)[:, 3])


def test_projection_moves_to_the_nearest_state_and_tells_the_way(problem, states):
    compiled, keeper, inputs = (
        evaluation(problem.projection, DOUBLE),
        ProgramProjection(problem, DOUBLE),
        Inputs(problem),
    )
    for point in states.T:
        state, found = point[1:].copy(), nearest_state(compiled, inputs(point[0], point[1:]), len(point) - 1)
        moved = keeper.project(point[0], state)
        assert np.allclose(state, found, rtol=1e-13, atol=1e-13)
        assert moved == pytest.approx(distance(point[1:], found, nominal_of(problem).state), rel=1e-12)


def test_a_function_cached_for_all_values_of_a_parameter_is_compiled_at_once(tmp_path):
    """Else the last digits of a motion would depend on how many were integrated before."""
    file = tmp_path / "oscillator.mac"
    file.write_text(
        """load("holonom.mac")$
        system : holonomic_system(coordinates = [x], parameters = [k], kinetic_energy = dot(x)^2/2,
          potential_energy = k*x^2/2, constraints = [])$
        swing : holonomic_scene(system, parameter_values = [k = 1], initial_state = [x = 1, dot(x) = 0])$"""
    )
    problem = motion_problem(file, Request(), Limits(), open_parameters=("k",))
    assert problem.values == {"k": Fraction(1)}
    assert not isinstance(evaluation_once(problem, problem.matrices, DOUBLE), LazyCompiledFunction)


def test_all_that_follow_a_motion_ask_the_same_matrices():
    """Each had its own, carried out by NumPy some hundred times before it was compiled."""
    linkage = example("linkage.mac")
    motion = HybridMotion(linkage, SimulationRequest(until=Fraction(1)), 1.0)
    advance(motion, 1.0)  # past a dead centre
    mode = motion.mode
    first, second = mode.engine._first, mode.engine._second
    assert isinstance(second, RobustEngine)
    assert second.steps > 0
    assert mode.matrices is second.matrices
    assert mode.matrices is first.watch._matrices


def test_heyoka_is_given_full_vectors_and_no_point_more_comes_back():
    """The rest of a vector is computed by other instructions, with other roundings."""
    given = []
    doubled = in_full_vectors(lambda inputs: given.append(inputs.shape[1]) or 2 * inputs)
    width = import_heyoka().recommended_simd_size()
    for points in range(1, 2 * width + 2):
        inputs = np.arange(3.0 * points).reshape(3, points)
        assert np.array_equal(doubled(inputs), 2 * inputs)
    assert given == [-(-points // width) * width for points in range(1, 2 * width + 2)]
