"""The numerical motion, against closed forms, published solutions and conservation laws."""

import math
import warnings
from fractions import Fraction

import mpmath
import numpy as np
import pytest
import scipy.special
from problems import problem
from refusing import failing

import holonom
from holonom.explanations import engine_text, notes
from holonom.failures import ErrorKind, HolonomError, HolonomWarning
from holonom.program.motion_problem import MotionProblem, motion_problem
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.simulation.engines.program_engine import NO_SLOPE
from holonom.simulation.hard_cases import Difficulty, MotionState, _fastest_decay
from holonom.simulation.matrices import MotionMatrices
from holonom.simulation.request import EngineName, SimulationRequest, Stabilization
from holonom.simulation.result import Report, Simulation
from holonom.simulation.simulate import _EnergyStatistics, simulate

# Test Set for IVP Solvers, car axis, t = 3, as its file R/ex_reference.R prints it: positions, velocities, multipliers.
CAR_AXIS_POSITIONS = [
    0.493455784275402809122e-1,
    0.496989460230171153861,
    0.104174252488542151681e1,
    0.373911027265361256927,
]
CAR_AXIS_VELOCITIES = [
    -0.770583684040972357970e-1,
    0.744686658723778553466e-2,
    0.175568157537232222276e-1,
    0.770341043779251976443,
]
CAR_AXIS_MULTIPLIERS = [-0.473688659084893324729e-2, -0.110468033125734368808e-2]

# Test Set for IVP Solvers, Andrews' squeezing mechanism, t = 0.03. The true solution agrees to 9, 7 and 5 digits; there
# the multipliers have the opposite sign, M a + G^T lambda = f.
ANDREWS_POSITIONS = [
    0.1581077119629904e2,
    -0.1575637105984298e2,
    0.4082224013073101e-1,
    -0.5347301163226948,
    0.5244099658805304,
    0.5347301163226948,
    0.1048080741042263e1,
]
ANDREWS_VELOCITIES = [
    0.1139920302151208e4,
    -0.1424379294994111e4,
    0.1103291221937134e2,
    0.1929337464421385e2,
    0.5735699284790808,
    -0.1929337464421385e2,
    0.3231791658026955,
]
ANDREWS_MULTIPLIERS = [
    0.1991753333731910e3,
    -0.2975531228015052e2,
    0.2306654119098399e2,
    0.3145271365475927e2,
    0.2264249232082739e2,
    0.1161740700019673e2,
]


def final(motion: MotionProblem, **request) -> Report:
    return simulate(motion, SimulationRequest(samples=0, **request)).report


def simulated(motion: MotionProblem, **request) -> Simulation:
    return simulate(motion, SimulationRequest(**request))


def numbers(values) -> list[float]:
    return [float(value) for value in values.values()]


def free_motion_of_the_paper(t):
    """s = q1 + q2 obeys s'' + 2 s' + s = 0, and q1'' = -s; q3 = u s."""
    a, b, decay = 3, 19 / 6, np.exp(-t)
    s = (a + b * t) * decay
    q1 = 1 + (1 / 2 - a - b) * t + (a + b) * (1 - decay) + b * (1 - (1 + t) * decay)
    return q1, s - q1, 0.3 * np.exp(t) * s


def test_the_papers_free_motion_is_its_closed_form():
    simulation = simulated(problem("paper/paper.mac", "free_motion_scene"), samples=21)
    expected = free_motion_of_the_paper(simulation.times)
    for samples, truth in zip(simulation.coordinates.values(), expected, strict=True):
        assert samples == pytest.approx(truth, rel=1e-12, abs=1e-12)
    assert np.abs(simulation.multipliers["lambda1"]).max() < 1e-13


def test_a_pendulum_swings_as_jacobis_elliptic_functions_say():
    """Truth: released at rest at the angle a, sin(theta/2) = sin(a/2) cd(sqrt(g) t)."""
    simulation = simulated(problem("pendulum.mac", "swing_scene"), samples=11)
    k = mpmath.sin(mpmath.pi / 26)
    for t, x, y in zip(simulation.times, *simulation.coordinates.values(), strict=True):
        half = mpmath.asin(k * mpmath.ellipfun("cd", mpmath.sqrt(9.81) * t, k=k))
        assert [x, y] == pytest.approx([float(mpmath.sin(2 * half)), -float(mpmath.cos(2 * half))], abs=1e-12)


