"""The runs of a book, performed by processes."""

import os

import pytest

from holonom.companion.chapter import Run
from holonom.companion.runs import perform
from holonom.failures import ErrorKind, HolonomError


def test_a_process_that_is_ended_is_one_sentence_and_the_fault_of_the_machine():
    with pytest.raises(HolonomError) as raised:
        perform([Run(os._exit, (9,)), Run(abs, (-1,))], lambda: None)
    assert raised.value.kind is ErrorKind.WORKER_ENDED
    assert raised.value.kind.status == 3
