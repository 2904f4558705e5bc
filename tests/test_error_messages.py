"""Messages of errors for a catalog: the text of the command line, and in Chinese no English words."""

import ast
import pickle
import re
from pathlib import Path

import pytest

import holonom
from holonom.error_messages import ARGUMENTS, translatable_error
from holonom.failures import ErrorKind, HolonomError
from holonom.language import speaking, translated

FACTS = {"time": 1.5, "multiplier": "lambda1", "package": "numpy", "named": "holonom[motion]", "example": "m=1,2"}
ENGLISH_PROSE = re.compile(r"[A-Za-z]{2,} [a-z]{2,}")


@pytest.mark.parametrize("kind", ErrorKind, ids=lambda kind: kind.name)
def test_an_error_has_no_english_words_in_chinese(kind):
    error = HolonomError(kind, "scene.mac:3", "12", option="--until", **FACTS)
    message = translatable_error(error)
    assert str(message).startswith(f"scene.mac:3: until: {error.reason}")
    with speaking("zh"):
        shown = translated(pickle.loads(pickle.dumps(message)))
    code = rf"`[^`]+`|\w+=\S+|(?<![A-Za-z])({'|'.join({*ARGUMENTS.values()})}) "  # an argument stands before its value
    assert ENGLISH_PROSE.findall(re.sub(code, "", shown)) == []
    assert shown != message


def details():
    """Yield each detail of an error that the sources write down, with its file and line."""
    for file in sorted(Path(holonom.__file__).parent.rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "HolonomError":
                given = [*node.args[2:3], *(each.value for each in node.keywords if each.arg == "detail")]
                yield from ((f"{file.name}:{node.lineno}", each) for each in given)


def test_a_detail_in_words_is_a_message_of_the_catalog():
    """Words in a plain string stay English on a Chinese page; names and values have no place in a catalog."""
    written = [
        (place, ast.unparse(each)) for place, each in details() if isinstance(each, ast.Constant | ast.JoinedStr)
    ]
    assert written
    assert [each for each in written if ENGLISH_PROSE.search(re.sub(r"\{[^}]*\}", "", each[1]))] == []
