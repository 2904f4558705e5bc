"""One process, confined: so much time, memory and output, and nothing of it left behind.

What runs a stranger's program is walled in by bubblewrap besides: no network, a process namespace of its own, and of
the file system nothing but what is named, to be read only. All that it started ends with it then, whatever kills this
process. Without bubblewrap a watcher ends the process group once this process is gone.
"""

import os
import selectors
import shutil
import signal
import subprocess
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from enum import Enum
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from .failures import Failure

if TYPE_CHECKING:
    import psutil

MIB = 1024 * 1024
BLOCK = 512  # bytes in which a shell counts the size of files
CHUNK = 65536
WATCH_INTERVAL = 0.05  # seconds between two looks at the memory: a fast hog gains about 100 MiB in between
LEAVING_TIME = 5.0  # seconds for a process that has closed its output to be gone
PROBE_TIME = 10.0  # seconds for bubblewrap to show that it is allowed here

# Arguments: the size of files in blocks, then the command. Standard input is a pipe that nobody writes to: it ends with
# this process, and the process group with it.
WATCHED = (
    'ulimit -c 0; ulimit -f "$1"; shift; exec 4<&0 </dev/null; '
    '(read -r _ <&4; kill -KILL 0) >/dev/null 2>&1 & exec "$@" 4<&-'
)
SYSTEM = ("/bin", "/sbin", "/lib", "/lib32", "/lib64", "/usr", "/etc/alternatives", "/etc/ld.so.cache")
OWN_PROCESSES = ("--proc", "/proc")  # newer versions of GCL read there how much memory there is, and how theirs lies
SHARED_BY_PROGRAMS = ("bin", "lib", "lib64", "libexec", "share")  # what lies beside a program that is not in /usr


class Sandbox(Enum):
    """Whether a scene is walled in: always, where that can be done, or not at all because it is trusted."""

    REQUIRED = "required"
    WHERE_POSSIBLE = "where possible"
    TRUSTED = "trusted"


@dataclass(frozen=True)
class Limits:
    """What one process may take, and whether it is walled in.

    Parameters
    ----------
    seconds : float
        Wall-clock time.
    memory_mib : int
        Resident memory of the process and all that it started, in MiB.
    output_mib : int
        Printed text, in MiB.
    file_mib : int
        Each file written, in MiB.
    """

    seconds: float = 120.0
    memory_mib: int = 4096
    output_mib: int = 16
    file_mib: int = 1024
    sandbox: Sandbox = Sandbox.WHERE_POSSIBLE


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


@dataclass(frozen=True)
class Confinement:
    """Where a process runs and what it sees."""

    directory: Path  # its working directory, the only one that it may write to where it is walled in
    environment: Mapping[str, str]  # its whole environment
    readable: Sequence[Path]  # what it may read besides the system's programs, where it is walled in
    limits: Limits


