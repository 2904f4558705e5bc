"""Truth: the paper's free motion in closed form, q1 + q2 = (3 + 19/6 t) exp(-t), by mpmath."""

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import jsonschema
import mpmath
import pytest
from refusing import failing

from holonom.benchmark.work_precision.engines import RUNGE_KUTTA
from holonom.benchmark.work_precision.measurement import WORKING_DIGITS, Group, Measurement, relative_error
from holonom.benchmark.work_precision.reference import find_reference
from holonom.benchmark.work_precision.runner import measure
from holonom.benchmark.work_precision.series import expansion_of
from holonom.benchmark.work_precision.solvers import SOLVERS
from holonom.benchmark.work_precision.study import Plan, _benchmark_cases, study
from holonom.document_types import schema
from holonom.failures import ErrorKind
from holonom.figures.benchmark import study_figure
from holonom.figures.style import Picture
from holonom.formats import Publication, published
from holonom.program.motion_problem import motion_problem
from holonom.program.request import Request, Solve
from holonom.sandbox import Limits
from holonom.simulation.request import Stabilization

ROOT = Path(__file__).parents[3]
PAPER = ROOT / "examples" / "paper" / "paper.mac"
REQUEST = Request("free_motion_scene")
UNTIL = Fraction(2)
SHORT = Plan(
    tolerances={"double": (1e-6, 1e-9, 1e-12), "30": (1e-20,)},
    solver_tolerances=(1e-6, 1e-9),
    orders=(10, 20),
    series_digits=25,
)


def closed_form(time):
    """Coordinates and velocities: dot(q1) = v1 - integral of s, s = q1 + q2, q3 = u s, u = 3/10 exp(t)."""
    with mpmath.workdps(WORKING_DIGITS):
        t = mpmath.mpf(time.numerator) / time.denominator
        a, b = mpmath.mpf(3), mpmath.mpf(19) / 6
        decay = mpmath.exp(-t)
        s, ds = (a + b * t) * decay, (b - a - b * t) * decay
        v1 = mpmath.mpf(1) / 2 - (a + b) + (a + b + b * t) * decay
        q1 = 1 + (mpmath.mpf(1) / 2 - a - b) * t + (a + 2 * b) - (a + 2 * b + b * t) * decay
        u0 = mpmath.mpf(3) / 10
        return [q1, s - q1, u0 * (a + b * t), v1, ds - v1, u0 * b]


@pytest.fixture(scope="module")
def problems():
    return [motion_problem(PAPER, replace(REQUEST, solve=solve), Limits(), 70) for solve in Solve]


@pytest.fixture(scope="module")
def reference(problems):
    time = expansion_of(problems[0], UNTIL).time
    return find_reference(problems[0], sorted({time, UNTIL}), 30)


@pytest.fixture(scope="module")
def done():
    return study(PAPER, REQUEST, Limits(), replace(SHORT, tolerances={"double": (1e-4, 1e-8, 1e-12)}))


def test_the_reference_is_the_closed_form_to_fifteen_digits_more(reference):
    for time, state in reference.states.items():
        assert relative_error(state, closed_form(time)) < 1e-45


def test_the_reference_is_confirmed_by_another_order_and_precision(reference):
    assert reference.digits != reference.confirming_digits
    assert reference.order != reference.confirming_order
    assert min(reference.digits, reference.confirming_digits) >= 30 + 15
    assert 0 < reference.difference < 1e-45


@pytest.mark.long
@pytest.mark.usefixtures("c_compiler")
def test_what_the_table_states_is_the_distance_from_the_closed_form(problems, reference):
    plan = Plan(tolerances={"double": (1e-9,), "30": (1e-20,)}, solver_tolerances=(1e-6,), orders=SHORT.orders)
    cases = list(_benchmark_cases(problems, UNTIL, expansion_of(problems[0], UNTIL), plan))
    results = measure(cases, reference, lambda: None)
    for case, result in zip(cases, results, strict=True):
        prepared = case.prepare()
        error = relative_error(prepared.state(prepared.run()), closed_form(case.time))
        assert isinstance(result, Measurement), result
        assert result.error == pytest.approx(error, rel=1e-6)
        assert result.seconds > 0
        assert result.operations > 0


@pytest.mark.long
def test_maxima_sums_its_own_series_to_the_truncated_closed_form(done):
    """The rest of the exponential series at t = 1 decides the error of orders 10 and 20, rounded or not."""
    exact = {m.setting: m.error for m in done.measurements if m.method == "series, exact"}
    rounded = {m.setting: m.error for m in done.measurements if m.method == "series, 25 digits"}
    assert exact["order 20"] < 1e-15 < 1e-7 < exact["order 10"] < 1e-5
    assert rounded["order 20"] == pytest.approx(exact["order 20"], rel=1e-3)


@pytest.mark.long
@pytest.mark.usefixtures("c_compiler")
def test_every_group_is_measured(done):
    assert {m.group for m in done.measurements} == set(Group)
    assert {m.method for m in done.measurements if m.group is Group.SOLVER} == set(SOLVERS)
    assert {m.method for m in done.measurements if m.group is Group.RUNGE_KUTTA} == {RUNGE_KUTTA}
    assert len([m for m in done.measurements if m.group is Group.STABILIZATION]) == len(Stabilization)
    assert not done.omissions


@pytest.mark.long
def test_the_document_keeps_to_its_schema(done):
    document = json.loads(json.dumps(published(Publication.ACCURACY, done)))
    jsonschema.Draft202012Validator(schema("accuracy")).validate(document)
    assert len(document["measurements"]) == len(done.measurements)
    assert document["advice"][-1] == {"digits": 30, "cheapest": None}


@pytest.mark.long
def test_the_figure_names_every_method_and_the_machine(done, tmp_path):
    Picture(study_figure(done)).save(tmp_path / "study.svg")
    drawn = (tmp_path / "study.svg").read_text(encoding="utf-8")
    for text in (*{m.method for m in done.measurements}, done.machine.date, done.machine.versions["heyoka"]):
        assert text in drawn


@pytest.mark.long
def test_precisions_whose_reference_would_take_too_long_are_left_out_with_the_reason():
    plan = replace(
        SHORT, tolerances={"double": (1e-6,), "100": (1e-50,)}, orders=(10,), until=UNTIL, longest_reference=0
    )
    done = study(PAPER, REQUEST, Limits(), plan)
    (left_out,) = (omission for omission in done.omissions if omission.method.startswith("Taylor"))
    assert left_out.method == "Taylor, 100 digits"
    assert "0 s" in left_out.reason
    assert done.until == UNTIL
    assert {m.method for m in done.measurements if m.group is Group.TAYLOR} == {"Taylor, double"}


def test_a_scene_that_ends_by_an_event_is_asked_for_a_time(tmp_path):
    # its until was missed in silence
    file = tmp_path / "falling.mac"
    file.write_text("""load("holonom.mac")$
system : holonomic_system(coordinates = [y], kinetic_energy = dot(y)^2/2, potential_energy = 10*y)$
fall : holonomic_scene(system, initial_state = [y = 1, dot(y) = 0], time_span = [0, 2], until = [y])$""")
    with failing(ErrorKind.NO_COMMON_END):
        study(file, Request(), Limits(), Plan())
