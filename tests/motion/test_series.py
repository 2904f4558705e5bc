"""Power series of the initial motion: against a recurrence written by hand, between the engines, and their ends."""

import json
import math
import subprocess
import sys
from fractions import Fraction
from functools import cache
from pathlib import Path

import mpmath
import pytest

from harness.confined import Limits
from harness.failures import HolonomError
from harness.maxima import run_batch
from harness.motion import heyoka_series
from harness.motion.heyoka_series import Precision
from harness.motion.radius import estimate_radius, truncation_error
from harness.motion.series import MotionSeries, SeriesRequest, compute_series, number, numbers, read_series, values_at

ROOT = Path(__file__).resolve().parents[2]
PAPER = ROOT / "examples" / "paper" / "paper.mac"
PENDULUM = ROOT / "examples" / "pendulum.mac"


@cache
def series(file: Path, order: int, digits: int | str = "exact", scene: str | None = None, u0: str = "3/10"):
    settings = {"u0": u0} if file == PAPER else {}
    return compute_series(file, SeriesRequest(order, scene, digits, settings=settings), Limits())


def compiled(order: int, precision: Precision, file: Path = PAPER, scene: str | None = None) -> MotionSeries:
    return heyoka_series.compute_series(file, SeriesRequest(order, scene), precision, Limits())


def paper_by_hand(order: int, u0: Fraction) -> dict[str, list[Fraction]]:
    """Equation (14) under u = u0 + t. With s = q1 + q2:

    ddot(q1) = -s - u lambda, ddot(q2) = -2 dot(s) - u lambda, ddot(q3) = lambda with q3 = u s, hence
    (1 + 2 u^2) lambda = 2 dot(s) - u (s + 2 dot(s)).
    """
    q1, q2 = [Fraction(1), Fraction(1, 2)], [Fraction(2), Fraction(-1, 3)]
    reaction: list[Fraction] = []

    def at(row: list[Fraction], n: int) -> Fraction:
        return row[n] if n >= 0 else Fraction(0)

    for n in range(order + 1):
        s = [a + b for a, b in zip(q1, q2, strict=True)]
        ds = [k * c for k, c in enumerate(s)][1:]
        driven = 2 * ds[n] - u0 * (s[n] + 2 * ds[n]) - at(s, n - 1) - 2 * at(ds, n - 1)
        reaction.append((driven - 4 * u0 * at(reaction, n - 1) - 2 * at(reaction, n - 2)) / (1 + 2 * u0**2))
        carried = u0 * reaction[n] + at(reaction, n - 1)
        q1.append((-s[n] - carried) / ((n + 1) * (n + 2)))
        q2.append((-2 * ds[n] - carried) / ((n + 1) * (n + 2)))
    s = [a + b for a, b in zip(q1, q2, strict=True)]
    q3 = [u0 * s[n] + at(s, n - 1) for n in range(order + 1)]
    return {"q1": q1[: order + 1], "q2": q2[: order + 1], "q3": q3, "lambda1": reaction}


def relative_digits(found: MotionSeries, exact: MotionSeries) -> float:
    """Digits in which all coefficients agree."""
    worst = mpmath.mpf(0)
    with mpmath.workdps(80):
        for (_, row), (_, true) in zip(found.all_series(), exact.all_series(), strict=True):
            for a, b in zip(numbers(row), numbers(true), strict=True):
                worst = max(worst, abs(a - b) / abs(b) if b else abs(a))
        return float(-mpmath.log10(worst)) if worst else math.inf


def test_paper_to_order_40_in_exact_rationals():
    found = dict(series(PAPER, 40).all_series())
    expected = paper_by_hand(40, Fraction(3, 10))
    assert {name: [Fraction(text) for text in row] for name, row in found.items()} == expected
    assert found["q1"][:3] == ("1", "1/2", "-167/118")


def test_rounded_coefficients_have_their_digits():
    assert relative_digits(series(PAPER, 40, 30), series(PAPER, 40)) >= 29


def test_entire_motion_loses_no_digits():
    """Coefficients down to 1e-50: rounding excites a motion that ends at the radius, and is found out."""
    free = "free_motion_scene"
    assert relative_digits(series(PAPER, 40, 20, free), series(PAPER, 40, "exact", free)) >= 19


@pytest.mark.parametrize(("precision", "digits"), [(Precision.DOUBLE, 12), (Precision.QUADRUPLE, 29)])
def test_engines_agree(precision, digits):
    assert relative_digits(compiled(40, precision), series(PAPER, 40)) >= digits


def test_engines_agree_on_a_pendulum():
    swing = compiled(20, Precision.QUADRUPLE, PENDULUM, "lengthening_scene")
    assert relative_digits(swing, series(PENDULUM, 20, 40, "lengthening_scene")) >= 28


