"""The refusals of the library in Maxima, by their ids."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from holonom.failures import HolonomError


@contextmanager
def refused(refusal: str) -> Iterator[None]:
    """Assert that what is done inside ends with a refusal of this id."""
    with pytest.raises(HolonomError) as caught:
        yield
    assert caught.value.refusal == refusal
