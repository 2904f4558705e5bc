"""Work of a child process while a command goes on."""

import math
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing import Pipe, get_context
from multiprocessing.connection import Connection
from typing import Any

from ..failures import Failure, HolonomError
from ..processes import die_with_parent


@contextmanager
def beside(work: Callable[..., Any], *arguments: Any) -> Iterator[Connection]:
    """Have a child do some work; it ends with the block.

    The child is a copy of this process, which must not have other threads then. It is sent one object, the first
    argument of the work, and sends back the result, which `result_of` takes.
    """
    ours, theirs = Pipe()
    child = get_context("fork").Process(target=_work, args=(os.getpid(), theirs, work, arguments), daemon=True)
    child.start()
    theirs.close()
    try:
        yield ours
    finally:
        child.kill()
        child.join()


def result_of(child: Connection, seconds: float = math.inf, otherwise: Any = None) -> Any:
    """Return what came of the work, or something else if it takes longer.

    Raises what it raised, and where the child ended.
    """
    if math.isfinite(seconds) and not child.poll(max(seconds, 0)):
        return otherwise
    try:
        result = child.recv()
    except EOFError:
        raise HolonomError(Failure.WORKER_ENDED) from None
    if isinstance(result, BaseException):
        raise result
    return result


def _work(parent: int, connection: Connection, work: Callable[..., Any], arguments: tuple[Any, ...]) -> None:
    die_with_parent(parent)
    try:
        connection.send(work(connection.recv(), *arguments))
    except Exception as error:
        connection.send(error)
