"""The least correction of many elements at once: against NumPy's least squares and Lagrange's conditions."""

import numpy as np
import pytest

from holonom.simulation.initial_state import least_step

RANDOM = np.random.default_rng(1)
ELEMENTS = 4


def metric(unknowns: int) -> np.ndarray:
    roots = RANDOM.normal(size=(ELEMENTS, unknowns, unknowns))
    return np.moveaxis(roots @ roots.swapaxes(1, 2) + np.eye(unknowns), 0, 2)


@pytest.mark.parametrize("redundant", [False, True])
def test_it_meets_the_constraints_and_no_shorter_one_does(redundant):
    """Along each direction within the constraints the correction has no component, in the metric."""
    mass, jacobian, residual = metric(4), RANDOM.normal(size=(2, 4, ELEMENTS)), RANDOM.normal(size=(2, ELEMENTS))
    if redundant:
        jacobian = np.concatenate([jacobian, jacobian[:1] + jacobian[1:]])
        residual = np.concatenate([residual, residual[:1] + residual[1:]])
    found = least_step(mass, jacobian, residual, redundant)
    assert found.shape == (4, ELEMENTS)
    for k in range(ELEMENTS):
        assert jacobian[:, :, k] @ found[:, k] == pytest.approx(-residual[:, k])
        within = np.linalg.svd(jacobian[:, :, k])[2][2:]
        assert within @ mass[:, :, k] @ found[:, k] == pytest.approx(np.zeros(2), abs=1e-12)


def test_without_a_metric_it_is_the_only_one():
    jacobian, residual = RANDOM.normal(size=(3, 3, ELEMENTS)), RANDOM.normal(size=(3, ELEMENTS))
    found = least_step(None, jacobian, residual, False)
    for k in range(ELEMENTS):
        assert found[:, k] == pytest.approx(-np.linalg.inv(jacobian[:, :, k]) @ residual[:, k])


def test_more_constraints_than_unknowns_are_met_if_they_agree():
    jacobian, wanted = RANDOM.normal(size=(3, 2, ELEMENTS)), RANDOM.normal(size=(2, ELEMENTS))
    found = least_step(None, jacobian, np.einsum("buk,uk->bk", jacobian, -wanted), False)
    assert found == pytest.approx(wanted)


@pytest.mark.parametrize("redundant", [False, True])
def test_units_of_unknowns_and_constraints_change_nothing(redundant):
    """A mass of 1e-27 beside a gradient of 1e-10 counted as rounding, so that the step was another."""
    mass, jacobian, residual = metric(3), RANDOM.normal(size=(2, 3, ELEMENTS)), RANDOM.normal(size=(2, ELEMENTS))
    if redundant:
        jacobian, residual = np.concatenate([jacobian, jacobian[:1]]), np.concatenate([residual, residual[:1]])
    units, areas = np.array([1e-10, 1.0, 1e9])[:, None], np.array([1e-20, 1.0, 1e3])[: len(residual), None]
    masses = 1e-27 * mass / units[:, None] / units
    found = least_step(masses, areas[:, None] * jacobian / units, areas * residual, redundant)
    assert found / units == pytest.approx(least_step(mass, jacobian, residual, redundant), rel=1e-12)


@pytest.mark.parametrize("constraints", [2, 3])
def test_one_singular_element_leaves_the_others(constraints):
    jacobian, residual = RANDOM.normal(size=(constraints, 2, ELEMENTS)), RANDOM.normal(size=(constraints, ELEMENTS))
    jacobian[:, 1, 1] = 2 * jacobian[:, 0, 1]
    alone = least_step(None, jacobian, residual, False)
    assert np.isnan(alone).any(axis=0).tolist() == [False, True, False, False]
    others = [0, 2, 3]
    assert alone[:, others] == pytest.approx(least_step(None, jacobian[:, :, others], residual[:, others], False))


def test_an_element_that_is_not_finite_has_none():
    jacobian, residual = RANDOM.normal(size=(3, 2, ELEMENTS)), RANDOM.normal(size=(3, ELEMENTS))
    jacobian[0, 0, 0], residual[2, 3] = np.inf, np.nan
    assert np.isnan(least_step(None, jacobian, residual, False)).all(axis=0).tolist() == [True, False, False, True]
