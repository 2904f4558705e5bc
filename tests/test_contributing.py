"""The tests that CONTRIBUTING names for the architecture rules exist."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[1]


TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")


def section(title):
    return re.search(rf"^## {title}\n(.*?)(?=^## )", TEXT, re.MULTILINE | re.DOTALL)[1]


def test_the_tests_of_the_architecture_rules_exist():
    named = re.findall(r"`(tests/[\w/]+\.py)::(\w+)`", TEXT)
    rules = re.findall(r"^\d+\. .*", section("Architecture rules"), re.MULTILINE)
    assert len(named) == len(rules) > 9
    assert [(file, test) for file, test in named if f"def {test}(" not in (ROOT / file).read_text()] == []


def test_every_folder_of_the_package_is_in_the_layout():
    folders = {path.name for path in (ROOT / "harness").iterdir() if path.is_dir() and path.name != "__pycache__"}
    assert {name for name in folders if f"](harness/{name})" not in section("Project layout")} == set()


def test_every_link_leads_to_a_file():
    links = re.findall(r"\]\(([^)]+)\)", TEXT)
    assert links
    assert [link for link in links if not (ROOT / link).exists()] == []
