"""A supervised command: its processes and temporary files end with it.

The command runs in a process below the supervisor, which waits for it or for a signal, ends the remaining processes,
and removes the directory for temporary files. The supervisor is itself a child of the process that was started, and
is notified of its end: even if that is killed, all is ended and removed. The kernel alone does not do that:
bubblewrap, killed at the wrong time, leaves a child that waits for it for ever. The next command removes the files of
a killed supervisor.
"""

import math
import mmap
import os
import signal
import tempfile
import time
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from .failures import ErrorKind, HolonomError
from .language import translatable
from .processes import SIGNALLED, become_subreaper, die_with_parent, end_children, signal_without_parent
from .temporary import private_directory, remove_abandoned_directories

ENDING_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
PARENT_ENDED = signal.SIGUSR1  # sent to the supervisor
QUIET_ENDS = (*ENDING_SIGNALS, signal.SIGPIPE)
EXPECTED = 120.0  # seconds: what takes longer is to be asked for with a time limit
BOARD = 512  # bytes of memory in which the command leaves what it is doing

_board: mmap.mmap | None = None
_time_limit = math.inf  # seconds
_deadline = math.inf  # the time, of the monotonic clock, at which they are over


def supervise(command: Callable[[], int]) -> int:
    """Run a command in a child of a child of this process.

    Only the child, the supervisor, returns from this function.

    Parameters
    ----------
    command : callable
        Takes nothing. Returns its exit status.

    Returns
    -------
    int
        Exit status of the command, 128 + n if signal n ended it on request.

    Raises
    ------
    HolonomError
        No directory for temporary files can be made, or the command crashed or ran out of time.
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
    """Return in a child, in a process group of its own.

    This process passes signals on, and ends with the child's status.
    """
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
    """Limit the time of the command from now on.

    The kernel ends the command by SIGALRM, independent of its state. Without supervision there is no limit.

    Parameters
    ----------
    seconds : float
        Wall-clock time.
    """
    global _time_limit, _deadline
    if _board is not None:
        _time_limit, _deadline = seconds, time.monotonic() + seconds
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_REAL, seconds)
        _write(_written())


def limit_expected_time() -> None:
    """Limit the time of a command without a limit.

    A command that takes longer than expected needs an explicit limit.
    """
    if math.isinf(_time_limit):
        limit_time(EXPECTED)


def time_to_limit() -> float:
    """Return the time until the command is ended.

    Returns
    -------
    float
        In seconds, infinite without a limit.
    """
    return math.inf if _board is None else _deadline - time.monotonic()


@contextmanager
def doing(what: str) -> Iterator[None]:
    """Record the activity of the command in the block.

    The message names it if the command crashes or runs out of time.

    Parameters
    ----------
    what : str
        Activity, such as "compiling the motion".

    Yields
    ------
    None
    """
    before = _written()
    _write(what)
    try:
        yield
    finally:
        _write(before)


def _written() -> str:
    return _left_word()[1]


def _left_word() -> tuple[str, str]:
    """Return the recorded time limit and activity of the command."""
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


def _wait(child: int, heeded: Collection[int]) -> int:
    """Wait until the command ends or a signal requests its end."""
    while True:
        number = signal.sigwait(heeded)
        if number != signal.SIGCHLD:
            return SIGNALLED + number
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            return _status_of(os.waitstatus_to_exitcode(status))


def _status_of(code: int) -> int:
    """Return the exit status of a child, or raise the error that ended it."""
    if code >= 0:
        return code
    limit, what = _left_word()
    if -code == signal.SIGALRM:
        raise HolonomError(ErrorKind.COMMAND_TOO_LONG, detail=_during(f"{limit} s", what))
    if -code in QUIET_ENDS:
        return SIGNALLED - code
    name = next((each.name for each in signal.Signals if each == -code), f"signal {-code}")
    raise HolonomError(ErrorKind.COMMAND_CRASHED, detail=_during(name, what))


def _during(fact: str, what: str) -> str:
    return translatable("%(fact)s while %(what)s", fact=fact, what=what) if what else fact
