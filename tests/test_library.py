"""The Maxima library as a whole: one namespace."""

import re
from collections import Counter

from holonom.maxima import LIBRARY

DEFINITION = re.compile(r"^(\w+)\([^()]*\)\s*:=", re.MULTILINE)
LISP_DEFINITION = re.compile(r"^\(def(?:un|macro) (\S+)", re.MULTILINE)


def test_no_function_is_defined_twice():
    maxima = "\n".join(file.read_text() for file in LIBRARY.rglob("*.mac"))
    lisp = "\n".join(file.read_text() for file in LIBRARY.rglob("*.lisp"))
    names = [*DEFINITION.findall(maxima), *(name.lstrip("$") for name in LISP_DEFINITION.findall(lisp))]
    assert [name for name, times in Counter(names).items() if times > 1] == []
