"""Work of a thread of its own while a command waits for Maxima."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Thread


@contextmanager
def meanwhile(work: Callable[[], None]) -> Iterator[None]:
    """Do some work, imports mostly, while the block waits for Maxima; the block itself must import nothing."""
    working = Thread(target=work)
    working.start()
    try:
        yield
    finally:
        working.join()
