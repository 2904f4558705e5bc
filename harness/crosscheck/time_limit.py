"""A time limit for all verdicts together.

The verdict that it interrupts is undecided. Those before it remain.
"""

from __future__ import annotations

import math
import signal
import threading
import time
from collections.abc import Callable
from types import FrameType
from typing import TypeVar

Result = TypeVar("Result")

ALARM = signal.SIGVTALRM
"""The signal that interrupts the main thread; the time limit of the whole command has another."""


class OutOfTime(BaseException):
    """End of the time limit, which handlers of ordinary errors do not catch."""


class TimeLimit:
    """A time limit in seconds from now on.

    Only the main thread can be limited.
    """

    def __init__(self, seconds: float = math.inf) -> None:
        heard = threading.current_thread() is threading.main_thread()
        self._end = time.monotonic() + seconds if heard else math.inf

    def result(self, work: Callable[[], Result], otherwise: Result) -> Result:
        """Return the result of some work, or a substitute if the time ends before it.

        Parameters
        ----------
        work : callable
            Function without arguments.
        otherwise : Result
            The substitute.

        Returns
        -------
        Result
        """
        if math.isinf(self._end):
            return work()
        left = self._end - time.monotonic()
        if left <= 0:
            return otherwise
        before = signal.signal(ALARM, _interrupt)
        timer = threading.Timer(left, signal.pthread_kill, (threading.main_thread().ident, ALARM))
        timer.daemon = True
        try:
            timer.start()
            return work()
        except OutOfTime:
            return otherwise
        finally:
            timer.cancel()
            timer.join()
            signal.signal(ALARM, before)


def _interrupt(number: int, frame: FrameType | None) -> None:
    raise OutOfTime
