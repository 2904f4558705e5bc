"""Wait for processes that others end."""

import time
from collections.abc import Callable

import psutil


def soon(condition: Callable[[], bool]) -> bool:
    """Return True once the condition holds, False if it does not within a time that no machine needs."""
    deadline = time.monotonic() + 100
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.02)
    return condition()


def living(mark: str) -> list[psutil.Process]:
    """Return the processes with the mark on their command lines."""
    return [
        each for each in psutil.process_iter(["cmdline"]) if any(mark in word for word in each.info["cmdline"] or ())
    ]
