"""Times: of work that may take too long, and of functions over arrays of points."""

import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

import numpy as np
from numpy.typing import NDArray

REPEATS = 7  # the shortest time counts: what disturbs a measurement makes it longer


class TooLong(Exception):
    """Work took longer than its limit."""


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Interrupt the work inside after so many seconds."""

    def interrupt(signum: int, frame: FrameType | None) -> None:
        raise TooLong

    previous = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, previous)


def many_points(evaluate: Callable[[NDArray[np.float64]], object], points: NDArray[np.float64]) -> float:
    """Seconds a point, for an array of points."""
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        evaluate(points)
        times.append(time.perf_counter() - start)
    return min(times) / points.shape[1]
