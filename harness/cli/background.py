"""Work in a thread while a command waits for Maxima."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import Thread

from ..sandbox import Limits


@contextmanager
def run_in_background(file: Path, limits: Limits, work: Callable[[], None]) -> Iterator[None]:
    """Run work in a thread while the block has Maxima run about a file.

    The work is mostly imports. The block itself must import nothing.

    Parameters
    ----------
    file : Path
        Scene file.
    limits : Limits
        Limits of each run of Maxima.
    work : callable
        Function without arguments. Its exceptions are ignored.

    Yields
    ------
    None

    Raises
    ------
    HolonomError
        As `get_ready`.
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
    with suppress(Exception):  # errors of imports are reported where the module is needed
        work()
