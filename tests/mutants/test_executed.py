"""The tests of a mutant are those that execute its function."""

import re

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


def test_the_most_specific_tests_come_first_while_there_is_time():
    assert executed.Executed(TESTS).by(FIRST) == ["b.py::slow"], "one at least, whatever it takes"
    quick = {**TESTS, "b.py::slow": {**TESTS["b.py::slow"], "seconds": 1}}
    assert executed.Executed(quick).by(FIRST) == ["b.py::slow", "c.py::quick", "a.py::wide[x]"]
    assert executed.Executed(quick).by(SECOND) == ["a.py::wide[x]"]


def test_a_function_that_was_not_measured_has_the_tests_of_its_callers():
    found = {str(each): each for each in sources.functions()}
    name, caller = "maxima/steps.mac::meaning_of", "maxima/steps.mac::require_meanings"
    tests = {"tests/a.mac": {"seconds": 1, "functions": [caller]}}
    assert executed.Executed(tests).by(found[name]) == ["tests/a.mac"]
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
    marks = re.findall(r"(?:\(\?mark\(|\(mark |\.mark\()(\d+)\)", "\n".join(texts))
    assert sorted(map(int, marks)) == [*range(len(sources.functions()))]
    found = executed._executed_by(copy, executed.ROOT / "tests/maxima/rtest_christoffel.mac")
    functions = found["tests/maxima/rtest_christoffel.mac"]["functions"]
    called = "maxima/derivation/christoffel.mac::christoffel_first_kind", "maxima/language/one_pass.lisp::$gradient"
    assert set(called) <= set(functions)
    assert "maxima/control/servo.mac::servo_motion" not in functions
