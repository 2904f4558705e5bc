"""What is particular to the Runge-Kutta engine: compiled steps, states between them, the projection in C."""

import gc
import re
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import mpmath
import numpy as np
import pytest
from problems import problem
from refusing import failing
from scipy.integrate import DOP853

from holonom.failures import ErrorKind, HolonomError
from holonom.program.motion_problem import motion_problem
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.simulation.engines.engine import Task, advance
from holonom.simulation.engines.program_engine import FIRST_BLOCK
from holonom.simulation.engines.runge_kutta import DRIVER, RungeKuttaEngine
from holonom.simulation.engines.taylor import TaylorEngine
from holonom.simulation.request import EngineName, SimulationRequest, Stabilization
from holonom.simulation.simulate import simulate

THROWN = """
load("holonom.mac")$
body : holonomic_system(coordinates = [x, z], kinetic_energy = (dot(x)^2 + dot(z)^2)/2, potential_energy = 10*z,
  constraints = [])$
flight : holonomic_scene(body, initial_state = [x = 0, z = 0, dot(x) = 1, dot(z) = 5], time_span = [0, 1])$
"""

pytestmark = pytest.mark.usefixtures("c_compiler")


def test_a_parabola_is_followed_to_rounding(write_scene):
    """Truth: a method of order 8 is exact for polynomials of degree 2, and the first step reaches the end."""
    motion = RungeKuttaEngine(Task.of(motion_problem(write_scene(THROWN), Request(), Limits()), tol=1e-6))
    advance(motion, 1.0)
    assert motion.state == pytest.approx([1, 0, 1, -5], abs=1e-13)


def test_far_from_zero_a_step_was_longer_or_shorter_than_the_time_it_took(write_scene):
    """Of ddot(x) = sin(t) from t = 10^9, where times are 1e-7 apart, dot(x) had an error of 1e-5 after 0.1."""
    driven = write_scene("""
        load("holonom.mac")$
        system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [sin(t)])$
        scene : holonomic_scene(system, initial_state = [x = 0, dot(x) = 0], time_span = [10^9, 10^9 + 1/10])$""")
    motion = RungeKuttaEngine(Task.of(motion_problem(driven, Request(), Limits())))
    advance(motion, 1e9 + 0.1)
    end = Fraction(motion.time)
    with mpmath.workdps(30):
        truth = mpmath.cos(10**9) - mpmath.cos(mpmath.mpf(end.numerator) / end.denominator)
    assert motion.state[1] == pytest.approx(float(truth), abs=2e-8)


def test_coefficients_are_those_of_scipys_method():
    """Truth: the tables of DOP853."""
    text, table = DRIVER.read_text(encoding="utf-8"), DOP853

    def row(terms: str) -> list[float]:
        found = re.findall(r"(-? ?[\d.]+(?:e-\d+)?)\*k(\d+)\[i\]", terms)
        numbers = {int(stage): float(number.replace(" ", "")) for number, stage in found}
        return [numbers.get(stage, 0.0) for stage in range(1, 17)]

    def filled(numbers: np.ndarray) -> list[float]:
        return [*numbers, *[0.0] * 16][:16]

    stages, fractions = [*table.A, table.B, *table.A_EXTRA], [*table.C, 1.0, *table.C_EXTRA]
    for stage, fraction, terms in re.findall(r"STAGE\((\d+), ([\d.]+), (.*?)\)\n", text, re.DOTALL):
        assert row(terms) == filled(stages[int(stage) - 1])
        assert float(fraction) == fractions[int(stage) - 1]
    formulas = {"after[i] = y[i] + h*(0": table.B, "error5 = (": table.E5, "error3 = (": table.E3}
    formulas |= {f"dense[{place}][i] = h*(": numbers for place, numbers in enumerate(table.D, start=4)}
    for name, numbers in formulas.items():
        terms = text[text.index(name) + len(name.rstrip("0")) :]
        assert row(terms[: terms.index(";")]) == filled(numbers)


def test_states_between_the_steps_take_three_evaluations_and_have_the_error_of_a_step():
    """Truth: the Taylor engine's at the same times; by a step of its own, each took twelve, 180 a step here."""
    motion, true = (
        simulate(problem("pendulum.mac"), SimulationRequest(engine=engine, tol=1e-9, samples=101))
        for engine in (EngineName.RUNGE_KUTTA, EngineName.TAYLOR)
    )
    for name, values in motion.coordinates.items():
        assert values == pytest.approx(true.coordinates[name], abs=2e-8)
    engine = RungeKuttaEngine(Task.of(problem("pendulum.mac"), tol=1e-9))
    for step in engine.integrate(10.0):
        step.states(np.linspace(step.start, step.end, 15))
    assert engine.evaluations <= 16 * engine.steps


def test_the_error_follows_the_tolerance():
    """Truth: the pendulum of the Taylor engine at rounding; six powers of ten in the tolerance are six in the error."""
    true = TaylorEngine(Task.of(problem("pendulum.mac")))
    advance(true, 10.0)
    errors = []
    for tol in (1e-4, 1e-7, 1e-10):
        motion = RungeKuttaEngine(Task.of(problem("pendulum.mac"), tol=tol))
        advance(motion, 10.0)
        errors.append(np.abs(motion.state - true.state).max())
    assert errors[2] < 1e-9
    assert 1e2 < errors[0] / errors[1] < 1e5
    assert 1e2 < errors[1] / errors[2] < 1e5


