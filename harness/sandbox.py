"""Run a process with limits, and in a bubblewrap sandbox if requested.

In the sandbox a process has namespaces of its own: no network, no other process, the user nobody without privileges.
It sees the system's programs and the files that it is given, read-only. Memory of limited size stands in for its
working directory. Outside, it can write to the given output files alone. A filter rejects system calls that no
derivation needs.
"""

import os
import selectors
import shutil
import signal
import subprocess
import sys
import time
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from enum import Enum
from functools import cache
from pathlib import Path

from . import processes
from .failures import ErrorKind, HolonomError
from .language import translatable
from .system_calls import call_filter

MIB = 1024 * 1024
CHUNK = 65536
WATCH_INTERVAL = 0.05  # seconds between two looks at the memory: a fast process gains about 100 MiB in between
LEAVING_TIME = 5.0  # seconds for a process that has closed its output to end
PROBE_TIME = 10.0  # seconds for bubblewrap to show that it works here
SCRATCH = 16  # one part in this many of the memory limit is for files in the sandbox
INODE = 1024  # bytes of memory that a file in the sandbox takes besides its content, at least
OPEN_FILES = 256  # descriptors of one process in the sandbox

SYSTEM = ("/bin", "/sbin", "/lib", "/lib32", "/lib64", "/usr", "/etc/alternatives", "/etc/ld.so.cache")
LISPS = ("maxima", "gcl", "sbcl", "ecl", "libecl", "clisp", "ccl")  # beginnings of the names of their libraries
NOBODY = "65534"
ISOLATION = (
    *("--unshare-user", "--unshare-all", "--disable-userns", "--uid", NOBODY, "--gid", NOBODY, "--cap-drop", "ALL"),
    *("--die-with-parent", "--new-session"),
)
KERNEL = ("--proc", "/proc", "--remount-ro", "/proc", "--dev", "/dev")
# Words of bubblewrap if the kernel or a container forbids it, or if it is too old for these options.
FORBIDDEN = ("not permitted", "ermission", "does not support", "Unknown option", "Read-only file system")
UNSANDBOXED = (
    "no sandbox, because bubblewrap is missing or not permitted: the scene file can access your files. "
    "Install or allow bubblewrap, or run with --trust."
)


class Sandbox(Enum):
    """The use of the sandbox for a scene file: always, if possible, or never.

    In it, the file sees the system's programs, the library, copies of the files that its text names below its own
    folder, and copies of the ``.mac``, ``.lisp`` and ``.csv`` files in it. `Limits.allow` adds others. It has no
    network, no sockets, no privileges, and limited memory, processes and time.

    Examples
    --------
    >>> import holonom
    >>> holonom.Limits(sandbox=holonom.Sandbox.TRUSTED).sandbox.name
    'TRUSTED'
    """

    REQUIRED = "required"
    WHERE_POSSIBLE = "where possible"
    TRUSTED = "trusted"


@dataclass(frozen=True)
class Limits:
    """Limits of one process, and its isolation.

    Parameters
    ----------
    seconds : float
        Wall-clock time.
    memory_mib : int
        Memory of the process and all that it started, files in the sandbox included, in MiB.
    output_mib : int
        Printed text, in MiB.
    file_mib : int
        Each file written, in MiB.
    processes : int
        Processes and threads at the same time.
    sandbox : Sandbox
        When the process runs in the sandbox.
    allow : tuple of Path
        Files that a scene may read in the sandbox besides those in its folder.

    Examples
    --------
    >>> import holonom
    >>> holonom.Limits(seconds=10).seconds
    10
    """

    seconds: float = 120.0
    memory_mib: int = 4096
    output_mib: int = 16
    file_mib: int = 1024
    processes: int = 100
    sandbox: Sandbox = Sandbox.WHERE_POSSIBLE
    allow: tuple[Path, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "sandbox", Sandbox(self.sandbox))  # its text, too, which no mode would be
        object.__setattr__(self, "allow", tuple(map(Path, self.allow)))


class LimitExceeded(Exception):
    """A process exceeded a limit and was ended.

    Parameters
    ----------
    kind : ErrorKind
        The limit.
    detail : str
        Its value, with its unit.
    """

    def __init__(self, kind: ErrorKind, detail: str) -> None:
        super().__init__(kind, detail)
        self.kind = kind
        self.detail = detail


@dataclass(frozen=True)
class Place:
    """Surroundings of a process.

    Parameters
    ----------
    directory : Path
        Working directory. In the sandbox memory stands in for it, with the files that the directory holds, read-only.
    environment : mapping of str to str
        The whole environment.
    limits : Limits
        What the process may take.
    readable : sequence of Path
        Files and folders that it can read in the sandbox besides the system's programs.
    copies : mapping of Path to int
        Files of which it can read copies in the sandbox, each with a descriptor of its content.
    outputs : sequence of Path
        Files of the directory that it can write to from the sandbox.
    """

    directory: Path
    environment: Mapping[str, str]
    limits: Limits
    readable: Sequence[Path] = ()
    copies: Mapping[Path, int] = field(default_factory=dict)
    outputs: Sequence[Path] = ()


