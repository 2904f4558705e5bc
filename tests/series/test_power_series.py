"""Power series of the initial motion: against a recurrence written by hand, between the engines, and their ends."""

import json
import math
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path

import mpmath
import numpy as np
import pytest
from paper_series import START, paper_by_hand
from refusing import failing

import holonom
from holonom.failures import ErrorKind
from holonom.formats import Document, read
from holonom.sandbox import Limits
from holonom.series.compute import compute_series
from holonom.series.power_series import MotionSeries, number, numbers, values_at
from holonom.series.radius import POLYNOMIAL, truncation_error
from holonom.series.request import SeriesRequest

ROOT = Path(__file__).resolve().parents[2]
PAPER = ROOT / "examples" / "paper" / "paper.mac"
PENDULUM = ROOT / "examples" / "pendulum.mac"
ANDREWS = ROOT / "examples" / "andrews.mac"

needs_extended = pytest.mark.skipif(
    np.finfo(np.longdouble).nmant != 63, reason="this machine has no extended precision"
)


@cache
def series(file: Path, order: int, digits: int | str = "exact", scene: str | None = None, u0: str = "3/10"):
    settings = {"u0": u0} if file == PAPER else {}
    return compute_series(file, SeriesRequest(order, scene, digits, settings=settings), Limits())


def compiled(
    order: int, precision: str, file: Path = PAPER, scene: str | None = None, until: Fraction | None = None
) -> MotionSeries:
    return compute_series(file, SeriesRequest(order, scene, until=until, precision=precision), Limits())


def relative_digits(found: MotionSeries, exact: MotionSeries) -> float:
    """Digits in which all coefficients agree."""
    worst = mpmath.mpf(0)
    with mpmath.workdps(130):
        for (_, row), (_, true) in zip(found.all_series(), exact.all_series(), strict=True):
            for a, b in zip(numbers(row), numbers(true), strict=True):
                worst = max(worst, abs(a - b) / abs(b) if b else abs(a))
        return float(-mpmath.log10(worst)) if worst else math.inf


def test_paper_to_order_40_in_exact_rationals():
    found = dict(series(PAPER, 40).all_series())
    expected = paper_by_hand(40, Fraction(3, 10), START["q1"], START["q2"])
    assert {name: [Fraction(text) for text in row] for name, row in found.items()} == expected
    assert found["q1"][:3] == ("1", "1/2", "-167/118")


def test_rounded_coefficients_have_their_digits():
    assert relative_digits(series(PAPER, 40, 30), series(PAPER, 40)) >= 29


def test_entire_motion_loses_no_digits():
    """Coefficients down to 1e-50: rounding excites a motion that ends at the radius, and is found out."""
    free = "free_motion_scene"
    assert relative_digits(series(PAPER, 40, 20, free), series(PAPER, 40, "exact", free)) >= 19


@pytest.mark.long
@pytest.mark.parametrize("order", [24, 60])
def test_coefficients_that_fall_faster_than_rounding_are_no_zeros(order, tmp_path):
    """Those of cos(sqrt(1 + t)), by 4 (1 + t) y'' + 2 y' + y = 0, end below 1e-1100: all of them were given as 0."""
    scene = tmp_path / "scene.mac"
    scene.write_text(
        'load("holonom.mac")$'
        "system : holonomic_system(coordinates = [z], controls = [u], kinetic_energy = dot(z)^2/2,"
        "  constraints = [z - u])$"
        "entire_scene : holonomic_scene(system, control_law = [u = cos(sqrt(t))], time_span = [1, 2],"
        "  initial_state = [])$"
    )
    found = compute_series(scene, SeriesRequest(order), Limits())
    with mpmath.workdps(400):
        true = [mpmath.cos(1), -mpmath.sin(1) / 2]
        for n in range(order - 1):
            true.append(-(true[n] + (4 * n + 2) * (n + 1) * true[n + 1]) / (4 * (n + 2) * (n + 1)))
        row = numbers(found.coordinates["z"])
        assert all(abs(a - b) <= abs(b) * mpmath.mpf(10) ** -29 for a, b in zip(row, true, strict=True))
    assert "entire" in found.radius.note


PRECISIONS = [
    ("double", 12),
    pytest.param("extended", 15, marks=needs_extended),
    ("quadruple", 29),
    ("20", 19),
    ("100", 99),
]


