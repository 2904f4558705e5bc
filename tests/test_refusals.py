"""Each refusal of the library: its id is met by what asks for it, its message is as written, and none lacks a row."""

import json
import re
import tomllib
from pathlib import Path

import pytest

from holonom.maxima import LIBRARY, run_batch

CASES = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
ROWS: dict[str, dict[str, str]] = CASES["refusals"]
SOURCES = [file for ending in ("mac", "lisp") for file in sorted(Path(LIBRARY).rglob(f"*.{ending}"))]
ASKING = """
met : []$
asks(id, %asked) := met : endcons(json_array(readable(id), readable(refusal_of(%asked)),
  if last_refusal = false then "" else last_refusal@message), met)$
write_met(%file) := write_json(apply('json_array, met), %file)$
"""


def asked() -> str:
    return "".join(f"asks('{id}, lambda([], {row['asked']}))$\n" for id, row in ROWS.items())


@pytest.fixture(scope="module")
def answers(tmp_path_factory) -> dict[str, list[str]]:
    """Return the id and the message that each row meets, all in one run."""
    folder = tmp_path_factory.mktemp("refusals")
    for name, content in CASES["files"].items():
        (folder / name).write_text(content, encoding="utf-8")
    (folder / "asked.mac").write_text(ASKING + CASES["before"] + asked(), encoding="utf-8")
    file = folder / "cases.mac"
    file.write_text(f'load("holonom.mac")$ open_namespace()$ load("{folder}/asked.mac")$', encoding="utf-8")
    return {id: answer for id, *answer in json.loads(run_batch(file, "write_met"))}


@pytest.mark.parametrize("refusal", ROWS)
def test_a_refusal_has_its_id_and_its_message(answers, refusal):
    assert answers[refusal] == [refusal, ROWS[refusal]["message"]]


def test_each_refusal_has_a_case():
    table = (Path(LIBRARY) / "refusals.mac").read_text(encoding="utf-8")
    assert list(ROWS) == re.findall(r"^  \['(\w+),", table, re.MULTILINE)


def test_each_refusal_is_of_the_table():
    used = {id for file in SOURCES for id in re.findall(r"refuse\(?\s*'\$?(\w+)", file.read_text(encoding="utf-8"))}
    assert used == set(ROWS)


@pytest.mark.parametrize("file", SOURCES, ids=lambda file: str(file.relative_to(LIBRARY)))
def test_no_error_is_raised_elsewhere(file):
    found = re.findall(r"(?<![\w$])error\(|\(merror\b|\(\$error\b", file.read_text(encoding="utf-8"))
    assert len(found) == {"refusals.lisp": 1, "refusals.mac": 1}.get(file.name, 0)
