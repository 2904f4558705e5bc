"""A command under supervision: everything that it started ends with it, and no temporary file stays.

The command runs in a process below the supervisor, which waits for it or for a signal, ends what is left, and removes
the directory for temporary files. The supervisor is itself a child of the process that was started, and learns of its
end: even if that is killed, all is ended and removed. The kernel alone does not see to that: bubblewrap, killed at the
wrong instant, leaves a child that waits for it for ever. The next command removes the files of a killed supervisor.
"""

import math
import mmap
import os
import signal
import tempfile
import time
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from .processes import SIGNALLED, become_subreaper, die_with_parent, end_children, signal_without_parent
from .temporary import private_directory, remove_abandoned_directories

OUT_OF_TIME = 2
CRASHED = 3
ENDING_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
PARENT_ENDED = signal.SIGUSR1  # sent to the supervisor
QUIET_ENDS = (*ENDING_SIGNALS, signal.SIGPIPE)
EXPECTED = 120.0  # seconds: what takes longer is to be asked for with a time limit
BOARD = 512  # bytes of memory in which the command leaves what it is doing

_board: mmap.mmap | None = None
_time_limit = math.inf  # seconds
_deadline = math.inf  # the instant, of the monotonic clock, at which they are over


@dataclass(frozen=True)
class Ending:
    """The ending of a command."""

    status: int  # its exit status; 128 + n if signal n ended it; 2 if its time was over; 3 if it crashed
    sentence: str = ""  # the message to print; empty if the command printed its own


def supervise(command: Callable[[], int]) -> Ending:
    """Run a command in a child of a child of this process; only the child, the supervisor, comes back from here.

    Raises
    ------
    HolonomError
        No directory for temporary files can be made.
    """
    global _board
    heeded = [each for each in ENDING_SIGNALS if signal.getsignal(each) is not signal.SIG_IGN]
    for each in (signal.SIGCHLD, PARENT_ENDED):
        signal.signal(each, lambda *_: None)  # what is ignored may be lost while it is blocked
    heeded += [signal.SIGCHLD, PARENT_ENDED]
    signal.pthread_sigmask(signal.SIG_BLOCK, heeded)  # none comes before the directory is removed
    group = os.getpgrp()
    _go_on_in_child(heeded)
    remove_abandoned_directories()
    with private_directory() as directory:
        _board = mmap.mmap(-1, BOARD)
        become_subreaper()
        supervisor = os.getpid()
        child = os.fork()
        if child == 0:
            for each in (signal.SIGCHLD, PARENT_ENDED):
                signal.signal(each, signal.SIG_DFL)
            signal.pthread_sigmask(signal.SIG_UNBLOCK, heeded)
            with suppress(OSError):  # the group has ended
                os.setpgid(0, group)
            os._exit(_run(command, directory, supervisor))
        try:
            return _wait(child, heeded)
        finally:
            end_children()


def _go_on_in_child(heeded: Collection[int]) -> None:
    """Come back in a child, in a process group of its own; this process passes signals on, and ends as it does."""
    parent = os.getpid()
    child = os.fork()
    if child == 0:
        os.setpgid(0, 0)  # out of reach of what kills a whole group
        signal_without_parent(parent, PARENT_ENDED)
        return
    while True:
        number = signal.sigwait(heeded)
        if number != signal.SIGCHLD:
            os.kill(child, number)
            continue
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            code = os.waitstatus_to_exitcode(status)
            os._exit(code if code >= 0 else SIGNALLED - code)


def limit_time(seconds: float) -> None:
    """Limit the time of the command from now on; without supervision it is not limited.

    The kernel ends the command by SIGALRM, whatever it computes.
    """
    global _time_limit, _deadline
    if _board is not None:
        _time_limit, _deadline = seconds, time.monotonic() + seconds
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_REAL, seconds)
        _write(_written())


def limit_expected_time() -> None:
    """Limit the time of a command that has no limit: what takes longer than expected is to be asked for with one."""
    if math.isinf(_time_limit):
        limit_time(EXPECTED)


def time_to_limit() -> float:
    """Return the seconds until the command is ended; infinite if nothing limits it."""
    return math.inf if _board is None else _deadline - time.monotonic()


@contextmanager
def doing(what: str) -> Iterator[None]:
    """Leave word of what the command does in the block, for the message if it crashes or runs out of time."""
    before = _written()
    _write(what)
    try:
        yield
    finally:
        _write(before)


def _written() -> str:
    return _left_word()[1]


def _left_word() -> tuple[str, str]:
    """Return the time limit and what the command does, as the command wrote them."""
    text = "" if _board is None else _board[:].rstrip(b"\0").decode(errors="replace")
    limit, _, what = text.partition("\n")
    return limit, what


def _write(what: str) -> None:
    if _board is not None:
        _board[:] = f"{_time_limit:g}\n{what}".encode()[:BOARD].ljust(BOARD, b"\0")


def _run(command: Callable[[], int], directory: Path, supervisor: int) -> int:
    """Run the command, in the child."""
    die_with_parent(supervisor)
    tempfile.tempdir = os.environ["TMPDIR"] = str(directory)
    return command()


def _wait(child: int, heeded: Collection[int]) -> Ending:
    """Wait until the command ends, or a signal asks for its end."""
    while True:
        number = signal.sigwait(heeded)
        if number != signal.SIGCHLD:
            return Ending(SIGNALLED + number)
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            return _ending_of(os.waitstatus_to_exitcode(status))


def _ending_of(status: int) -> Ending:
    if status >= 0:
        return Ending(status)
    limit, what = _left_word()
    during = f" while {what}" if what else ""
    if -status == signal.SIGALRM:
        sentence = f"this took longer than {limit} s, and ran out of them{during}; ask for less, or raise --time-limit."
        return Ending(OUT_OF_TIME, sentence)
    if -status in QUIET_ENDS:
        return Ending(SIGNALLED - status)
    name = next((each.name for each in signal.Signals if each == -status), f"signal {-status}")
    return Ending(CRASHED, f"ended by {name}{during}; perhaps this machine lacks memory: ask for less.")
