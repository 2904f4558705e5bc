"""Drives that are special functions of the time, against SciPy's and mpmath's own."""

from collections.abc import Callable
from pathlib import Path

import mpmath
import numpy as np
import pytest
from refusing import refused
from scipy import special
from scipy.integrate import solve_ivp

import holonom
from holonom.crosscheck.report import Verdict
from holonom.failures import ErrorKind, HolonomError
from holonom.program.model import scene_model
from holonom.program.motion_problem import MotionProblem, motion_problem
from holonom.program.numpy_function import NumpyFunction
from holonom.program.precision import read_precision
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.series.compute import compute_series
from holonom.series.heyoka_series import expand
from holonom.series.request import SeriesRequest
from holonom.simulation.request import EngineName, SimulationRequest
from holonom.simulation.simulate import simulate

WRITE = Callable[[str], Path]
DIGITS = {EngineName.TAYLOR: 1e-13, EngineName.RUNGE_KUTTA: 1e-11, EngineName.ROBUST: 1e-8}

MIXED = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y, z], controls = [u, w, s], parameters = [k],
  kinetic_energy = (dot(x)^2 + dot(y)^2 + dot(z)^2)/2,
  potential_energy = [stiffness = airy_ai(k*t)*x^2/2],
  forces = [push = [bessel_k(1/3, t + 1), u*jacobi_sn(t, 1/2) + gamma(1 + t/k), s*erfc(t - 1) + bessel_y(2, t + 1)]],
  constraints = [y - w*x])$
mixed : holonomic_scene(system,
  control_law = [u = bessel_i(1, t), w = airy_bi(-t) + bessel_j(1/2, t + 1), s = exp(-t)*bessel_j(2, 3*sin(t))],
  parameter_values = [k = 2], initial_state = [x = 1, dot(x) = 0, z = 0, dot(z) = 1], time_span = [0, 2])$
"""

PUSHED = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [c],
  kinetic_energy = c*(dot(x)^2 + dot(y)^2)/2, forces = [push = [c*{force}, 0]], constraints = [y - u])$
pushed : holonomic_scene(system, control_law = [u = {law}], parameter_values = [c = 1],
  initial_state = [x = 0, dot(x) = 0], {more})$
"""


def pushed(force: str = "bessel_j(0, t)", law: str = "bessel_i(1, t)", more: str = "time_span = [0, 10]") -> str:
    return PUSHED.format(force=force, law=law, more=more)


def asked(file: Path, digits: int = 17, parameters: tuple[str, ...] = ()) -> MotionProblem:
    return motion_problem(file, Request(), Limits(), digits, parameters)


def twice_integrated(t: mpmath.mpf) -> mpmath.mpf:
    """x with d^2x/dt^2 = J_0(t), from rest at zero: its power series."""
    return mpmath.nsum(
        lambda k: (-1) ** int(k) * t ** (2 * k + 2) / (4**k * mpmath.factorial(k) ** 2 * (2 * k + 1) * (2 * k + 2)),
        [0, mpmath.inf],
    )


def by_scipy(t: float, state: np.ndarray) -> list[float]:
    """The motion of MIXED with y = w x put in."""
    x, v, _, vz = state
    _, _, bi, rate = special.airy(-t)
    half = [special.jvp(0.5, t + 1, k) for k in range(3)]
    w, w1, w2 = bi + half[0], -rate + half[1], -t * bi + half[2]
    along_x = special.kv(1 / 3, t + 1) - special.airy(2 * t)[0] * x
    along_y = special.iv(1, t) * special.ellipj(t, 0.5)[0] + special.gamma(1 + t / 2)
    along_z = np.exp(-t) * special.jv(2, 3 * np.sin(t)) * special.erfc(t - 1) + special.yv(2, t + 1)
    return [v, (along_x + w * along_y - w * (2 * w1 * v + w2 * x)) / (1 + w * w), vz, along_z]


@pytest.fixture(scope="module")
def mixed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("mixed") / "scene.mac"
    file.write_text(MIXED, encoding="utf-8")
    return file


@pytest.fixture(scope="module")
def problem(mixed: Path) -> MotionProblem:
    return asked(mixed)


