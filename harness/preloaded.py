"""Images of Maxima with the library loaded, cached to spare each run the loading.

In an image the library's Lisp functions, and those that runs are made of, are compiled (`preload.lisp`). The name of
an image is the hash of its dependencies: the program, the library's text, this file. An image is written completely,
after it ran once, and is used unchanged. If there is none, or none can be made, a run loads the library, with the
same results. Only GCL, on which Maxima of Debian runs, makes them here.
"""

import fcntl
import os
import shutil
import stat
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

from .sandbox import MIB, LimitExceeded, Limits, Place, Sandbox, run_process
from .temporary import private_directory

# What Debian's script sets before it starts Maxima on GCL, and what follows the program's name there.
ENVIRONMENT = {"GCL_GC_PAGE_THRESH": "0.2", "GCL_GC_ALLOC_MIN": "0.01", "GCL_GC_PAGE_MAX": "0.05"}
ARGUMENTS = ("-eval", "(cl-user::run)", "-f", "--")
QUIET = ("--init=/dev/null", "--very-quiet")

MOST_IMAGES = 8  # images, of several versions or installations: one or two gigabytes
FREE_SPACE = 1024 * MIB  # on a fuller disk none is made
ASKED_AGAIN = 3600.0  # seconds after which a Maxima that made none tries again: the machine may have been busy
MAKING = Limits(seconds=300.0, sandbox=Sandbox.TRUSTED)  # only the library is run
MEMORY_OF_IMAGES = 1024  # MiB that GCL takes the machine to have: GCL 2.7 saves all pages that it allocated
PRELOAD = Path(__file__).with_name("preload.lisp")
JOBS = (Path(__file__).with_name("headless.lisp"),)  # what runs are made of

_known: dict[tuple[str, Path, frozenset], Path] = {}


def preloaded_image(maxima: str, library: Path, environment: frozenset[tuple[str, str]]) -> Path | None:
    """Return the program that is Maxima with the library loaded.

    It takes `ARGUMENTS` before Maxima's own.

    Parameters
    ----------
    maxima : str
        Path of Maxima.
    library : Path
        Folder of the library.
    environment : frozenset of (str, str)
        The part of the environment that Maxima is started with.

    Returns
    -------
    Path or None
        None if there is no image and none can be made, or while another process makes one.
    """
    asked = (maxima, library, environment)
    with suppress(OSError, RuntimeError):  # RuntimeError: there is no home directory
        if asked not in _known:
            _known[asked] = _own_folder() / f"{_name(*asked)}.image"
        image = _known[asked]
        _remove_old_failure(image)
        if not image.exists():
            _make_alone(image, *asked)
        return image if image.stat().st_size else None  # an empty file: this Maxima made none
    return None


def remove_if_broken(image: Path, place: Place) -> None:
    """Remove an image that does not run, so that the next run makes it again.

    Parameters
    ----------
    image : Path
        The image.
    place : Place
        Surroundings in which it has failed.
    """
    with suppress(LimitExceeded, OSError):
        if not _runs(image, replace(place, limits=MAKING)):
            image.unlink()


def share_of_memory(mebibytes: int) -> str:
    """Return the share of the machine's memory that GCL is to count with.

    Parameters
    ----------
    mebibytes : int
        Memory in MiB.

    Returns
    -------
    str
        A number, for the environment.
    """
    return f"{mebibytes * MIB / (os.sysconf('SC_PHYS_PAGES') * os.sysconf('SC_PAGE_SIZE')):.6f}"


def quoted(text: str | Path) -> str:
    """Return a string literal, for Lisp and for Maxima alike.

    Parameters
    ----------
    text : str or Path
        Any text.

    Returns
    -------
    str
    """
    return '"' + str(text).replace("\\", "\\\\").replace('"', '\\"') + '"'