def test_a_thrown_body_without_constraints_flies_a_parabola(write_scene):
    scene = write_scene("""
load("holonom.mac")$
body : holonomic_system(coordinates = [x, z], kinetic_energy = (dot(x)^2 + dot(z)^2)/2, potential_energy = 10*z,
  constraints = [])$
flight : holonomic_scene(body, initial_state = [x = 0, z = 0, dot(x) = 1, dot(z) = 5], time_span = [0, 1])$
""")
    report = final(motion_problem(scene, Request(), Limits()))
    assert numbers(report.coordinates) == pytest.approx([1, 0], abs=1e-14)
    assert numbers(report.velocities) == pytest.approx([1, -5], abs=1e-14)


def test_the_car_axis_arrives_where_it_is_published_to():
    report = final(problem("car_axis.mac"), tol=1e-14)
    assert numbers(report.coordinates) == pytest.approx(CAR_AXIS_POSITIONS, abs=1e-10)
    assert numbers(report.velocities) == pytest.approx(CAR_AXIS_VELOCITIES, abs=1e-10)
    assert numbers(report.multipliers) == pytest.approx(CAR_AXIS_MULTIPLIERS, abs=1e-12)


def test_andrews_squeezer_arrives_where_it_is_published_to():
    report = final(problem("andrews.mac"))
    assert numbers(report.coordinates) == pytest.approx(ANDREWS_POSITIONS, rel=1e-9)
    assert numbers(report.velocities) == pytest.approx(ANDREWS_VELOCITIES, rel=1e-7)
    assert numbers(report.multipliers) == pytest.approx([-x for x in ANDREWS_MULTIPLIERS], rel=3e-6)


def test_a_linkage_keeps_its_branch_through_its_dead_centres():
    """Truth: the rods' angle is an elliptic function of the time; the tip is (2 sn cn, 2 sn^2 - 1), mirrored."""
    report = final(problem("linkage.mac"))
    k = 9.81 * 2 / (2 / 3 + 1)
    a, m = mpmath.sqrt(1 + 4 * k), 4 * k / (1 + 4 * k)
    sn, cn = (mpmath.ellipfun(name, a * 5 - mpmath.ellipk(m), m=m) for name in ("sn", "cn"))
    assert [report.coordinates["x0"], report.coordinates["y0"]] == pytest.approx(
        [float(-2 * sn * cn), float(2 * sn**2 - 1)], abs=1e-10
    )
    assert abs(report.energy_error) < 1e-10


def test_a_hand_over_is_reported_in_one_line_each():
    report = final(problem("linkage.mac"), until=Fraction(1))
    taylor, robust, last = report.segments
    assert (taylor.engine, robust.engine, last.engine) == (EngineName.TAYLOR, EngineName.ROBUST, EngineName.TAYLOR)
    assert 0.6 < robust.start < 0.70845 < robust.end
    assert robust.case is Difficulty.SINGULAR_CONFIGURATION
    text = engine_text(report.segments)
    assert text.startswith("taylor, robust 0.6")
    assert text.endswith(", taylor")
    said = [line for line in notes(report) if "the robust engine takes over" in line]
    assert len(said) == 1
    assert "because the configuration nears a singular one" in said[0]


def test_the_taylor_engine_alone_stops_before_a_singular_configuration():
    """Truth: the rods lie in line for the first time where their angle is a right one, at t = 0.70845."""
    with failing(ErrorKind.NO_WAY_ON) as refusal:
        final(problem("linkage.mac"), engine=EngineName.TAYLOR)
    assert refusal.value.case is Difficulty.SINGULAR_CONFIGURATION