@pytest.mark.parametrize(("precision", "digits"), PRECISIONS)
def test_engines_agree(precision, digits):
    assert relative_digits(compiled(40, precision), series(PAPER, 40)) >= digits


def test_engines_agree_on_a_pendulum():
    swing = compiled(20, "quadruple", PENDULUM, "lengthening_scene")
    assert relative_digits(swing, series(PENDULUM, 20, 40, "lengthening_scene")) >= 28


@pytest.mark.long
def test_engines_agree_on_the_squeezer_in_fifty_digits():
    """Seven bodies, six constraints, order 40: Maxima's confirmed bigfloats and heyoka's arithmetic of MPFR."""
    assert relative_digits(compiled(40, "50", ANDREWS), series(ANDREWS, 40, 50)) >= 48


def test_a_shorter_series_is_the_beginning_of_a_longer_one():
    longer, shorter = (holonom.load(PENDULUM).series(order=order, precision=30) for order in (9, 5))
    for (name, row), (same, start) in zip(longer.all_series(), shorter.all_series(), strict=True):
        assert (same, start) == (name, row[:6])


def test_automatic_arithmetic_is_exact_where_it_can_be():
    assert series(PAPER, 4, "automatic").arithmetic == "exact"
    assert series(PENDULUM, 4, "automatic", "swing_scene").arithmetic == "bigfloat(30)"


SHORT = [Fraction(3, 10)]
LONG = [Fraction(-2), *(Fraction(k, 4) for k in range(-6, 9, 2)), Fraction(-1, 10)]


@pytest.mark.parametrize("u0", [*SHORT, *(pytest.param(u0, marks=pytest.mark.long) for u0 in LONG)])
def test_radius_of_the_paper(u0):
    """Truth: the zeros of 1 + 2 (u0 + t)^2, a complex pair."""
    radius = series(PAPER, 160, u0=str(u0)).radius
    true = math.sqrt(u0**2 + 0.5)
    assert abs(radius.estimate - true) <= min(radius.uncertainty, 1e-3 * true)
    assert sorted(z.imag for z in radius.singularities) == pytest.approx([-math.sqrt(0.5), math.sqrt(0.5)], abs=1e-6)
    assert [z.real for z in radius.singularities] == pytest.approx([-float(u0)] * 2, abs=1e-6)


def test_radius_is_where_a_pade_approximant_has_a_pole():
    """A second opinion: mpmath's Padé approximant of the multiplier."""
    motion = series(PAPER, 40)
    with mpmath.workdps(60):
        _, denominator = mpmath.pade(numbers(motion.multipliers["lambda1"]), 20, 20)
        poles = [complex(z) for z in mpmath.polyroots(denominator[::-1], maxsteps=500, extraprec=500)]
    for singularity in motion.radius.singularities:
        assert min(abs(pole - singularity) for pole in poles) < 0.05 * motion.radius.estimate


def test_motion_under_the_free_law_is_entire():
    radius = series(PAPER, 40, "exact", "free_motion_scene").radius
    assert radius.estimate is None
    assert "entire" in radius.note


def test_radius_of_a_pendulum_released_at_rest():
    """Truth: the amplitude's elliptic functions have their poles at ±K ± i K', in units of sqrt(l/g)."""
    radius = series(PENDULUM, 60, 30, "swing_scene").radius
    m = mpmath.sin(mpmath.pi / 26) ** 2
    true = abs(mpmath.mpc(mpmath.ellipk(m), mpmath.ellipk(1 - m))) / mpmath.sqrt(9.81)
    assert abs(radius.estimate - true) <= radius.uncertainty
    assert len(radius.singularities) == 4


def test_truncation_error_covers_the_error():
    motion = series(PAPER, 40)
    longer = {name: numbers(row) for name, row in series(PAPER, 160).all_series()}
    for time in (0.1, 0.4, 0.6):
        for name, row in motion.all_series():
            error = abs(mpmath.polyval(longer[name][::-1], time) - mpmath.polyval(numbers(row)[::-1], time))
            assert float(error) <= 10 * truncation_error(numbers(row), motion.radius, time)


def test_values_beyond_the_radius_are_refused_with_the_reason():
    with failing(ErrorKind.BEYOND_RADIUS, "t = 2", "0.7681146"):
        values_at(series(PAPER, 40), Fraction(2))


