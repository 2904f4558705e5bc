"""The derivation record: what Maxima writes is read whole, and anything else is refused."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from sympy import Rational, Symbol

from holonom.documents import ask
from holonom.failures import ErrorKind, HolonomError
from holonom.formats import VERSION, Document
from holonom.record import read_record

CHAIN = Path(__file__).parents[1] / "examples" / "chain.mac"
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
    assert raised.value.kind is ErrorKind.NOT_A_DOCUMENT


@pytest.mark.parametrize(
    ("place", "value"),
    [
        (["version"], VERSION + 1),
        (["surprise"], 1),
        (["system", "coordinates"], "x"),
        (["system", "constraints", 0], None),
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


def test_refuses_what_is_no_expression_when_it_is_asked_for(particle_record):
    document = json.loads(particle_record)
    document["system"]["constraints"][0] = ["eval", "x"]
    document["scenes"][0]["initial_state"]["x"] = ["eval", "x"]
    record = read_record(json.dumps(document))
    for question in (lambda: record.system.constraints, lambda: record.scenes[0].initial_state["x"]):
        with pytest.raises(HolonomError) as raised:
            question()
        assert raised.value.kind is ErrorKind.NOT_AN_EXPRESSION


@pytest.mark.parametrize(
    ("force", "x", "speed", "numbers"),
    [
        ("1 - signum(dot(x))/2", 0, 0, ["13", "18"]),
        ("1 - signum(dot(x))/2", 0, 1, []),
        ("1 - abs(dot(x))*dot(x)", 0, 0, []),  # the jump is in the fourth derivative
        ("-abs(x)", 0, 1, ["18"]),
        ("-max(abs(x) - 1, 0)", 0, 1, []),
        ("-max(abs(x) - 1, 0)", 1, 1, ["18"]),
    ],
)
def test_series_were_shown_for_starts_at_which_a_sign_jumps(force, x, speed, numbers, write_scene):
    file = write_scene(f"""load("holonom.mac")$
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [{force}])$
push : holonomic_scene(system, initial_state = [x = {x}, dot(x) = {speed}])$
""")
    (scene,) = read_record(ask(Document.RECORD, file)).scenes
    assert [equation.number for equation in scene.equations if scene.jumping(equation)] == numbers


def test_the_record_of_a_chain_grew_with_the_square_of_its_length():
    lengths = [len(ask(Document.RECORD, CHAIN, settings={"N": str(links)})) for links in (16, 32)]
    assert lengths[1] < 2.2 * lengths[0]


def test_reading_and_printing_a_record_imported_sympy(particle_record):
    program = (
        "import sys; from rich.console import Console; from holonom.record import read_record; "
        "from holonom.display.derivation import show_record; "
        "show_record(Console(), read_record(sys.stdin.read())); assert 'sympy' not in sys.modules"
    )
    done = subprocess.run([sys.executable, "-c", program], input=particle_record, text=True, capture_output=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert "(11) accelerations" in done.stdout