CROSS = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2, constraints = [x*y])$
s : holonomic_scene(system, time_span = [0, 1], initial_state = [x = -1, y = 0, dot(x) = 1])$"""


def test_a_run_that_ended_in_a_singular_configuration_was_an_internal_error(write_scene):
    """Truth: x = t - 1, which the last step takes to the crossing of both lines."""
    cross = motion_problem(write_scene(CROSS), Request(), Limits())
    report = final(cross)
    assert report.coordinates["x"] == pytest.approx(0, abs=1e-12)
    assert Difficulty.SINGULAR_CONFIGURATION in report.cases
    with failing(ErrorKind.NO_WAY_ON) as stopped:
        final(cross, engine=EngineName.TAYLOR)
    assert stopped.value.case is Difficulty.SINGULAR_CONFIGURATION


REDUNDANT = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y, a], parameters = [g],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2 + dot(a)^2/4, potential_energy = g*y, constraints = [%s])$
s : holonomic_scene(system, parameter_values = [g = 981/100], time_span = [0, 1],
  initial_state = [a = 1/2], initial_guess = [x = 9/10, y = 1/2])$"""
CIRCLE, ANGLE = "x^2 + y^2 - 1", "x - cos(a), y - sin(a)"


def test_constraints_that_are_solved_depend_on_each_other_in_a_regular_configuration(write_scene):
    """Truth: the angle's own constraints are independent everywhere, and the circle follows from them."""
    ends = [
        final(motion_problem(write_scene(REDUNDANT % f"{one}, {other}"), Request(), Limits()))
        for one, other in [(CIRCLE, ANGLE), (ANGLE, CIRCLE)]
    ]
    assert numbers(ends[0].coordinates) == pytest.approx(numbers(ends[1].coordinates), abs=1e-10)
    assert [segment.case for segment in ends[0].segments] == [None, Difficulty.REDUNDANT, None]
    assert [len(end.segments) for end in ends] == [3, 1]
    assert all(Difficulty.SINGULAR_CONFIGURATION not in end.cases for end in ends)


RHOMBUS = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y, z, w],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2 + dot(z)^2 + dot(w)^2, potential_energy = 9*y + 10*w,
  constraints = [x^2 + y^2 - 1, (z - 1)^2 + w^2 - 1, (z - x)^2 + (w - y)^2 - 1, 2*x^2 + 2*y^2 - 2])$
s : holonomic_scene(system, initial_state = [x = 0, y = 1, z = 1, w = 1, dot(x) = 1, dot(y) = 0, dot(z) = 1,
  dot(w) = 0], time_span = [0, 1])$"""


def test_a_singular_configuration_of_redundant_constraints_is_one(write_scene):
    """Truth: the rhombus lies in line where w = y = 0."""
    report = final(motion_problem(write_scene(RHOMBUS), Request(), Limits()))
    assert report.segments[1].case is Difficulty.SINGULAR_CONFIGURATION
    assert report.coordinates["z"] == pytest.approx(report.coordinates["x"] + 1, abs=1e-8)


LOST_LOGARITHM = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  forces = [(log(u) - log(t))*y, 0], constraints = [x])$
s : holonomic_scene(system, control_law = [u = t], time_span = [-2, -1], initial_state = [y = 1, dot(y) = 0])$"""


def test_a_multiplier_without_a_finite_value_is_no_result(write_scene):
    """The accelerations need no logarithm of t; lambda1 was NaN, with exit status 0."""
    report = final(motion_problem(write_scene(LOST_LOGARITHM), Request(), Limits()))
    assert "multipliers" in {violation.quantity for violation in report.violations}


PULSE = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  potential_energy = x^2/2, constraints = [y - u])$
s : holonomic_scene(system, control_law = [u = exp(-t^2)], time_span = [-10, 10],
  initial_state = [x = 1, dot(x) = 0])$"""


def test_a_motion_was_called_free_for_a_multiplier_that_is_zero_at_its_end(write_scene):
    """Truth: the multiplier is 2 (2 t^2 - 1) exp(-t^2), which is -2 at t = 0 and 1e-41 at the ends."""
    pulse = motion_problem(write_scene(PULSE), Request(), Limits())
    assert Difficulty.FREE_CANCELLATION not in simulate(pulse, SimulationRequest(samples=101)).report.cases
    report = final(pulse)  # which keeps the ends alone
    assert not any("motion is free:" in line for line in notes(report))


DAMPED = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], parameters = [c], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  forces = [-2*c*(x + dot(x)), 0], constraints = [y - x])$
s : holonomic_scene(system, parameter_values = [c = 10], time_span = [0, 6], initial_state = [x = 1, dot(x) = 0])$"""


