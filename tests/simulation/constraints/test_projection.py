"""Projection: closed forms of nearest states, dependent constraints, contradictions, Newton's convergence."""

import numpy as np
import pytest
from problems import problem

from holonom.failures import ErrorKind
from holonom.program.motion_problem import motion_problem
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.simulation.constraints.projection import InconsistentConstraints, settle
from holonom.simulation.constraints.singularity import VANISHED, Watch
from holonom.simulation.matrices import Matrices, MotionMatrices
from holonom.simulation.nominal import Nominal

CIRCLE = """
load("holonom.mac")$
circle : holonomic_system(
  coordinates = [x, y], parameters = [m],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2,
  constraints = {constraints})$
round : holonomic_scene(circle, parameter_values = [m = 3], nominal = [y = 1],
  initial_state = [x = {x}, y = {y}, dot(x) = 0, dot(y) = 0])$
"""


@pytest.fixture
def circle(write_scene):
    def matrices(constraints: str, x: str = "2", y: str = "0") -> MotionMatrices:
        file = write_scene(CIRCLE.format(constraints=constraints, x=x, y=y))
        return MotionMatrices(motion_problem(file, Request(), Limits()))

    return matrices


class Counted:
    """Matrices that count how often they are asked for."""

    def __init__(self, matrices: MotionMatrices) -> None:
        self.matrices, self.nominal, self.calls = matrices, matrices.nominal, 0

    def __call__(self, t: float, state: np.ndarray):
        self.calls += 1
        return self.matrices(t, state)


def test_on_a_circle_the_nearest_state_is_radial_and_tangential(circle):
    matrices = circle("[(x^2 + y^2 - 4)/2]")
    state = np.array([1.5, 1.7, 0.4, -0.9])
    projected = settle(matrices, 0.0, state, 1)[0]
    radial = state[:2] / np.linalg.norm(state[:2])
    assert np.allclose(projected[:2], 2 * radial, rtol=1e-15)
    assert np.allclose(projected[2:], state[2:] - (state[2:] @ radial) * radial, rtol=1e-14)


def test_a_dependent_constraint_changes_nothing(circle):
    once, twice = circle("[(x^2 + y^2 - 4)/2]"), circle("[(x^2 + y^2 - 4)/2, 5*x^2 + 5*y^2 - 20]")
    state = np.array([1.5, 1.7, 0.4, -0.9])
    assert np.allclose(settle(once, 0.0, state, 1)[0], settle(twice, 0.0, state, 1)[0], rtol=1e-14)


def test_the_size_of_a_free_coordinate_hid_what_is_left_of_a_constraint(circle):
    """Beside x = 10^9 corrections of 1e-6 were rounding errors, and sin(y) = 3/2 was satisfied."""
    state = np.array([1e9, 0.6, 0.0, 0.0])
    found = settle(circle("[sin(y) - 3/5]", "10^9", "asin(3/5)"), 0.0, state, 1)[0]
    assert found[1] == pytest.approx(np.arcsin(0.6), rel=1e-15)
    with pytest.raises(InconsistentConstraints):
        settle(circle("[sin(y) - 3/5 - t^2]", "10^9", "asin(3/5)"), 1.0, state, 1)


def test_newtons_method_squares_the_distance(circle):
    matrices = Counted(circle("[(x^2 + y^2 - 4)/2]"))
    settle(matrices, 0.0, np.array([2.02, 0.01, 0.0, 1.0]), 1)
    assert matrices.calls <= 5  # 2e-2, 1e-4, 2e-9, rounding, and the look that finds it so


def test_in_the_mass_metric_the_heavy_coordinate_stays():
    bob = problem("hard/heavy_bob.mac")
    matrices = MotionMatrices(bob)
    state = np.array([float(bob.start[name]) for name in bob.state])
    state[: len(state) // 2] += 1e-4
    at = matrices(0.0, state)
    moved = settle(matrices, 0.0, state)[0][: len(at.force)] - state[: len(at.force)]
    # A d = J^T mu: to first order, the change is a combination of the constraints' gradients
    weights = np.linalg.lstsq(at.jacobian.T, at.mass @ moved, rcond=None)[0]
    left = at.mass @ moved - at.jacobian.T @ weights
    assert np.all(np.abs(left) <= 1e-3 * np.max(np.abs(at.mass @ moved)))
    assert np.max(np.abs(matrices(0.0, state).residual)) > 1e-5


@pytest.mark.parametrize("distance", [1e-8, 1e-4, 1e-2])
def test_a_closed_spatial_mechanism_is_put_together_again(distance):
    sarrus = problem("hard/sarrus_linkage.mac")
    matrices = MotionMatrices(sarrus)
    state = np.array([float(sarrus.start[name]) for name in sarrus.state])
    disturbed = state + distance * np.sin(np.arange(1, len(state) + 1))
    projected = settle(matrices, 0.0, disturbed, len(sarrus.multipliers) - 1)[0]
    at = matrices(0.0, projected)
    assert np.max(np.abs(at.residual)) <= 1e-14
    assert np.max(np.abs(at.residual_rate)) <= 1e-14
    assert np.linalg.norm(projected - state) <= 20 * distance


def test_contradicting_constraints_are_refused_with_what_remains():
    def matrices(t: float, state: np.ndarray) -> Matrices:
        """Of x - y and x - y - t^2, which no scene may have."""
        jacobian = np.array([[1.0, -1.0], [1.0, -1.0]])
        missed, missed_rate = np.array([0.0, t**2]), np.array([0.0, 2 * t])
        residuals = jacobian @ state[:2] - missed, jacobian @ state[2:] - missed_rate
        return Matrices(3 * np.eye(2), np.zeros(2), jacobian, np.array([0.0, -2.0]), *residuals, True)

    matrices.nominal = Nominal(1.0, np.ones(4))
    with pytest.raises(InconsistentConstraints) as refused:
        settle(matrices, 1.0, np.zeros(4), 1)
    assert refused.value.kind is ErrorKind.INCONSISTENT
    # x - y = 1/2 misses both by 1/2; over the length sqrt(2/m) of a gradient in the mass metric
    assert refused.value.residual == pytest.approx(0.5 / np.sqrt(2 / 3), rel=1e-12)
    assert refused.value.detail.split(";")[0] == "1"


@pytest.mark.parametrize(
    ("constraints", "name"),
    [("[x^2 + y^2 - 4, 7*(x - y - 2)]", "lambda1"), ("[x - y - 2, 9*(x^2 + y^2 - 4)]", "lambda2")],
)
def test_a_gradient_has_vanished_where_a_share_of_its_first_size_is_left(write_scene, constraints, name):
    """Truth: that of x^2 + y^2 is in proportion to the radius, 2 at first; that of x - y is constant."""
    found = motion_problem(write_scene(CIRCLE.format(constraints=constraints, x="2", y="0")), Request(), Limits())
    watch = Watch(found, MotionMatrices(found))
    for share, expected in ((1.0, None), (1.01 * VANISHED, None), (0.99 * VANISHED, name)):
        assert watch.vanished(0.0, np.array([1.2 * share, 1.6 * share, 0.0, 0.0])) == expected
