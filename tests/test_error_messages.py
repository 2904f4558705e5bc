"""Messages of errors for a catalog: the text of the command line, and in Chinese no English words."""

import pickle
import re

import pytest

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
