"""The measurement of a function's time, by a clock that the function itself advances."""

from types import SimpleNamespace

import pytest

from holonom.program import timing


@pytest.mark.parametrize(("calls", "each"), [(1, 0.5), (8, 0.25)])
def test_a_batch_calls_as_often_as_asked_and_tells_the_seconds_of_one_call(calls, each, monkeypatch):
    met, now = [], [3.0]

    def function(point):
        met.append(point)
        now[0] += each

    monkeypatch.setattr(timing, "time", SimpleNamespace(perf_counter=lambda: now[0]))
    assert timing.python_batch(function, [1.0, 2.0])(calls) == each
    assert met == [[1.0, 2.0]] * calls
