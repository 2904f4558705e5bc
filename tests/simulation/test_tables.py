"""Control laws given by tables, against SciPy's splines: x'' = u(t), so x is the spline's second antiderivative."""

import math
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from refusing import failing, refused
from scipy.integrate import cumulative_simpson, quad
from scipy.interpolate import CubicSpline

import holonom
from holonom.failures import ErrorKind
from holonom.program.model import scene_model
from holonom.program.request import Request
from holonom.program.table_numbers import TimeFunction
from holonom.series.power_series import number, values_at
from holonom.simulation.time_events import time_events

POINTS = [(0, 0), (1, 2), (1.3, 0.5), (3.5, 1), (4, -1)]
ENDS = {"natural": "natural", "clamped": "clamped", "[3, -1/2]": ((1, 3.0), (1, -0.5))}
ENGINES = {"taylor": 1e-14, "runge-kutta": 1e-12, "robust": 1e-10}
SCENE = """
load("holonom.mac")$
system : holonomic_system(coordinates = [x], controls = [u], kinetic_energy = dot(x)^2/2, forces = [u])$
drive : holonomic_scene(system, control_law = [u = {law}], initial_state = [x = 1, dot(x) = -2], time_span = [{span}])$
"""


@pytest.fixture
def driven(tmp_path: Path):
    """A scene under a law, beside a CSV file."""

    def write(law: str, span: str = "0, 4", csv: str = "") -> holonom.Scene:
        (tmp_path / "drive.csv").write_text(csv, encoding="utf-8")
        (tmp_path / "scene.mac").write_text(SCENE.format(law=law, span=span), encoding="utf-8")
        return holonom.load(tmp_path / "scene.mac")

    return write


def points(rows=POINTS):
    return "[" + ", ".join(f"[{t}, {u}]" for t, u in rows) + "]"


def truth(times, ends="natural", rows=POINTS, start=0.0):
    """The motion from x = 1, dot(x) = -2 at the start."""
    spline = CubicSpline(*np.array(rows, dtype=float).T, bc_type=ENDS[ends])
    rate, place = spline.antiderivative(1), spline.antiderivative(2)
    since = times - start
    return 1 - 2 * since + place(times) - place(start) - rate(start) * since


@pytest.mark.parametrize("ends", ENDS)
def test_the_motion_under_a_table_is_the_splines_second_antiderivative(driven, ends):
    motion = driven(f"table({points()}, {ends})").simulate(samples=9)
    assert motion["x"] == pytest.approx(truth(motion.times, ends), rel=1e-14, abs=1e-14)


@pytest.mark.parametrize("engine", ["runge-kutta", "robust"])
def test_every_engine_follows_it(driven, engine, c_compiler):
    motion = driven(f"table({points()})").simulate(samples=9, engine=engine)
    assert motion["x"] == pytest.approx(truth(motion.times), rel=ENGINES[engine], abs=ENGINES[engine])


def test_a_csv_file_beside_the_scene_gives_the_same_motion(driven):
    csv = "# measured\ntime, u\n\n" + "".join(f"{t:.1e},  {u}\r\n" for t, u in POINTS)
    motion = driven('table("drive.csv")', csv=csv).simulate(samples=5)
    assert motion["x"] == pytest.approx(truth(motion.times), rel=1e-14, abs=1e-14)


def test_a_byte_order_mark_was_taken_for_a_part_of_the_first_number(driven):
    csv = "\ufeff" + "\r\n".join(f"{t},{u}" for t, u in POINTS) + "\r\n\r\n"
    motion = driven('table("drive.csv")', csv=csv).simulate(samples=2)
    assert motion["x"] == pytest.approx(truth(motion.times), rel=1e-14)


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_lines_end_as_they_like_and_numbers_may_stand_in_quotes(driven, end):
    csv = "\ufeff" + end.join(['"t","u"', *(f'"{t}","{u}"' for t, u in POINTS), "", ""])
    motion = driven('table("drive.csv")', csv=csv).simulate(samples=2)
    assert motion["x"] == pytest.approx(truth(motion.times), rel=1e-14)


