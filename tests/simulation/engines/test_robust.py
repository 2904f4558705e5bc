"""The robust engine: through singular configurations, under redundant constraints, where numbers are large or stiff."""

import numpy as np
import pytest
from problems import problem
from refusing import failing
from scipy.optimize import minimize_scalar
from truths import GRAVITY, four_bar, linkage_period, linkage_tip, sarrus_angles

import holonom
from holonom.failures import ErrorKind, HolonomError
from holonom.program.motion_problem import MotionProblem, motion_problem
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.simulation.constraints.singularity import least_of, singular_values_at
from holonom.simulation.engines import robust
from holonom.simulation.engines.collocation import NODES, TAIL, Collocation
from holonom.simulation.engines.engine import Solutions, Task, advance
from holonom.simulation.engines.robust import RobustEngine
from holonom.simulation.residuals import condition

PLACE = 1e-6  # share of a collocation step to which the place of the singular configuration is found
FOUR_BAR_AT_10 = [0.47838505776097055901, 0.87815017879120930116]  # by its elliptic functions, to twenty digits


def singular_times(motion):
    """Times of singular configurations: of the least relevant singular value along collocation steps."""

    def place(collocation):
        def least(t):
            state = collocation(np.array([t]))[:, 0]
            return least_of(singular_values_at(motion.matrices, t, state), motion.rank)

        start, end = collocation.start, collocation.end
        return minimize_scalar(least, bounds=(start, end), options={"xatol": PLACE * (end - start)}).x

    return [time for time in map(place, motion._collocations) if time <= motion.time]


def test_a_four_bar_linkage_goes_through_its_dead_centres():
    motion = RobustEngine(Task.of(problem("linkage.mac"), tol=1e-12))
    advance(motion, 10.0)
    assert np.allclose(motion.state[:2], FOUR_BAR_AT_10, rtol=0, atol=1e-9)
    assert len(singular_times(motion)) == 10
    assert all(abs(linkage_tip(1, time)[1]) < 1e-5 for time in singular_times(motion))  # rods in line


@pytest.mark.parametrize(
    ("bars", "revolutions"), [(4, 5), *(pytest.param(*each, marks=pytest.mark.long) for each in ((1, 25), (12, 1)))]
)
def test_it_stays_on_its_branch_for_many_revolutions(bars, revolutions):
    motion = RobustEngine(Task.of(problem("linkage.mac", N=str(bars))))
    advance(motion, revolutions * linkage_period(bars) + 0.1)
    assert np.allclose(motion.state[:2], linkage_tip(bars, motion.time), rtol=0, atol=1e-6)
    assert len(singular_times(motion)) == 2 * revolutions
    assert np.max(np.abs(motion.matrices(motion.time, motion.state).residual)) < 1e-12


def test_states_between_the_steps_and_within_a_collocation_step_are_on_the_motion():
    motion = RobustEngine(Task.of(problem("linkage.mac"), tol=1e-12))
    for piece in motion.integrate(1.5):
        times = np.linspace(piece.start, piece.end, 5)
        tips = np.array([linkage_tip(1, t) for t in times])
        assert np.allclose(piece.states(times)[:2].T, tips, rtol=0, atol=1e-8)


def solution(motion, time, state):
    """The unknowns of the equations of motion at one state."""
    return Solutions(*(each[:, 0] for each in motion.solutions(np.array([time]), state[:, None])))


def test_constraint_forces_stay_right_through_a_dead_centre():
    motion = RobustEngine(Task.of(problem("linkage.mac"), tol=1e-12))
    advance(motion, 1.5)
    for away in [-3e-2, -1e-3, -1e-5, 1e-8, 1e-6, 1e-4, 1e-2, 0.4]:
        time = singular_times(motion)[0] + away
        state, accelerations = four_bar(time)
        at, found = motion.matrices(time, state), solution(motion, time, state)
        assert found.accelerations == pytest.approx(accelerations, abs=1e-9)
        assert found.constraint_forces == pytest.approx(at.mass @ accelerations - at.force, abs=1e-9)


