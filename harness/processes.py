"""Processes that end together: with their parent, or with the command that started them.

Linux gives the orphans of a subreaper to it, so it can end each process that was started below it, also those in
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
TICK = 0.1  # seconds between two looks for the parent, where the kernel does not tell of its end
ROUNDS = 500  # attempts to end all children, a hundredth of a second each
PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36
HELD = re.compile(r"^(?:VmRSS|VmSwap|VmPTE|HugetlbPages):\s*(\d+) kB$", re.MULTILINE)  # of /proc/PID/status


def die_with_parent(parent: int) -> None:
    """Have this process killed when its parent ends. Parameters as for `signal_without_parent`."""
    signal_without_parent(parent, signal.SIGKILL)


def signal_without_parent(parent: int, number: int) -> None:
    """Have this process sent a signal when its parent ends, by the kernel or else by a thread.

    Parameters
    ----------
    parent : int
        Process number of the parent; if it has ended already, the signal is sent at once.
    number : int
        The signal.
    """

    def watch_parent() -> None:
        while os.getppid() == parent:
            time.sleep(TICK)
        os.kill(os.getpid(), number)

    if not _control_process(PR_SET_PDEATHSIG, number):
        Thread(target=watch_parent, daemon=True).start()
    elif os.getppid() != parent:
        os.kill(os.getpid(), number)


def become_subreaper() -> None:
    """Adopt the orphans among the processes that this one starts, where the kernel can arrange that."""
    _control_process(PR_SET_CHILD_SUBREAPER, 1)


def children(pid: int) -> list[int]:
    """Return the processes that a process has started, by any of its threads."""
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
    """Return all processes below a process."""
    found = children(pid)
    for each in found:  # the list grows meanwhile
        found += children(each)
    return found


def held_memory(pid: int) -> int:
    """Return the memory of a process in bytes, its page tables and what is swapped out included; 0 if it has ended."""
    if not os.path.exists("/proc/self/status"):
        return sum(1024 * int(kib) for kib in _printed_by("ps", "-o", "rss=", "-p", str(pid)))
    with suppress(OSError), open(f"/proc/{pid}/status", encoding="utf-8", errors="replace") as file:
        return sum(1024 * int(kib) for kib in HELD.findall(file.read()))
    return 0


def count_threads(pid: int) -> int:
    """Return the number of threads of a process, 1 where the kernel does not tell."""
    try:
        return len(os.listdir(f"/proc/{pid}/task"))
    except OSError:
        return 1


def _printed_by(*command: str) -> list[str]:
    import subprocess

    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.splitlines()


def end_children() -> None:
    """Kill all that this process has started until it has no children; it adopts those of the ended ones."""
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
    """Call Linux's prctl; return True if there is one and it succeeded."""
    return sys.platform == "linux" and ctypes.CDLL(None).prctl(option, ctypes.c_ulong(value), 0, 0, 0) == 0


def _run(file_size: int, command: list[str]) -> int:
    """Run a command to its end, with all that it starts; return its exit status as a shell does."""
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
    """Return those that this process may use, where the system can tell; else those that there are."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


if __name__ == "__main__":
    os._exit(_run(int(sys.argv[1]), sys.argv[2:]))