@pytest.mark.parametrize("engine", ["taylor", "runge-kutta"])
def test_a_thousand_points_give_the_splines_motion(driven, engine, c_compiler):
    """Enough intervals are integrated over, and numbers described, in more than one portion."""
    rows = [(k / 100, round(math.sin(k / 30) + math.cos(k) / 20, 6)) for k in range(1001)]
    csv = "".join(f"{t},{u}\n" for t, u in rows)
    law = 'table("drive.csv")*cos(t)^2 + table("drive.csv")*sin(t)^2'
    scene = driven(law, span="0, 10", csv=csv)
    motion = scene.simulate(samples=101, engine=engine)
    assert motion["x"] == pytest.approx(truth(motion.times, rows=rows), rel=1e-11, abs=1e-11)
    assert len(motion.report.switchings) == 999
    assert abs(motion.report.energy_error) < 1e-11


def test_steps_end_at_every_point_and_on_the_number_nearest_to_it(driven):
    motion = driven(f"table({points()})").simulate()
    assert {1.0, 1.3, 3.5} <= set(motion.times.tolist())
    assert [switching.t for switching in motion.report.switchings] == [1.0, 1.3, 3.5]


def test_a_motion_may_start_at_a_point(driven):
    """The spline is not analytic there; the motion continues from it all the same."""
    motion = driven(f"table({points()})", span="1.3, 4").simulate(samples=5)
    assert motion["x"] == pytest.approx(truth(motion.times, start=1.3), rel=1e-14, abs=1e-14)


def test_the_check_takes_the_law_around_the_start(driven):
    scene = driven(f"1/2 + table({points()})*sin(t)")
    assert scene.record.scenes[0].law_around_start
    found = {verdict.number: verdict.verdict.value for verdict in scene.check().verdicts}
    assert found["13"] in ("proved", "agrees")
    assert found["18"] in ("proved", "agrees")


def test_signs_of_the_time_alone_change_at_known_times(driven):
    problem = driven("if 3*t < 7 then t else sin(t) + max(t^2 - 9, 0) - 2", span="0, 4")._problem("direct", 17)
    known = time_events(problem)
    assert [(sign.of, known[sign.name].to) for sign in problem.signs if sign.name in known] == [("3*t-7", 1)]
    assert float(next(iter(known.values())).t) == pytest.approx(7 / 3)


def test_many_points(driven):
    """One part of the motion for each interval, of a program as short as under one polynomial."""
    rows = [(k / 8, round(math.sin(k), 6)) for k in range(14)]
    motion = driven(f"table({points(rows)})", span="0, 13/8").simulate(samples=3)
    assert motion["x"] == pytest.approx(truth(motion.times, rows=rows), rel=1e-14, abs=1e-14)


@pytest.mark.parametrize(
    ("law", "span", "csv", "refusal"),
    [
        ("table([[0, 0], [1, 2], [1, 3]])", "0, 1", "", "times_not_increasing"),
        ("table([[0, 0]])", "0, 1", "", "too_few_points"),
        ("table([[0, 0], [1, u0]])", "0, 1", "", "point_without_numbers"),
        ("table([0, 1])", "0, 1", "", "points_not_pairs"),
        ("table([[0, 0], [1, 2]], parabolic)", "0, 1", "", "unknown_end_of_table"),
        ("table([[0, 0], [1, 2]])", "0, 2", "", "span_beyond_table"),
        ("table([[1, 0], [2, 2]])", "0, 2", "", "start_outside_table"),
        ('table("drive.csv")', "0, 1", "0, 0\n1, 2x\n", "number_in_table_file"),
        ('table("drive.csv")', "0, 1", "0, 0\n1, 2, 3\n", "columns_of_table_file"),
        ('table("drive.csv")', "0, 1", "0, 0\n1, 1e999\n", "number_in_table_file"),
        (
            'table("drive.csv")',
            "0, 1",
            "t,u\n\n0,0\n0.50,1\n.5,1\n",
            "times_of_table_file",
        ),
        (
            'table("drive.csv")',
            "0, 1",
            "t;u\n0;0\n1;2\n",
            "line_without_comma",
        ),
        ('table("drive.csv")', "0, 1", "0,0;1,5\n1,0;2,5\n", "line_without_comma"),
        ('table("drive.csv")', "0, 1", "0,0,1,5\n1,0,2,5\n", "columns_of_table_file"),
        ('table("drive.csv")', "0, 1", "0,\0 0\n", "null_in_table_file"),
        ('table("drive.csv")', "0, 1", "", "too_few_points"),
        ('table("other.csv")', "0, 1", "", "missing_table_file"),
        ("diff(table([[0, 0], [1, 2]]), t)", "0, 1", "", "law_without_derivative"),
        (
            "subst(t = 2*t, table([[0, 0], [2, 2]]))",
            "0, 1",
            "",
            "table_not_of_time",
        ),
    ],
)
def test_a_bad_table_is_refused(driven, law, span, csv, refusal):
    with refused(refusal):
        driven(law, span, csv).simulate()