@pytest.mark.parametrize(("c", "stiff"), [(10, False), (20000, True)])
def test_a_decay_that_holds_back_all_steps_was_a_long_run_alone(c, stiff, write_scene):
    """Truth: x'' = -c (x + x'), whose deviations decay with two rates; steps of order 20 reach 8.2 times the faster."""
    motion = motion_problem(write_scene(DAMPED), Request(settings={"c": str(c)}), Limits())
    report = final(motion)
    slow, fast = c / 2 - np.sqrt(c * c / 4 - c), c / 2 + np.sqrt(c * c / 4 - c)
    truth = (fast * np.exp(-6 * slow) - slow * np.exp(-6 * fast)) / (fast - slow)
    assert report.coordinates["x"] == pytest.approx(truth, rel=1e-8)
    assert (Difficulty.STIFF in report.cases) is stiff
    state = np.array([*report.coordinates.values(), *report.velocities.values()])
    assert _fastest_decay(MotionState(MotionMatrices(motion), 6.0, state)) == pytest.approx(fast, rel=1e-6)


WALL = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  potential_energy = exp(1000*(x - 1)), constraints = [y - x])$
s : holonomic_scene(system, time_span = [0, 1000], initial_state = [x = 0, dot(x) = 1])$"""


@pytest.mark.filterwarnings("error")
def test_forces_beyond_all_numbers_were_warnings_of_numpy_and_a_free_motion(write_scene):
    """Truth: dot(x)^2 = 1 - s with s = exp(1000*(x - 1)), so 1/sqrt(s) = cosh(500*(t - T)), and exp(500) at t = 0."""
    report = final(motion_problem(write_scene(WALL), Request(), Limits()))
    assert (report.trusted, Difficulty.FREE_CANCELLATION in report.cases) == (True, False)
    turned = 1 + np.log(2) / 500
    assert report.coordinates["x"] == pytest.approx(1 - (1000 - turned - np.log(2) / 500), abs=1e-7)


def test_redundant_constraints_are_reported_and_followed():
    """Truth: a constraint given twice changes nothing but its own multiplier, by every engine."""
    engines = (EngineName.TAYLOR, EngineName.ROBUST)
    reports = [final(problem("hard/repeated_constraint.mac"), engine=each) for each in engines]
    for report, engine in zip(reports, engines, strict=True):
        assert [segment.engine for segment in report.segments] == [engine]
        assert any("The constraints are redundant" in line for line in notes(report))
        assert report.multipliers["lambda2"] == 0
        assert report.condition < 2
    assert reports[0].multipliers["lambda1"] == pytest.approx(reports[1].multipliers["lambda1"], rel=1e-7)


def test_a_precision_that_the_robust_engine_lacks_is_not_feigned():
    with failing(ErrorKind.NO_WAY_ON) as stopped:
        final(problem("linkage.mac", digits=36), precision="quadruple")
    assert stopped.value.case is Difficulty.SINGULAR_CONFIGURATION


@pytest.mark.parametrize("scene", [("chain.mac", "swing_scene"), ("andrews.mac", None), ("pendulum.mac", None)])
@pytest.mark.parametrize("engine", [EngineName.RUNGE_KUTTA, EngineName.ROBUST])
@pytest.mark.usefixtures("c_compiler")
def test_all_engines_find_the_same_motion(scene, engine):
    ours, theirs = (final(problem(*scene), engine=each) for each in (EngineName.TAYLOR, engine))
    assert [segment.engine for segment in (*ours.segments, *theirs.segments)] == [EngineName.TAYLOR, engine]
    assert numbers(theirs.coordinates) == pytest.approx(numbers(ours.coordinates), rel=1e-7, abs=1e-7)
    assert numbers(theirs.multipliers) == pytest.approx(numbers(ours.multipliers), rel=1e-5, abs=1e-5)


@pytest.mark.parametrize(
    "file", ["paper/paper.mac", "chain.mac", "andrews.mac", "car_axis.mac", "spherical_pendulum.mac"]
)
def test_residuals_and_energy_balance_are_rounding(file):
    report = final(problem(file))
    assert max(report.residuals.values()) < 1e-12
    assert abs(report.energy_error) < 1e-11


def test_energy_is_balanced_by_the_work_of_the_control():
    """Truth: the energy of a pendulum that is paid out changes, by the work of the string alone."""
    motion = problem("pendulum.mac", "lengthening_scene")
    observing = MotionProblem(**{**vars(motion), "observe": ("energy", "residuals")})
    simulation = simulated(observing, samples=50, until=Fraction(20))
    energy, error = simulation.energy["energy"], simulation.energy["energy_error"]
    assert np.ptp(energy) > 1
    assert np.abs(error).max() < 1e-11
    assert set(simulation.residuals) == {"position", "velocity", "acceleration"}
    assert max(samples.max() for samples in simulation.residuals.values()) < 1e-12
    assert simulation.coordinates == simulation.multipliers == {}


def test_projection_keeps_the_constraints_that_nothing_else_keeps():
    """Over ten thousand swings rounding adds up, unless the state is projected."""
    motion = problem("pendulum.mac", "swing_scene")
    left = {
        stabilization: final(motion, stabilization=stabilization, until=Fraction(20000)).residuals["position"]
        for stabilization in Stabilization
    }
    assert left[Stabilization.PROJECTION] < 1e-15
    assert left[Stabilization.NONE] > 1e-13


def test_stabilizations_in_the_equations_let_an_error_die_out():
    """Truth: a position that misses its constraint by 1e-6 is back after many decay times, with both stabilizations."""
    motion = problem("pendulum.mac", "swing_scene")
    astray = MotionProblem(**{**vars(motion), "start": {**motion.start, "y": str(float(motion.start["y"]) - 1e-6)}})
    left = {
        stabilization: final(astray, stabilization=stabilization).residuals["position"]
        for stabilization in Stabilization
    }
    assert left[Stabilization.NONE] > 1e-7
    assert left[Stabilization.BAUMGARTE] < 1e-13
    assert left[Stabilization.GGL] < 1e-13


def test_a_start_that_is_found_has_as_many_digits_as_the_motion(write_scene):
    """Uniform motion on a circle from y = -sqrt(3)/2, which was known to 60 digits of 80."""
    scene = write_scene("""
