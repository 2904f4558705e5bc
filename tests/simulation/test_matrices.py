"""Matrices of the equations of motion: at one state, at many, and for many motions."""

from fractions import Fraction

import numpy as np
import pytest
from problems import problem

from holonom.simulation.initial_state import at_values
from holonom.simulation.matrices import BatchMatrices, MotionMatrices

CRANE = problem("crane.mac", open_parameters=("m",))
MASSES = np.array([[50.0, 100.0, 200.0]])
STATES = np.random.default_rng(3).uniform(1, 2, (len(CRANE.state), 3))


def test_matrices_of_many_motions_are_those_of_each():
    together = BatchMatrices(CRANE)(0.5, STATES, MASSES)
    for k, mass in enumerate(MASSES[0]):
        alone = MotionMatrices(at_values(CRANE, {"m": Fraction(mass)}))(0.5, STATES[:, k])
        for one, many in zip(alone, together, strict=True):
            assert many[..., k] == pytest.approx(one, rel=1e-14, abs=1e-14)


def test_a_state_without_numbers_is_marked_and_no_other():
    states = STATES.copy()
    states[-1, 1] = np.inf
    assert BatchMatrices(CRANE)(0.5, states, MASSES).finite.tolist() == [True, False, True]
