"""P = -lambda (df/dt + du/dt df/du): the energy balance of motions confirms it, and so does the power along the way."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from holonom.companion.cards import scene_named
from holonom.companion.power import energy_balance, values_along
from holonom.companion.runs import Derived
from holonom.crosscheck.independent import reaction_power
from holonom.crosscheck.system import described_system
from holonom.program.motion_problem import motion_problem
from holonom.program.request import Request
from holonom.record import derived_record
from holonom.sandbox import Limits
from holonom.simulation.request import SimulationRequest
from holonom.simulation.simulate import simulate

EXAMPLES = Path(__file__).parents[2] / "examples"


def simulated(file, name, until):
    record = derived_record(file, {}, Limits())
    scene = scene_named(Derived(record, None), name)
    problem = replace(motion_problem(file, Request(name), Limits()), observe=("trajectory", "multipliers"))
    return record.system, scene, simulate(problem, SimulationRequest(until=Fraction(until), samples=2001, tol=1e-13))


@pytest.mark.parametrize(
    ("file", "scene"),
    [("paper/paper.mac", "initial_motion_scene"), ("whirling_bob.mac", "drawn_in_scene")],
    ids=["tilted plane", "whirling bob"],
)
def test_the_work_at_the_knob_is_what_the_energy_balance_lacks(file, scene):
    found = energy_balance(*simulated(EXAMPLES / file, scene, 3))
    assert abs(found.by_controls[-1]) > 0.1
    assert found.error < 1e-9


def test_where_the_motion_is_free_turning_the_knob_costs_nothing():
    found = energy_balance(*simulated(EXAMPLES / "paper" / "paper.mac", "free_motion_scene", 3))
    assert max(abs(found.power)) < 1e-12


def test_drawing_in_the_whirling_bob_takes_the_tension_times_the_speed():
    """The string pulls with m u w^2, and comes in by -du/dt."""
    system, scene, motion = simulated(EXAMPLES / "whirling_bob.mac", "drawn_in_scene", 3)
    power = values_along(reaction_power(described_system(system, scene.effects)), scene, motion)
    length, rate = motion.coordinates["r"], motion.velocities["dot(phi)"]
    assert power == pytest.approx(length * rate**2 / 10)