@pytest.mark.parametrize("away", [-1e-2, -1e-4, -1e-6, -1e-8, 0.0, 1e-8, 1e-6, 1e-4, 1e-2])
def test_it_may_start_at_a_dead_centre_and_beside_one(away):
    motion, start = RobustEngine(Task.of(problem("linkage.mac"), tol=1e-12)), 0.70845002 + away
    motion.restart(start, four_bar(start)[0])
    advance(motion, 1.0)
    assert motion.state == pytest.approx(four_bar(1.0)[0], abs=1e-9)


def test_a_motion_may_stop_and_go_on_anywhere():
    motion = RobustEngine(Task.of(problem("linkage.mac"), tol=1e-12))
    for time in np.linspace(0.0, 1.5, 61)[1:]:
        advance(motion, time)
        assert motion.time == time
        assert np.allclose(motion.state[:2], linkage_tip(1, time), rtol=0, atol=1e-9)


IN_LINE = """
load("holonom.mac")$
bars : holonomic_system(
  coordinates = [x0, y0, x1, y1],
  kinetic_energy = (2*(dot(x0)^2 + dot(y0)^2 + dot(x1)^2 + dot(y1)^2) + dot(x0)*dot(x1) + dot(y0)*dot(y1))/6,
  potential_energy = 981/100*(y0 + y1),
  constraints = [(x0^2 + y0^2 - 1)/2, ((x1 - 1)^2 + y1^2 - 1)/2, ((x1 - x0)^2 + (y1 - y0)^2 - 1)/2])$
started : holonomic_scene(bars, initial_state = [x0 = 1, y0 = 0, x1 = 2, y1 = 0,
  dot(x0) = 0, dot(y0) = {left}, dot(x1) = 0, dot(y1) = {right}])$
"""


@pytest.fixture
def in_line(write_scene):
    """A four-bar linkage that starts with all rods in line."""

    def asked(left: str, right: str) -> MotionProblem:
        return motion_problem(write_scene(IN_LINE.format(left=left, right=right)), Request(), Limits())

    return asked


def test_from_a_singular_configuration_the_velocities_choose_the_parallelogram(in_line):
    motion = RobustEngine(Task.of(in_line("-3", "-3"), tol=1e-12))
    advance(motion, 0.4)
    x0, y0, x1, y1 = motion.state[:4]
    assert (x1, y1) == pytest.approx((1 + x0, y0), abs=1e-12)
    # both rods turn alike: 5/6 v^2 + 2 g y is constant
    assert 5 / 6 * (motion.state[4:6] @ motion.state[4:6]) + 2 * GRAVITY * y0 == pytest.approx(7.5, rel=1e-11)


def test_from_a_singular_configuration_the_velocities_choose_the_folded_branch(in_line):
    motion = RobustEngine(Task.of(in_line("0", "-3"), tol=1e-12))
    advance(motion, 0.4)
    # the left rod lies still, its tip on the right rod's hinge; the other two turn together: v^2/3 + g y is constant
    assert motion.state[[0, 1, 4, 5]] == pytest.approx([1, 0, 0, 0], abs=1e-10)
    assert motion.state[6:] @ motion.state[6:] / 3 + GRAVITY * motion.state[3] == pytest.approx(3, rel=1e-11)


def test_a_velocity_along_no_branch_is_refused(in_line):
    with pytest.raises(HolonomError):
        advance(RobustEngine(Task.of(in_line("3", "-3"), tol=1e-12)), 0.4)


def test_at_rest_in_a_singular_configuration_nothing_tells_the_branch(in_line):
    with failing(ErrorKind.NO_WAY_ON):
        advance(RobustEngine(Task.of(in_line("0", "0"), tol=1e-10)), 1.0)


