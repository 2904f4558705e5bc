"""A command under supervision: whatever ends it, what it started ends with it, and nothing that it put aside stays.

The command runs in a child process. This one only waits: it ends the command at a signal or when its time is over, sees
it end by itself or crash, ends what is left of it, and removes its directory for temporary files. Where this process is
killed, the child is killed, and the next command removes the directory.
"""

import ctypes
import math
import mmap
import os
import signal
import struct
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from threading import Thread
from types import FrameType

from .files import private_directory, sweep_private_directories

SIGNALLED = 128  # a shell adds this to the number of the signal that ended a command
OUT_OF_TIME = 2
CRASHED = 3
ENDING_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
QUIET_ENDS = (*ENDING_SIGNALS, signal.SIGPIPE)
EXPECTED = 120.0  # seconds: what surely takes longer is to be asked for with a time limit
TICK = 0.1  # seconds between two looks at the clock
ROUNDS = 500  # attempts to end all that a command started, a hundredth of a second each
CLOCK = struct.Struct("dd")  # seconds that the command may take, and the instant at which they are over
BOARD = 512  # bytes of what the command tells its supervisor: the clock, then what it is doing
SET_PDEATHSIG, SET_CHILD_SUBREAPER = 1, 36  # of Linux's prctl

_board: mmap.mmap | None = None


@dataclass(frozen=True)
class Ending:
    """How a command ended."""

    status: int  # its exit status; 128 + n where a signal n ended it; 2 where its time was over; 3 where it crashed
    sentence: str = ""  # what is to be told; empty where it told all by itself


class _Interrupted(BaseException):
    """A signal ends the wait, or the time is over."""

    def __init__(self, ending: Ending) -> None:
        super().__init__(ending)
        self.ending = ending


def supervise(command: Callable[[], int]) -> Ending:
    """Run a command in a child process, which does not come back from here.

    Raises
    ------
    HolonomError
        No directory for temporary files can be made.
    """
    global _board
    sweep_private_directories()
    with private_directory() as directory:
        _board = mmap.mmap(-1, BOARD)
        limit_time(math.inf)
        _control_process(SET_CHILD_SUBREAPER, 1)
        supervisor = os.getpid()
        child = os.fork()
        if child == 0:
            os._exit(_run(command, directory, supervisor))
        try:
            with _interruptions():
                return _ending_of(os.waitpid(child, 0)[1])
        except _Interrupted as interrupted:
            return interrupted.ending
        finally:
            _end_descendants()


def limit_time(seconds: float) -> None:
    """Say how much time the command has from now on; without supervision it is not limited."""
    if _board is not None:
        CLOCK.pack_into(_board, 0, seconds, time.monotonic() + seconds)


def time_left() -> float:
    """Seconds that the command has left, `EXPECTED` where nothing limits it; infinite without supervision."""
    if _board is None:
        return math.inf
    seconds, deadline = CLOCK.unpack_from(_board, 0)
    return deadline - time.monotonic() if math.isfinite(seconds) else EXPECTED


@contextmanager
def doing(what: str) -> Iterator[None]:
    """Say what the command does in the block, for the sentence that tells in what it ran out of time."""
    before = _written()
    _write(what)
    try:
        yield
    finally:
        _write(before)


def _written() -> str:
    return "" if _board is None else _board[CLOCK.size :].rstrip(b"\0").decode(errors="replace")


def _write(what: str) -> None:
    if _board is not None:
        _board[CLOCK.size :] = what.encode()[: BOARD - CLOCK.size].ljust(BOARD - CLOCK.size, b"\0")


def die_with_parent(parent: int) -> None:
    """Have this process killed when its parent ends, by the kernel or else a thread; a parent that is gone counts."""

    def end_without_parent() -> None:
        if os.getppid() != parent:
            os._exit(SIGNALLED + signal.SIGKILL)

    def look_for_parent() -> None:
        while True:
            end_without_parent()
            time.sleep(TICK)

    if _control_process(SET_PDEATHSIG, signal.SIGKILL):
        end_without_parent()
    else:
        Thread(target=look_for_parent, daemon=True).start()


def _run(command: Callable[[], int], directory: Path, supervisor: int) -> int:
    """Run the command, in the child."""
    die_with_parent(supervisor)
    tempfile.tempdir = os.environ["TMPDIR"] = str(directory)
    return command()


def _ending_of(status: int) -> Ending:
    number = -os.waitstatus_to_exitcode(status)
    if number <= 0:
        return Ending(-number)
    if number in QUIET_ENDS:
        return Ending(SIGNALLED + number)
    name = signal.Signals(number).name
    return Ending(CRASHED, f"ended by {name}{_while_doing()}; perhaps this machine lacks memory: ask for less.")


def _while_doing() -> str:
    what = _written()
    return f" while {what}" if what else ""


@contextmanager
def _interruptions() -> Iterator[None]:
    """Signals that end a command, and the end of its time, interrupt the block; the signals are ignored after it."""

    def end(number: int, _: FrameType | None) -> None:
        raise _Interrupted(Ending(SIGNALLED + number))

    def look_at_clock(*_: object) -> None:
        seconds, deadline = CLOCK.unpack_from(_board, 0)
        if time.monotonic() > deadline:
            sentence = f"this took longer than {seconds:g} s, and ran out of them{_while_doing()}"
            raise _Interrupted(Ending(OUT_OF_TIME, f"{sentence}; ask for less, or raise --time-limit."))

    heeded = [number for number in ENDING_SIGNALS if signal.getsignal(number) is not signal.SIG_IGN]
    signal.signal(signal.SIGALRM, look_at_clock)
    signal.setitimer(signal.ITIMER_REAL, TICK, TICK)
    for number in heeded:
        signal.signal(number, end)
    try:
        yield
    finally:
        for number in heeded:
            signal.signal(number, signal.SIG_IGN)
        signal.setitimer(signal.ITIMER_REAL, 0)


def _end_descendants() -> None:
    """End what the command started, orphans too where the kernel gives them to this process."""
    for _ in range(ROUNDS):
        if not _reap():
            return
        import psutil  # a command that ends as it should does without

        for process in psutil.Process().children(recursive=True):
            with suppress(psutil.Error):
                process.kill()
        time.sleep(0.01)


def _reap() -> bool:
    """Take note of the children that have ended; whether there are others."""
    try:
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass
    except ChildProcessError:
        return False
    return True


def _control_process(option: int, value: int) -> bool:
    """Linux's prctl; whether there is one, and it did so."""
    return sys.platform == "linux" and ctypes.CDLL(None).prctl(option, ctypes.c_ulong(value), 0, 0, 0) == 0
