"""The tests of a mutant are those that execute its function."""

import re
from collections import Counter

import executed
import pytest
import sources
from copies import Copy

FIRST, SECOND, OTHER = [each for each in sources.functions() if each.language == "py"][:3]
TESTS = {
    "a.py::wide[x]": {"seconds": 0, "functions": [str(FIRST), str(SECOND)]},
    "b.py::slow": {"seconds": 2 * executed.SECONDS, "functions": [str(FIRST)]},
    "c.py::quick": {"seconds": 0.3, "functions": [str(FIRST)]},
}


@pytest.fixture
def near(monkeypatch):
    """The nearness of each test file to any function."""
    found = Counter()
    monkeypatch.setattr(executed, "nearness", lambda file, function: found[file])
    return found


def test_the_most_specific_tests_come_first_in_portions_of_some_seconds(near):
    assert executed.Executed(TESTS).by(FIRST) == [["b.py::slow"], ["c.py::quick", "a.py::wide[x]"]]
    quick = {**TESTS, "b.py::slow": {**TESTS["b.py::slow"], "seconds": 1}}
    assert executed.Executed(quick).by(FIRST) == [["b.py::slow", "c.py::quick", "a.py::wide[x]"]]
    assert executed.Executed(quick).by(SECOND) == [["a.py::wide[x]"]]


def test_the_nearest_files_come_first_with_more_tests_in_a_row(near):
    third = executed.SECONDS / 3
    tests = {f"{file}.py::{n}": {"seconds": third, "functions": [str(FIRST)] * n} for file in "ab" for n in (1, 2, 3)}
    assert executed.Executed(tests).by(FIRST)[0] == ["a.py::1", "a.py::2", "b.py::1"]
    near["b.py"] = 1
    assert executed.Executed(tests).by(FIRST) == [[f"{file}.py::{n}" for n in (1, 2, 3)] for file in "ba"]
    tests = {each: {**measured, "seconds": 1} for each, measured in tests.items()}
    assert executed.Executed(tests).by(FIRST) == [[f"{file}.py::{n}" for file in "ba" for n in (1, 2, 3)]]


def test_a_test_file_is_near_the_file_that_it_is_named_after_and_the_functions_that_it_names():
    found = {str(each): each for each in sources.functions()}
    axes = found["harness/sweeps/axes.py::Axes.names"]
    assert executed.nearness("tests/sweeps/test_axes.py", axes) == 2
    christoffel = found["maxima/derivation/christoffel.mac::christoffel_first_kind"]
    assert executed.nearness("tests/maxima/rtest_christoffel.mac", christoffel) == 2
    assert executed.nearness("tests/maxima/rtest_steps.mac", christoffel) == 1
    assert executed.nearness("tests/sweeps/test_axes.py", christoffel) == 0


def test_what_a_fixture_executes_asks_for_the_whole_file(near):
    tests = {each: {"seconds": 1, "functions": [str(FIRST)]} for each in ("a.py", "a.py::x", "b.py::y")}
    assert executed.Executed(tests).by(FIRST) == [["a.py", "b.py::y"]]


def test_a_function_that_was_not_measured_has_the_tests_of_its_callers(near):
    found = {str(each): each for each in sources.functions()}
    name, caller = "maxima/steps.mac::meaning_of", "maxima/steps.mac::require_meanings"
    tests = {"tests/a.mac": {"seconds": 1, "functions": [caller]}}
    assert executed.Executed(tests).by(found[name]) == [["tests/a.mac"]]
    assert executed.Executed(tests).by(OTHER) == []
    everything_of_maxima = {"tests/a.mac": {"seconds": 1, "functions": [name for name in found if ".py::" not in name]}}
    assert executed.Executed(everything_of_maxima).by(found["harness/sweeps/axes.py::Axes.names"]) == []


@pytest.mark.long
def test_marks_tell_what_a_test_executes_in_each_language(tmp_path):
    copy = Copy(tmp_path / "copy")
    executed.add_marks(copy)
    texts = [
        (copy.directory / path).read_text(encoding="utf-8") for path in {each.path for each in sources.functions()}
    ]
    marks = re.findall(r"(?:\(\?holonom_mark\(|\(holonom_mark |\.mark\()(\d+)\)", "\n".join(texts))
    assert sorted(map(int, marks)) == [*range(len(sources.functions()))]
    found = executed._executed_by(copy, executed.ROOT / "tests/maxima/rtest_christoffel.mac")
    functions = found["tests/maxima/rtest_christoffel.mac"]["functions"]
    called = "maxima/derivation/christoffel.mac::christoffel_first_kind", "maxima/language/one_pass.lisp::$gradient"
    assert set(called) <= set(functions)
    assert "maxima/control/servo.mac::servo_motion" not in functions
    passing = "tests/simulation/test_friction_with_reactions.py::test_without_a_reaction_there_is_no_friction"
    status, printed = copy.run(executed.LONGEST, passing)
    assert status == 0, printed