def test_a_series_was_summed_up_where_the_law_is_another(driven):
    """It gave x = 1 at t = 3/2, with status 0; the push begins at t = 1."""
    series = driven("if t < 1 then 0 else 6*(t - 1)^2").series(order=12)
    assert series.switch == "t-1"
    assert values_at(series, Fraction(0)).values["x"] == 1
    assert number(series.switching_time) == 1
    assert values_at(series, Fraction(3, 4)).values["x"] == -0.5
    for time in (Fraction(3, 2), Fraction(-1, 4)):
        with failing(ErrorKind.SERIES_SWITCHED, "t-1"):
            values_at(series, time)
    assert driven("t^2").series(order=4).switch is None


def test_a_series_under_a_table_is_summed_up_to_its_next_point(driven):
    series = driven("table([[0, 0], [1/2, 1], [4, 0]])").series(order=4)
    assert number(series.switching_time) == 0.5
    values_at(series, Fraction(1, 2))
    with failing(ErrorKind.SERIES_SWITCHED, "t-1/2"):
        values_at(series, Fraction(3, 4))
    assert driven("if t^2 < 2 then 1 else t^3").series(order=4).switching_time is None


def test_what_an_if_calls_in_its_branches_was_left_uncalled_and_refused(driven):
    """A table, a function of the scene, a derivative, behind conditions that are not decided beforehand."""
    law = f"if t < 1 then table({points()}) elseif later(t) < 5 then diff(sin(t), t) else later(t)"
    scene = driven(f"block(define(later(s), s^2), {law})")
    motion = scene.simulate(samples=9)

    spline = CubicSpline(*np.array(POINTS).T, bc_type="natural")

    def push(t):
        if t < 1:
            return float(spline(t))
        return math.cos(t) if t * t < 5 else t * t

    def moved(t):
        inner = [(max(a, 0), min(b, t)) for a, b in ((0, 1), (1, math.sqrt(5)), (math.sqrt(5), 4)) if a < t]
        return 1 - 2 * t + sum(quad(lambda s: (t - s) * push(s), a, b, epsabs=1e-13)[0] for a, b in inner)

    assert motion["x"] == pytest.approx([moved(t) for t in motion.times], rel=1e-11)


def test_no_motion_leads_beyond_the_last_point(driven):
    scene = driven(f"table({points()})")
    with failing(ErrorKind.LAW_ENDS, "t = 4"):
        scene.simulate(until=5)


@pytest.mark.parametrize("law", [f"table({points()})", "if t < 13/10 then t^2 else max(2*t, 5)"])
def test_a_library_takes_the_law_in_all_its_parts(driven, law):
    scene = driven(law)
    model = scene_model(scene.file, Request(), (), scene.limits)
    times = np.array([0.2, 1.1, 2.0, 3.75])
    found = dict(zip(model.law.outputs, TimeFunction(model.law, model.tables)(times), strict=True))
    spline = CubicSpline(*np.array(POINTS, dtype=float).T, bc_type="natural")
    truth = spline(times) if law.startswith("table") else [0.04, 1.21, 5, 7.5]
    assert found["u"] == pytest.approx(truth, rel=1e-14)


def test_one_program_serves_all_polynomials_of_a_table(driven):
    # each of hundreds of pieces was compiled anew, of a law that named them all
    short, long = (
        driven(f"table({points([(k / 8, k % 3) for k in range(count)])})", span="0, 1")._problem("direct", 17)
        for count in (9, 90)
    )
    assert short.motion == long.motion
    assert [len(problem.tables[0].pieces) for problem in (short, long)] == [8, 89]
    assert not long.signs


