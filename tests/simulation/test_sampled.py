"""Samples of a motion: each quantity is one column under its name, and parts are put together in order."""

import numpy as np

from holonom.simulation.result import Sampled, joined

NAMES = {
    "coordinates": "x",
    "velocities": "dot(x)",
    "multipliers": "lambda1",
    "constraint_forces": "Lambda[1]",
    "energy": "energy",
    "residuals": "position",
    "controls": "u",
    "outputs": "height",
    "sensitivities": "d(x, m)",
}


def sampled(first: float) -> Sampled:
    groups = {group: {name: first + place + np.arange(3.0)} for place, (group, name) in enumerate(NAMES.items(), 1)}
    return Sampled(times=first + np.arange(3.0), **groups)


def test_every_quantity_is_a_column_with_the_time_first():
    columns = dict(sampled(0).columns())
    assert next(iter(columns)) == "t"
    assert list(columns)[-1] == "residual.position"
    assert set(columns) == {"t", "residual.position", *NAMES.values()} - {"position"}
    expected = {name: 1 + place for place, name in enumerate(NAMES.values())} | {"t": 0, "residual.position": 6}
    assert {name: samples[0] for name, samples in columns.items()} == {name: expected[name] for name in columns}
    assert list(sampled(0).residual_columns()) == ["residual.position"]


def test_parts_are_joined_in_order():
    whole = joined([sampled(0), sampled(3), sampled(6)])
    assert whole.times.tolist() == list(range(9))
    for group, (name, samples) in zip(NAMES, [next(iter(getattr(whole, each).items())) for each in NAMES], strict=True):
        first = getattr(sampled(0), group)[name][0]
        assert samples.tolist() == (first + np.arange(9.0)).tolist()
    assert joined([sampled(2)]).times.tolist() == [2, 3, 4]