def test_a_time_within_the_uncertainty_of_the_radius_was_beyond_it():
    motion = series(PAPER, 40)
    uncertain = replace(motion)
    vars(uncertain)["radius"] = replace(motion.radius, uncertainty=0.5)
    with failing(ErrorKind.BEYOND_RADIUS, "whether", "t = 0.5", "0.8", "higher order"):
        values_at(uncertain, Fraction(1, 2))
    assert values_at(motion, Fraction(1, 2)).time == Fraction(1, 2)


def test_values_are_refused_where_the_radius_is_unknown_and_the_terms_grow():
    with failing(ErrorKind.BEYOND_RADIUS, "t = 5"):
        values_at(series(PAPER, 10), Fraction(5))


def worst_difference_at_the_end(one, other):
    """Between two continuations."""
    with mpmath.workdps(60):
        return max(
            abs(number(ours[name][-1]) - number(theirs[name][-1]))
            for ours, theirs in ((one.coordinates, other.coordinates), (one.velocities, other.velocities))
            for name in theirs
        )


def test_continuation_passes_the_radius():
    """Beyond it, heyoka's integrator in quadruple precision is the witness of Maxima's expansions."""
    found = compute_series(PAPER, SeriesRequest(8, digits="exact", until=Fraction(3)), Limits()).continuation
    assert worst_difference_at_the_end(found, compiled(8, "quadruple", until=Fraction(3)).continuation) < 1e-26


@pytest.mark.long
@pytest.mark.parametrize(
    ("precision", "error"), [("double", 1e-13), pytest.param("extended", 1e-16, marks=needs_extended), ("40", 1e-39)]
)
def test_continuation_has_the_precision_of_its_numbers(precision, error):
    witness = compute_series(PAPER, SeriesRequest(8, digits=50, until=Fraction(-2)), Limits()).continuation
    found = compiled(8, precision, until=Fraction(-2)).continuation
    assert number(found.times[-1]) == -2
    assert worst_difference_at_the_end(found, witness) < error


def test_continuation_ends_at_a_pole(tmp_path):
    """ddot(x) = 6 x^2 from x = 1, dot(x) = 2: x = 1/(1 - t)^2."""
    scene = tmp_path / "pole.mac"
    scene.write_text(
        'load("holonom.mac")$\n'
        "system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [pull = [6*x^2]],"
        " constraints = [])$\n"
        "escape : holonomic_scene(system, initial_state = [x = 1, dot(x) = 2])$\n"
    )
    before = compiled(20, "double", scene, until=Fraction(1, 2)).continuation
    assert float(before.coordinates["x"][-1]) == pytest.approx(4, rel=1e-14)
    with failing(ErrorKind.NO_CONTINUATION, "t = 1"):
        compiled(20, "double", scene, until=Fraction(2))


def test_constraint_forces_are_multipliers_times_gradients(tmp_path):
    """Where a scene observes them: Lambda = lambda df/dq, a product of series, with f = q3 - (u0 + t) (q1 + q2)."""
    scene = tmp_path / "paper.mac"
    text = PAPER.read_text().replace("../../maxima/holonom.mac", str(ROOT / "maxima" / "holonom.mac"))
    text = text.replace("sconcat(pathname_directory(load_pathname), ", "(")
    scene.write_text(text.rpartition("  time_span")[0] + "  observe = [constraint_forces])$\n")
    for motion in (series(scene, 12), compiled(12, "quadruple", scene)):
        assert set(motion.constraint_forces) == {"Lambda[1]", "Lambda[2]", "Lambda[3]"}
        with mpmath.workdps(50):
            reaction = numbers(motion.multipliers["lambda1"])
            pulled = [-(mpmath.mpf(3) / 10 * reaction[n] + (reaction[n - 1] if n else 0)) for n in range(13)]
            for name, expected in zip(motion.constraint_forces, (pulled, pulled, reaction), strict=True):
                found = numbers(motion.constraint_forces[name])
                assert max(abs(a - b) for a, b in zip(found, expected, strict=True)) < 1e-26


def test_order_that_heyoka_cannot_reach_is_refused():
    with failing(ErrorKind.ORDER_TOO_HIGH):
        compiled(1000, "double")


def test_long_exact_numbers_are_read():
    text = "1" * 6000
    assert float(number(f"{text}/{text}0")) == pytest.approx(0.1)


def test_what_is_no_series_is_refused():
    with failing(ErrorKind.NOT_A_DOCUMENT, "holonom-motion-series"):
        read(Document.MOTION_SERIES, '{"order": 3}', MotionSeries)


