"""Maxima lines are taken from the source file as they stand there."""

import pytest

from holonom.companion import excerpts
from holonom.companion.excerpts import excerpt
from holonom.failures import ErrorKind, HolonomError

TEXT = """/* The head. */

/* Twice x; a comment may say f(x) := $ */
f(x) := block([s : "a $ b"],
  /* not; here */
  2*x)$

g : 7$ h(y) := y;
"""


@pytest.fixture(autouse=True)
def file(tmp_path, monkeypatch):
    (tmp_path / "file.mac").write_text(TEXT)
    monkeypatch.setattr(excerpts, "shared", lambda folder: tmp_path)
    return "maxima/file.mac"


def test_a_definition_comes_with_the_comment_above_it_and_ends_with_its_own_terminator(file):
    found = excerpt(file, "f")
    assert found.text == TEXT[TEXT.index("/* Twice") : TEXT.index("\n\ng :")]


def test_a_variable_is_defined_by_a_colon(file):
    assert excerpt(file, "g").text == "g : 7$"


def test_what_is_not_defined_is_missed_loudly(file):
    with pytest.raises(HolonomError) as caught:
        excerpt(file, "x")
    assert caught.value.kind is ErrorKind.DEFINITION_MISSING
