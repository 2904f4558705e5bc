"""Files and directories that appear whole or not at all."""

import errno
import os
import shutil
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from .failures import Failure, HolonomError
from .temporary import remove_tree

MANIFEST = ".holonom-written"
DRAFTS = ".holonom-*.new"  # names of files that are about to get their own
LINKS = 40  # that lead from one to the next, which is what Linux follows


def shared(folder: str) -> Path:
    """Return a folder that travels with the package, ``maxima`` or ``examples``: inside it where a wheel has put it.

    In the repository, where the package is used in place, it lies beside the package.
    """
    inside = Path(__file__).resolve().with_name("share") / folder
    return inside if inside.is_dir() else Path(__file__).resolve().parents[1] / folder


def scene_file(path: str | Path) -> Path:
    """Return a scene file as it is named.

    Where there is none, the example of that name that travels with the package.
    """
    file = Path(path)
    if not file.exists() and file.parts[:1] == ("examples",):
        travelling = shared("examples").joinpath(*file.parts[1:])
        return travelling if travelling.is_file() else file
    return file


def near_file(missing: Path) -> str:
    """Return what a file that is missing may have been meant to be, as the end of a sentence.

    Empty where nothing is near.
    """
    try:
        names = [file.name for file in missing.parent.iterdir()]
    except OSError:
        return ""
    from difflib import get_close_matches

    near = get_close_matches(missing.name, names, n=1)
    return f", but there is {missing.with_name(near[0])}" if near else ""


def require_writable(path: Path) -> None:
    """Refuse a file that cannot be written, before there is anything to write.

    Raises
    ------
    HolonomError
        It is a directory, or nothing can be put beside it.
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
    """Write a file so that nobody ever sees half of it.

    Parameters
    ----------
    path : Path
        The file. What it held is replaced, and its permissions stay. A device or a pipe is written to as it is.
    content : str or bytes
        What it is to hold; text becomes UTF-8.

    Raises
    ------
    HolonomError
        The file cannot be written; what it held is still there.
    """
    with whole_file(path) as file:
        file.write(content if isinstance(content, bytes) else content.encode())


@contextmanager
def whole_file(path: Path) -> Iterator[BinaryIO]:
    """Provide a file that is written piece by piece, and of which nobody ever sees a part.

    Parameters
    ----------
    path : Path
        As for `write_whole`.

    Raises
    ------
    HolonomError
        The file cannot be written; what it held is still there, as after any other exception of the block.
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
    """Append a line to a file, which is made where it is missing. A line that was cut off before ends here.

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
    """Write files into a directory, each whole or not at all; what else the directory holds stays.

    Raises
    ------
    HolonomError
        The directory cannot be made or written to.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _unwritable(directory, error) from None
    manifest = _manifest({*written_before(directory), *files})
    for name, text in {MANIFEST: manifest, **files}.items():
        write_whole(directory / name, text)


def written_before(directory: Path) -> frozenset[str]:
    """Return the files of a directory that its manifest lists, by their paths in it."""
    try:
        listed = (directory / MANIFEST).read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError):
        return frozenset()
    return frozenset(name for name in listed if os.path.lexists(directory / name))


def require_own_files(directory: Path, names: Iterable[str]) -> None:
    """Refuse to replace files of a directory, given by their paths in it, that its manifest does not list."""
    listed = written_before(directory)
    for name in names:
        if os.path.lexists(directory / name) and name not in listed:
            raise HolonomError(Failure.FOREIGN_FILE, directory / name)


def write_whole_directory(path: Path, files: Mapping[str, str | bytes]) -> None:
    """Write a directory; a new one appears whole or not at all.

    In a directory that is there, the files that its manifest lists are replaced or removed, each at once and only when
    all new ones are on the disk. The others stay as they are.

    Parameters
    ----------
    files : mapping of str to str or bytes
        What each file holds, text in UTF-8, by its path in the directory.

    Raises
    ------
    HolonomError
        The directory cannot be written, or holds a file of one of the names that its manifest does not list; what was
        there still is.
    """
    target = path.resolve()
    require_own_files(path, files)
    try:
        with ExitStack() as opened:
            written = {}
            for name, content in files.items():
                file = written[name] = opened.enter_context(_unnamed(target.parent))
                file.write(content.encode() if isinstance(content, str) else content)
                _to_disk(file)
            if target.exists():
                _put_into(target, written)
            else:
                _new_directory(target, written)
    except OSError as error:
        raise _unwritable(path, error) from None