def test_command_writes_the_document(holonom_here):
    document = json.loads(holonom_here("series", PAPER, "--order", "40", "--exact", "--json", "-").stdout)
    assert document["arithmetic"] == "exact"
    assert document["coordinates"]["q1"][:3] == ["1", "1/2", "-167/118"]
    assert document["radius_of_convergence"]["estimate"] == pytest.approx(math.sqrt(0.59), rel=1e-2)
    first = min(document["radius_of_convergence"]["singularities"])
    assert first == pytest.approx([-0.3, -math.sqrt(0.5)], abs=1e-4)


@pytest.mark.parametrize(
    "arguments",
    [
        ["--order", "1"],
        ["--order", "4", "--digits", "0"],
        ["--order", "4", "--exact", "--digits", "3"],
        ["--order", "4", "--digits", "10000000000"],
        ["--order", "4", "--precision", "0"],
        ["--order", "4", "--precision", "half"],
        ["--order", "4", "--precision", "10000000000"],
        ["--order", "4", "--precision", "double", "--exact"],
        ["--order", "400", "--precision", "double"],
        ["--order", "4", "--at", "noon"],
        ["--order", "40", "--at", "5"],
        ["--order", "4", "--scene", "nowhere"],
    ],
)
def test_bad_requests_leave_with_two_and_one_sentence(arguments, holonom_here):
    done = holonom_here("series", PAPER, *arguments)
    assert done.returncode == 2
    assert done.stdout == ""
    assert "Traceback" not in done.stderr


# ---- derivatives by parameters and initial values ---------------------------------------------------------------

GUESSED = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [m, l, g],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, potential_energy = m*g*y, forces = [-m*dot(x)*abs(dot(x)), 0],
  constraints = [x^2 + y^2 - (l + u)^2])$
scene : holonomic_scene(system, control_law = [u = a*t^2], parameter_values = [m = 2, l = 5, g = 10, a = 1/2],
  initial_state = [x = 3*l/5, dot(x) = START], initial_guess = [y = -4, dot(y) = 3])$
"""


def varied(write_scene, start: str = "4", **settings: str) -> MotionSeries:
    scene = write_scene(GUESSED.replace("START", start))
    directions = ("l", "a", "m", "dot(x)")
    return compute_series(scene, SeriesRequest(8, sensitivities=directions, settings=settings), Limits())


def test_derivatives_are_the_limits_of_differences(write_scene):
    """Of exact coefficients at values a step of 1e-12 apart, so that 24 digits are lost of none."""
    step = Fraction(1, 10**12)
    found = varied(write_scene)
    for name, value in {"l": 5, "a": Fraction(1, 2), "dot(x)": 4}.items():
        ahead, behind = (
            varied(write_scene, str(value + way))
            if name == "dot(x)"
            else varied(write_scene, **{name: str(value + way)})
            for way in (step, -step)
        )
        for x in ("x", "y", "lambda1"):
            rows = (dict(each.all_series())[x] for each in (ahead, behind))
            limits = [(Fraction(a) - Fraction(b)) / (2 * step) for a, b in zip(*rows, strict=True)]
            exact = [Fraction(text) for text in found.sensitivities[f"d({x}, {name})"]]
            assert exact == pytest.approx(limits, rel=1e-18, abs=1e-18), (name, x)


def test_derivatives_by_the_mass_are_known(write_scene):
    """All terms of T, V and Q have the factor m: the motion keeps still, and the multiplier grows with m."""
    found = varied(write_scene)
    assert {*found.sensitivities["d(x, m)"], *found.sensitivities["d(y, m)"]} == {"0"}
    assert [2 * Fraction(a) for a in found.sensitivities["d(lambda1, m)"]] == [
        Fraction(a) for a in found.multipliers["lambda1"]
    ]


def test_derivatives_of_rounded_series_are_those_of_the_motion_s_sensitivities():
    """All of the start is given, of irrational numbers: an initial value moves others along the manifold."""
    scene = holonom.load(PENDULUM)
    names = ["x", "g", "dot(x)"]
    found = values_at(scene.series(order=30, sensitivities=names), Fraction(1, 10)).values
    simulated = scene.simulate(until=0.1, sensitivities=names)
    for name in (f"d({y}, {p})" for y in ("x", "y", "lambda1") for p in names):
        assert float(found[name]) == pytest.approx(float(simulated[name][-1]), rel=1e-12), name


def test_derivatives_of_a_motion_at_rest_are_no_polynomials(write_scene):
    """x = 0 is the motion, and d(x, x) = cosh(t)."""
    scene = write_scene("""load("holonom.mac")$
