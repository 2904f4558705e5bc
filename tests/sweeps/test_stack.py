"""The place on the stack at which functions are called."""

from functools import partial

import pytest

from holonom.sweeps import stack
from holonom.sweeps.stack import PLACES, TRIALS, FastestPlace


@pytest.mark.parametrize("fastest", range(len(PLACES)))
def test_the_fastest_place_is_taken_after_the_trials(monkeypatch, fastest):
    """Truth: a clock that each place advances by its own time."""
    clock, called = [0.0], []

    def at(place: int):
        def call(function):
            clock[0] += 1.0 if place == fastest else 2.0
            called.append(place)
            return function()

        return call

    monkeypatch.setattr(stack, "PLACES", tuple(map(at, range(len(PLACES)))))
    monkeypatch.setattr(stack, "perf_counter", lambda: clock[0])
    caller = FastestPlace()
    results = [caller.call(partial(int, str(number))) for number in range(40)]
    assert results == list(range(40))
    assert [called.count(place) for place in range(len(PLACES))].count(TRIALS) == len(PLACES) - 1
    assert set(called[TRIALS * len(PLACES) :]) == {fastest}
