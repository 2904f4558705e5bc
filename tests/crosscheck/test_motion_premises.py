"""The premises of a motion, changed one at a time, and a start on another branch than the guess chooses."""

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from mpmath import mp

from holonom.crosscheck.described_motion import DescribedMotion
from holonom.crosscheck.digits import WORKING_DIGITS
from holonom.crosscheck.motion_program import verify_programs
from holonom.crosscheck.motion_series import verify_series
from holonom.crosscheck.motion_start import nearer_start
from holonom.crosscheck.motion_states import States
from holonom.crosscheck.motions import read_motions, verdicts_out_of_time
from holonom.crosscheck.premises import Premises, differences
from holonom.crosscheck.questions import ask_for_check
from holonom.crosscheck.report import Verdict
from holonom.crosscheck.switches import law_times
from holonom.documents import ask
from holonom.formats import Document
from holonom.program.motion_program import Call, Name, Operation
from holonom.program.request import Solve
from holonom.record import read_record
from holonom.source import Source

EXAMPLES = Path(__file__).parents[2] / "examples"
SCENE = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [m],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, potential_energy = m*y, constraints = [x^2 + y^2 - u^2])$
run : holonomic_scene(system, control_law = [u = if t < 3/2 then 2 else t + 1/2], parameter_values = [m = 1],
  initial_state = [x = 1, dot(x) = 1/2], initial_guess = [y = -1, dot(y) = 0], time_span = [0, 3],
  until = [y - x, lambda1],
  observe = [trajectory, controls, constraint_forces, pull = -2*lambda1*u, a = [ddot(x), energy + ddot(u)]])$