def test_automatic_arithmetic_is_exact_where_it_can_be():
    assert series(PAPER, 4, "automatic").arithmetic == "exact"
    assert series(PENDULUM, 4, "automatic", "swing_scene").arithmetic == "bigfloat(30)"


@pytest.mark.parametrize("u0", [Fraction(k, 4) for k in range(-8, 9, 2)] + [Fraction(3, 10), Fraction(-1, 10)])
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
    assert "entire" in radius.remark


def test_radius_of_a_pendulum_released_at_rest():
    """Truth: the amplitude's elliptic functions have their poles at ±K ± i K', in units of sqrt(l/g)."""
    radius = series(PENDULUM, 60, 30, "swing_scene").radius
    m = mpmath.sin(mpmath.pi / 26) ** 2
    true = abs(mpmath.mpc(mpmath.ellipk(m), mpmath.ellipk(1 - m))) / mpmath.sqrt(9.81)
    assert abs(radius.estimate - true) <= radius.uncertainty
    assert len(radius.singularities) == 4


@pytest.mark.parametrize(
    ("coefficient", "true"),
    [
        (lambda n: mpmath.mpf(3) ** -n, 3.0),
        (lambda n: mpmath.binomial(mpmath.mpf(1) / 2, n) / mpmath.mpf(2) ** n, 2.0),
        (lambda n: mpmath.mpf(0) if n % 2 else mpmath.mpf(5) ** -n, 5.0),
        (lambda n: mpmath.mpf(n % 2) / (n + 1) * mpmath.mpf(4) ** -n, 4.0),
    ],
    ids=["pole", "square root", "even", "odd logarithm"],
)
def test_radius_of_known_functions(coefficient, true):
    radius = estimate_radius([[coefficient(n) for n in range(41)]])
    assert abs(radius.estimate - true) <= radius.uncertainty <= 1e-2 * true


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ([mpmath.mpf(1)] * 5 + [mpmath.mpf(0)] * 20, "polynomial"),
        ([1 / mpmath.factorial(n) for n in range(30)], "entire"),
        ([mpmath.mpf(1)] * 5, "unknown"),
    ],
)
def test_where_there_is_no_radius_words_say_why(row, said):
    radius = estimate_radius([row])
    assert radius.estimate is None
    assert said in radius.remark


def test_truncation_error_covers_the_error():
    motion = series(PAPER, 40)
    longer = {name: numbers(row) for name, row in series(PAPER, 160).all_series()}
    for time in (0.1, 0.4, 0.6):
        for name, row in motion.all_series():
            error = abs(mpmath.polyval(longer[name][::-1], time) - mpmath.polyval(numbers(row)[::-1], time))
            assert float(error) <= 10 * truncation_error(numbers(row), motion.radius, time)


def test_values_beyond_the_radius_are_refused_with_the_reason():
    with pytest.raises(HolonomError, match=r"does not converge at t = 2: its radius of convergence is 0\.768"):
        values_at(series(PAPER, 40), Fraction(2))


def test_continuation_passes_the_radius():
    """Beyond it, heyoka's integrator in quadruple precision is the witness."""
    request = SeriesRequest(8, None, "exact", Fraction(3))
    continuation = compute_series(PAPER, request, Limits()).continuation
    arguments = "lambda([file], write_initial_value_problem(file, false, 36))"
    problem = heyoka_series.read_problem(run_batch(PAPER, arguments))
    integrator = heyoka_series.make_integrator(problem, 38, Precision.QUADRUPLE)
    integrator.propagate_until(type(integrator.time)("3"))
    rows = [*continuation.coordinates.values(), *continuation.velocities.values()]
    with mpmath.workdps(40):
        for row, witness in zip(rows, integrator.state, strict=False):
            assert abs(number(row[-1]) - mpmath.mpf(str(witness))) < 1e-26


def test_order_that_heyoka_cannot_reach_is_refused():
    with pytest.raises(HolonomError, match="heyoka reaches order"):
        compiled(1000, Precision.DOUBLE)


def test_long_exact_numbers_are_read():
    text = "1" * 6000
    assert float(number(f"{text}/{text}0")) == pytest.approx(0.1)


def test_what_is_no_series_is_refused():
    with pytest.raises(HolonomError, match="not a power series"):
        read_series('{"order": 3}')


def test_command_writes_the_document():
    command = [sys.executable, "-m", "harness", "series", str(PAPER), "--order", "40", "--exact", "--json", "-"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, cwd=ROOT)
    document = json.loads(done.stdout)
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
        ["--order", "4", "--at", "noon"],
        ["--order", "40", "--at", "5"],
        ["--order", "4", "--scene", "nowhere"],
    ],
)
def test_bad_requests_leave_with_two_and_one_sentence(arguments):
    command = [sys.executable, "-m", "harness", "series", str(PAPER), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, cwd=ROOT)
    assert done.returncode == 2
    assert done.stdout == ""
    assert "Traceback" not in done.stderr
