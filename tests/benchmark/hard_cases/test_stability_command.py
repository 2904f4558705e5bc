"""holonom stability: one table, one figure, one document, and the status that tells whether a case fails."""

import json
import re
import xml.etree.ElementTree as ET

import pytest
from jsonschema import Draft202012Validator
from refusing import message_of

from holonom.benchmark.hard_cases import register
from holonom.benchmark.hard_cases.case import Case, Extent, Sweep, examined, graded, required
from holonom.cli import holonom
from holonom.document_types import schema
from holonom.explanations import advice
from holonom.failures import ErrorKind
from holonom.simulation.hard_cases import Difficulty


def shown(name: str, *found) -> Case:
    return Case(name, Difficulty.STIFF, "a truth told by hand", lambda extent: iter(found))


PASSED = shown(
    "passed",
    graded("plain", "place", 1.25, 6.0, compared=True),
    graded("ours", "place", 9.0, 6.0),
    required("ours", "reported", True),
    Sweep("angle", (0.1, 0.01), {"ours": (9.0, 8.0), "plain": (9.0, 7.0)}),
)
FAILED = shown("failed", graded("ours", "place", 5.0, 6.0))


def run(monkeypatch, cases, *arguments) -> int:
    monkeypatch.setattr(register, "REGISTER", cases)
    return holonom(["stability", *map(str, arguments)], standalone_mode=False)


def test_document_keeps_its_schema_and_tells_digits_verdicts_and_advice(monkeypatch, capsys):
    assert run(monkeypatch, (PASSED,), "--short", "--json", "-") == 0
    content = json.loads(capsys.readouterr().out)
    Draft202012Validator(schema("hard-cases")).validate(content)
    (case,) = content["cases"]
    assert [result["outcome"] for result in case["results"]] == ["loses it", "holds", "holds"]
    assert [result["digits"] for result in case["results"]] == [1.25, 9.0, None]
    assert case["sweep"]["digits"]["plain"] == [9.0, 7.0]
    assert case["advice"] == advice(Difficulty.STIFF)
    assert not case["fails"]


def test_a_failing_case_leaves_with_one(monkeypatch, capsys):
    assert run(monkeypatch, (PASSED, FAILED)) == 1
    table = capsys.readouterr().out
    assert table.count("fails") == 1
    assert advice(Difficulty.STIFF) in table


def test_figure_shows_every_method_and_is_the_same_twice(monkeypatch, tmp_path):
    files = tmp_path / "first.svg", tmp_path / "second.svg"
    for file in files:
        assert run(monkeypatch, (PASSED, FAILED), "--plot", file) == 1
    text = files[0].read_text()
    assert text == files[1].read_text()
    labels = " ".join(ET.fromstring(text).itertext())
    assert "plain: place" in labels
    assert "failed" in labels
    assert "angle" in labels


def test_the_suffix_of_a_figure_selects_png(monkeypatch, tmp_path):
    """It was an SVG document under that name."""
    assert run(monkeypatch, (PASSED,), "--plot", tmp_path / "figure.png") == 0
    assert (tmp_path / "figure.png").read_bytes().startswith(b"\x89PNG")


def test_figure_that_cannot_be_written_is_refused(monkeypatch, tmp_path, capsys):
    assert run(monkeypatch, (PASSED,), "--plot", tmp_path / "no" / "figure.svg") == 2
    assert re.search(message_of(ErrorKind.UNWRITABLE), capsys.readouterr().err)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("kind", Difficulty)
def test_advice_is_one_sentence_for_each_kind(kind):
    sentence = advice(kind)
    assert sentence[0].isupper()
    assert sentence.endswith(".")
    assert ". " not in sentence


def test_results_and_sweep_of_a_case_are_distinguished():
    assert examined(FAILED, Extent.SHORT).sweep is None
    report = examined(PASSED, Extent.SHORT)
    assert len(report.results) == 3
    assert report.sweep.variable == "angle"