def _target(path: Path) -> Path:
    """Return the file that a name leads to; no link is followed that somebody else made."""
    link = path
    for _ in range(LINKS):
        if not link.is_symlink():
            break
        if link.lstat().st_uid not in (0, os.geteuid()):
            raise PermissionError(None, f"{link} is a link that somebody else made")
        link = link.parent / link.readlink()
    return path.resolve()


def _status(path: Path) -> os.stat_result | None:
    """Return what there is of a name; None where there is nothing."""
    with suppress(FileNotFoundError):
        return path.lstat()
    return None


def _unnamed(folder: Path) -> BinaryIO:
    """Return a file on the disk of a folder that has no name.

    It is gone when it is closed, also by the end of the process.
    """
    with suppress(AttributeError, OSError):  # a system, or a file system, without O_TMPFILE
        return os.fdopen(os.open(folder, os.O_TMPFILE | os.O_RDWR, 0o600), "w+b")
    return tempfile.TemporaryFile(dir=folder)


def _to_disk(file: BinaryIO) -> None:
    file.flush()
    os.fsync(file.fileno())


def _put_in_place(file: BinaryIO, target: Path) -> None:
    """Give a file without a name that of another one, in its place and with its permissions."""
    _take_permissions(file.fileno(), _status(target))
    with _opened(target.parent) as folder:
        draft = _draft_name()
        try:
            _give_name(file, draft, folder)
            os.replace(draft, target.name, src_dir_fd=folder, dst_dir_fd=folder)
        except BaseException:
            with suppress(FileNotFoundError):
                os.unlink(draft, dir_fd=folder)
            raise


def _take_permissions(descriptor: int, replaced: os.stat_result | None) -> None:
    """Give a file the owner and the permissions of the one that it replaces; a new one those that the umask leaves."""
    if replaced is None:
        mask = os.umask(0o077)
        os.umask(mask)
        os.fchmod(descriptor, 0o666 & ~mask)
        return
    with suppress(PermissionError):  # it is somebody else's, in a folder that both may write to
        os.fchown(descriptor, replaced.st_uid, replaced.st_gid)
    os.fchmod(descriptor, replaced.st_mode & 0o777)


@contextmanager
def _opened(folder: Path) -> Iterator[int]:
    descriptor = os.open(folder, os.O_DIRECTORY | getattr(os, "O_PATH", os.O_RDONLY))
    try:
        yield descriptor
    finally:
        os.close(descriptor)


def _draft_name() -> str:
    return f".holonom-{os.urandom(8).hex()}.new"


def _give_name(file: BinaryIO, name: str, folder: int) -> None:
    """Give a file without a name a new one; where the system cannot, copy it to a file that nobody else has made."""
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


def _new_directory(target: Path, files: Mapping[str, BinaryIO]) -> None:
    """Put files without names into a new directory."""
    draft = target.with_name(_draft_name())
    draft.mkdir()
    try:
        _put_into(draft, files)
        draft.rename(target)
    except BaseException:
        remove_tree(draft)
        raise


def _put_into(directory: Path, files: Mapping[str, BinaryIO]) -> None:
    """Put files without names into a directory, and remove files that its manifest alone names."""
    gone = written_before(directory) - files.keys()
    write_whole(directory / MANIFEST, _manifest({*gone, *files}))
    for name, file in files.items():
        (directory / name).parent.mkdir(parents=True, exist_ok=True)
        _put_in_place(file, directory / name)
    for name in gone:
        (directory / name).unlink(missing_ok=True)
    write_whole(directory / MANIFEST, _manifest(files))


def _manifest(names: Iterable[str]) -> str:
    return "".join(f"{name}\n" for name in sorted(names))


def _unwritable(path: Path, error: OSError) -> Exception:
    """Return the refusal to write a file.

    A lack of descriptors or memory, or a broken disk, is no matter of the file.
    """
    if error.errno in (errno.EMFILE, errno.ENFILE, errno.ENOMEM, errno.EIO):
        return error
    full = error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
    failure = Failure.DISK_FULL if full else Failure.UNWRITABLE
    return HolonomError(failure, path, error.strerror or str(error))
