"""The memory that many digits take is known before, from the order that heyoka has."""

from fractions import Fraction
from math import inf
from pathlib import Path
from types import SimpleNamespace

import psutil
import pytest
from refusing import failing

from holonom import supervisor
from holonom.failures import ErrorKind
from holonom.program import expense
from holonom.program.expense import order_for, require_means
from holonom.program.motion_problem import MotionProblem, motion_problem
from holonom.program.precision import GUARD_DIGITS, read_precision
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.series.heyoka_series import continue_motion, expand
from holonom.simulation.engines.engine import Task
from holonom.simulation.engines.taylor import TaylorEngine
from holonom.simulation.request import SimulationRequest
from holonom.simulation.simulate import integrate, simulate

PENDULUM = Path(__file__).resolve().parents[2] / "examples" / "pendulum.mac"
DIGITS = 1000


@pytest.fixture(scope="module")
def pendulum() -> MotionProblem:
    return motion_problem(PENDULUM, Request(), Limits(), DIGITS + GUARD_DIGITS)


@pytest.mark.parametrize("digits", [30, 250])
def test_the_order_is_that_of_heyokas_steps(pendulum, digits):
    engine = TaylorEngine(Task.of(pendulum, precision=digits))
    assert order_for(digits + GUARD_DIGITS) == pytest.approx(engine._integrator.order, abs=1)


REQUESTS = {
    "a motion": lambda problem, numbers: simulate(problem, SimulationRequest(precision=numbers.digits)),
    "a motion by larger steps": lambda problem, numbers: integrate(
        problem, SimulationRequest(tol=1e-300, precision=numbers.digits, until=Fraction(100)), print
    ),
    "a series": lambda problem, numbers: expand(problem, 5000, numbers),
    "a series continued": lambda problem, numbers: continue_motion(problem, Fraction(2), numbers),
}


@pytest.mark.parametrize("asked", REQUESTS)
def test_more_digits_than_memory_holds_are_refused(asked, pendulum, monkeypatch):
    monkeypatch.setattr(psutil, "virtual_memory", lambda: SimpleNamespace(available=2**18))
    with failing(ErrorKind.MEMORY_TOO_SMALL, "0"):
        REQUESTS[asked](pendulum, read_precision(str(DIGITS)))


@pytest.mark.parametrize(("limit", "seconds"), [(inf, [supervisor.EXPECTED]), (1000.0, [])])
def test_a_thousand_digits_ran_until_the_time_was_over(limit, seconds, pendulum, monkeypatch):
    given = []
    monkeypatch.setattr(supervisor, "_time_limit", limit)
    monkeypatch.setattr(supervisor, "limit_time", given.append)
    require_means(pendulum, read_precision(str(DIGITS)), 5000)
    assert given == seconds


def test_what_the_memory_holds_is_made(pendulum):
    require_means(pendulum, read_precision(str(DIGITS)), 5000)


def test_low_orders_are_not_tried_before(pendulum, monkeypatch):
    monkeypatch.setattr(expense, "import_heyoka", None)
    require_means(pendulum, read_precision("100"), order_for(110))