def run_confined(command: Sequence[str], confinement: Confinement, printed: bytearray) -> int:
    """Run a command to its end, or end it with all that it started at the first limit it exceeds.

    Returns its exit status; negative, the signal that ended it.

    Parameters
    ----------
    command : sequence of str
        The program, by its path, and its arguments.
    printed : bytearray
        Receives what it prints, also when it is ended early.

    Raises
    ------
    LimitExceeded
        It took more time or memory, or printed more, than the limits allow.
    OSError
        It cannot be started.
    """
    limits = confinement.limits
    walls = _walls(confinement, Path(command[0])) if walled_in(limits) else ()
    blocks = str(limits.file_mib * MIB // BLOCK)
    # A session of its own: the process and its children are one group, out of reach of the terminal's Ctrl-C.
    process = subprocess.Popen(
        ["/bin/sh", "-c", WATCHED, "sh", blocks, *walls, *command],
        cwd=confinement.directory,
        env=dict(confinement.environment),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        start_new_session=True,
    )
    try:
        _watch(process, limits, printed)
        with suppress(subprocess.TimeoutExpired):  # its output is complete, and it is ended below
            process.wait(LEAVING_TIME)
    finally:
        _end(process)
    return process.returncode


def walled_in(limits: Limits) -> bool:
    """Whether a run under these limits is walled in by bubblewrap."""
    return limits.sandbox is not Sandbox.TRUSTED and bubblewrap() is not None


@cache
def bubblewrap() -> str | None:
    """The path of bubblewrap; None where it is missing or forbidden."""
    if (found := shutil.which("bwrap")) is None:
        return None
    command = [found, "--unshare-all", "--die-with-parent", "--ro-bind", "/", "/", *OWN_PROCESSES, "/bin/sh", "-c", ":"]
    try:
        tried = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, timeout=PROBE_TIME, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return None
    return found if tried.returncode == 0 else None


def _walls(confinement: Confinement, program: Path) -> list[str]:
    """The command that goes before a command to wall it in."""
    directory = str(confinement.directory.resolve())
    walls = [
        bubblewrap(),
        "--unshare-all",
        "--die-with-parent",
        "--cap-drop",
        "ALL",
        *OWN_PROCESSES,
        "--dev",
        "/dev",
        "--tmpfs",
        "/tmp",
    ]
    for part in filter(os.path.lexists, SYSTEM):
        walls += ["--symlink", os.readlink(part), part] if os.path.islink(part) else ["--ro-bind", part, part]
    for part in map(str, (*surroundings(program), *confinement.readable)):
        walls += ["--ro-bind", part, part]
    return [*walls, "--bind", directory, directory, "--chdir", directory, "--"]


def surroundings(program: Path) -> list[Path]:
    """What a program that is not in /usr needs: the folders beside it, and it by the name that it is called by."""
    folders = {program.parent, *(program.resolve().parents[1] / name for name in SHARED_BY_PROGRAMS)}
    return sorted(folder for folder in folders if folder.is_dir() and not folder.is_relative_to("/usr"))


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
                if (memory := resident_memory(process.pid)) > limits.memory_mib * MIB:
                    raise LimitExceeded(Failure.TOO_LARGE, f"{limits.memory_mib} MiB")
                next_look = now + WATCH_INTERVAL


def resident_memory(pid: int) -> int:
    """Resident memory of a process and all that it started, in bytes.

    What has ended, even while it was looked at, counts for nothing, nor does what nobody lets this process look at.
    """
    return sum(map(_own_memory, _tree(pid)))


def _tree(pid: int) -> "list[psutil.Process]":
    import psutil  # while the process starts

    try:
        process = psutil.Process(pid)
        if not _kernel_lists_children():
            return [process, *process.children(recursive=True)]
    except psutil.NoSuchProcess:
        return []
    return [process, *(each for child in _children(pid) for each in _tree(child))]


@cache
def _kernel_lists_children() -> bool:
    """Whether Linux says what a process has started: to look through all processes takes ten times as long."""
    return Path(f"/proc/self/task/{os.getpid()}/children").exists()


def _children(pid: int) -> list[int]:
    """The processes that a process has started, by any of its threads."""
    found = []
    with suppress(OSError):  # it has ended
        for thread in Path(f"/proc/{pid}/task").iterdir():
            found += map(int, (thread / "children").read_text(encoding="ascii").split())
    return found


def _own_memory(process: "psutil.Process") -> int:
    import psutil

    try:
        return process.memory_info().rss
    except psutil.Error:
        return 0


def _end(process: subprocess.Popen[bytes]) -> None:
    """End a process, all that it started, and its group."""
    import psutil

    for each in _tree(process.pid):
        with suppress(psutil.Error):  # it has ended, or has other rights by now
            each.kill()
    with suppress(ProcessLookupError, PermissionError):  # nobody is left, or for macOS only what has ended
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    process.stdout.close()
    process.stdin.close()
