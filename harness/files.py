"""Files that are written completely or not at all."""

import errno
import os
import shutil
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from .failures import ErrorKind, HolonomError
from .language import translatable

MANIFEST = ".holonom-written"
DRAFTS = ".holonom-*.new"  # names of files that are about to get their own
LINKS = 40  # that lead from one to the next, which is what Linux follows


def shared(folder: str) -> Path:
    """Return a folder of the package.

    A wheel has it inside the package. In the repository, it is next to the package.

    Parameters
    ----------
    folder : str
        ``maxima`` or ``examples``.

    Returns
    -------
    Path
    """
    inside = Path(__file__).resolve().with_name("share") / folder
    return inside if inside.is_dir() else Path(__file__).resolve().parents[1] / folder


def scene_file(path: str | Path) -> Path:
    """Return a scene file by its name.

    If it does not exist, return the example of that name in the package.

    Parameters
    ----------
    path : str or Path
        Name of the file.

    Returns
    -------
    Path
    """
    file = Path(path)
    if not file.exists() and file.parts[:1] == ("examples",):
        travelling = shared("examples").joinpath(*file.parts[1:])
        return travelling if travelling.is_file() else file
    return file


def near_file(missing: Path) -> str:
    """Return a suggestion for a missing file, as the end of a message.

    Parameters
    ----------
    missing : Path
        Name of the missing file.

    Returns
    -------
    str
        Empty if no name in its folder is similar.
    """
    try:
        names = [file.name for file in missing.parent.iterdir() if file.name != missing.name]  # as a link to nothing
    except OSError:
        return ""
    from difflib import get_close_matches

    near = get_close_matches(missing.name, names, n=1)
    return translatable(", but there is %(name)s", name=missing.with_name(near[0])) if near else ""


def require_writable(path: Path) -> None:
    """Raise if a file cannot be written, before its content is computed.

    Parameters
    ----------
    path : Path
        File to be written.

    Raises
    ------
    HolonomError
        It is a directory, or its folder cannot be written to.
    """
    try:
        if path.is_dir():
            raise IsADirectoryError(None, "it is a directory")
        if not path.exists() or path.is_file():
            target = _target(path)
            _status(target)
            _unnamed(target.parent).close()
    except OSError as error:
        raise _unwritable(path, error) from None


def write_whole(path: Path, content: str | bytes) -> None:
    """Write a file that is never seen incomplete.

    Parameters
    ----------
    path : Path
        The file. Its former content is replaced, and its permissions stay. A device or a pipe is written to directly.
    content : str or bytes
        The new content. Text becomes UTF-8.

    Raises
    ------
    HolonomError
        The file cannot be written, or its former content is still there.
    """
    with whole_file(path) as file:
        file.write(content if isinstance(content, bytes) else content.encode())


@contextmanager
def whole_file(path: Path) -> Iterator[BinaryIO]:
    """Yield a file that is written in parts and is never seen incomplete.

    Parameters
    ----------
    path : Path
        As for `write_whole`.

    Yields
    ------
    BinaryIO
        Open for writing.

    Raises
    ------
    HolonomError
        The file cannot be written. Its former content is still there, as after any other exception of the block.
    """
    try:
        if path.exists() and not path.is_file():
            with path.open("wb") as file:
                yield file
            return
        target = _target(path)
        with _unnamed(target.parent) as file:
            yield file
            _to_disk(file)
            _put_in_place(file, target)
    except OSError as error:
        raise _unwritable(path, error) from None


def append_line(path: Path, line: str) -> None:
    """Append a line to a file, which is created if missing.

    A truncated last line is ended first.

    Parameters
    ----------
    path : Path
        The file. A link is not followed.
    line : str
        Text without a line feed.

    Raises
    ------
    HolonomError
        The file cannot be written.
    """
    try:
        descriptor = os.open(path, os.O_WRONLY | os.O_APPEND | os.O_CREAT | os.O_NOFOLLOW, 0o666)
        with open(descriptor, "ab") as file:
            file.write(f"\n{line}\n".encode())
            _to_disk(file)
    except OSError as error:
        raise _unwritable(path, error) from None


