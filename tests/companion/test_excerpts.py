"""Statements of scene files are taken from them as they stand there."""

import pytest

from holonom.companion import pages
from holonom.companion.pages import excerpt
from holonom.failures import ErrorKind, HolonomError

TEXT = """/* The head. */

f : block([s : "a $ b"],
  /* not; here */
  2*x)$

g : 7$ h : y;
"""


@pytest.fixture(autouse=True)
def file(tmp_path, monkeypatch):
    (tmp_path / "file.mac").write_text(TEXT)
    monkeypatch.setattr(pages, "EXAMPLES", tmp_path)
    return "file.mac"


def test_a_statement_ends_with_its_own_terminator(file):
    assert excerpt(file, "f") == TEXT[TEXT.index("f :") : TEXT.index("\n\ng :")]
    assert excerpt(file, "g") == "g : 7$"


def test_what_is_not_assigned_is_missed_loudly(file):
    with pytest.raises(HolonomError) as caught:
        excerpt(file, "x")
    assert caught.value.kind is ErrorKind.DEFINITION_MISSING
