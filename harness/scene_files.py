"""The files that a scene may read in the sandbox, opened.

They are the regular files below the scene's folder that its text names, and those in it that end in .mac, .lisp
or .csv. Links are not followed, nor is a hidden file or folder entered, and their size is limited.
"""

import os
import re
import stat
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

from .failures import ErrorKind, HolonomError
from .language import translatable

SUFFIXES = (".mac", ".lisp", ".csv")
STRING = re.compile(r'"((?:[^"\\\n]|\\.)*+)')  # also one that does not end, or a search takes the square of the time
MOST_FILES, MOST_BYTES = 500, 256 * 2**20


@contextmanager
def opened_scene_files(scene: Path, allowed: Iterable[Path]) -> Iterator[Mapping[Path, int]]:
    """Open the files that a scene may read, and close them at the end.

    Parameters
    ----------
    scene : Path
        The scene file.
    allowed : iterable of Path
        Further files that the scene may read.

    Yields
    ------
    mapping of Path to int
        The descriptor of each file.

    Raises
    ------
    HolonomError
        The files are too many or too large, or an allowed one cannot be read.
    """
    folder, found = scene.resolve().parent, _Opened(scene)
    try:
        for file in allowed:
            found.add(file.resolve(), _open_allowed(file))
        for name in (*_named_in(scene), *_beside(folder)):
            with suppress(OSError):  # the text means something else, or the file is a link, or not to be read
                found.add(folder / name, _open_below(folder, name))
        yield found.descriptors
    finally:
        for descriptor in found.descriptors.values():
            os.close(descriptor)


class _Opened:
    """Opened files, of limited number and size."""

    def __init__(self, scene: Path) -> None:
        self.descriptors: dict[Path, int] = {}
        self._scene, self._left = scene, MOST_BYTES

    def add(self, path: Path, descriptor: int) -> None:
        """Add a file by its descriptor, or close that if the file is known."""
        if path in self.descriptors:
            os.close(descriptor)
            return
        self.descriptors[path] = descriptor
        self._left -= os.fstat(descriptor).st_size
        if self._left < 0 or len(self.descriptors) > MOST_FILES:
            detail = translatable(
                "more than %(files)s files or %(size)s MiB", files=MOST_FILES, size=MOST_BYTES // 2**20
            )
            raise HolonomError(ErrorKind.TOO_MUCH_BESIDE, self._scene, detail)


def _named_in(scene: Path) -> list[str]:
    """Return the strings in a scene's text that may name a file below its folder."""
    text = scene.read_text(encoding="utf-8", errors="replace")
    return [name for name in dict.fromkeys(STRING.findall(text)) if _is_below(name)]


def _is_below(name: str) -> bool:
    parts = name.split("/")
    return len(name) < os.pathconf("/", "PC_NAME_MAX") and all(part and not part.startswith(".") for part in parts)


def _beside(folder: Path) -> list[str]:
    with suppress(OSError):
        return sorted(name for name in os.listdir(folder) if name.endswith(SUFFIXES) and not name.startswith("."))
    return []


def _open_below(folder: Path, name: str) -> int:
    """Open a regular file below a folder, without following links.

    Raises
    ------
    OSError
        There is no such file.
    """
    here = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    *folders, last = name.split("/")
    try:
        for each in folders:
            below = os.open(each, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW, dir_fd=here)
            os.close(here)
            here = below
        return _regular(os.open(last, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK, dir_fd=here))
    finally:
        os.close(here)


def _open_allowed(file: Path) -> int:
    try:
        return _regular(os.open(file, os.O_RDONLY | os.O_NONBLOCK))
    except OSError as error:
        raise HolonomError(ErrorKind.FILE_UNREADABLE, file, error.strerror or str(error)) from None


def _regular(descriptor: int) -> int:
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise OSError(None, "not a regular file")
    return descriptor
