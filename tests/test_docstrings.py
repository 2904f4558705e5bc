"""Examples in docstrings print what they say."""

import doctest
from importlib import import_module
from pathlib import Path

import pytest

import holonom

PACKAGE = Path(holonom.__file__).parent
WITH_EXAMPLES = [file for file in sorted(PACKAGE.rglob("*.py")) if ">>> " in file.read_text(encoding="utf-8")]


@pytest.mark.parametrize("file", WITH_EXAMPLES, ids=lambda file: file.relative_to(PACKAGE).as_posix())
def test_examples_print_what_they_say(file):
    name = ".".join(("holonom", *file.relative_to(PACKAGE).with_suffix("").parts))
    found = doctest.testmod(import_module(name))
    assert found.attempted > 0
    assert found.failed == 0
