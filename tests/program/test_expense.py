"""What many digits take is known before: as many steps as there will be, to the order that heyoka has."""

from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace

import psutil
import pytest

from holonom.failures import Failure, HolonomError
from holonom.program import expense
from holonom.program.expense import order_for, require_means
from holonom.program.motion_problem import MotionProblem, motion_problem
from holonom.program.precision import GUARD_DIGITS, read_precision
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.series.heyoka_series import continue_motion, expand
from holonom.simulation.engines.taylor import TaylorEngine
from holonom.simulation.request import SimulationRequest
from holonom.simulation.simulate import follow, simulate

PENDULUM = Path(__file__).resolve().parents[2] / "examples" / "pendulum.mac"
DIGITS = 1000


@pytest.fixture(scope="module")
def pendulum() -> MotionProblem:
    return motion_problem(PENDULUM, Request(), Limits(), DIGITS + GUARD_DIGITS)


@pytest.mark.parametrize("digits", [30, 250])
def test_the_order_is_that_of_heyokas_steps(pendulum, digits):
    engine = TaylorEngine(pendulum, None, read_precision(str(digits)))
    assert order_for(digits + GUARD_DIGITS) == pytest.approx(engine._integrator.order, abs=1)


def test_the_steps_are_as_many_as_will_be_taken(pendulum, monkeypatch):
    told = []
    monkeypatch.setattr(expense, "_require_time", lambda steps, *_: told.append(steps))
    precision = read_precision("200")
    engine, until = TaylorEngine(pendulum, None, precision), precision.number("2")
    require_means(pendulum, precision, engine._integrator.order, until)
    engine.advance(until)
    assert told == [pytest.approx(engine.steps, rel=0.2)]


REQUESTS = {
    "a motion": lambda problem, numbers: simulate(problem, SimulationRequest(precision=numbers.digits)),
    "a motion by larger steps": lambda problem, numbers: follow(
        problem, SimulationRequest(tol=1e-300, precision=numbers.digits, until=Fraction(100)), print
    ),
    "a series": lambda problem, numbers: expand(problem, 5000, numbers),
    "a series continued": lambda problem, numbers: continue_motion(problem, Fraction(2), numbers),
}


@pytest.mark.parametrize("asked", REQUESTS)
def test_a_thousand_digits_ran_until_the_time_was_over(asked, pendulum, monkeypatch):
    monkeypatch.setattr(expense, "time_left", lambda: 0.1)
    with pytest.raises(HolonomError, match="to order .* in 1000 digits at .* s each take much") as refused:
        REQUESTS[asked](pendulum, read_precision(str(DIGITS)))
    assert refused.value.failure is Failure.TIME_TOO_SHORT


def test_more_digits_than_the_memory_holds_are_refused(pendulum, monkeypatch):
    monkeypatch.setattr(psutil, "virtual_memory", lambda: SimpleNamespace(available=2**20))
    with pytest.raises(HolonomError, match="about .* MiB of memory, and 1 are free") as refused:
        expand(pendulum, 5000, read_precision(str(DIGITS)))
    assert refused.value.failure is Failure.MEMORY_TOO_SMALL


def test_where_nothing_limits_the_time_none_is_too_long(pendulum):
    require_means(pendulum, read_precision(str(DIGITS)), 5000)


def test_what_is_quickly_done_is_not_tried_before(pendulum, monkeypatch):
    monkeypatch.setattr(expense, "import_heyoka", None)
    require_means(pendulum, read_precision("100"), order_for(110), 10**9)
