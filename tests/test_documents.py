"""Documents: every one has a schema, keeps it, and is refused where it does not."""

import gc
import json
from dataclasses import replace
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from refusing import failing

from holonom.document_types import TYPES, schema
from holonom.documents import Question, ask, ask_all
from holonom.errata import Errata
from holonom.failures import ErrorKind, HolonomError
from holonom.formats import Document, Publication, is_document, nothing_collected, read
from holonom.maxima import DEFAULT_LIMITS, run_description
from holonom.record import Record
from holonom.source import Source

EXAMPLES = Path(__file__).parents[1] / "examples"
PAPER, PENDULUM = EXAMPLES / "paper" / "paper.mac", EXAMPLES / "pendulum.mac"


@pytest.mark.parametrize("name", [*Document, *Publication])
def test_every_document_has_a_schema_that_names_its_format(name):
    found = schema(name)
    Draft202012Validator.check_schema(found)
    assert found["properties"]["format"] == {"const": f"holonom-{name}"}
    assert found["properties"]["version"] == {"const": 2}


def test_every_schema_is_that_of_a_document():
    assert TYPES.keys() == {*Document, *Publication}


@pytest.mark.parametrize(
    ("document", "file", "arguments"),
    [
        (Document.RECORD, PENDULUM, ()),
        (Document.PROGRAM, PENDULUM, (None, "direct")),
        (Document.EFFECTS, PENDULUM, (None, "direct")),
        (Document.MODEL, PENDULUM, (None, "direct", ("m",))),
        (Document.MOTION_PROBLEM, PENDULUM, (None, "orthogonal", 17, (), ())),
        (Document.MOTION_PROBLEM, PENDULUM, (None, "direct", 17, ("l0", "N"), ("response",))),
        (Document.MOTION_SERIES, PAPER, ("initial_motion_scene", 6, "exact", None)),
        (Document.SERIES_COSTS, PAPER, (None, (2, 4), 20)),
        (Document.FREE_MOTION, PAPER, (None, None)),
    ],
)
def test_maxima_writes_what_the_schema_says(document, file, arguments):
    assert isinstance(read(document, ask(document, file, *arguments), TYPES[document]), TYPES[document])


@pytest.mark.parametrize(
    "command",
    [
        ("series", str(PAPER), "--order", "12", "--at", "1/10"),
        ("series", str(PENDULUM), "--order", "12", "--precision", "double", "--until", "1"),
        ("simulate", str(PENDULUM), "--samples", "5"),
        ("simulate", str(EXAMPLES / "linkage.mac"), "--until", "1", "--final"),
        ("check", str(PENDULUM)),
        ("effects", str(PENDULUM)),
        ("free", str(PAPER)),
        ("free", str(PENDULUM)),
    ],
)
def test_commands_publish_what_the_schema_says(command, holonom_here):
    content = json.loads(holonom_here(*command, "--json", "-").stdout)
    Draft202012Validator(schema(content["format"].removeprefix("holonom-"))).validate(content)


def test_what_has_another_shape_is_refused_where_it_differs():
    with failing(ErrorKind.NOT_A_DOCUMENT, "$.equations[0]"):
        read(Document.ERRATA, '{"format": "holonom-errata", "version": 2, "equations": [2]}', Errata)


ENVELOPE = {"format": "holonom-check", "version": 2}


@pytest.mark.parametrize(
    ("content", "ours"),
    [
        (ENVELOPE, True),
        ([ENVELOPE, ENVELOPE], True),
        ({"name": "mine"}, False),
        ({**ENVELOPE, "format": "holonom-thesis"}, False),
        ({**ENVELOPE, "format": ["holonom-check"]}, False),
        ({**ENVELOPE, "version": 1}, False),
        ({"mine": ENVELOPE}, False),
        ([], False),
        ([ENVELOPE, "mine"], False),
    ],
)
def test_a_document_is_known_by_its_envelope(content, ours):
    assert is_document(json.dumps(content).encode()) is ours


@pytest.mark.parametrize("text", [b'{"format": "holonom-check", "version": 2', b"\xff\xfe", b"[" * 100_000, b""])
def test_what_is_no_json_is_no_document(text):
    assert not is_document(text)


@pytest.mark.parametrize("scene", ["", "a b", "quit()", "1x", "x;", "x\ny"])
def test_what_is_no_name_never_reaches_maxima(scene):
    with pytest.raises(HolonomError) as raised:
        ask(Document.FREE_MOTION, PAPER, scene)
    assert raised.value.kind is ErrorKind.NOT_A_SCENE_NAME


def test_one_run_writes_the_documents_of_several():
    source = Source(EXAMPLES / "pendulum.mac")
    scene = source.description().scenes[-1].name
    no_series = Question(Document.MOTION_SERIES, (scene, -1, "automatic", None))
    questions = [
        Question(Document.RECORD),
        no_series,
        Question(Document.PROGRAM, (scene, "orthogonal")),
        Question(Document.MOTION_SERIES, (scene, 5, "automatic", None)),
        Question(Document.RECORD),
    ]
    together = ask_all(questions, source)
    alone = [answer for each in questions for answer in ask_all([each], source)]
    refusals = [(each.kind, each.refusal, each.detail) for each in (together.pop(1), alone.pop(1))]
    assert refusals[0] == refusals[1]
    assert refusals[0][0] is ErrorKind.REFUSED
    assert together == alone


def test_documents_written_before_a_limit_are_valid():
    description = Source(EXAMPLES / "bead.mac").description()
    endless = "lambda([file], do print(file))"
    writers = ["write_record", endless, "write_record"]
    limits = replace(DEFAULT_LIMITS, output_mib=1)
    record, *broken_off = run_description(description.text, description.file, writers, limits, None)
    read(Document.RECORD, record, Record)
    assert [each.kind for each in broken_off] == [ErrorKind.TOO_MUCH_TEXT] * 2


@nothing_collected()
def collecting_while_divided_by(number):
    return number / number and gc.isenabled()


@pytest.mark.parametrize("collects", [True, False])
def test_nothing_is_collected_while_a_document_is_read_and_then_as_before(collects):
    (gc.enable if collects else gc.disable)()
    try:
        assert (collecting_while_divided_by(1), gc.isenabled()) == (False, collects)
        with pytest.raises(ZeroDivisionError):
            collecting_while_divided_by(0)
        assert gc.isenabled() == collects
    finally:
        gc.enable()
