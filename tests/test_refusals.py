"""Each refusal of the library: its id is met by what asks for it, its message is as written, and none lacks a row."""

import json
import re
import tomllib
from pathlib import Path

import pytest
from refusing import english_in

from holonom.language import Message, speaking, translated
from holonom.maxima import LIBRARY, run_batch

CASES = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
ROWS: dict[str, list[dict[str, str]]] = CASES["refusals"]
SOURCES = [file for ending in ("mac", "lisp") for file in sorted(Path(LIBRARY).rglob(f"*.{ending}"))]
NEGATIVE = re.compile(r"-\((\w+[*/]\w+)\)")  # as Maxima 5.47 and later write -4/5
ASKING = """
met : []$
asks(%asked) := met : endcons(
  json_array(readable(refusal_of(%asked)), message_of_error(), json_reason(last_refusal@message)), met)$
write_met(%file) := write_json(apply('json_array, met), %file)$
"""


def asked() -> str:
    return "".join(f"asks(lambda([], {row['asked']}))$\n" for rows in ROWS.values() for row in rows)


@pytest.fixture(scope="module")
def answers(tmp_path_factory) -> dict[str, list[list[str]]]:
    """Return the id and the message that each case meets, all in one run."""
    folder = tmp_path_factory.mktemp("refusals")
    for name, content in CASES["files"].items():
        (folder / name).write_text(content, encoding="utf-8")
    (folder / "asked.mac").write_text(ASKING + CASES["before"] + asked(), encoding="utf-8")
    file = folder / "cases.mac"
    file.write_text(f'load("holonom.mac")$ open_namespace()$ load("{folder}/asked.mac")$', encoding="utf-8")
    met = iter(json.loads(run_batch(file, "write_met")))
    return {refusal: [next(met) for _ in rows] for refusal, rows in ROWS.items()}


@pytest.mark.parametrize("refusal", ROWS)
def test_a_refusal_has_its_id_and_its_messages(answers, refusal):
    met = [[kind, NEGATIVE.sub(r"-\1", message)] for kind, message, _ in answers[refusal]]
    assert met == [[refusal, row["message"]] for row in ROWS[refusal]]


@pytest.mark.parametrize("refusal", ROWS)
def test_a_refusal_has_no_english_words_in_chinese(answers, refusal):
    for _, message, parts in answers[refusal]:
        assert str(made := Message.of_document(parts)) == message
        with speaking("zh"):
            assert english_in(translated(made)) == []


def test_each_refusal_has_a_case():
    table = (Path(LIBRARY) / "refusals.mac").read_text(encoding="utf-8")
    assert list(ROWS) == re.findall(r"^  \['(\w+),", table, re.MULTILINE)


def test_each_refusal_is_of_the_table():
    used = {id for file in SOURCES for id in re.findall(r"refuse\(?\s*'\$?(\w+)", file.read_text(encoding="utf-8"))}
    assert used == set(ROWS)


@pytest.mark.parametrize("file", SOURCES, ids=lambda file: str(file.relative_to(LIBRARY)))
def test_no_error_is_raised_elsewhere(file):
    found = re.findall(r"(?<![\w$])error\(|\(merror\b|\(\$error\b", file.read_text(encoding="utf-8"))
    assert len(found) == {"refusals.lisp": 1, "refusals.mac": 2}.get(file.name, 0)
