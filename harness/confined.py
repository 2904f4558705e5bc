"""One process, confined: so much time, memory and output, and nothing of it left behind."""

import os
import resource
import selectors
import signal
import subprocess
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from .failures import Failure

MIB = 1024 * 1024
PAGE = os.sysconf("SC_PAGE_SIZE")
CHUNK = 65536
WATCH_INTERVAL = 0.05  # seconds between two looks at the memory: a fast hog gains about 100 MiB in between
LEAVING_TIME = 5.0  # seconds for a process that has closed its output to be gone


@dataclass(frozen=True)
class Limits:
    """What one process may take.

    Parameters
    ----------
    seconds : float
        Wall-clock time.
    memory_mib : int
        Resident memory of the process and its children, in MiB.
    output_mib : int
        Printed text, in MiB.
    file_mib : int
        Each file written, in MiB.
    """

    seconds: float = 120.0
    memory_mib: int = 4096
    output_mib: int = 16
    file_mib: int = 1024


class LimitExceeded(Exception):
    """A process took more than its limits and was ended.

    Parameters
    ----------
    failure : Failure
        Which limit it was.
    detail : str
        The limit, with its unit.
    """

    def __init__(self, failure: Failure, detail: str) -> None:
        super().__init__(failure, detail)
        self.failure = failure
        self.detail = detail


def run_confined(
    command: Sequence[str], directory: Path, environment: Mapping[str, str], limits: Limits, printed: bytearray
) -> None:
    """Run a command to its end, or end it with all its children at the first limit it exceeds.

    Parameters
    ----------
    command : sequence of str
        The program and its arguments.
    directory : Path
        Its working directory.
    environment : mapping of str to str
        Its whole environment.
    limits : Limits
        What it may take.
    printed : bytearray
        Receives what it prints, also when it is ended early.

    Raises
    ------
    LimitExceeded
        It took more time or memory, or printed more, than the limits allow.
    """
    # A session of its own: the process and its children are one group, out of reach of the terminal's Ctrl-C.
    process = subprocess.Popen(
        command,
        cwd=directory,
        env=dict(environment),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        start_new_session=True,
    )
    try:
        _limit_files(process.pid, limits)
        _watch(process, limits, printed)
        with suppress(subprocess.TimeoutExpired):  # its output is complete, and it is ended below
            process.wait(LEAVING_TIME)
    finally:
        _end_group(process)


def _limit_files(pid: int, limits: Limits) -> None:
    size = limits.file_mib * MIB
    with suppress(ProcessLookupError):  # it may have ended already
        resource.prlimit(pid, resource.RLIMIT_FSIZE, (size, size))


def _watch(process: subprocess.Popen[bytes], limits: Limits, printed: bytearray) -> None:
    """Collect the output until its end; look at the clock and the memory on the way."""
    output = process.stdout
    deadline = time.monotonic() + limits.seconds
    next_look = 0.0
    memory = 0
    with selectors.DefaultSelector() as selector:
        selector.register(output, selectors.EVENT_READ)
        while True:
            if selector.select(WATCH_INTERVAL):
                chunk = os.read(output.fileno(), CHUNK)
                if not chunk:
                    return
                printed += chunk
            if len(printed) > limits.output_mib * MIB:
                raise LimitExceeded(Failure.TOO_MUCH_TEXT, f"{limits.output_mib} MiB")
            if (now := time.monotonic()) > deadline:
                raise LimitExceeded(Failure.TOO_LONG, f"{limits.seconds:g} s, holding {memory // MIB} MiB of memory")
            if now > next_look:
                if (memory := _resident_memory(process.pid)) > limits.memory_mib * MIB:
                    raise LimitExceeded(Failure.TOO_LARGE, f"{limits.memory_mib} MiB")
                next_look = now + WATCH_INTERVAL


def _resident_memory(group: int) -> int:
    """Resident memory of a process group in bytes, as Linux reports it in /proc/<pid>/stat; 0 elsewhere."""
    pages = 0
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            # The fields after the command's name, which may hold anything: state, parent, group, ...
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue  # it ended meanwhile
        if int(fields[2]) == group:
            pages += int(fields[21])
    return pages * PAGE


def _end_group(process: subprocess.Popen[bytes]) -> None:
    with suppress(ProcessLookupError):  # perhaps nobody is left
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    process.stdout.close()