def test_the_first_collocation_step_was_as_long_as_a_division_by_no_speed_makes_it(in_line, monkeypatch):
    motion = RobustEngine(Task.of(in_line("-3", "-3"), tol=1e-10))
    monkeypatch.setattr(robust, "probed", lambda *asked: (2, 0.0))  # whose velocities point nowhere
    with np.errstate(divide="raise"), failing(ErrorKind.NO_WAY_ON):
        motion.restart(0.0, np.array([1.0, 0, 2, 0, 0, 0, 0, 0]))


def test_a_redundant_spatial_mechanism_moves_through_its_singular_configurations():
    sarrus = problem("hard/sarrus_linkage.mac")
    motion, times = RobustEngine(Task.of(sarrus, tol=1e-12)), np.linspace(0.25, 4.0, 16)
    assert motion.rank == len(sarrus.multipliers) - 1
    height = sarrus.coordinates.index("p3z")
    for time, angle in zip(times, sarrus_angles(times), strict=True):
        advance(motion, time)
        assert motion.state[height] == pytest.approx(2 * np.sin(angle), abs=1e-9)
    flat_or_in_line = np.diff(np.sign(np.sin(2 * sarrus_angles(np.linspace(1e-3, 4.0, 4000)))))
    assert len(singular_times(motion)) == np.count_nonzero(flat_or_in_line)


def test_under_redundant_constraints_forces_are_unique_and_multipliers_those_of_the_program():
    motion = RobustEngine(Task.of(problem("hard/sarrus_linkage.mac"), tol=1e-11))
    advance(motion, 0.3)
    found, at = solution(motion, motion.time, motion.state), motion.matrices(motion.time, motion.state)
    forces = at.mass @ found.accelerations - at.force
    assert np.allclose(found.constraint_forces, forces, rtol=0, atol=1e-12 * np.max(np.abs(forces)))
    assert np.allclose(at.jacobian.T @ found.multipliers, forces, rtol=0, atol=1e-10 * np.max(np.abs(forces)))
    assert np.flatnonzero(found.multipliers == 0).tolist() == [13]


def test_the_papers_free_motion_stays_right_until_the_control_overflows():
    motion = RobustEngine(Task.of(problem("paper/paper.mac", "free_motion_scene"), tol=1e-11))
    for time in (10.0, 100.0, 400.0, 709.0):
        advance(motion, time)
        # q1 + q2 = (a + b t) exp(-t), q3 = u0 (a + b t), and no reaction
        assert motion.state[2] == pytest.approx(0.3 * (3 + (3 + 1 / 6) * time), rel=1e-9)
        found = solution(motion, time, motion.state)
        assert abs(found.multipliers[0]) <= 1e-13
        assert np.max(np.abs(found.constraint_forces)) <= 1e-13
    with pytest.raises(HolonomError) as refused:
        advance(motion, 720.0)
    assert refused.value.kind is ErrorKind.NO_WAY_ON
    assert 709 < motion.time < 710


STIFF = """
load("holonom.mac")$
pair : holonomic_system(
  coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  forces = [damping = [-10^5*dot(x), -10^5*dot(y)], spring = [-10^5*x, -10^5*y]],
  constraints = [x - y, 2*x - 2*y])$
released : holonomic_scene(pair, initial_state = [x = 1, y = 1, dot(x) = 0, dot(y) = 0])$
"""


def test_a_stiff_motion_is_found_out_and_followed(write_scene):
    motion = RobustEngine(Task.of(motion_problem(write_scene(STIFF), Request(), Limits()), tol=1e-8))
    advance(motion, 2.0)
    assert motion.stiff
    assert motion.steps < 1000  # DOP853 alone takes some thirty thousand
    slow, fast = np.roots([1, 1e5, 1e5])[::-1]
    x = (fast * np.exp(2 * slow) - slow * np.exp(2 * fast)) / (fast - slow)
    assert motion.state[0] == pytest.approx(x, abs=1e-9)


