"""Processes that end together, with their parent or with their command.

Linux assigns orphans to the subreaper above them, so it can end each process that was started below it, also those in
sessions of their own. Run as a program, this module is such a subreaper: it runs one command under resource limits,
and ends everything that the command started when the command ends, or when its own standard input does.
"""

import ctypes
import os
import re
import signal
import sys
import time
from contextlib import suppress
from threading import Thread

SIGNALLED = 128  # a shell adds this to the number of the signal that ended a command
POLL_INTERVAL = 0.1  # seconds between two checks for the parent, if the kernel does not report its end
ROUNDS = 500  # attempts to end all children, a hundredth of a second each
PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36
MEMORY_IN_USE = re.compile(r"^(?:VmRSS|VmSwap|VmPTE|HugetlbPages):\s*(\d+) kB$", re.MULTILINE)  # of /proc/PID/status


def die_with_parent(parent: int) -> None:
    """End this process when its parent ends.

    Parameters
    ----------
    parent : int
        Process number of the parent, as for `signal_without_parent`.
    """
    signal_without_parent(parent, signal.SIGKILL)


def signal_without_parent(parent: int, number: int) -> None:
    """Send this process a signal when its parent ends, by the kernel or a thread.

    Parameters
    ----------
    parent : int
        Process number of the parent. If it has ended already, the signal is sent at once.
    number : int
        The signal.
    """

    def watch_parent() -> None:
        while os.getppid() == parent:
            time.sleep(POLL_INTERVAL)
        os.kill(os.getpid(), number)

    if not _control_process(PR_SET_PDEATHSIG, number):
        Thread(target=watch_parent, daemon=True).start()
    elif os.getppid() != parent:
        os.kill(os.getpid(), number)


def become_subreaper() -> None:
    """Adopt orphans among the descendants of this process, if the kernel supports it."""
    _control_process(PR_SET_CHILD_SUBREAPER, 1)


def children(pid: int) -> list[int]:
    """Return the processes that a process has started, by any of its threads.

    Parameters
    ----------
    pid : int
        Process number.

    Returns
    -------
    list of int
        Process numbers, empty if the process has ended.
    """
    if not os.path.exists(f"/proc/self/task/{os.getpid()}/children"):
        lines = map(str.split, _printed_by("ps", "-axo", "ppid=,pid="))
        return [int(child) for parent, child in lines if int(parent) == pid]
    found: list[int] = []
    with suppress(OSError):  # the process has ended
        for thread in os.listdir(f"/proc/{pid}/task"):
            with open(f"/proc/{pid}/task/{thread}/children", encoding="ascii") as file:
                found += map(int, file.read().split())
    return found


def descendants(pid: int) -> list[int]:
    """Return all processes below a process.

    Parameters
    ----------
    pid : int
        Process number.

    Returns
    -------
    list of int
        Process numbers.
    """
    found = children(pid)
    for each in found:  # the list grows during the loop
        found += children(each)
    return found


def memory_in_use(pid: int) -> int:
    """Return the memory of a process.

    Page tables and swapped pages are included.

    Parameters
    ----------
    pid : int
        Process number.

    Returns
    -------
    int
        In bytes. 0 if the process has ended.
    """
    if not os.path.exists("/proc/self/status"):
        return sum(1024 * int(kib) for kib in _printed_by("ps", "-o", "rss=", "-p", str(pid)))
    with suppress(OSError), open(f"/proc/{pid}/status", encoding="utf-8", errors="replace") as file:
        return sum(1024 * int(kib) for kib in MEMORY_IN_USE.findall(file.read()))
    return 0


def count_threads(pid: int) -> int:
    """Return the number of threads of a process.

    Parameters
    ----------
    pid : int
        Process number.

    Returns
    -------
    int
        1 if the number is unknown.
    """
    try:
        return len(os.listdir(f"/proc/{pid}/task"))
    except OSError:
        return 1


def _printed_by(*command: str) -> list[str]:
    import subprocess

    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.splitlines()


def end_children() -> None:
    """Kill all children of this process until none is left.

    It adopts the children of those that end.
    """
    for _ in range(ROUNDS):
        for each in descendants(os.getpid()):
            with suppress(ProcessLookupError, PermissionError):
                os.kill(each, signal.SIGKILL)
        try:
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        except ChildProcessError:
            return
        time.sleep(0.01)


def _control_process(option: int, value: int) -> bool:
    """Call Linux's prctl. Return True if it exists and succeeds."""
    return sys.platform == "linux" and ctypes.CDLL(None).prctl(option, ctypes.c_ulong(value), 0, 0, 0) == 0


def _run(file_size: int, command: list[str]) -> int:
    """Run a command with all its descendants to the end.

    Return its exit status as a shell does.
    """
    import resource

    become_subreaper()
    for limit, most in ((resource.RLIMIT_CORE, 0), (resource.RLIMIT_FSIZE, file_size)):
        resource.setrlimit(limit, (most, most))
    null = os.open(os.devnull, os.O_RDONLY)
    child = os.posix_spawn(
        command[0], command, os.environ, file_actions=[(os.POSIX_SPAWN_DUP2, null, 0), (os.POSIX_SPAWN_CLOSE, null)]
    )
    Thread(target=_kill_at_end_of_input, args=(child,), daemon=True).start()
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    end_children()
    return status if status >= 0 else SIGNALLED - status


def _kill_at_end_of_input(child: int) -> None:
    os.read(0, 1)
    with suppress(ProcessLookupError):
        os.kill(child, signal.SIGKILL)


def usable_cores() -> int:
    """Return the number of cores that this process may use.

    Returns
    -------
    int
        The number of all cores if the system does not report it.
    """
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


if __name__ == "__main__":
    os._exit(_run(int(sys.argv[1]), sys.argv[2:]))