def run_process(command: Sequence[str], place: Place, printed: bytearray) -> int:
    """Run a command, and end all its processes if it exceeds a limit.

    Parameters
    ----------
    command : sequence of str
        Path of the program, and its arguments.
    place : Place
        Surroundings of the process.
    printed : bytearray
        Receives the output, also of a process that is ended early.

    Returns
    -------
    int
        Exit status. 128 + n if signal n ended the process.

    Raises
    ------
    LimitExceeded
        The process took more time, memory or processes, or printed more, than the limits allow.
    HolonomError
        The sandbox failed.
    OSError
        The process cannot be started.
    """
    limits, isolated = place.limits, is_isolated(place.limits)
    with _filter_descriptors(isolated) as filters:
        around = _sandbox(command, place, filters) if isolated else _subreaper(limits)
        process = subprocess.Popen(
            [*around, *command],
            cwd=place.directory,
            env=dict(place.environment),
            stdin=subprocess.DEVNULL if isolated else subprocess.PIPE,  # the subreaper ends with its input
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            start_new_session=True,  # out of reach of the terminal's Ctrl-C
            pass_fds=(*filters, *place.copies.values()),
        )
    try:
        _watch(process, place, printed)
        with suppress(subprocess.TimeoutExpired):  # its output is complete, and it is ended below
            process.wait(LEAVING_TIME)
    finally:
        _end(process)
    return process.returncode


def is_isolated(limits: Limits) -> bool:
    """Return True if a process with these limits runs in the sandbox.

    Parameters
    ----------
    limits : Limits
        Limits of the process.

    Returns
    -------
    bool

    Raises
    ------
    HolonomError
        The limits require a sandbox, and this machine has none, or as `has_sandbox`.
    """
    isolated = limits.sandbox is not Sandbox.TRUSTED and has_sandbox()
    if limits.sandbox is Sandbox.REQUIRED and not isolated:
        raise HolonomError(ErrorKind.NO_SANDBOX)
    return isolated


def warn_unsandboxed(limits: Limits) -> None:
    """Warn if a scene file is not trusted and will run without a sandbox.

    Parameters
    ----------
    limits : Limits
        Limits of the process.

    Raises
    ------
    HolonomError
        As `is_isolated`.
    """
    if limits.sandbox is not Sandbox.TRUSTED and not is_isolated(limits):
        warnings.warn(UNSANDBOXED, stacklevel=3)


@cache
def has_sandbox() -> bool:
    """Return True if bubblewrap is installed and works on this machine.

    False if it is missing, or the kernel or a container forbids it.

    Returns
    -------
    bool

    Raises
    ------
    HolonomError
        bubblewrap fails for another reason: the machine is too busy, or lacks processes or descriptors.
    """
    if (bubblewrap := shutil.which("bwrap")) is None:
        return False
    command = [bubblewrap, *ISOLATION, "--ro-bind", "/", "/", *KERNEL, "--", "/bin/sh", "-c", ":"]
    try:
        tried = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, timeout=PROBE_TIME, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise HolonomError(ErrorKind.SANDBOX_FAILED, bubblewrap, str(error)) from None
    message = tried.stderr.decode(errors="replace").strip()
    if tried.returncode and not any(words in message for words in FORBIDDEN):
        raise HolonomError(
            ErrorKind.SANDBOX_FAILED,
            bubblewrap,
            message or translatable("exit status %(status)s", status=tried.returncode),
        )
    return tried.returncode == 0


def _subreaper(limits: Limits) -> list[str]:
    """Return the command prefix that sets limits outside the sandbox."""
    return [sys.executable, "-I", "-S", processes.__file__, str(limits.file_mib * MIB)]


