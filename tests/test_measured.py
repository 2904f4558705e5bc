"""The list of tests that take more than a second names tests that exist."""

import ast
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1]
MEASURED = Path(__file__).with_name("measured.txt").read_text(encoding="utf-8").splitlines()


@cache
def functions(path):
    """Return the names of a file's test functions, with their classes, as pytest joins them."""
    body = ast.parse((ROOT / path).read_text(encoding="utf-8")).body
    inside = {
        f"{each.name}::{f.name}"
        for each in body
        if isinstance(each, ast.ClassDef)
        for f in each.body
        if hasattr(f, "name")
    }
    return inside | {each.name for each in body if isinstance(each, ast.FunctionDef)}


def test_each_name_is_that_of_a_test():
    named = {tuple(each.partition("[")[0].split("::", 1)) for each in MEASURED}
    assert named
    assert [each for each in named if each[1] not in functions(each[0])] == []
