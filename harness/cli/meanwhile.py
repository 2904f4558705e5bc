"""Work of a thread of its own while a command waits for Maxima."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import Thread

from ..sandbox import Limits


@contextmanager
def meanwhile(file: Path, limits: Limits, work: Callable[[], None]) -> Iterator[None]:
    """Do some work, imports mostly, while the block has Maxima run about a file; the block itself must import nothing.

    Raises as `get_ready`.
    """
    from ..maxima import get_ready

    get_ready(file, limits)
    working = Thread(target=_done_quietly, args=(work,))
    working.start()
    try:
        yield
    finally:
        working.join()


def _done_quietly(work: Callable[[], None]) -> None:
    with suppress(Exception):  # what cannot be imported is told where it is needed
        work()