def _sandbox(command: Sequence[str], place: Place, filters: Sequence[int]) -> list[str]:
    """Return the command prefix that starts the sandbox."""
    limits = place.limits
    own = str(place.directory.resolve())
    mounts: list[str] = [*ISOLATION, *KERNEL]
    for part in filter(os.path.lexists, SYSTEM):
        mounts += ["--symlink", os.readlink(part), part] if os.path.islink(part) else ["--ro-bind", part, part]
    for part in map(str, (*surroundings(Path(command[0])), *place.readable)):
        mounts += ["--ro-bind", part, part]
    for seen, descriptor in place.copies.items():
        os.lseek(descriptor, 0, os.SEEK_SET)  # an earlier process has had a copy
        mounts += ["--ro-bind-data", str(descriptor), str(seen)]
    mounts += ["--size", str(limits.memory_mib * MIB // SCRATCH), "--tmpfs", own]
    for file in sorted(each for each in place.directory.iterdir() if each.is_file()):
        mounts += ["--bind" if file in place.outputs else "--ro-bind", str(file), f"{own}/{file.name}"]
    mounts += ["--remount-ro", "/dev", "--remount-ro", "/", "--chdir", own]
    for descriptor in filters:
        mounts += ["--seccomp", str(descriptor)]
    most = ["--core=0", f"--fsize={limits.file_mib * MIB}", f"--nofile={OPEN_FILES}", f"--nproc={limits.processes}"]
    return ["bwrap", *mounts, "--", "prlimit", *most]


def surroundings(program: Path) -> list[Path]:
    """Return the files that a program outside /usr needs.

    These are the program, the programs in its folder, and the libraries of Lisps.

    Parameters
    ----------
    program : Path
        Path of the program.

    Returns
    -------
    list of Path
        Files and folders, empty for a program in /usr.
    """
    real = program.resolve()
    if real.is_relative_to("/usr"):
        return []
    if real.parent.name != "bin":
        return [program]
    prefix = real.parents[1]
    libraries = (prefix.glob(f"{part}/{name}*") for part in ("lib", "lib64", "libexec", "share") for name in LISPS)
    return sorted({program.parent, real.parent, *(each for found in libraries for each in found)})


@contextmanager
def _filter_descriptors(isolated: bool) -> Iterator[tuple[int, ...]]:
    """Yield the descriptor with the filter of system calls for bubblewrap, if any."""
    program = call_filter() if isolated else b""
    if not program:
        yield ()
        return
    reader, writer = os.pipe()
    try:
        with open(writer, "wb") as file:
            file.write(program)
        yield (reader,)
    finally:
        os.close(reader)


def _watch(process: subprocess.Popen[bytes], place: Place, printed: bytearray) -> None:
    """Collect the output until its end, and check time, memory and processes."""
    output, limits = process.stdout, place.limits
    deadline = time.monotonic() + limits.seconds
    next_look = 0.0
    memory = 0
    with selectors.DefaultSelector() as selector:
        selector.register(output, selectors.EVENT_READ)
        while True:
            chunk = os.read(output.fileno(), CHUNK) if selector.select(WATCH_INTERVAL) else None
            printed += chunk or b""
            if len(printed) > limits.output_mib * MIB:
                raise LimitExceeded(ErrorKind.TOO_MUCH_TEXT, f"{limits.output_mib} MiB")
            if (now := time.monotonic()) > deadline:
                raise LimitExceeded(ErrorKind.TOO_LONG, f"{limits.seconds:g} s, holding {memory // MIB} MiB of memory")
            if chunk == b"":
                return
            if now > next_look:
                memory = _require_little(process.pid, place)
                next_look = now + WATCH_INTERVAL


def _require_little(pid: int, place: Place) -> int:
    """Return the memory of a process and its descendants in bytes.

    Raise if they exceed the limits.
    """
    found = [pid, *processes.descendants(pid)]
    memory = sum(map(processes.memory_in_use, found)) + _files_in_memory(found[:2][-1], place)
    if memory > place.limits.memory_mib * MIB:
        raise LimitExceeded(ErrorKind.TOO_LARGE, f"{place.limits.memory_mib} MiB")
    if sum(map(processes.count_threads, found)) > place.limits.processes:
        raise LimitExceeded(ErrorKind.TOO_MANY_PROCESSES, f"{place.limits.processes}")
    return memory


def _files_in_memory(pid: int, place: Place) -> int:
    """Return the memory of the files in the sandbox.

    It is 0 if the first process is not, or not yet, in a sandbox.
    """
    try:
        found = os.statvfs(f"/proc/{pid}/root{place.directory.resolve()}")
    except OSError:
        return 0
    size = found.f_blocks * found.f_frsize
    if size > place.limits.memory_mib * MIB // SCRATCH:
        return 0
    return size - found.f_bfree * found.f_frsize + (found.f_files - found.f_ffree) * INODE


def _end(process: subprocess.Popen[bytes]) -> None:
    """End a process and all its descendants.

    Both the subreaper and bubblewrap end last: each waits until nothing is left below it.
    """
    if process.stdin is not None:
        process.stdin.close()
    if process.poll() is None:
        for child in processes.children(process.pid):
            with suppress(ProcessLookupError, PermissionError):
                os.kill(child, signal.SIGKILL)
        with suppress(subprocess.TimeoutExpired):
            process.wait(LEAVING_TIME)
        process.kill()
    process.wait()
    process.stdout.close()