@pytest.fixture(scope="module")
def pushed_problem(tmp_path_factory: pytest.TempPathFactory) -> MotionProblem:
    file = tmp_path_factory.mktemp("pushed") / "scene.mac"
    file.write_text(pushed(), encoding="utf-8")
    return asked(file)


@pytest.mark.usefixtures("c_compiler")
@pytest.mark.parametrize("engine", DIGITS)
def test_all_engines_follow_a_push_and_a_law_by_bessel_functions(pushed_problem: MotionProblem, engine: EngineName):
    report = simulate(pushed_problem, SimulationRequest(samples=0, engine=engine)).report
    assert report.coordinates["x"] == pytest.approx(float(twice_integrated(mpmath.mpf(10))), rel=DIGITS[engine])
    assert report.coordinates["y"] == pytest.approx(special.iv(1, 10), rel=DIGITS[engine])


def test_special_functions_of_numbers_are_numbers(write_scene: WRITE):
    scene = pushed(force="-bessel_j(0, c)*x", law="gamma(1/3)*sin(t)").replace("x = 0", "x = 1")
    report = simulate(asked(write_scene(scene)), SimulationRequest(samples=0)).report
    assert report.coordinates["x"] == pytest.approx(np.cos(10 * np.sqrt(special.j0(1))), abs=1e-13)
    assert report.coordinates["y"] == pytest.approx(special.gamma(1 / 3) * np.sin(10), abs=1e-13)
    with refused("special_not_rational"):
        compute_series(write_scene(scene), SeriesRequest(order=3, digits="exact"), Limits())


def test_a_switching_surface_of_a_special_function_has_its_name(write_scene: WRITE):
    scene = pushed(force="max(bessel_j(0, t), 0)", more="time_span = [0, 3]")
    (switching,) = simulate(asked(write_scene(scene)), SimulationRequest(samples=0)).report.switchings
    assert switching.function == "bessel_j(0,t)"
    assert switching.t == pytest.approx(special.jn_zeros(0, 1)[0], rel=1e-14)


@pytest.mark.long
@pytest.mark.usefixtures("c_compiler")
@pytest.mark.parametrize("engine", DIGITS)
def test_all_engines_follow_scipys_motion(problem: MotionProblem, engine: EngineName):
    truth = solve_ivp(by_scipy, (0, 2), [1, 0, 0, 1], method="DOP853", rtol=2.3e-14, atol=1e-15).y[:, -1]
    report = simulate(problem, SimulationRequest(samples=0, engine=engine)).report
    found = [report.coordinates["x"], report.velocities["dot(x)"], report.coordinates["z"], report.velocities["dot(z)"]]
    assert found == pytest.approx(truth, abs=DIGITS[engine])


def test_the_law_of_the_model_is_scipys_with_its_rates(write_scene: WRITE):
    law = scene_model(write_scene(pushed()), Request(), [], Limits()).law
    values = dict(zip(law.outputs, NumpyFunction(law)([1.25]), strict=True))
    assert values["u"] == pytest.approx(special.iv(1, 1.25), rel=1e-14)
    assert values["dot(u)"] == pytest.approx(special.ivp(1, 1.25), rel=1e-14)
    assert values["ddot(u)"] == pytest.approx(special.ivp(1, 1.25, 2), rel=1e-14)


@pytest.mark.long
def test_a_push_by_a_bessel_function_in_quadruple_precision(write_scene: WRITE):
    problem = asked(write_scene(pushed()), 37)
    report = simulate(problem, SimulationRequest(samples=0, precision="quadruple")).report
    with mpmath.workdps(40):
        assert abs(mpmath.mpf(str(report.coordinates["x"])) - twice_integrated(mpmath.mpf(10))) < 1e-30
        assert abs(mpmath.mpf(str(report.coordinates["y"])) - mpmath.besseli(1, 10)) < 1e-26


