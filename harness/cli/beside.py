"""Work in a child process while a command runs."""

import math
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing import Pipe, get_context
from multiprocessing.connection import Connection
from typing import Any

from ..failures import ErrorKind, HolonomError
from ..processes import die_with_parent


@contextmanager
def beside(work: Callable[..., Any], *arguments: Any) -> Iterator[Connection]:
    """Run work in a child process that ends with the block.

    The child is a copy of this process, which must not have other threads then.

    Parameters
    ----------
    work : callable
        Function to call in the child. Its first argument is the object sent to the child.
    *arguments : object
        Further arguments of the function.

    Yields
    ------
    Connection
        Connection to the child, for one object to send and for `result_of`.
    """
    connection, other_end = Pipe()
    child = get_context("fork").Process(target=_work, args=(os.getpid(), other_end, work, arguments), daemon=True)
    child.start()
    other_end.close()
    try:
        yield connection
    finally:
        child.kill()
        child.join()


def result_of(child: Connection, seconds: float = math.inf, otherwise: Any = None) -> Any:
    """Return the result of the work, or another value if it takes longer.

    Parameters
    ----------
    child : Connection
        Connection from `beside`.
    seconds : float
        Longest time to wait, in seconds.
    otherwise : object
        Value to return after that time.

    Returns
    -------
    object

    Raises
    ------
    HolonomError
        The child process ended without a result.
    Exception
        The exception of the work.
    """
    if math.isfinite(seconds) and not child.poll(max(seconds, 0)):
        return otherwise
    try:
        result = child.recv()
    except EOFError:
        raise HolonomError(ErrorKind.WORKER_ENDED) from None
    if isinstance(result, BaseException):
        raise result
    return result


def _work(parent: int, connection: Connection, work: Callable[..., Any], arguments: tuple[Any, ...]) -> None:
    die_with_parent(parent)
    try:
        connection.send(work(connection.recv(), *arguments))
    except Exception as error:
        connection.send(error)
