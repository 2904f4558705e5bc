"""A simulation says the advice on a hard case that somebody's scene turns out to be, and none on a plain one."""

import pytest

from holonom.explanations import ADVICE, advice, notes
from holonom.program.motion_problem import motion_problem
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.simulation.hard_cases import Difficulty, MotionState, _stiffness
from holonom.simulation.matrices import MotionMatrices, start_of
from holonom.simulation.request import FINAL_STATE_ALONE, SimulationRequest
from holonom.simulation.simulate import simulate

SCENE = """
load("holonom.mac")$
system : holonomic_system(coordinates = {coordinates}, controls = {controls}, kinetic_energy = {kinetic_energy},
  potential_energy = {potential_energy}, constraints = {constraints})$
motion : holonomic_scene(system, control_law = {law}, initial_state = {state}, time_span = {span})$
"""
PENDULUM = {
    "coordinates": "[x, y]",
    "controls": "[]",
    "kinetic_energy": "(dot(x)^2 + dot(y)^2)/2",
    "potential_energy": "10*y",
    "constraints": "[x^2 + y^2 - 1]",
    "law": "[]",
    "state": "[x = 3/5, y = -4/5, dot(x) = 0]",
    "span": "[0, 1]",
}
TETHERED = "[x^2 + y^2 + z^2 - 1, (x - 1/10^6)^2 + y^2 + z^2 - 1 - 1/10^12]"
SOMEBODYS = {
    Difficulty.NEARLY_DEPENDENT: {
        "coordinates": "[x, y, z]",
        "kinetic_energy": "(dot(x)^2 + dot(y)^2 + dot(z)^2)/2",
        "constraints": TETHERED,
        "state": "[x = 0, y = 3/5, z = -4/5, dot(x) = 0, dot(y) = 0, dot(z) = 0]",
    },
    Difficulty.REDUNDANT: {"constraints": "[x^2 + y^2 - 1, 2*x^2 + 2*y^2 - 2]"},
    Difficulty.STIFF: {
        "potential_energy": "x^2/2 + 10^6*y^2/2",
        "constraints": "[]",
        "state": "[x = 1, y = 1, dot(x) = 0, dot(y) = 0]",
    },
    Difficulty.MASS_RATIO: {"kinetic_energy": "(dot(x)^2/10^10 + dot(y)^2)/2"},
    Difficulty.FREE_CANCELLATION: {
        "controls": "[u]",
        "constraints": "[y - u]",
        "law": "[u = 1 - 5*t^2]",
        "state": "[x = 0, dot(x) = 1]",
    },
    Difficulty.OVERFLOW: {
        "controls": "[u]",
        "constraints": "[y - u*x]",
        "potential_energy": "x^2/2",
        "law": "[u = exp(t)]",
        "state": "[x = 1, dot(x) = 0]",
        "span": "[0, 350]",
    },
    Difficulty.LONG_RUN: {"span": "[0, 4000]"},
}


def notes_on(file) -> set[str]:
    asked = SimulationRequest(samples=FINAL_STATE_ALONE)
    report = simulate(motion_problem(file, Request(), Limits()), asked).report
    return set(notes(report))


@pytest.mark.parametrize("kind", SOMEBODYS)
def test_somebodys_hard_case_is_met_with_the_advice_on_it(write_scene, kind):
    assert advice(kind) in notes_on(write_scene(SCENE.format(**PENDULUM | SOMEBODYS[kind])))


def test_a_plain_pendulum_needs_no_advice(write_scene):
    assert not set(ADVICE.values()) & notes_on(write_scene(SCENE.format(**PENDULUM)))


@pytest.mark.parametrize("ratio", [10, 10**4])
def test_stiffness_is_the_ratio_of_two_springs(write_scene, ratio):
    springs = SOMEBODYS[Difficulty.STIFF] | {"potential_energy": f"x^2/2 + {ratio}*y^2/2"}
    problem = motion_problem(write_scene(SCENE.format(**PENDULUM | springs)), Request(), Limits())
    assert _stiffness(MotionState(MotionMatrices(problem), *start_of(problem))) == pytest.approx(ratio, rel=1e-6)