load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  constraints = [x^2 + y^2 - 1])$
turning : holonomic_scene(system, initial_state = [x = 1/2, dot(x) = 1], initial_guess = [y = -1, dot(y) = 0])$
""")
    motion = motion_problem(scene, Request(), Limits(), 80)
    with mpmath.workdps(90):
        y = mpmath.mpf(str(final(motion, precision=80, until=Fraction(1)).coordinates["y"]))
        assert abs(y - mpmath.sin(2 / mpmath.sqrt(3) - mpmath.pi / 3)) < mpmath.mpf("1e-77")


@pytest.mark.long
def test_quadruple_precision_agrees_with_fifty_digits():
    reports = [
        final(problem("pendulum.mac", "lengthening_scene", digits), precision=precision, until=Fraction(3, 2))
        for precision, digits in (("quadruple", 36), (50, 50))
    ]
    for ours, theirs in zip(*(report.coordinates.values() for report in reports), strict=True):
        with mpmath.workdps(50):
            assert abs(mpmath.mpf(str(ours)) - mpmath.mpf(str(theirs))) < mpmath.mpf("1e-31")


def test_extended_precision_has_three_digits_more_than_double():
    truth = final(problem("pendulum.mac", "lengthening_scene", 36), precision="quadruple", until=Fraction(30))
    errors = {
        precision: max(
            abs(float(x - type(x)(str(y))))
            for x, y in zip(
                final(
                    problem("pendulum.mac", "lengthening_scene", 36), precision=precision, until=Fraction(30)
                ).coordinates.values(),
                truth.coordinates.values(),
                strict=True,
            )
        )
        for precision in ("double", "extended")
    }
    assert errors["extended"] < errors["double"] / 100
    assert errors["double"] < 1e-11


def test_samples_are_those_asked_for():
    motion = problem("pendulum.mac", "swing_scene")
    steps, few, last = (simulated(motion, samples=samples) for samples in (None, 5, 0))
    assert len(steps.times) == steps.report.steps + 1
    assert few.times.tolist() == [0, 2.5, 5, 7.5, 10]
    assert last.times.tolist() == [10]
    for name in motion.coordinates:
        ends = {float(simulation.coordinates[name][-1]) for simulation in (steps, few, last)}
        assert max(ends) - min(ends) < 1e-13
        assert few.coordinates[name][-1] == few.report.coordinates[name]


def test_a_tolerance_is_met():
    """Truth: the closed form of the paper's free motion; a looser tolerance is less exact."""
    motion, truth = problem("paper/paper.mac", "free_motion_scene"), free_motion_of_the_paper(10.0)
    loose, tight = (final(motion, tol=tol) for tol in (1e-5, 1e-13))
    errors = [max(abs(np.array(numbers(report.coordinates)) - truth) / 1e2) for report in (loose, tight)]
    assert errors[1] < 1e-12 < errors[0] < 1e-3