scene : holonomic_scene(holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [x]),
  initial_state = [x = 0, dot(x) = 0])$
""")
    found = compute_series(scene, SeriesRequest(12, sensitivities=("x",)), Limits())
    assert [Fraction(a) * math.factorial(k) for k, a in enumerate(found.sensitivities["d(x, x)"])] == [1, 0] * 6 + [1]
    assert (found.polynomial, found.radius.note == POLYNOMIAL.note) == (True, False)


def test_derivatives_by_heyoka_are_refused():
    request = SeriesRequest(4, precision="double", sensitivities=("g",))
    with failing(ErrorKind.SERIES_VARIED):
        compute_series(PENDULUM, request, Limits())


def test_a_sign_had_no_value(write_scene):
    scene = write_scene("""load("holonom.mac")$
      system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, potential_energy = abs(x - 1))$
      s : holonomic_scene(system, initial_state = [x = 0, dot(x) = 2])$""")
    with failing(ErrorKind.NOT_ANALYTIC):
        compute_series(scene, SeriesRequest(4, precision="double"), Limits())


@pytest.mark.parametrize("contact", ["20*max(0, -x)^(3/2)", "if x < 0 then 20*(-x)^(3/2) else 0"])
def test_series_on_both_sides_of_a_hertz_contact(contact):
    """The force is 20 (1 + t)^(3/2) at first where x = -1 - t, and zero where x is positive."""
    text = """system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [{contact}])$
        scene : holonomic_scene(system, initial_state = [x = {x}, dot(x) = {x}])$"""
    inside, outside = (holonom.system(text.format(contact=contact, x=x)).series(order=3) for x in (-1, 1))
    assert numbers(inside.coordinates["x"]) == [-1, -1, 10, 5]
    assert numbers(outside.coordinates["x"]) == [1, 1, 0, 0]


@pytest.mark.parametrize("options", [{}, {"precision": "double"}], ids=["maxima", "heyoka"])
def test_controls_have_series_and_servo_constraints_have_no_multipliers(options):
    """A mass on a rope of length l is moved as x = t^3 and lifted as y = t^2 - 4; w pushes along exp(t)."""
    text = """system : holonomic_system(coordinates = [x, y], controls = [F, l, w],
            kinetic_energy = (dot(x)^2 + dot(y)^2)/2, forces = [F + w, 0], constraints = [y + l])$
        s : holonomic_scene(system, servo_constraints = [x = t^3, y = t^2 - 4], control_law = [w = exp(t)],
            initial_state = [])$"""
    found = holonom.system(text).series(order=6, **options)
    assert {*found.multipliers} == {"lambda1"}
    expected = {
        "F": [-1, 5, *(-1 / math.factorial(k) for k in range(2, 7))],
        "w": [1 / math.factorial(k) for k in range(7)],
        "ddot(l)": [-2, *[0] * 6],
    }
    assert {*found.controls} == {*expected}
    for name, row in expected.items():
        assert [float(Fraction(x)) for x in found.controls[name]] == pytest.approx(row, abs=1e-14)


def test_a_polynomial_motion_under_servo_constraints_is_one():
    text = """system : holonomic_system(coordinates = [x], controls = [F], kinetic_energy = dot(x)^2/2, forces = [F])$
        s : holonomic_scene(system, servo_constraints = [x = t^3], initial_state = [])$"""
    assert holonom.system(text).series(order=14).radius.note == POLYNOMIAL.note


def test_series_of_more_coordinates_than_a_call_takes_arguments():
    """80 pendulums, two of them on a curve, where Newton's method finds the start."""
    scene = holonom.system("""
q : makelist(concat(x, i), i, 80)$
system : holonomic_system(coordinates = q, kinetic_energy = apply("+", map(lambda([x], dot(x)^2), q))/2,
  potential_energy = apply("+", map(lambda([x], -cos(x)), q)), constraints = [x1^3 + x1*x2 - 3])$
run : holonomic_scene(system, time_span = [0, 1], initial_guess = [x1 = 6/5, dot(x1) = 0],
  initial_state = append(map(lambda([x], x = 1), rest(q)), map(lambda([x], dot(x) = 0), rest(q))))$
""")
    found = scene.series(order=3, digits=30)
    assert float(found.coordinates["x80"][2]) == pytest.approx(-math.sin(1) / 2)
