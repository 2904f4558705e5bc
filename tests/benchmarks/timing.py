"""Times: of work that may take too long, and of compiled functions, one point and many."""

import ctypes
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

import numpy as np
from numpy.typing import NDArray

from harness.motion.c_function import load_c

TIMER = Path(__file__).with_name("timer.c")
REPEATS = 7  # the shortest time counts: what disturbs a measurement makes it longer
MEASUREMENT = 0.02  # seconds of one repeat
Compiled = Callable[..., None]


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


class Timer:
    """Measures compiled functions without Python between the calls."""

    def __init__(self) -> None:
        self._seconds = load_c(TIMER.read_text(encoding="utf-8")).seconds_a_call
        self._seconds.argtypes = (ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_long)
        self._seconds.restype = ctypes.c_double

    def one_point(self, function: Compiled, point: NDArray[np.float64], outputs: int) -> float:
        """Seconds for one call of ``function(in, out)``."""
        result = np.empty(outputs)
        address = ctypes.cast(function, ctypes.c_void_p)

        def seconds(calls: int) -> float:
            return self._seconds(address, point.ctypes.data, result.ctypes.data, calls)

        calls = max(1, int(MEASUREMENT / max(seconds(1), seconds(1), 1e-9)))
        return min(seconds(calls) for _ in range(REPEATS))


def many_points(evaluate: Callable[[NDArray[np.float64]], object], points: NDArray[np.float64]) -> float:
    """Seconds a point, for an array of points."""
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        evaluate(points)
        times.append(time.perf_counter() - start)
    return min(times) / points.shape[1]
