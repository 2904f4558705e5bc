"""Maxima with the library already loaded, kept as an image in the user's cache: each run is spared the loading.

In it the library's Lisp functions, and those that runs are made of, are compiled (`preload.lisp`).
An image is made when it is first wanted, by Maxima itself, and bears the name of all that it depends on: the program,
the library's text, this file. It is used only where it belongs to the user, is out of others' reach, and has the
checksum that it was made with; where there is none, or none can be made, a run loads the library, and finds the same.
The checksum of so large a file takes as long as Maxima does: it is taken when the machine was started since, or the
file is another, or was written to.
A process holds the image that it uses by a lock, from before it looks at it to its own end; every other one removes
what nobody has used for long, or what is too many, and nothing that is held.
Only GCL 2.6, on which Maxima of Debian 12 runs, makes them here.
"""

import fcntl
import os
import shutil
import stat
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from hashlib import file_digest, sha256
from pathlib import Path
from secrets import token_hex
from shutil import disk_usage

from .confined import MIB, Confinement, LimitExceeded, Limits, Sandbox, run_confined
from .files import draft_of, private_directory

# What Debian's script sets before it starts Maxima on GCL, and what follows the program's name there.
ENVIRONMENT = {"GCL_GC_PAGE_THRESH": "0.2", "GCL_GC_ALLOC_MIN": "0.01", "GCL_GC_PAGE_MAX": "0.05"}
ARGUMENTS = ("-eval", "(cl-user::run)", "-f", "--")
QUIET = ("--init=/dev/null", "--very-quiet")

KEPT = 3  # images, of so many versions or installations; more while they are in use
MOST = 8  # images, whenever they were last used: a gigabyte
IN_USE = 3600.0  # seconds after its last use for which an image is one of these
DAY = 86400.0  # seconds
UNUSED = 7 * DAY  # after which the last one goes, too
FREE_SPACE = 1024 * MIB  # on a fuller disk none is made
MAKING = Limits(seconds=100.0, sandbox=Sandbox.TRUSTED)  # the library alone is run
BOOT = Path("/proc/sys/kernel/random/boot_id")  # Linux names there each start of the machine
PRELOAD = Path(__file__).with_name("preload.lisp")
JOBS = tuple(Path(__file__).with_name(f"{name}.lisp") for name in ("headless", "description"))  # what runs are made of
COMPILED = ("functions.lisp", "functions.o")  # all Lisp functions, and what they were compiled to


_held: list[int] = []
_known: dict[tuple[str, Path, frozenset], Path | None] = {}


class _MadeElsewhere(Exception):
    """Another process is making an image."""


def preloaded_image(maxima: str, library: Path, environment: frozenset[tuple[str, str]]) -> Path | None:
    """The program that is Maxima with the library loaded.

    Parameters
    ----------
    maxima : str
        The path of Maxima.
    environment : frozenset of (str, str)
        What of the environment Maxima is started with.

    Returns
    -------
    Path or None
        It takes `ARGUMENTS` before Maxima's own; None where there is none and none can be made, or it was taken away,
        or while another process makes one.
    """
    asked = (maxima, library, environment)
    if asked not in _known:
        with suppress(_MadeElsewhere):
            _known[asked] = _image(*asked)
    image = _known.get(asked)
    return image if image is not None and image.exists() else None


def _image(maxima: str, library: Path, environment: frozenset[tuple[str, str]]) -> Path | None:
    with suppress(OSError, RuntimeError):  # RuntimeError: there is no home directory
        folder = _own_folder()
        image = folder / f"{_name(maxima, library, environment)}.image"
        if not _is_sound(image):
            with _alone_in(folder):
                if not _is_sound(image):
                    _make(image, maxima, library, dict(environment))
                _hold(image)
        with suppress(OSError):  # another process removes them
            _remove_unused_ones(folder)
        if image.stat().st_size:
            _note(image)
            return image
    return None


def quoted(text: str | Path) -> str:
    """A string literal, for Lisp and for Maxima alike."""
    return '"' + str(text).replace("\\", "\\\\").replace('"', '\\"') + '"'


def _own_folder() -> Path:
    """The folder of the images; refused where others may write to it."""
    folder = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache", "holonom")
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    found = folder.lstat()
    if not stat.S_ISDIR(found.st_mode) or found.st_uid != os.getuid() or found.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
        raise PermissionError(None, "it is not the user's own", str(folder))
    return folder.resolve()


def _name(maxima: str, library: Path, environment: frozenset[tuple[str, str]]) -> str:
    program = Path(maxima).resolve()
    known = [program, program.stat().st_size, program.stat().st_mtime_ns, library, sorted(environment)]
    texts = [Path(__file__), PRELOAD, *JOBS, *sorted(_texts(library))]
    return sha256(b"\0".join([repr(known).encode(), *(each.read_bytes() for each in texts)])).hexdigest()


def _texts(library: Path) -> Iterator[Path]:
    return (file for file in library.rglob("*") if file.suffix in (".mac", ".lisp"))


