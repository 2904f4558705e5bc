"""Files and directories that appear whole or not at all."""

import errno
import fcntl
import os
import re
import shutil
import tempfile
import weakref
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from .failures import Failure, HolonomError

MANIFEST = ".holonom-written"
DRAFT = "draft-"
PRIVATE = ".holonom-run-"
PRIVATE_NAME = re.compile(re.escape(PRIVATE) + r"[a-z0-9_]{8}")


def shared(folder: str) -> Path:
    """A folder that travels with the package, ``maxima`` or ``examples``: inside it where a wheel has put it.

    In the repository, where the package is used in place, it lies beside the package.
    """
    inside = Path(__file__).resolve().with_name("share") / folder
    return inside if inside.is_dir() else Path(__file__).resolve().parents[1] / folder


def scene_file(path: str | Path) -> Path:
    """A scene file as it is named; where there is none, the example of that name that travels with the package."""
    file = Path(path)
    if not file.exists() and file.parts[:1] == ("examples",):
        travelling = shared("examples").joinpath(*file.parts[1:])
        return travelling if travelling.is_file() else file
    return file


@contextmanager
def private_directory() -> Iterator[Path]:
    """A directory for temporary files, gone at the end. While it is in use it is locked."""
    path, lock = _locked_directory()
    try:
        yield path
    finally:
        _remove_private_directory(path)
        os.close(lock)


class KeptDirectory:
    """A private directory that is there for as long as somebody refers to this object.

    Raises
    ------
    HolonomError
        It cannot be made.
    """

    def __init__(self) -> None:
        held = ExitStack()
        self.path = held.enter_context(private_directory())
        weakref.finalize(self, held.close)


def sweep_private_directories() -> None:
    """Remove the directories that killed runs left: those that nobody has locked."""
    with suppress(OSError):
        for name in filter(PRIVATE_NAME.fullmatch, os.listdir(tempfile.gettempdir())):
            _sweep(Path(tempfile.gettempdir(), name))


def remove_tree(path: Path) -> None:
    """Remove a directory, whatever its permissions, and all that it holds."""

    def make_writable(function: Callable[..., object], name: str, _: object) -> None:
        with suppress(OSError):
            os.chmod(os.path.dirname(name), 0o700)
            if os.path.isdir(name) and not os.path.islink(name):
                os.chmod(name, 0o700)
                shutil.rmtree(name, ignore_errors=True)
            else:
                function(name)

    shutil.rmtree(path, onerror=make_writable)


def _locked_directory() -> tuple[Path, int]:
    """A new directory, and the descriptor that holds its lock."""
    while True:
        try:
            path = Path(tempfile.mkdtemp(prefix=PRIVATE)).resolve()
        except OSError as error:
            raise HolonomError(Failure.NO_PRIVATE_DIRECTORY, detail=error.strerror or str(error)) from None
        try:
            lock = os.open(path, os.O_RDONLY)
            fcntl.flock(lock, fcntl.LOCK_EX)
        except FileNotFoundError:  # swept before it was opened
            continue
        except OSError as error:  # as of a file system without locks
            _remove(path)
            raise HolonomError(Failure.NO_PRIVATE_DIRECTORY, detail=error.strerror or str(error)) from None
        if path.exists():  # and was not swept before it was locked
            return path, lock
        os.close(lock)


def _remove_private_directory(path: Path) -> None:
    """Remove a private directory, and first the unfinished files that it has links to."""
    for link in path.glob(f"{DRAFT}*"):
        if link.is_symlink():
            _remove(link.readlink())
    remove_tree(path)


@contextmanager
def draft_of(target: Path) -> Iterator[Path]:
    """A name beside a file or directory, for what is to take its place. At the end nothing has that name.

    A command that runs under supervision links to it from its private directory: should it be killed, the draft is
    removed with that.
    """
    draft = target.with_name(f".{target.name}.{os.getpid()}.new")
    home = Path(tempfile.gettempdir())
    link = home / f"{DRAFT}{os.urandom(8).hex()}" if PRIVATE_NAME.fullmatch(home.name) else None
    if link is not None:
        link.symlink_to(draft)
    try:
        yield draft
    finally:
        _remove(draft)
        if link is not None:
            link.unlink(missing_ok=True)