def write_files(directory: Path, files: Mapping[str, str]) -> None:
    """Write files into a directory, each completely or not at all.

    Other files of the directory stay.

    Parameters
    ----------
    directory : Path
        It is created if it is missing.
    files : mapping of str to str
        Content of each file by its name.

    Raises
    ------
    HolonomError
        The directory cannot be made or written to.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _unwritable(directory, error) from None
    manifest = "".join(f"{name}\n" for name in sorted({*written_before(directory), *files}))
    for name, text in {MANIFEST: manifest, **files}.items():
        write_whole(directory / name, text)


def written_before(directory: Path) -> frozenset[str]:
    """Return the files of a directory that its manifest lists.

    Parameters
    ----------
    directory : Path
        Directory with or without a manifest.

    Returns
    -------
    frozenset of str
        Paths in the directory, of files that exist.
    """
    try:
        listed = (directory / MANIFEST).read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError):
        return frozenset()
    return frozenset(name for name in listed if os.path.lexists(directory / name))


def require_own_files(directory: Path, names: Iterable[str]) -> None:
    """Raise if files of a directory are not in its manifest.

    Parameters
    ----------
    directory : Path
        Directory with or without a manifest.
    names : iterable of str
        Paths in the directory.

    Raises
    ------
    HolonomError
        A file exists that is not in the manifest.
    """
    listed = written_before(directory)
    for name in names:
        if os.path.lexists(directory / name) and name not in listed:
            raise HolonomError(ErrorKind.UNRELATED_FILE, directory / name)


def _target(path: Path) -> Path:
    """Return the target of a file name, except for links of other users."""
    link = path
    for _ in range(LINKS):
        if not link.is_symlink():
            break
        if link.lstat().st_uid not in (0, os.geteuid()):
            raise PermissionError(None, f"{link} is a link of another user")
        link = link.parent / link.readlink()
    return path.resolve()


def _status(path: Path) -> os.stat_result | None:
    """Return the status of a name, or None if it does not exist."""
    with suppress(FileNotFoundError):
        return path.lstat()
    return None


def _unnamed(folder: Path) -> BinaryIO:
    """Return an unnamed file on the disk of a folder.

    It disappears when it is closed, also by the end of the process.
    """
    with suppress(AttributeError, OSError):  # a system, or a file system, without O_TMPFILE
        return os.fdopen(os.open(folder, os.O_TMPFILE | os.O_RDWR, 0o600), "w+b")
    return tempfile.TemporaryFile(dir=folder)


def _to_disk(file: BinaryIO) -> None:
    file.flush()
    os.fsync(file.fileno())


def _put_in_place(file: BinaryIO, target: Path) -> None:
    """Give an unnamed file the name, place and permissions of another file."""
    _take_permissions(file.fileno(), _status(target))
    with _opened(target.parent) as folder:
        draft = f".holonom-{os.urandom(8).hex()}.new"
        try:
            _give_name(file, draft, folder)
            os.replace(draft, target.name, src_dir_fd=folder, dst_dir_fd=folder)
        except BaseException:
            with suppress(FileNotFoundError):
                os.unlink(draft, dir_fd=folder)
            raise


def _take_permissions(descriptor: int, replaced: os.stat_result | None) -> None:
    """Give a file the owner and the permissions of the one that it replaces.

    A new file has the permissions of the umask.
    """
    if replaced is None:
        mask = os.umask(0o077)
        os.umask(mask)
        os.fchmod(descriptor, 0o666 & ~mask)
        return
    with suppress(PermissionError):  # it belongs to another user, in a folder that both may write to
        os.fchown(descriptor, replaced.st_uid, replaced.st_gid)
    os.fchmod(descriptor, replaced.st_mode & 0o777)


@contextmanager
def _opened(folder: Path) -> Iterator[int]:
    descriptor = os.open(folder, os.O_DIRECTORY | getattr(os, "O_PATH", os.O_RDONLY))
    try:
        yield descriptor
    finally:
        os.close(descriptor)


def _give_name(file: BinaryIO, name: str, folder: int) -> None:
    """Give an unnamed file a new name.

    If the system cannot, it is copied to a file that only this process can have created.
    """
    try:
        os.link(f"/proc/self/fd/{file.fileno()}", name, dst_dir_fd=folder)
    except OSError:
        mode = os.fstat(file.fileno()).st_mode & 0o777
        flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW
        with open(os.open(name, flags, 0o600, dir_fd=folder), "wb") as copy:
            file.seek(0)
            shutil.copyfileobj(file, copy)
            os.fchmod(copy.fileno(), mode)
            _to_disk(copy)


def _unwritable(path: Path, error: OSError) -> Exception:
    """Return the error for a file that cannot be written.

    A lack of descriptors or memory, or a broken disk, is not an error of the file.
    """
    if error.errno in (errno.EMFILE, errno.ENFILE, errno.ENOMEM, errno.EIO):
        return error
    full = error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
    failure = ErrorKind.DISK_FULL if full else ErrorKind.UNWRITABLE
    return HolonomError(failure, path, error.strerror or str(error))
