"""Errors by their kinds, refusals of the library in Maxima by their ids: no words of theirs."""

import re
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from holonom.failures import ErrorKind, HolonomError


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
    assert [fact for fact in facts if not re.search(rf"(?<!\w){re.escape(fact)}(?!\w)", told)] == []
