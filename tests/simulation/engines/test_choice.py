"""Which engine ``auto`` takes, and that either is relieved where the configuration is singular."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from problems import problem

from holonom.simulation.engines import fallback, runge_kutta
from holonom.simulation.engines.choice import Choice, quicker_engine
from holonom.simulation.engines.code import Code, _compilation
from holonom.simulation.engines.runge_kutta import FINEST, RungeKuttaEngine
from holonom.simulation.request import EngineName, SimulationRequest
from holonom.simulation.simulate import simulate

LONG, SHORT = Fraction(100_000), Fraction(10)


def report(until, **request):
    wanted = SimulationRequest(until=until, samples=0, **request)
    return simulate(problem("pendulum.mac", "swing_scene"), wanted).report


@pytest.mark.usefixtures("c_compiler")
def test_a_long_motion_at_a_coarse_tolerance_goes_to_runge_kutta_and_a_short_one_does_not():
    long, short = report(LONG, tol=1e-6), report(SHORT, tol=1e-6)
    assert [segment.engine for segment in long.segments] == [EngineName.RUNGE_KUTTA] == [long.choice.engine]
    assert long.choice.seconds[EngineName.RUNGE_KUTTA] < long.choice.seconds[EngineName.TAYLOR]
    assert [segment.engine for segment in short.segments] == [EngineName.TAYLOR]


@pytest.mark.usefixtures("c_compiler")
def test_the_steps_tried_to_choose_leave_no_trace():
    """Truth: the motion that the Taylor engine follows where it alone is asked, to the last bit."""
    weighed, asked = report(Fraction(40), tol=1e-9), report(Fraction(40), tol=1e-9, engine=EngineName.TAYLOR)
    assert weighed.choice.engine is EngineName.TAYLOR
    assert weighed.coordinates == asked.coordinates
    assert weighed.steps == asked.steps
    assert asked.choice is None


@pytest.mark.usefixtures("c_compiler")
def test_the_number_of_steps_ahead_is_that_of_the_motion():
    """Truth: the steps that the motion then takes, within a tenth: the pendulum's first steps are like the others."""
    done = report(Fraction(300), tol=1e-9)
    assert done.choice.steps == pytest.approx(done.steps, rel=0.1)


@pytest.mark.parametrize(("tol", "precision"), [(None, "double"), (1e-16, "double"), (1e-9, "quadruple")])
def test_what_runge_kutta_cannot_hold_is_not_weighed(tol, precision):
    assert report(Fraction(1), tol=tol, precision=precision).choice is None


@pytest.mark.usefixtures("c_compiler")
@pytest.mark.parametrize(
    ("tol", "reached"), [(FINEST, True), (np.nextafter(FINEST, 0), False), (np.nextafter(1, 0), True), (1.0, False)]
)
def test_runge_kutta_holds_tolerances_from_its_finest_to_one(tol, reached):
    assert RungeKuttaEngine.comparable(float(tol)) is reached


def test_without_a_compiler_there_is_no_choice(monkeypatch):
    monkeypatch.setattr(runge_kutta, "has_compiler", lambda: False)
    assert not RungeKuttaEngine.comparable(1e-6)


@pytest.mark.usefixtures("c_compiler")
def test_a_compiler_that_fails_leaves_the_motion_to_taylor(monkeypatch, tmp_path):
    """Truth: the motion that the Taylor engine follows where it alone is asked, to the last bit."""
    compiler = tmp_path / "cc"
    compiler.write_text("#!/bin/sh\necho no space for objects >&2\nexit 1\n")
    compiler.chmod(0o755)
    monkeypatch.setenv("CC", str(compiler))
    done, asked = report(LONG, tol=1e-6), report(LONG, tol=1e-6, engine=EngineName.TAYLOR)
    assert done.choice.engine is EngineName.TAYLOR
    assert "no space for objects" in done.choice.refused
    assert done.coordinates == asked.coordinates


@pytest.mark.usefixtures("c_compiler")
def test_states_wanted_between_the_steps_count():
    """Truth: dense output takes three stages beside the twelve of a step, and the other engine next to nothing."""
    alone, dense = (quicker_engine(50_000, 210, 1e-6, wanted).seconds for wanted in (False, True))
    begun = RungeKuttaEngine.expected_seconds(0, 210, 1e-6, False)
    engine = EngineName.RUNGE_KUTTA
    assert dense[engine] - begun == pytest.approx((alone[engine] - begun) * 15 / 12)
    assert dense[EngineName.TAYLOR] == alone[EngineName.TAYLOR]


@pytest.mark.usefixtures("c_compiler")
def test_runge_kutta_is_relieved_at_dead_centres_like_taylor(monkeypatch):
    """Truth: the linkage as the Taylor engine follows it through the same dead centres."""

    def of(engine):
        def chosen(steps, operations, tol, dense):
            return Choice(engine, steps, operations, {})

        monkeypatch.setattr(fallback, "quicker_engine", chosen)
        wanted = SimulationRequest(tol=1e-11, samples=0)
        return simulate(replace(problem("linkage.mac")), wanted).report

    ours, theirs = of(EngineName.RUNGE_KUTTA), of(EngineName.TAYLOR)
    engines = [segment.engine for segment in ours.segments]
    assert EngineName.ROBUST in engines
    assert set(engines) == {EngineName.RUNGE_KUTTA, EngineName.ROBUST}
    for name, value in theirs.coordinates.items():
        assert ours.coordinates[name] == pytest.approx(value, abs=1e-7)


def test_compact_code_is_compiled_in_a_time_that_grows_as_the_program_and_better_code_as_its_square():
    def growth(code):
        times = [_compilation(code, operations) for operations in (0, 1000, 2000)]
        return (times[2] - times[0]) / (times[1] - times[0])

    assert (growth(Code.COMPACT), growth(Code.UNROLLED)) == (pytest.approx(2), pytest.approx(4))