def test_a_motion_in_one_call_is_that_in_pieces_and_past_a_block():
    """Truth: the same steps, to the last bit; 100 time units take several blocks."""
    until, task = 100.0, Task.of(problem("pendulum.mac", "swing_scene"), tol=1e-9)
    motions = [RungeKuttaEngine(task) for _ in range(2)]
    advance(motions[0], until)
    for _ in motions[1].integrate(until):
        pass
    assert motions[0].time == motions[1].time == until
    assert motions[0].steps == motions[1].steps > FIRST_BLOCK
    assert np.array_equal(motions[0].state, motions[1].state)


@pytest.mark.parametrize("stabilization", [Stabilization.BAUMGARTE, Stabilization.GGL])
def test_stabilizations_in_the_equations_let_an_error_die_out(stabilization):
    """Truth: a position off its constraint by 1e-6 is back after many decay times, with stabilization only."""
    motion = problem("pendulum.mac", "swing_scene")
    astray = replace(motion, start={**motion.start, "y": str(float(motion.start["y"]) - 1e-6)})

    def missed(stabilization):
        engine = RungeKuttaEngine(Task.of(astray, tol=1e-12, stabilization=stabilization))
        advance(engine, float(motion.time_span[1]))
        return abs(engine.state[0] ** 2 + engine.state[1] ** 2 - 1)

    assert missed(stabilization) < 1e-12
    assert missed(Stabilization.NONE) > 1e-7


@pytest.mark.parametrize("stabilization", [Stabilization.BAUMGARTE, Stabilization.GGL])
def test_with_stabilization_the_motion_is_that_of_the_taylor_engine(stabilization):
    """Truth: both solve the same equations, with the same gamma."""
    ours, theirs = (
        RungeKuttaEngine(Task.of(problem("pendulum.mac"), tol=1e-13, stabilization=stabilization)),
        TaylorEngine(Task.of(problem("pendulum.mac"), stabilization=stabilization)),
    )
    for engine in (ours, theirs):
        advance(engine, 5.0)
    assert ours.state == pytest.approx(theirs.state, abs=1e-10)


def test_projection_keeps_the_constraints_that_a_coarse_tolerance_loses():
    def missed(stabilization):
        motion = RungeKuttaEngine(
            Task.of(problem("pendulum.mac", "swing_scene"), tol=1e-5, stabilization=stabilization)
        )
        advance(motion, 50.0)
        (x, y), (vx, vy) = motion.state[:2], motion.state[2:]
        return max(abs(x**2 + y**2 - 1), abs(x * vx + y * vy))

    assert missed(Stabilization.PROJECTION) < 1e-14
    assert missed(Stabilization.NONE) > 1e-6


def test_the_work_of_a_control_is_balanced():
    """Truth: energy; the car axis' road does work on it all the time."""
    request = SimulationRequest(tol=1e-11, engine=EngineName.RUNGE_KUTTA, samples=0)
    report = simulate(problem("car_axis.mac"), request).report
    assert abs(report.energy_error) < 1e-11
    assert [segment.engine for segment in report.segments] == [EngineName.RUNGE_KUTTA]
    assert report.code == ""


@pytest.mark.parametrize(
    ("request_", "kind"),
    [
        (SimulationRequest(tol=1e-15), ErrorKind.TOLERANCE_OUT_OF_RANGE),
        (SimulationRequest(precision="quadruple"), ErrorKind.RUNGE_KUTTA_IS_DOUBLE),
    ],
)
def test_what_it_lacks_is_refused(request_, kind):
    wanted = replace(request_, engine=EngineName.RUNGE_KUTTA, until=Fraction(1), samples=0)
    with failing(kind):
        simulate(problem("pendulum.mac"), wanted)


ENDED = """load("holonom.mac")$
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, potential_energy = x^2/2)$
swing : holonomic_scene(system, initial_state = [x = 1, dot(x) = 0], time_span = [0, 3], until = [x])$
"""


def test_motions_left_their_libraries_open(write_scene):
    """Each row of a sweep that is integrated alone may have one of its own."""

    def open_libraries() -> int:
        gc.collect()  # those that other tests have left open
        return len(set(re.findall(r"\S*/motion\.so", Path("/proc/self/maps").read_text(encoding="utf-8"))))

    swing, ended = problem("pendulum.mac", "swing_scene"), motion_problem(write_scene(ENDED), Request(), Limits())
    before = open_libraries()
    engine = RungeKuttaEngine(Task.of(swing))
    assert open_libraries() == before + 1
    engine.close()
    for until in (Fraction(1), Fraction(10**12)):  # the second takes too many steps
        with suppress(HolonomError):
            simulate(swing, SimulationRequest(engine=EngineName.RUNGE_KUTTA, until=until))
    assert simulate(ended, SimulationRequest(engine=EngineName.RUNGE_KUTTA)).report.ending.crossed == "x"
    assert open_libraries() == before