@pytest.mark.parametrize(
    ("tol", "precision"), [(1e-17, "double"), (1e-20, "extended"), (1e-40, "quadruple"), (2, "double")]
)
def test_a_tolerance_that_the_numbers_cannot_hold_is_refused(tol, precision):
    with failing(ErrorKind.TOLERANCE_OUT_OF_RANGE):
        final(problem("paper/paper.mac"), tol=tol, precision=precision)


def test_a_length_that_goes_through_zero_stops_the_motion_there():
    """Truth: the length 1 - t is zero at t = 1."""
    with failing(ErrorKind.NO_GRADIENT, "lambda1") as refusal:
        final(problem("hard/vanishing_length.mac"))
    assert refusal.value.facts["time"] == pytest.approx(1, abs=1e-4)


def test_a_tolerance_that_the_robust_engine_cannot_hold_is_refused():
    with failing(ErrorKind.TOLERANCE_OUT_OF_RANGE, "robust"):
        final(problem("paper/paper.mac"), tol=1e-15, engine=EngineName.ROBUST)


def test_a_singularity_of_the_control_law_stops_the_motion_there(write_scene):
    """Truth: the table's height 1/(1 - t) has a pole at t = 1."""
    scene = write_scene("""
load("holonom.mac")$
particle : holonomic_system(coordinates = [x, z], controls = [u], kinetic_energy = (dot(x)^2 + dot(z)^2)/2,
  constraints = [z - u])$
rise : holonomic_scene(particle, control_law = [u = 1/(1 - t)], initial_state = [x = 0, dot(x) = 1],
  time_span = [0, 2])$
""")
    with failing(ErrorKind.NO_WAY_ON) as stopped:
        final(motion_problem(scene, Request(), Limits()))
    assert float(stopped.value.detail.split(",")[0]) == pytest.approx(1, abs=1e-4)


def test_an_end_before_the_start_is_refused():
    with failing(ErrorKind.NOT_AFTER_START):
        final(problem("paper/paper.mac"), until=Fraction(0))


def test_a_motion_without_an_end_is_refused():
    motion = problem("paper/paper.mac")
    with failing(ErrorKind.NO_END):
        final(MotionProblem(**{**vars(motion), "time_span": None}))


def test_a_long_run_earns_better_code():
    """Quick code is for short runs; the motion is the same."""
    motion = problem("pendulum.mac", "swing_scene")
    short, long = (final(motion, until=Fraction(until)) for until in (1, 30000))
    assert long.compile_seconds > 0
    assert long.steps > 10000 * short.steps
    assert long.residuals["position"] < 1e-15


