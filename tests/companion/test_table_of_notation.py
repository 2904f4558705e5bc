"""The names in the table of notation are names: of Maxima functions, and of what a record holds."""

import re
from dataclasses import fields

import pytest
from pages import REPOSITORY

from holonom.companion import table
from holonom.record import Scene, System

PAGE = REPOSITORY / "harness" / "companion" / "book" / "notation.md"
ROW = re.compile(r"^\* - (?!paper).*\n  - .*\n  -.*\n  -(.*)\n  -(.*)$", re.MULTILINE)
ROWS = [[cell.strip(" `") for cell in row] for row in ROW.findall(PAGE.read_text(encoding="utf-8"))]
SYMBOLS = [{"maxima": maxima, "python": python} for maxima, python in ROWS]
RECORD = {
    name: {each.name for each in fields(kind)} | {*vars(kind)} for name, kind in (("system", System), ("scene", Scene))
}
WORDS = table("words")  # by the ids of equations
LIBRARY = [path.read_text(encoding="utf-8") for path in sorted((REPOSITORY / "maxima").rglob("*.[ml]*"))]


@pytest.mark.parametrize("function", [each["maxima"] for each in SYMBOLS if each["maxima"]])
def test_maxima_functions_are_defined(function):
    assert any(f"\n{function}(" in text or f"(defun ${function} (" in text for text in LIBRARY)


@pytest.mark.parametrize("path", [each["python"] for each in SYMBOLS])
def test_python_names_are_in_the_record(path):
    if path.startswith("equations["):
        assert path.split('"')[1] in WORDS
    else:
        owner, name = path.split(".")
        assert name in RECORD[owner]
