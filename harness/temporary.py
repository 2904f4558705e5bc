"""Private directories for temporary files, removed when they are no longer used.

A directory is locked as long as its process lives. Directories of killed processes are removed by the next command.
"""

import fcntl
import os
import re
import stat
import tempfile
import weakref
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from .failures import ErrorKind, HolonomError

PREFIX = ".holonom-run-"
NAME = re.compile(re.escape(PREFIX) + r"[a-z0-9_]{8}")


@contextmanager
def private_directory() -> Iterator[Path]:
    """Make a directory for temporary files, and remove it at the end.

    Yields
    ------
    Path

    Raises
    ------
    HolonomError
        No directory can be made.
    """
    path, lock = _locked_directory()
    try:
        yield path
    finally:
        remove_tree(path)
        os.close(lock)


class OwnDirectory:
    """A private directory that exists as long as this object does.

    Raises as `private_directory`.
    """

    def __init__(self) -> None:
        stack = ExitStack()
        self.path = stack.enter_context(private_directory())
        weakref.finalize(self, stack.close)

    def __deepcopy__(self, known: dict[int, object]) -> "OwnDirectory":
        return self  # a copy of a result reads the same files


def remove_abandoned_directories() -> None:
    """Remove the private directories of processes that were killed."""
    with suppress(OSError):
        for name in filter(NAME.fullmatch, os.listdir(tempfile.gettempdir())):
            _remove_if_abandoned(Path(tempfile.gettempdir(), name))


def remove_tree(path: Path) -> None:
    """Remove a directory with its content, without following links.

    Entries that cannot be removed are left. Directories are emptied into the topmost one before they are removed, so
    depth costs neither stack nor descriptors.

    Parameters
    ----------
    path : Path
        The directory.
    """
    with suppress(OSError):
        top = os.open(path, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
        try:
            os.fchmod(top, 0o700)
            while sum(_remove_entry(name, top) for name in os.listdir(top)):
                pass
        finally:
            os.close(top)
        os.rmdir(path)


def _remove_entry(name: str, top: int) -> bool:
    """Remove a file or a directory. Return True on success.

    The entries of a directory are first moved to the topmost one.
    """
    try:
        if not _is_directory(name, top):
            os.unlink(name, dir_fd=top)
            return True
        os.chmod(name, 0o700, dir_fd=top)
        folder = os.open(name, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW, dir_fd=top)
        try:
            for each in os.listdir(folder):
                if _is_directory(each, folder):
                    os.chmod(each, 0o700, dir_fd=folder)  # to move a directory takes the right to write to it
                os.rename(each, os.urandom(16).hex(), src_dir_fd=folder, dst_dir_fd=top)
        finally:
            os.close(folder)
        os.rmdir(name, dir_fd=top)
    except OSError:
        return False
    return True


def _is_directory(name: str, folder: int) -> bool:
    return stat.S_ISDIR(os.stat(name, dir_fd=folder, follow_symlinks=False).st_mode)


def _locked_directory() -> tuple[Path, int]:
    """Return a new directory, and the descriptor that holds its lock."""
    try:
        while True:
            path = Path(tempfile.mkdtemp(prefix=PREFIX)).resolve()
            with suppress(FileNotFoundError):  # removed as abandoned before it was locked
                lock = os.open(path, os.O_RDONLY)
                try:
                    fcntl.flock(lock, fcntl.LOCK_EX)
                except OSError:  # a file system without locks
                    remove_tree(path)
                    raise
                if path.exists():
                    return path, lock
                os.close(lock)
    except OSError as error:
        raise HolonomError(ErrorKind.NO_PRIVATE_DIRECTORY, detail=error.strerror or str(error)) from None


def _remove_if_abandoned(path: Path) -> None:
    with suppress(OSError):
        directory = os.open(path, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
        try:
            if os.fstat(directory).st_uid == os.getuid():
                fcntl.flock(directory, fcntl.LOCK_EX | fcntl.LOCK_NB)
                remove_tree(path)
        finally:
            os.close(directory)