@pytest.mark.parametrize("engine", ["auto", "robust"])
def test_simulate_starts_where_a_force_has_no_slope(engine):
    """x'' = x^(1/3) from x = 0 at unit speed: x'^2 = 1 + 3/2 x^(4/3)."""
    motion = holonom.system("""
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [x^(1/3)])$
motion : holonomic_scene(system, initial_state = [x = 0, dot(x) = 1], time_span = [0, 1])$""")
    found = motion.simulate(samples=2, engine=engine)
    assert found["dot(x)"][-1] ** 2 == pytest.approx(1 + 1.5 * found["x"][-1] ** (4 / 3), rel=1e-6)


@pytest.mark.parametrize("force", ["-x^(1/3)", "sqrt(x)"])
def test_simulate_rests_where_a_force_has_no_slope(force):
    """Under sqrt(x), Norton's dome, x = t^4/144 begins so, too."""
    motion = holonom.system(f"""
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [{force}])$
motion : holonomic_scene(system, initial_state = [x = 0, dot(x) = 0], time_span = [0, 1])$""").simulate(samples=2)
    assert motion["x"][-1] == 0
    assert motion.report.trusted
    assert [segment.reason for segment in motion.report.segments] == [NO_SLOPE]
    assert any(NO_SLOPE in note for note in notes(motion.report))


def test_simulate_passes_where_a_force_has_no_slope():
    """x'' = -2 |x|^(2/3) signum(x) from rest at x = -1: half a period is 2 Beta(3/5, 1/2) 3/5 sqrt(5/12)."""
    half = 1.2 * math.sqrt(5 / 12) * scipy.special.beta(3 / 5, 1 / 2)
    motion = holonom.system(f"""
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [-2*abs(x)^(2/3)*signum(x)])$
motion : holonomic_scene(system, initial_state = [x = -1, dot(x) = 0], time_span = [0, {Fraction(3 * half)}])$""")
    found = motion.simulate(samples=4)
    assert found["x"] == pytest.approx([-1, 1, -1, 1], abs=1e-10)
    assert found["dot(x)"] == pytest.approx([0, 0, 0, 0], abs=1e-10)
    assert found.report.trusted


@pytest.mark.usefixtures("c_compiler")
@pytest.mark.parametrize("engine", ["auto", "robust", "runge-kutta"])
@pytest.mark.parametrize(
    ("force", "work"),
    [
        ("sqrt(abs(x))", lambda x: 2 / 3 * np.sign(x) * abs(x) ** 1.5),
        ("-sqrt(abs(x))*signum(x)", lambda x: -2 / 3 * abs(x) ** 1.5),
        ("abs(x)^(1/3)", lambda x: 3 / 4 * np.sign(x) * abs(x) ** (4 / 3)),
    ],
)
def test_simulate_passes_the_zero_of_a_root_of_a_size(force, work, engine):
    """It ended there, "where numbers overflow": sqrt(-x) has no value behind it. Truth: v^2/2 is the work."""
    found = holonom.system(f"""
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [{force}])$
motion : holonomic_scene(system, initial_state = [x = -1, dot(x) = 1/10], time_span = [0, 2])$""").simulate(
        samples=5, engine=engine
    )
    x = found["x"]
    assert x[-1] > 0.5
    assert found["dot(x)"] ** 2 / 2 == pytest.approx(1 / 200 + work(x) - work(-1.0), abs=1e-8)


def test_parameter_without_use_is_a_warning_once():
    """A term that was commented out: x = a t^2/2."""
    scene = holonom.system("""
system : holonomic_system(coordinates = [x], parameters = [a, b], kinetic_energy = dot(x)^2/2, forces = [a])$
motion : holonomic_scene(system, parameter_values = [a = 1, b = 2], initial_state = [x = 0, dot(x) = 0],
  time_span = [0, 1])$""")
    with pytest.warns(HolonomWarning) as told:
        found = scene.simulate(samples=2)
        scene.program()
    assert [("'b'" in str(each.message), "'a'" in str(each.message)) for each in told] == [(True, False)]
    assert found["x"][-1] == pytest.approx(0.5)