def _remove(path: Path) -> None:
    if path.is_dir() and not path.is_symlink():
        remove_tree(path)
    else:
        with suppress(OSError):  # there may be no such place at all
            path.unlink()


def _sweep(path: Path) -> None:
    with suppress(OSError):
        if path.is_symlink() or path.stat().st_uid != os.getuid():
            return
        lock = os.open(path, os.O_RDONLY)
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            _remove_private_directory(path)
        finally:
            os.close(lock)


def near_file(missing: Path) -> str:
    """What a file that is missing may have been meant to be, as the end of a sentence; empty where nothing is near."""
    try:
        names = [file.name for file in missing.parent.iterdir()]
    except OSError:
        return ""
    from difflib import get_close_matches

    near = get_close_matches(missing.name, names, n=1)
    return f", but there is {missing.with_name(near[0])}" if near else ""


def write_whole(path: Path, content: str | bytes) -> None:
    """Write a file so that nobody ever sees half of it.

    Parameters
    ----------
    path : Path
        The file; what it held is replaced. A device or a pipe is written to as it is.
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
    """A file that is written piece by piece, and of which nobody ever sees a part.

    Parameters
    ----------
    path : Path
        As for `write_whole`.

    Raises
    ------
    HolonomError
        The file cannot be written; what it held is still there, as after any other exception of the block.
    """
    target = path.resolve()
    try:
        if target.exists() and not target.is_file():
            with target.open("wb") as file:
                yield file
        else:
            with draft_of(target) as draft:
                with draft.open("wb") as file:
                    yield file
                draft.replace(target)
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
    for name, text in {**files, MANIFEST: manifest}.items():
        write_whole(directory / name, text)


def written_before(directory: Path) -> frozenset[str]:
    """The files of a directory that its manifest lists, by their paths in it."""
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
    """Write a directory so that nobody ever sees half of it.

    Parameters
    ----------
    path : Path
        The directory. Of one that is there the files that its manifest lists are replaced, and the others stay.
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
        with draft_of(target) as draft:
            for name, content in {**files, MANIFEST: _manifest(files)}.items():
                (draft / name).parent.mkdir(parents=True, exist_ok=True)
                (draft / name).write_bytes(content.encode() if isinstance(content, str) else content)
            if target.exists():
                _take_along(target, draft)
            _exchange(target, draft)
    except OSError as error:
        raise _unwritable(path, error) from None


def _manifest(names: Iterable[str]) -> str:
    return "".join(f"{name}\n" for name in sorted(names))


def _take_along(directory: Path, draft: Path) -> None:
    """Copy into a directory's draft what the directory's manifest does not list."""
    listed = {*written_before(directory), MANIFEST}
    for folder, folders, names in os.walk(directory):
        kept = [Path(folder, name) for name in names] + [
            Path(folder, name) for name in folders if Path(folder, name).is_symlink()
        ]
        for file in kept:
            if str(name := file.relative_to(directory)) not in listed:
                (draft / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(file, draft / name, follow_symlinks=False)


def _exchange(target: Path, draft: Path) -> None:
    """Put a draft in the place of a directory; the old one goes, or comes back where that fails."""
    replaced = target.with_name(f".{target.name}.{os.getpid()}.old")
    try:
        if target.exists():
            target.replace(replaced)
        draft.replace(target)
    finally:
        if replaced.exists() and not target.exists():
            replaced.replace(target)
        _remove(replaced)


def _unwritable(path: Path, error: OSError) -> HolonomError:
    full = error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
    failure = Failure.DISK_FULL if full else Failure.UNWRITABLE
    return HolonomError(failure, path, error.strerror or str(error))
