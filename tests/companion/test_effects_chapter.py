"""Foucault's pendulum in the chapter on effects: the plane of its swings goes back against the turning frame."""

from pathlib import Path

import numpy as np
import pytest

from holonom.program.motion_problem import motion_problem
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.simulation.request import SimulationRequest
from holonom.simulation.result import Simulation
from holonom.simulation.simulate import simulate

TURNING, STILL = "foucault_scene", "still_scene"
FILE = Path(__file__).parents[2] / "examples" / "spherical_pendulum.mac"
OMEGA, LENGTH, REACH = 1 / 20, 1, 3 / 5


def turning_point(motion: Simulation) -> tuple[float, float]:
    """The last turning time on the side where the bob began, and its angle from the start."""
    x, y = motion.coordinates["x"], motion.coordinates["y"]
    away = np.hypot(x, y)
    turns = np.flatnonzero((away[1:-1] >= away[:-2]) & (away[1:-1] > away[2:]) & (x[1:-1] * x[0] > 0)) + 1
    return float(motion.times[turns[-1]]), float(np.arctan2(y[turns[-1]], x[turns[-1]]) - np.arctan2(y[0], x[0]))


def turned(scene: str) -> tuple[float, float]:
    problem = motion_problem(FILE, Request(scene), Limits())
    return turning_point(simulate(problem, SimulationRequest(samples=1801)))


def test_the_plane_goes_back_with_the_precession_of_its_narrow_ellipse():
    """In space the bob starts with the speed Omega a and goes round an ellipse of half axes a and b = Omega a/w, which
    turns at the rate 3/8 a b w/l^2 in the sense in which it is gone round (Olsson, Am. J. Phys. 46 (1978) 1118).
    """
    time, angle = turned(TURNING)
    precession = 3 / 8 * OMEGA * REACH**2 / LENGTH**2 * time
    assert angle == pytest.approx(-OMEGA * time + precession, abs=0.01)


def test_without_the_turning_frame_it_stays():
    assert turned(STILL)[1] == pytest.approx(0, abs=1e-12)