def test_parameter_of_a_servo_constraint_alone_is_used():
    scene = holonom.system("""
system : holonomic_system(coordinates = [x], parameters = [b], controls = [u], kinetic_energy = dot(x)^2/2,
  forces = [u])$
motion : holonomic_scene(system, servo_constraints = [x - b*t^2], parameter_values = [b = 2], initial_state = [],
  time_span = [0, 1])$""")
    with warnings.catch_warnings(action="error"):
        assert scene.simulate(samples=2)["x"][-1] == pytest.approx(2)


@pytest.mark.long
@pytest.mark.parametrize("name", ["euler", "all", "local", "coordinates", "exact", "block"])
def test_name_of_maxima_may_name_a_coordinate_and_a_parameter(name):
    scene = holonom.system(f"""
system : holonomic_system(coordinates = [{name}], kinetic_energy = dot({name})^2/2, forces = [1])$
motion : holonomic_scene(system, initial_state = [{name} = 0, dot({name}) = 0], time_span = [0, 1])$""")
    assert scene.simulate(samples=2)[name][-1] == pytest.approx(0.5)
    assert scene.check().disagreements == 0
    other = holonom.system(f"""
system : holonomic_system(coordinates = [x], parameters = [{name}], kinetic_energy = dot(x)^2/2, forces = [{name}])$
motion : holonomic_scene(system, parameter_values = [{name} = 3], initial_state = [x = 0, dot(x) = 0],
  time_span = [0, 1])$""")
    assert other.simulate(samples=2)["x"][-1] == pytest.approx(1.5)


@pytest.mark.parametrize(
    "effect", ["forces = [k = [-k*x]]", "potential_energy = [k = k*x^2/2]", "forces = [-forces*x]"]
)
def test_parameter_named_as_an_effect_is_refused_by_name(effect):
    """A value of k took the place of the effect's name too, and the spring was lost without a word."""
    name = "forces" if "forces*x" in effect else "k"
    with pytest.raises(HolonomError) as refused:
        holonom.system(f"""
system : holonomic_system(coordinates = [x], parameters = [{name}], kinetic_energy = dot(x)^2/2, {effect})$
motion : holonomic_scene(system, parameter_values = [{name} = 4], initial_state = [x = 1, dot(x) = 0],
  time_span = [0, 1])$""").simulate(samples=2)
    assert f"'{name}'" in refused.value.detail


def test_function_of_a_user_with_an_internal_name_changes_nothing():
    scene = holonom.system("""
total(x) := x^2$
system : holonomic_system(coordinates = [x], kinetic_energy = total(dot(x))/2, forces = [1])$
motion : holonomic_scene(system, initial_state = [x = 0, dot(x) = 0], time_span = [0, 1])$""")
    assert scene.simulate(samples=2)["x"][-1] == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("stiffness", "velocity", "kind"),
    [("10^160", "0", ErrorKind.NO_WAY_ON), ("1", "10^400", ErrorKind.NUMBER_TOO_LARGE)],
)
def test_numbers_beyond_a_double_ended_in_an_internal_error(stiffness, velocity, kind):
    scene = holonom.system(
        "system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, "
        f"potential_energy = {stiffness}*x^2/2)$ "
        f"scene : holonomic_scene(system, initial_state = [x = 1, dot(x) = {velocity}])$"
    )
    with failing(kind):
        scene.simulate(until=1, samples=2)


@pytest.mark.parametrize("step", ["0", "-1", "inf", "nan"])
def test_a_longest_step_is_positive_and_finite(step):
    with failing(ErrorKind.NOT_A_STEP, step):
        simulate(problem("pendulum.mac", "swing_scene"), SimulationRequest(max_step=float(step)))


def test_changes_of_the_energy_are_counted_from_the_first_sample_of_all():
    statistics = _EnergyStatistics()
    statistics.add(np.array([1.0, 3.0]), np.array([0.0, -0.5]))
    statistics.add(np.array([2.0, 4.0]), np.array([0.3, 0.25]))
    assert (statistics.largest_change, statistics.error, statistics.last_error) == (3.0, 0.5, 0.25)
