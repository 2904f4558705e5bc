"""The metric of the constraints' directions, where A is singular: by the symmetry of Euler parameters."""

import numpy as np
import pytest
import scipy

from holonom.simulation.constraints.directions import weighted_constraints


@pytest.mark.parametrize("small", [0.1, 1e-2, 1e-4, 1e-8, 0.0])
@pytest.mark.parametrize("place", range(4))
def test_the_mass_of_a_body_in_euler_parameters_is_singular_whichever_of_them_is_small(place, small):
    """A = 4 L^T I L knows no inertia along e. Rounding was taken for one where the last parameter is small."""
    e = np.insert(np.sqrt((1 - small**2) / np.array([2.0, 3.0, 6.0])), place, small)
    L = np.array([[-e[1], e[0], e[3], -e[2]], [-e[2], -e[3], e[0], e[1]], [-e[3], e[2], -e[1], e[0]]])
    weighted = weighted_constraints(4 * L.T @ np.diag([1.0, 2.0, 3.0]) @ L, np.array([2 * e, L[0] + e]))
    assert weighted.stiffening is not None
    values = weighted.singular_values()
    assert values[0] < 10 * values[-1]


def test_units_of_the_coordinates_make_no_mass_singular():
    """Masses of 1 and 10^-30 on a diagonal, and coupled as strongly as those of a pendulum of two links."""
    units = np.array([1.0, 1e-15])
    for coupling in (0.0, 0.9):
        mass = np.array([[1.0, coupling], [coupling, 1.0]]) * np.outer(units, units)
        weighted = weighted_constraints(mass, np.ones((1, 2)))
        assert weighted.stiffening is None
        np.testing.assert_allclose(weighted.factor @ weighted.factor.T, mass, rtol=1e-14)


@pytest.mark.parametrize("length", [1.0, 1e-3, 1e-9])
def test_a_body_on_a_joint_has_the_same_directions_in_any_unit_of_length(length):
    e = np.array([0.4, 0.5, 0.6, np.sqrt(1 - 0.77)])
    L = np.array([[-e[1], e[0], e[3], -e[2]], [-e[2], -e[3], e[0], e[1]], [-e[3], e[2], -e[1], e[0]]])
    mass = scipy.linalg.block_diag(np.eye(3), 4 * L.T @ np.diag([0.1, 0.2, 0.3]) @ L)
    joint = np.hstack([np.eye(3), np.array([L[0] + e, L[1], L[2]])])
    jacobian = np.vstack([joint, np.concatenate([np.zeros(3), 2 * e])])
    units = np.concatenate([np.ones(3), np.full(4, length)])  # of x/length, for masses of one
    values = weighted_constraints(mass * np.outer(units, units), jacobian * units).singular_values()
    np.testing.assert_allclose(values, weighted_constraints(mass, jacobian).singular_values(), rtol=1e-9)


def test_several_states_with_a_singular_mass_matrix_have_each_its_own_metric():
    masses = np.array([np.diag([1.0, 0.0]), np.diag([5.0, 0.0])])
    jacobians = np.array([[[0.0, 1.0]], [[1.0, 1.0]]])
    together = weighted_constraints(masses, jacobians).singular_values()
    alone = [weighted_constraints(*each).singular_values() for each in zip(masses, jacobians, strict=True)]
    np.testing.assert_allclose(together, alone, rtol=1e-14)


@pytest.mark.parametrize("mass", [1.0, 1e-27])
def test_massless_coordinates_apart_from_others_have_the_largest_mass(mass):
    found = weighted_constraints(np.diag([mass, 0.0]), np.diag([0.0, 2.0]))
    np.testing.assert_allclose(found.stiffening, mass * np.diag([0.0, 1.0]), rtol=1e-14)