"""


@pytest.fixture(scope="module")
def asked(tmp_path_factory):
    file = tmp_path_factory.mktemp("premises") / "scene.mac"
    file.write_text(SCENE, encoding="utf-8")
    source = Source(file)
    motions = read_motions(source.description(), ask_for_check(source, {}))
    return source.description(), motions.programs[0], motions.series[0]


def with_verdicts(description, programs, **changes):
    direct = replace(programs.problems[Solve.DIRECT], **changes)
    changed = replace(programs, problems={**programs.problems, Solve.DIRECT: direct})
    return {each.found.verdict for each in verify_programs(description, [changed], "premises")}


def negated(program, name):
    return replace(program, outputs=program.outputs | {name: Name("x")})


def changes_of(problem):
    start = problem.start
    return {
        "another branch": {"start": start | {"y": start["y"].removeprefix("-"), "dot(y)": f"-{start['dot(y)']}"}},
        "off the constraint": {"start": start | {"y": "-1.7320508075688772935"}},
        "another given value": {"start": start | {"dot(x)": "0.5000000000000000000000000000001"}},
        "another time": {"start": start | {"t": "0.1"}},
        "another end": {"time_span": ("0", "3.0000001")},
        "no end": {"time_span": None},
        "fewer events": {"ends": replace(problem.ends, until=problem.ends.until[:1])},
        "another event": {"ends": replace(problem.ends, events=negated(problem.ends.events, "event[1]"))},
        "another control": {"controls": negated(problem.controls, "u")},
        "another output": {"outputs": negated(problem.outputs, "a[2]")},
        "fewer outputs": {"outputs": None},
        "observations": {"observe": problem.observe[:-1]},
        "coordinates": {"coordinates": problem.coordinates[::-1]},
        "a switch": {"switching": replace(problem.switching, assignments=moved(problem.switching))},
        "nothing": {},
    }


def moved(program):
    """The assignments, with t later by a little in all of them."""

    def later(expression):
        match expression:
            case Name("t"):
                return Call(Operation.SUBTRACT, (Name("t"), Fraction(1, 1000)))
            case Call(operation, arguments):
                return Call(operation, tuple(map(later, arguments)))
            case _:
                return expression

    return tuple((name, later(expression)) for name, expression in program.assignments)


def test_each_other_premise_is_found_and_the_right_ones_agree(asked):
    description, programs, _ = asked
    found = {
        what: with_verdicts(description, programs, **changes)
        for what, changes in changes_of(programs.problems[Solve.DIRECT]).items()
    }
    assert found.pop("nothing") == {Verdict.AGREES}
    assert [what for what, verdicts in found.items() if Verdict.DISAGREES not in verdicts] == []


def test_a_series_from_another_start_or_with_other_constraint_forces_is_found(asked):
    description, programs, series = asked
    (right,) = verify_series(description, [series], [programs])
    assert right.found.verdict is Verdict.AGREES
    for group in ("coordinates", "constraint_forces"):
        rows = getattr(series.series, group)
        for name, row in rows.items():
            wrong = {**rows, name: (f"{row[0]}1" if "." in row[0] else str(Fraction(row[0]) + 1), *row[1:])}
            changed = replace(series, series=replace(series.series, **{group: wrong}))
            (verdict,) = verify_series(description, [changed], [programs])
            assert verdict.found.verdict is Verdict.DISAGREES, (group, name)


def test_laws_are_compared_on_each_piece_and_beside_each_switch(asked):
    description, programs, _ = asked
    motion = DescribedMotion(description, description.scenes[0])
    times = sorted(law_times(motion, programs.problems[Solve.DIRECT], (mp.mpf(0), mp.mpf(3))))
    assert [round(float(each), 9) for each in times] == pytest.approx([0.75, 1.499997, 1.500003, 2.25], abs=1e-5)


def test_only_a_nearer_start_is_reported(asked):
    description, programs, _ = asked
    motion = DescribedMotion(description, description.scenes[0])
    with mp.workdps(WORKING_DIGITS):
        start = {name: mp.mpf(text) for name, text in programs.problems[Solve.DIRECT].start.items()}
        assert nearer_start(motion, start) == ""
        assert "nearer to the guess" in nearer_start(motion, start | {"y": -start["y"], "dot(y)": -start["dot(y)"]})


def test_a_record_that_starts_on_the_other_branch_differs_from_its_guess(asked, tmp_path):
    description, *_ = asked
    (tmp_path / "scene.mac").write_text(SCENE, encoding="utf-8")
    record = json.loads(ask(Document.RECORD, Source(tmp_path / "scene.mac")))
    assert [*differences(read_record(json.dumps(record)), Premises(description))] == []
    state = record["scenes"][0]["initial_state"]
    state |= {name: ["Multiply", -1, state[name]] for name in ("y", "dot(y)")}
    found = differences(read_record(json.dumps(record)), Premises(description))
    assert [each.what for each in found] == ["initial_guess"]
    record["scenes"][0]["title"] = "Kreis"
    found = differences(read_record(json.dumps(record)), Premises(description))
    assert ["Kreis" in each.detail for each in found] == [False, True]


@pytest.mark.parametrize("name", ["prescribed_tension", "overhead_crane"])
def test_scenes_that_move_other_systems_are_in_no_record(name):
    description = Source(EXAMPLES / f"{name}.mac").description()
    assert description.scenes
    assert Premises(description).scenes == ()


def test_every_fourth_state_is_on_either_side_of_zero(asked):
    description, programs, _ = asked
    states = States(DescribedMotion(description, description.scenes[0]), programs.problems[Solve.DIRECT], "sides")
    drawn = [states.state(attempt)["x"][0] for attempt in range(1, 80, 4)]
    assert min(drawn) < 0 < max(drawn)


def test_motions_that_took_too_long_are_undecided_in_each_scene(asked):
    description, *_ = asked
    without_scenes = replace(description, content=description.content | {"scenes": []})
    for described, name in ((description, "run"), (without_scenes, None)):
        (verdict,) = verdicts_out_of_time(described)
        assert (verdict.scene, verdict.verdict, verdict.points) == (name, Verdict.UNDECIDED, None)
        assert verdict.detail


def test_a_guess_on_the_constraints_is_no_nearer_start(tmp_path):
    """The start has the digits of its text; its distance from the fraction -2/3 was counted as an error."""
    file = tmp_path / "scene.mac"
    file.write_text("""load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2, constraints = [2*x + 3*y])$
run : holonomic_scene(system, initial_state = [x = 1, dot(x) = 0], initial_guess = [y = -2/3, dot(y) = 0])$
""")
    description = Source(file).description()
    motion = DescribedMotion(description, description.scenes[0])
    with mp.workdps(WORKING_DIGITS):
        start = {"t": mp.zero, "x": mp.one, "y": mp.mpf(f"-0.{'6' * 45}7"), "dot(x)": mp.zero, "dot(y)": mp.zero}
        assert nearer_start(motion, start) == ""
        assert "nearer to the guess" in nearer_start(motion, start | {"y": mp.mpf("-0.6667")})
