"""Stiffness against frequencies in closed form, at a cost of one factorization."""

import pytest

from holonom.program.motion_problem import motion_problem
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.simulation import hard_cases
from holonom.simulation.matrices import MotionMatrices, start_of

# Two pendulums that hang at rest, each on a rod: small swings have the frequencies sqrt(g/l).
PENDULUMS = """
load("holonom.mac")$
long  : particle(1, [x1, y1])$
short : particle(3, [x2, y2])$
system : holonomic_system(assembly(long, short, distance_joint(long, [0, 0], 1), distance_joint(short, [5, 0], 1/100),
  gravity = uniform_gravity(10, long, short)))$
hanging : holonomic_scene(system, initial_state = [x1 = 0, y1 = -1, x2 = 5, y2 = -1/100,
  dot(x1) = 0, dot(y1) = 0, dot(x2) = 0, dot(y2) = 0], time_span = [0, 1])$
"""


def test_stiffness_is_the_ratio_of_two_pendulums_lengths(write_scene, monkeypatch):
    """The equations of motion were factored anew for each way to move, a thousand times for a tree of 60 bodies."""
    factored = []
    monkeypatch.setattr(
        hard_cases,
        "DependentConstraints",
        lambda *of, known=hard_cases.DependentConstraints: factored.append(1) or known(*of),
    )
    problem = motion_problem(write_scene(PENDULUMS), Request(), Limits())
    at = hard_cases.MotionState(MotionMatrices(problem), *start_of(problem))
    assert hard_cases._stiffness(at) == pytest.approx(100, rel=1e-6)
    assert len(factored) == 1