def _own_folder() -> Path:
    """Return the folder of the images, or raise if others may write to it."""
    given = Path(os.environ.get("XDG_CACHE_HOME", ""))  # a relative one is ignored, as its standard requires
    folder = Path(given if given.is_absolute() else Path.home() / ".cache", "holonom")
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    found = folder.lstat()
    if not stat.S_ISDIR(found.st_mode) or found.st_uid != os.getuid() or found.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
        raise PermissionError(None, "it is not the user's own", str(folder))
    return folder.resolve()


def _name(maxima: str, library: Path, environment: frozenset[tuple[str, str]]) -> str:
    program = Path(maxima).resolve()
    passed = sorted((each, value) for each, value in environment if each != "PATH")  # Maxima has been found by it
    known = [program, program.stat().st_size, program.stat().st_mtime_ns, library, passed]
    library_files = sorted(file for file in library.rglob("*") if file.suffix in (".mac", ".lisp"))
    texts = [Path(__file__), PRELOAD, *JOBS, *library_files]
    return sha256(b"\0".join([repr(known).encode(), *(each.read_bytes() for each in texts)])).hexdigest()


def _remove_old_failure(image: Path) -> None:
    with suppress(FileNotFoundError):
        found = image.stat()
        if not found.st_size and time.time() - found.st_mtime > ASKED_AGAIN:
            image.unlink()


def _make_alone(image: Path, maxima: str, library: Path, environment: frozenset[tuple[str, str]]) -> None:
    """Make an image unless another process is making one.

    Several processes would make the same image and slow each other down.

    Raises
    ------
    OSError
        Another process makes one, or the disk is full.
    """
    lock = os.open(image.parent, os.O_RDONLY)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        if shutil.disk_usage(image.parent).free < FREE_SPACE:
            raise OSError(None, "there is too little space", str(image))
        if not image.exists():
            _make(image, maxima, library, dict(environment))
    finally:
        os.close(lock)


def _make(image: Path, maxima: str, library: Path, environment: Mapping[str, str]) -> None:
    """Have Maxima save an image with the library.

    An empty file records that it cannot, or that the image does not run.
    """
    with private_directory() as directory:
        inside = {name: str(directory) for name in ("HOME", "TMPDIR", "MAXIMA_USERDIR")}
        inside |= {"LC_ALL": "C", "GCL_MEM_MULTIPLE": share_of_memory(MEMORY_OF_IMAGES)}
        place = Place(directory, {**environment, **ENVIRONMENT, **inside}, MAKING)
        saved = directory / "image"
        if not _saves(saved, maxima, library, place):
            saved.write_bytes(b"")
        saved.chmod(0o500)
        _put(saved, image)


def _saves(saved: Path, maxima: str, library: Path, place: Place) -> bool:
    """Save an image of Maxima. Return True if that succeeds and the image runs."""
    asked = f"{PRELOAD.read_text(encoding='utf-8')}\n(save-with-library {' '.join(map(quoted, (library, *JOBS)))})\n"
    (place.directory / "save.lisp").write_text(asked, encoding="utf-8")
    with suppress(LimitExceeded):
        run_process([maxima, *QUIET, "--preload-lisp=save.lisp"], place, bytearray())
        return saved.exists() and _runs(saved, place)
    return False


def _runs(image: Path, place: Place) -> bool:
    return run_process([str(image), *ARGUMENTS, *QUIET, "--batch-string=quit();"], place, bytearray()) == 0


def _put(saved: Path, image: Path) -> None:
    """Write an image completely, and remove the oldest ones beyond the limit."""
    draft = image.with_suffix(".draft")  # of the one process that holds the lock
    shutil.copy(saved, draft)
    with draft.open("rb") as file:
        os.fsync(file.fileno())
    draft.replace(image)
    images = sorted(image.parent.glob("*.image"), key=lambda each: each.stat().st_mtime)
    for each in images[:-MOST_IMAGES]:
        each.unlink(missing_ok=True)
