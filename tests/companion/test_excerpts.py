"""Maxima lines are taken from the source file as they stand there."""

import pytest

from holonom.companion.excerpts import STEPS, excerpt, step
from holonom.companion.paper import REPOSITORY
from holonom.failures import ErrorKind, HolonomError

TEXT = """/* The head. */

/* Twice x; a comment may say f(x) := $ */
f(x) := block([s : "a $ b"],
  /* not; here */
  2*x)$

g : 7$ h(y) := y;
"""


@pytest.fixture
def root(tmp_path):
    (tmp_path / "file.mac").write_text(TEXT)
    return tmp_path


def test_a_definition_comes_with_the_comment_above_it_and_ends_with_its_own_terminator(root):
    found = excerpt(root, "file.mac", "f")
    assert found.first_line == 3
    assert found.text == TEXT[TEXT.index("/* Twice") : TEXT.index("\n\ng :")]


def test_a_variable_is_defined_by_a_colon(root):
    assert excerpt(root, "file.mac", "g").text == "g : 7$"


def test_what_is_not_defined_is_missed_loudly(root):
    with pytest.raises(HolonomError) as caught:
        excerpt(root, "file.mac", "x")
    assert caught.value.kind is ErrorKind.DEFINITION_MISSING


@pytest.mark.parametrize("key", STEPS)
def test_every_step_of_the_paper_is_found_in_the_library(key):
    for found in step(REPOSITORY, key):
        assert found.text.splitlines()[-1].endswith("$")
        assert f"\n{found.name}" in f"\n{found.text}"