@contextmanager
def _alone_in(folder: Path) -> Iterator[None]:
    """See that one process at a time makes an image; several would make the same, each the slower for the others."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        with suppress(OSError):  # a file system without locks
            try:
                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                raise _MadeElsewhere from None
        yield
    finally:
        os.close(descriptor)


def _is_sound(image: Path) -> bool:
    """Whether there is an image, held from now on, and as it was made, or no need to try again to make one."""
    return _hold(image) and (_is_as_seen(image) or _is_whole(image)) and not _is_to_be_tried_again(image)


def _is_whole(*files: Path) -> bool:
    """Whether files are there with the checksum that was taken when they were made."""
    try:
        return _checksum(files) == _checksum_file(files).read_text(encoding="ascii")
    except (OSError, UnicodeDecodeError):
        return False


def _is_as_seen(image: Path) -> bool:
    """Whether it is the file, in the state, whose checksum was last found right, and since the machine was started."""
    try:
        return _sight_file(image).read_text(encoding="ascii") == _sight(image)
    except (OSError, UnicodeDecodeError):
        return False


def _note(image: Path) -> None:
    """Keep that an image is whole, and when it was last used."""
    _sight_file(image).write_text(_sight(image), encoding="ascii")


def _sight(image: Path) -> str:
    """What changes whenever a file does; nobody can set the time of its last change."""
    found = image.stat()
    boot = BOOT.read_text(encoding="ascii") if BOOT.exists() else token_hex()
    return f"{boot}{found.st_ino} {found.st_size} {found.st_mtime_ns} {found.st_ctime_ns}"


def _sight_file(image: Path) -> Path:
    return image.with_suffix(".seen")


def _is_to_be_tried_again(image: Path) -> bool:
    """Whether it is a day since no image could be made: what was in the way may be gone."""
    found = image.stat()
    return found.st_size == 0 and found.st_mtime < time.time() - DAY


def _checksum(files: Sequence[Path]) -> str:
    whole = sha256()
    for each in files:
        with each.open("rb") as file:
            whole.update(file_digest(file, "sha256").digest())
    return whole.hexdigest()


def _checksum_file(files: Sequence[Path]) -> Path:
    return files[0].with_suffix(".sha256")


def _make(image: Path, maxima: str, library: Path, environment: Mapping[str, str]) -> None:
    """Have Maxima save itself with the library; an empty file says that it cannot, or that the image does not run."""
    if disk_usage(image.parent).free < FREE_SPACE:
        raise OSError(None, "there is too little space", str(image))
    kept = [image.with_name(name) for name in COMPILED]
    with private_directory() as directory, draft_of(image) as draft:
        inside = {"HOME": str(directory), "TMPDIR": str(directory), "MAXIMA_USERDIR": str(directory), "LC_ALL": "C"}
        confinement = Confinement(directory, {**environment, **ENVIRONMENT, **inside}, (), MAKING)
        _take_along(kept, directory)
        runs = False
        with suppress(LimitExceeded):
            _save(draft, maxima, library, confinement)
            runs = _runs(draft, confinement)
        if not runs:
            draft.unlink(missing_ok=True)
            draft.touch()
        _keep([directory / name for name in COMPILED], kept)
        _checksum_file([image]).write_text(_checksum([draft]), encoding="ascii")
        draft.replace(image)


def _save(draft: Path, maxima: str, library: Path, confinement: Confinement) -> None:
    """Have Maxima save itself with the library; there is no draft where it cannot."""
    names = " ".join(map(quoted, (library, *JOBS)))
    asked = f"{PRELOAD.read_text(encoding='utf-8')}\n(save-with-library {names})\n"
    (confinement.directory / "save.lisp").write_text(asked, encoding="utf-8")
    run_confined([maxima, *QUIET, "--preload-lisp=save.lisp"], confinement, bytearray())
    saved = confinement.directory / "image"
    if saved.exists():
        shutil.move(saved, draft)
        draft.chmod(0o500)


def _runs(program: Path, confinement: Confinement) -> bool:
    return run_confined([str(program), *ARGUMENTS, *QUIET, "--batch-string=quit();"], confinement, bytearray()) == 0


def _take_along(kept: Sequence[Path], directory: Path) -> None:
    """Copy what was compiled before, and take the copies only if they are whole: others may exchange it meanwhile."""
    copies = [directory / f"kept{each.suffix}" for each in kept]
    with suppress(FileNotFoundError):
        for source, target in zip((*kept, _checksum_file(kept)), (*copies, _checksum_file(copies)), strict=True):
            shutil.copy(source, target)
    if not _is_whole(*copies):
        for copy in copies:
            copy.unlink(missing_ok=True)


def _keep(made: Sequence[Path], kept: Sequence[Path]) -> None:
    """Keep what was compiled; the checksum is that of the two files together, whoever else exchanges one of them."""
    if all(each.exists() for each in made):
        checksum = _checksum(made)
        for source, target in zip(made, kept, strict=True):
            shutil.move(source, target)
        _checksum_file(kept).write_text(checksum, encoding="ascii")


def _hold(image: Path) -> bool:
    """Have an image stay until this process ends; whether it is there."""
    try:
        descriptor = os.open(image, os.O_RDONLY)
    except FileNotFoundError:
        return False
    with suppress(OSError):  # a file system without locks, on which nothing is removed either
        fcntl.flock(descriptor, fcntl.LOCK_SH)
    _held.append(descriptor)
    return image.exists()  # and was not removed before it was locked


def _remove_unused_ones(folder: Path) -> None:
    now = time.time()
    idle = {image: now - _last_used(image) for image in folder.glob("*.image")}
    images = sorted((each for each in idle if each.stat().st_size), key=idle.__getitem__)
    stay = {each for each in images[:MOST] if idle[each] < IN_USE}
    stay |= {each for each in images[:KEPT] if idle[each] < UNUSED}
    stay |= {each for each in idle if each not in images and idle[each] < DAY}  # they say that none can be made
    for each in idle.keys() - stay:
        _remove(each)


def _remove(image: Path) -> None:
    """Remove an image and what is noted of it, unless a process holds it."""
    with suppress(OSError), image.open("rb") as file:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        for each in (image, _checksum_file([image]), _sight_file(image)):
            each.unlink(missing_ok=True)


def _last_used(image: Path) -> float:
    try:
        return _sight_file(image).stat().st_mtime
    except FileNotFoundError:
        return image.stat().st_mtime
