"""The tests of a mutant of Python are those that execute its function."""

from pathlib import Path

import pytest
import sources
from executed import SECONDS, Executed

FIRST, SECOND = [each for each in sources.functions() if each.language == "py"][:2]


def line_of(function: sources.Function) -> int:
    return sources.read(function.path).count("\n", 0, function.start) + 1


@pytest.fixture
def measured(tmp_path, monkeypatch) -> Executed:
    """A measurement of two functions: one test executes both, two the first alone."""
    monkeypatch.setattr(Executed, "_files", lambda self: [Path(__file__)])
    monkeypatch.setattr(Executed, "_measure", lambda self, file: None)
    found = Executed(tmp_path, jobs=1)
    file = found._data(Path(__file__))
    data = pytest.importorskip("coverage").CoverageData(str(file))
    for test, functions in {"a.py::wide[x]": (FIRST, SECOND), "b.py::slow": (FIRST,), "c.py::quick": (FIRST,)}.items():
        data.set_context(f"{test}|run")
        for function in functions:
            data.add_lines({str(sources.ROOT / function.path): [line_of(function)]})
    data.write()
    times = f"{2 * SECONDS:.2f}s call     b.py::slow\n0.30s setup    c.py::quick\n1 passed\n"
    file.with_suffix(".txt").write_text(times, encoding="utf-8")
    return found


def test_the_most_specific_tests_come_first_while_there_is_time(measured):
    assert measured.by(FIRST) == ["b.py::slow"], "one at least, whatever it takes"
    measured.times = {}
    assert measured.by(FIRST) == ["b.py::slow", "c.py::quick", "a.py::wide[x]"]
    assert measured.by(SECOND) == ["a.py::wide[x]"]


def test_no_test_executes_a_function_that_none_calls(measured):
    other = next(each for each in sources.functions() if each.language == "py" and each.path != FIRST.path)
    assert measured.by(other) == []