@pytest.mark.long
def test_the_series_are_the_functions_own(write_scene: WRITE):
    series = compute_series(write_scene(pushed()), SeriesRequest(order=12, digits=20), Limits())
    with mpmath.workdps(40):
        for k in range(6):
            push = mpmath.mpf(-1) ** k / (4**k * mpmath.factorial(k) ** 2 * (2 * k + 1) * (2 * k + 2))
            law = 1 / (2 * 4**k * mpmath.factorial(k) * mpmath.factorial(k + 1))
            assert abs(mpmath.mpf(series.coordinates["x"][2 * k + 2]) / push - 1) < 1e-19, k
            assert abs(mpmath.mpf(series.coordinates["y"][2 * k + 1]) / law - 1) < 1e-19, k


@pytest.mark.long
def test_the_series_of_a_gamma_function_to_order_24(write_scene: WRITE):
    series = compute_series(
        write_scene(pushed(law="gamma(1 + t)")), SeriesRequest(order=24, digits=30), Limits(seconds=900)
    )
    with mpmath.workdps(40):
        for found, true in zip(series.coordinates["y"], mpmath.taylor(mpmath.gamma, 1, 24), strict=True):
            assert abs(mpmath.mpf(found) / true - 1) < 1e-28


def test_the_start_of_a_gamma_function_is_agreed_on(write_scene: WRITE):
    """Polygamma functions of whole numbers are values of Riemann's zeta function."""
    report = holonom.load(write_scene(pushed(law="gamma(1 + t/2)"))).check()
    (series,) = (each for each in report.verdicts if each.number == "18")
    assert series.verdict in (Verdict.PROVED, Verdict.AGREES)


@pytest.mark.parametrize(
    ("scene", "refusal"),
    [
        (pushed(force="bessel_j(0, x)"), "special_of_motion"),
        (pushed(law="bessel_y(0, t)"), "law_not_analytic"),
        (pushed(force="bessel_y(0, t)"), "special_not_written"),
        (pushed(force="bessel_j(0, t^4)"), "special_not_written"),
        (pushed(more="observe = [trajectory]"), "special_without_span"),
    ],
)
def test_what_cannot_be_written_out_is_refused(write_scene: WRITE, scene: str, refusal: str):
    with refused(refusal):
        asked(write_scene(scene))


def test_no_parameter_in_a_special_function_varies(write_scene: WRITE):
    with refused("special_of_parameters"):
        asked(write_scene(pushed(force="bessel_j(0, c*t)")), 17, ("c",))


def test_no_motion_goes_on_beyond_the_span_of_a_special_function(pushed_problem: MotionProblem):
    with pytest.raises(HolonomError) as caught:
        simulate(pushed_problem, SimulationRequest(until=11))
    assert caught.value.kind is ErrorKind.LAW_ENDS


def test_equations_for_other_integrators_went_on_after_the_time_span():
    scene = holonom.system("""system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2,
      forces = [bessel_j(0, t)])$
      pushed : holonomic_scene(system, initial_state = [x = 0, dot(x) = 0], time_span = [0, 3])$""")
    f, dae = scene.rhs(), scene.dae()
    assert solve_ivp(f, (0, 3), f.y0).success
    for later in (lambda: f(9, f.y0), lambda: dae.residual(9, dae.y0, dae.yp0)):
        with pytest.raises(HolonomError) as caught:
            later()
        assert caught.value.kind is ErrorKind.LAW_ENDS


def test_no_derivatives_of_high_order_are_taken_of_the_polynomials(pushed_problem: MotionProblem):
    with pytest.raises(HolonomError) as caught:
        expand(pushed_problem, 30, read_precision("double"))
    assert caught.value.kind is ErrorKind.SPECIAL_EXPANDED


def test_no_exact_series_is_given(write_scene: WRITE):
    with refused("special_not_rational"):
        compute_series(write_scene(pushed()), SeriesRequest(order=10, digits="exact"), Limits())


@pytest.mark.long
@pytest.mark.parametrize("order", ["2/3", "2"])
def test_sympy_finds_no_disagreement(write_scene: WRITE, order: str):
    """mpmath takes Y of an integer order as a limit, which is slow."""
    report = holonom.load(write_scene(MIXED.replace("bessel_y(2,", f"bessel_y({order},"))).check()
    assert report.disagreements == 0
    assert report.count(Verdict.UNDECIDED) == 0
