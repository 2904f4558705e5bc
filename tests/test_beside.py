"""Work of a child process beside a command."""

import os
import signal
import time

import pytest

from holonom.cli.beside import beside, result_of
from holonom.failures import ErrorKind, HolonomError


def refused(_: object) -> None:
    raise HolonomError(ErrorKind.REFUSED, "scene.mac:3", "no such mass", refusal="unknown_entry")


def ended(_: object) -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def test_result_comes_back():
    with beside(pow, 3) as child:
        child.send(2)
        assert result_of(child) == 8


def test_errors_are_raised_here():
    with beside(refused) as child:
        child.send(None)
        with pytest.raises(HolonomError) as error:
            result_of(child)
    assert (error.value.kind, error.value.place, error.value.refusal) == (
        ErrorKind.REFUSED,
        "scene.mac:3",
        "unknown_entry",
    )


def test_child_that_is_ended_is_reported():
    with beside(ended) as child:
        child.send(None)
        with pytest.raises(HolonomError) as error:
            result_of(child)
    assert error.value.kind is ErrorKind.WORKER_ENDED


def test_child_ends_with_the_block():
    with beside(lambda _: os.getpid()) as child:
        child.send(None)
        number = result_of(child)
    with pytest.raises(ProcessLookupError):
        os.kill(number, 0)
    with beside(time.sleep) as child:
        child.send(1000)


def test_result_that_takes_too_long_is_another():
    with beside(time.sleep) as child:
        child.send(1000)
        assert result_of(child, 0.01, "too long") == "too long"
