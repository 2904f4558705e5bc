"""Holonom in Maxima's user directory, where ``load(holonom)`` finds it from anywhere."""

import os
from pathlib import Path

from .failures import Failure, HolonomError
from .files import shared, write_files, write_whole, written_before
from .reference.maxima_help import help_files

STUB = "holonom.mac"
HELP = "holonom"
MARK = "/* Holonom, put here by `holonom maxima-path`, which puts it here anew when the library has moved. */"


def user_directory() -> Path:
    """The directory that Maxima calls maxima_userdir."""
    named = os.environ.get("MAXIMA_USERDIR")
    return Path(named or Path.home() / ".maxima").absolute()


def put_into_maxima(directory: Path) -> Path:
    """Let Maxima find the library, and its help, from a directory that it searches.

    Parameters
    ----------
    directory : Path
        It is made where it is missing.

    Returns
    -------
    Path
        The file that ``load(holonom)`` loads.

    Raises
    ------
    HolonomError
        The directory has a file of such a name that is not Holonom's, or cannot be written to.
    """
    stub, helping, files = directory / STUB, directory / HELP, help_files()
    if stub.exists() and not _is_ours(stub):
        raise HolonomError(Failure.FOREIGN_IN_MAXIMA, detail=str(stub))
    for name in files.keys() - written_before(helping):
        if (helping / name).exists():
            raise HolonomError(Failure.FOREIGN_IN_MAXIMA, detail=str(helping / name))
    write_files(helping, files)
    write_whole(stub, stub_text(shared("maxima"), helping))
    return stub


def stub_text(library: Path, helping: Path) -> str:
    """The Maxima file that loads the library and tells Maxima of its help."""
    return (
        f"{MARK}\n\n"
        f"load({_maxima_text(library / 'holonom.mac')})$\n"
        f"load({_maxima_text(library / 'help.lisp')})$\n"
        f"?holonom\\-help({_maxima_text(f'{helping}/')})$\n"
    )


def _is_ours(stub: Path) -> bool:
    try:
        return stub.read_bytes().startswith(MARK.encode())
    except OSError:
        return False


def _maxima_text(path: Path | str) -> str:
    escaped = str(path).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'
