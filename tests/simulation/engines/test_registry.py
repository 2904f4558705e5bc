"""An engine is added by its file and a line in the registry."""

from fractions import Fraction
from io import StringIO

import numpy as np
import pytest
from problems import problem
from refusing import failing
from rich.console import Console

from holonom.cli.motion import simulate as command
from holonom.display.motion import show_simulation
from holonom.failures import ErrorKind
from holonom.program.motion_problem import motion_problem
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.simulation.engines import registry
from holonom.simulation.hybrid_motion import EventOutcome
from holonom.simulation.output import simulation_document
from holonom.simulation.request import EngineName, SimulationRequest
from holonom.simulation.simulate import simulate

SLIDING = """load("holonom.mac")$
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [-2*signum(dot(x))])$
slide : holonomic_scene(system, initial_state = [x = 0, dot(x) = 1], time_span = [0, 9/10])$
"""


def simulated(**asked):
    wanted = SimulationRequest(until=Fraction(20), samples=21, tol=1e-8, **asked)
    return simulate(problem("pendulum.mac", "swing_scene"), wanted)


def shown(motion):
    file = StringIO()
    show_simulation(Console(file=file, width=1000), motion)
    return file.getvalue()


@pytest.fixture
def toy(monkeypatch):
    monkeypatch.setitem(registry.ENGINES, "toy", "toy_engine:ToyEngine")


def test_names_and_choices_are_those_of_the_registry():
    (option,) = (each for each in command.params if each.name == "engine")
    assert list(option.type.choices) == list(EngineName) == ["auto", *registry.ENGINES]


def test_added_engine_is_chosen_relieved_recorded_and_reported(toy):
    """Truth: the Taylor engine."""
    motion, truth = simulated(), simulated(engine=EngineName.TAYLOR)
    report, document = motion.report, simulation_document(motion)
    assert report.choice.engine == document["choice"]["engine"] == "toy"
    assert document["choice"]["seconds"]["toy"] == 0.0 < report.choice.seconds["taylor"]
    assert "0 s by toy" in shown(motion)
    assert [segment.engine for segment in report.segments] == ["toy", "robust", "toy"]
    assert [segment.start for segment in report.segments] == pytest.approx([0, 1, 1.5], abs=0.1)
    assert document["segments"][1]["reason"] == "stopped"
    assert document["engine"] == "toy, robust {:.6g}..{:.6g}, toy".format(
        *(segment.start for segment in report.segments[1:])
    )
    for name, samples in truth.coordinates.items():
        assert np.allclose(motion.coordinates[name], samples, atol=1e-4)


def test_added_engine_is_switched(toy, write_scene):
    """Truth: a mass of one under a friction of two comes to rest at x = 1/4, and sticks."""
    motion = simulate(motion_problem(write_scene(SLIDING), Request(), Limits()), SimulationRequest(engine="toy")).report
    assert [each.outcome for each in motion.switchings] == [EventOutcome.SLIDING]
    assert (float(motion.switchings[0].t), motion.coordinates["x"]) == pytest.approx((1 / 2, 1 / 4), abs=1e-9)


def test_added_engine_that_is_asked_for_follows_alone(toy):
    with failing(ErrorKind.NO_WAY_ON):
        simulated(engine="toy")
