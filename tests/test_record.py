"""The derivation record: what Maxima writes is read whole, and anything else is refused."""

import json

import pytest
from sympy import Rational, Symbol

from holonom.failures import Failure, HolonomError
from holonom.record import read_record

z, u = Symbol("z", real=True), Symbol("u", real=True)


def test_reads_what_maxima_writes(particle_record):
    record = read_record(particle_record)
    assert record.system.coordinates == ("x", "z")
    assert record.system.velocities == ("dot(x)", "dot(z)")
    assert record.system.constraints == (z - u,)
    assert [scene.name for scene in record.scenes] == ["rise"]
    assert Rational(1, 3) in record.scenes[0].initial_state.values()
    (constraint,) = record.derivations[0].equations[0].relations
    assert (constraint.left, constraint.right) == (z - u, 0)


@pytest.mark.parametrize("text", ["", "{", "[]", '{"format": "holonom-record"}', "[" * 100_000])
def test_refuses_what_is_no_record(text):
    with pytest.raises(HolonomError) as raised:
        read_record(text)
    assert raised.value.failure is Failure.NOT_A_DOCUMENT


@pytest.mark.parametrize(
    ("place", "value"),
    [
        (["version"], 2),
        (["surprise"], 1),
        (["system", "coordinates"], "x"),
        (["system", "constraints", 0], None),
        (["system", "constraints", 0], ["eval", "x"]),
        (["scenes", 0, "derivation"], 7),
        (["scenes", 0, "time_span"], [0]),
        (["derivations", 0, "equations", 0, "relations", 0], {"left": 1}),
    ],
)
def test_refuses_a_record_with_one_thing_wrong(place, value, particle_record):
    document = json.loads(particle_record)
    *path, last = place
    target = document
    for key in path:
        target = target[key]
    target[last] = value
    with pytest.raises(HolonomError) as raised:
        read_record(json.dumps(document))
    assert "\n" not in str(raised.value)