@pytest.mark.parametrize(
    ("entry", "refusal"),
    [
        ("until = [x - table([[0, 1], [1, 1], [2, 3]])]", "table_in_scene"),
        ("prescribed_reactions = [lambda1 = table([[0, 1], [2, 3]])]", "table_in_scene"),
    ],
)
def test_a_table_elsewhere_was_a_function_called_bracket(entry, refusal):
    scene = holonom.system(f"""
system : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  constraints = [x - u])$
led : holonomic_scene(system, {entry}{", control_law = [u = t]" if "until" in entry else ""}, initial_state = [])$""")
    with refused(refusal):
        scene.simulate(until=2)


def test_two_tables_one_inside_of_abs_and_a_law_in_parts(driven):
    # the sign of a function of a table named signs that had no value yet, which ended in a KeyError
    rows = [(0, 1), (1, -1), (2.5, -1), (4, 1)]
    law = f"table({points()}) + abs(table({points(rows)}, clamped)) + if t < 2 then 0 else t - 2"
    motion = driven(law).simulate(samples=5)
    times = np.linspace(0, 4, 20001)
    first, second = (
        CubicSpline(*np.array(each, dtype=float).T, bc_type=ends)(times)
        for each, ends in ((POINTS, "natural"), (rows, "clamped"))
    )
    push = first + np.abs(second) + np.maximum(times - 2, 0)
    rate = cumulative_simpson(push, x=times, initial=0)
    place = cumulative_simpson(rate, x=times, initial=0)
    assert motion["x"] == pytest.approx((1 - 2 * times + place)[::5000], abs=1e-7)


def test_a_motion_under_a_table_in_quadruple_precision(driven):
    motion = driven(f"table({points()})").simulate(samples=3, precision="quadruple")
    found = np.array([float(x) for x in motion["x"]])
    assert found == pytest.approx(truth(np.linspace(0, 4, 3)), rel=1e-14)


RADII = [(0, 1), (0.5, 1.1), (1, 1), (2, 1.2), (3, 1)]
LENGTHS = {  # laws of the length, each with its values at times
    "table": (
        "table([" + ", ".join(f"[{t}, {r}]" for t, r in RADII) + "])",
        CubicSpline(*np.array(RADII).T, bc_type="natural"),
    ),
    "parts": (
        "if t < 1 then 1 + t^3*(1 - t)^3 else 1 + (t - 1)^3/9",
        lambda t: 1 + np.where(t < 1, (t - t**2) ** 3, (t - 1) ** 3 / 9),
    ),
}


def lengthened(law: str) -> holonom.Scene:
    return holonom.system(f"""
system : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  constraints = [x^2 + y^2 - u^2])$
swing : holonomic_scene(system, control_law = [u = {LENGTHS[law][0]}], initial_state = [x = 0, dot(x) = 1],
  initial_guess = [y = -1, dot(y) = 0], time_span = [0, 2])$""")


@pytest.mark.parametrize("engine", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("stabilization", ["baumgarte", "ggl", "projection", "none"])
@pytest.mark.parametrize("law", LENGTHS)
def test_pendulum_of_given_length_keeps_its_angular_momentum(law, stabilization, engine, c_compiler):
    """Without gravity r^2 phi' is constant."""
    motion, length = lengthened(law).simulate(samples=5, stabilization=stabilization, engine=engine), LENGTHS[law][1]
    angle = sum(quad(lambda t: 1 / length(t) ** 2, *each, epsabs=1e-12)[0] for each in ((0, 1), (1, 2)))
    assert motion["x"][-1] == pytest.approx(length(2) * math.sin(angle), abs=1e-7)
    assert motion["y"][-1] == pytest.approx(-length(2) * math.cos(angle), abs=1e-7)


@pytest.mark.parametrize("stabilization", ["baumgarte", "ggl"])
@pytest.mark.parametrize("law", LENGTHS)
def test_gamma_of_an_earlier_run_stabilized_later_ones(law, stabilization):
    """At so coarse a tolerance the drift at the end of a part was taken for a jump of the constraint."""
    wanted = {"samples": 2, "stabilization": stabilization, "engine": "taylor", "tol": 1e-4}
    scene = lengthened(law)
    scene.simulate(until=Fraction(1, 8), **wanted)
    again, fresh = scene.simulate(until=2, **wanted), lengthened(law).simulate(until=2, **wanted)
    assert again["x"].tolist() == fresh["x"].tolist()
