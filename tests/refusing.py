"""Errors by their kinds, refusals of the library in Maxima by their ids: no words of theirs. English in Chinese."""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from string import Formatter

import pytest

from holonom.failures import ErrorKind, HolonomError

ENGLISH_PROSE = re.compile(r"[A-Za-z]{2,} [a-z]{2,}")
CODE = re.compile(r"`[^`]+`|holonom [a-z-]+|\w+=\S+|if t < 2 then")


def english_in(text: str) -> list[str]:
    """Return the first words of English prose in a Chinese text; commands and code in Maxima are none."""
    return ENGLISH_PROSE.findall(CODE.sub("", text))


@contextmanager
def refused(refusal: str) -> Iterator[None]:
    """Assert that what is done inside ends with a refusal of this id."""
    with pytest.raises(HolonomError) as caught:
        yield
    assert caught.value.refusal == refusal


@contextmanager
def failing(kind: ErrorKind, *facts: str) -> Iterator[pytest.ExceptionInfo[HolonomError]]:
    """Assert that the block ends with an error of this kind that names these facts, each as a whole word or more."""
    with pytest.raises(HolonomError) as caught:
        yield caught
    assert caught.value.kind is kind
    told = f"{caught.value.reason} {caught.value.detail}"
    assert [fact for fact in facts if not re.search(_whole(fact), told)] == []


def message_of(kind: ErrorKind | None, *facts: str) -> str:
    """Return the pattern of a command's message of this kind that names these facts. None: about the command line."""
    looks = "".join(f"(?=.*{_whole(fact)})" for fact in facts)
    text = _pattern(kind.reason) if kind else ".+"
    if kind and text == ".*" and kind.hints:  # what is wrong is in the detail
        text += f" .*(?i:{'|'.join(map(_pattern, kind.hints))})"
    return f"(?m)^holonom: error: {looks}(?:.*: )?{text}"


def _whole(fact: str) -> str:
    return rf"(?<!\w){re.escape(fact)}(?!\w)"


def _pattern(template: str) -> str:
    return "".join(
        re.escape(text) + (".*" if name is not None else "") for text, name, *_ in Formatter().parse(template)
    )
