"""The equations of motion solved with pivots, against pseudo-inverses, fifty digits, and what no solve may change."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp

from holonom.failures import ErrorKind, HolonomError
from holonom.simulation.constraints.directions import rank_of, weighted_constraints
from holonom.simulation.constraints.factorization import factored_constraints

RANDOM = settings(max_examples=60, derandomize=True)
SEEDS = st.integers(0, 2**32 - 1)


def random_system(seed: int, redundant: int):
    """A, h, J and c of a consistent system, some of the rows of J combinations of the others."""
    draw = np.random.default_rng(seed)
    n = draw.integers(2, 8)
    rank = draw.integers(1, n + 1)
    root = draw.normal(size=(n, n)) + 2 * np.eye(n)
    jacobian = draw.normal(size=(rank, n))
    jacobian = np.vstack([jacobian, draw.normal(size=(redundant, rank)) @ jacobian])
    return root @ root.T, draw.normal(size=n), jacobian, -jacobian @ draw.normal(size=n)


def factored_of(mass, jacobian):
    return factored_constraints(mass, jacobian, rank_of(weighted_constraints(mass, jacobian).singular_values()))


def solve(mass, force, jacobian, curvature):
    return factored_of(mass, jacobian).unknowns(force, curvature)


@RANDOM
@given(SEEDS, st.integers(0, 3))
def test_accelerations_keep_the_constraints_and_multipliers_are_the_least(seed, redundant):
    mass, force, jacobian, curvature = random_system(seed, redundant)
    accelerations, multipliers = solve(mass, force, jacobian, curvature)
    scale = np.linalg.cond(mass) * np.linalg.cond(jacobian @ jacobian.T + np.eye(len(jacobian)))
    assert np.allclose(jacobian @ accelerations, -curvature, rtol=0, atol=1e-13 * scale)
    reactions = mass @ accelerations - force
    assert np.allclose(jacobian.T @ multipliers, reactions, rtol=0, atol=1e-13 * scale * np.linalg.norm(reactions))
    least = np.linalg.pinv(jacobian.T, rcond=1e-10) @ reactions
    assert np.allclose(multipliers, least, rtol=0, atol=1e-12 * scale * (1 + np.linalg.norm(least)))


@pytest.mark.parametrize("redundant", [0, 2])
def test_a_correction_is_the_least_in_the_mass_metric(redundant):
    """Of all d with J d = -r, d = -A^-1 J^T (J A^-1 J^T)^+ r has the least d . A d."""
    mass, _, jacobian, residual = random_system(7, redundant)
    along = np.linalg.solve(mass, jacobian.T)
    least = -along @ np.linalg.pinv(jacobian @ along, rcond=1e-10) @ residual
    np.testing.assert_allclose(factored_of(mass, jacobian).correction(residual), least, rtol=1e-9)


@RANDOM
@given(SEEDS)
def test_a_repeated_constraint_changes_neither_motion_nor_constraint_forces(seed):
    mass, force, jacobian, curvature = random_system(seed, 0)
    once = solve(mass, force, jacobian, curvature)
    factors = np.array([[1.0], [-3.0], [1e-5]])
    repeated = np.vstack([jacobian, factors * jacobian[0]])
    twice = solve(mass, force, repeated, np.append(curvature, factors[:, 0] * curvature[0]))
    scale = 1e-12 * np.linalg.cond(mass) * np.linalg.cond(jacobian) ** 2
    assert np.allclose(once[0], twice[0], rtol=scale, atol=scale)
    assert np.allclose(jacobian.T @ once[1], repeated.T @ twice[1], rtol=scale, atol=scale)


def exact_accelerations(mass, force, jacobian, curvature):
    """Of the bordered system with the given doubles, to fifty digits."""
    n, g = len(mass), len(jacobian)
    with mp.workdps(50):
        bordered = mp.matrix(n + g)
        bordered[:n, :n], bordered[n:, :n] = mp.matrix(mass.tolist()), mp.matrix(jacobian.tolist())
        bordered[:n, n:] = -mp.matrix(jacobian.T.tolist())
        found = mp.lu_solve(bordered, mp.matrix([*force, *-curvature]))
        return np.array([float(x) for x in found[:n]])


@pytest.mark.parametrize("exponent", range(1, 8))
def test_nearly_parallel_constraints_keep_the_accelerations(exponent):
    angle = 10.0**-exponent
    mass = np.array([[2.0, 0.3, 0.1], [0.3, 1.0, 0.2], [0.1, 0.2, 3.0]])
    jacobian = np.array([[1.0, 0.4, 0.2], [np.cos(angle), 0.4 + np.sin(angle), 0.2]])
    force, curvature = np.array([1.0, -2.0, 0.5]), np.array([0.3, 0.3 + angle])
    expected = exact_accelerations(mass, force, jacobian, curvature)
    assert np.max(np.abs(solve(mass, force, jacobian, curvature)[0] - expected)) <= 1e-8 * np.max(np.abs(expected))


@pytest.mark.parametrize("factor", [1e-200, 1e-30, 1e30, 1e200])
def test_the_scale_of_a_constraint_does_no_harm(factor):
    mass, force, jacobian, curvature = random_system(7, 0)
    scales = np.ones(len(jacobian))
    scales[0] = factor
    plain = solve(mass, force, jacobian, curvature)
    scaled = solve(mass, force, scales[:, None] * jacobian, scales * curvature)
    assert np.allclose(plain[0], scaled[0], rtol=1e-12)
    assert np.allclose(plain[1], scales * scaled[1], rtol=1e-12)


def test_masses_of_all_sizes_keep_their_digits():
    mass, force = np.diag([1e12, 1.0, 1e-12]), np.array([1e12, 1.0, 1e-12])
    jacobian, curvature = np.array([[1.0, 1.0, 1.0], [0.0, 1.0, -1.0]]), np.array([0.5, -0.25])
    expected = exact_accelerations(mass, force, jacobian, curvature)
    assert np.allclose(solve(mass, force, jacobian, curvature)[0], expected, rtol=1e-12)


def test_a_coordinate_without_mass_moves_as_its_constraint_says():
    mass, force = np.diag([2.0, 0.0]), np.array([1.0, 4.0])
    jacobian, curvature = np.array([[1.0, -1.0], [2.0, -2.0]]), np.array([0.5, 1.0])
    accelerations, multipliers = solve(mass, force, jacobian, curvature)
    # 2 x'' = 1 + r, 0 = 4 - r, x'' - y'' = -1/2 with the reaction r = lambda1 + 2 lambda2
    assert np.allclose(accelerations, [2.5, 3.0])
    assert np.allclose(multipliers, [4 / 5, 8 / 5])


def test_a_free_coordinate_without_mass_is_refused():
    with pytest.raises(HolonomError) as refused:
        weighted_constraints(np.diag([1.0, 0.0]), np.array([[1.0, 0.0]]))
    assert refused.value.kind is ErrorKind.MASS_SINGULAR


def test_a_negative_mass_was_called_singular():
    """On x = 2 y it leaves 3/2 dot(y)^2 of kinetic energy; on x = y nothing, and alone it is no metric."""
    mass, force = np.diag([1.0, -1.0]), np.array([-2.0, 1.0])
    accelerations, _ = solve(mass, force, np.array([[1.0, -2.0]]), np.zeros(1))
    assert accelerations == pytest.approx([-2.0, -1.0], abs=1e-14)  # 3 ddot(y) = 2 h_x + h_y
    for jacobian in (np.array([[1.0, -1.0]]), np.zeros((0, 2))):
        with pytest.raises(HolonomError) as refused:
            weighted_constraints(mass, jacobian)
        assert refused.value.kind is ErrorKind.MASS_INDEFINITE


def test_without_constraints_the_forces_alone_decide():
    mass, force = np.array([[2.0, 1.0], [1.0, 3.0]]), np.array([1.0, -1.0])
    accelerations, multipliers = solve(mass, force, np.empty((0, 2)), np.empty(0))
    assert np.allclose(mass @ accelerations, force)
    assert multipliers.shape == (0,)


@pytest.mark.parametrize("redundant", [0, 2])
def test_several_states_at_once_are_each_solved_by_itself(redundant):
    systems = [random_system(seed, redundant) for seed in range(300)]
    alike = [each for each in systems if each[2].shape == (3 + redundant, 5)]
    mass, force, jacobian, curvature = (np.array(parts) for parts in zip(*alike, strict=True))
    assert len(mass) > 3
    factored = factored_constraints(mass, jacobian, 3)
    found = zip(*factored.unknowns(force, curvature), strict=True)
    for system, (accelerations, multipliers) in zip(alike, found, strict=True):
        expected = solve(*system)
        assert np.allclose(accelerations, expected[0], rtol=1e-9, atol=1e-9)
        assert np.allclose(multipliers, expected[1], rtol=1e-9, atol=1e-9)


def test_the_factors_of_a_row_of_loops_grow_like_the_row():
    """A matrix without zeros would have four times as many entries for twice as many loops."""

    def entries(loops: int) -> int:
        n = 2 * loops + 2
        mass = np.eye(n) + np.diag(np.full(n - 2, 1 / 6), 2) + np.diag(np.full(n - 2, 1 / 6), -2)
        x, y = np.eye(n)[::2], np.eye(n)[1::2]
        standing, lying = x + 2 * y, np.diff(x, axis=0) + np.diff(y, axis=0) / 3
        return factored_constraints(mass, np.concatenate([standing, lying]), 2 * loops + 1)._factors.nnz

    assert entries(80) < 2.2 * entries(40)


def test_constraints_that_are_singular_against_what_is_stated_have_no_accelerations():
    factored = factored_constraints(np.eye(2), np.array([[1.0, 0.0], [2.0, 0.0]]), 2)
    assert not np.isfinite(factored.accelerations(np.ones(2), np.zeros(2))).any()


def test_a_mass_that_makes_the_equations_singular_is_refused_when_they_are_factored():
    with pytest.raises(HolonomError) as refused:
        factored_constraints(np.diag([1.0, 0.0]), np.array([[1.0, 0.0]]), 1)
    assert refused.value.kind is ErrorKind.MASS_SINGULAR
