"""The changelog: one line an entry, Upgrading first."""

import re
from pathlib import Path

import pytest

TEXT = (Path(__file__).parents[1] / "CHANGELOG.md").read_text(encoding="utf-8")
RELEASES = re.split(r"^## ", TEXT, flags=re.MULTILINE)[1:]
ENTRIES = [line for line in TEXT.splitlines() if line.startswith("- ")]
WORDS, WIDTH = 22, 120  # an entry


def test_an_entry_is_one_short_line():
    assert ENTRIES
    assert [line for line in ENTRIES if len(line) > WIDTH or len(line.split()) > WORDS] == []
    assert re.findall(r"^ +\S.*", TEXT, re.MULTILINE) == []  # an entry has no second line


@pytest.mark.parametrize("release", [each for each in RELEASES if "### " in each], ids=lambda each: each.split()[0])
def test_a_release_begins_with_upgrading(release):
    assert re.search(r"^### (\w+)", release, re.MULTILINE)[1] == "Upgrading"


def test_no_entry_stands_twice():
    assert len(ENTRIES) == len(set(ENTRIES))
