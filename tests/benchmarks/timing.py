"""Times: of work that may take too long, and of functions over arrays of points."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from types import FrameType

import numpy as np
from numpy.typing import NDArray

CASADI = str(Path(__file__).with_name("casadi_functions.py"))
REPEATS = 7  # the shortest time counts: what disturbs a measurement makes it longer


class TooLong(Exception):
    """Work took longer than its limit."""


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Interrupt the work inside after some seconds."""

    def interrupt(signum: int, frame: FrameType | None) -> None:
        raise TooLong

    previous = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, previous)


def program_of_command(scene: Path, setting: str) -> tuple[str, float, float]:
    """The JSON that `holonom program` writes of a scene, with the processor seconds and the MiB that it takes."""
    with TemporaryDirectory() as directory:
        written = Path(directory, "program.json")
        seconds, mebibytes = cost_of_command("program", str(scene), "--set", setting, "-o", str(written))
        return written.read_text(encoding="utf-8"), seconds, mebibytes


def cost_of_command(*arguments: str) -> tuple[float, float]:
    """Processor seconds of a whole command and of all that it starts, and the MiB of the largest process."""
    return cost_of(sys.executable, "-m", "holonom", *arguments)


def cost_of(*command: str) -> tuple[float, float]:
    """Processor seconds of a process and of all that it starts, and the MiB of the largest."""
    process = subprocess.Popen(command, env=as_installed(), stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise subprocess.CalledProcessError(process.returncode, command)
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def write_report(file: Path, text: str) -> None:
    """Write a table into a file, whose directory is made where it is missing, and print it."""
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8")
    print(text)


def as_installed() -> dict[str, str]:
    """The environment for a whole command: Python keeps what it compiles, as it does for an installed package."""
    return {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}


def many_points(evaluate: Callable[[NDArray[np.float64]], object], points: NDArray[np.float64]) -> float:
    """Seconds a point, for an array of points."""
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        evaluate(points)
        times.append(time.perf_counter() - start)
    return min(times) / points.shape[1]