NEAR_MISS = """
load("holonom.mac")$
bars : holonomic_system(
  coordinates = [x0, y0, x1, y1],
  kinetic_energy = (2*(dot(x0)^2 + dot(y0)^2 + dot(x1)^2 + dot(y1)^2) + dot(x0)*dot(x1) + dot(y0)*dot(y1))/6,
  potential_energy = 981/100*(y0 + y1),
  constraints = [(x0^2 + y0^2 - 1)/2, ((x1 - 1)^2 + (y1 + 1/1000)^2 - (1001/1000)^2)/2,
                 ((x1 - x0)^2 + (y1 - y0)^2 - 1)/2])$
upright : holonomic_scene(bars, initial_state = [x0 = 0, y0 = 1, x1 = 1, y1 = 1,
  dot(x0) = 1, dot(y0) = 0, dot(x1) = 1, dot(y1) = 0])$
"""


@pytest.mark.long
def test_a_near_miss_is_no_singularity(write_scene):
    asked = motion_problem(write_scene(NEAR_MISS), Request(), Limits())
    motion, conditions = RobustEngine(Task.of(asked, tol=1e-11)), []
    for piece in motion.integrate(3.0):
        v0, v1 = motion.state[4:6], motion.state[6:]
        energy = (2 * (v0 @ v0 + v1 @ v1) + v0 @ v1) / 6 + GRAVITY * (motion.state[1] + motion.state[3])
        assert energy == pytest.approx(5 / 6 + 2 * GRAVITY, abs=1e-8), piece.end
        conditions.append(condition(motion.matrices(motion.time, motion.state)))
    assert max(conditions) > 1e3
    assert singular_times(motion) == []


@pytest.mark.long
def test_a_length_that_vanishes_stops_the_motion():
    motion = RobustEngine(Task.of(problem("hard/vanishing_length.mac")))
    with failing(ErrorKind.NO_WAY_ON):
        advance(motion, 2.0)
    assert motion.time == pytest.approx(1.0, abs=1e-5)


@pytest.mark.parametrize(("max_step", "until"), [(0.1, "0.8"), (0.05, "0.4"), (0.07, "2.66")])
def test_robust_engine_ends_with_a_step_that_rounding_leaves(max_step, until):
    """After eight steps of 0.1 the end is a rounding error away. At a coarse tolerance no step is shorter."""
    scene = holonom.load("examples/hard/repeated_constraint.mac")
    motion = scene.simulate(until=until, samples=2, engine="robust", max_step=max_step, tol=1e-5)
    assert motion.report.t == float(until)
    assert motion.report.steps == round(float(until) / max_step) + 1
    assert motion.report.trusted


def test_the_last_coefficients_alone_are_the_error_of_a_collocation():
    """Truth: what is left of a sum of Legendre polynomials is at most the sum of the sizes of their coefficients."""
    for k, coefficients in enumerate(np.eye(NODES + 2)):
        found = Collocation(0.0, 1.0, 2 * coefficients[:, None], np.zeros((NODES + 1, 1)))
        assert found.error(np.array([0.5])) == (4 if k >= NODES + 2 - TAIL else 0)


def test_accelerations_without_constraints_were_never_computed():
    scene = holonom.system("""system : holonomic_system(
      coordinates = [x, y], kinetic_energy = (3*dot(x)^2 + 2*dot(y)^2)/2,
      potential_energy = 3*y)$
      fall : holonomic_scene(system, initial_state = [x = 0, dot(x) = 1, y = 0, dot(y) = 0], time_span = [0, 2],
        observe = [trajectory, a = [ddot(x), ddot(y)]])$""")
    motion = scene.simulate(samples=5, engine="robust")
    assert motion["a[1]"] == pytest.approx(np.zeros(5))
    assert motion["a[2]"] == pytest.approx(np.full(5, -1.5))
