"""Files and directories that appear whole or not at all."""

import os
import shutil
from collections.abc import Mapping
from pathlib import Path

from .failures import Failure, HolonomError


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
    target = path.resolve()
    data = content if isinstance(content, bytes) else content.encode()
    try:
        if target.exists() and not target.is_file():
            target.write_bytes(data)
        else:
            _replace(target, data)
    except OSError as error:
        raise HolonomError(Failure.UNWRITABLE, path, error.strerror or str(error)) from None


def write_files(directory: Path, files: Mapping[str, str]) -> None:
    """Write files into a directory, each whole or not at all; what else the directory holds stays.

    Parameters
    ----------
    directory : Path
        It is made where it is missing.
    files : mapping of str to str
        The text of each file, by its name.

    Raises
    ------
    HolonomError
        The directory cannot be made or written to.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise HolonomError(Failure.UNWRITABLE, directory, error.strerror or str(error)) from None
    for name, text in files.items():
        write_whole(directory / name, text)


def write_whole_directory(path: Path, files: Mapping[str, str]) -> None:
    """Write a directory so that nobody ever sees half of it.

    Parameters
    ----------
    path : Path
        The directory; one that is there is replaced with all that it holds.
    files : mapping of str to str
        The text of each file, by its path in the directory.

    Raises
    ------
    HolonomError
        The directory cannot be written; what was there still is.
    """
    target = path.resolve()
    draft, replaced = (target.with_name(f".{target.name}.{kind}.{os.getpid()}") for kind in ("new", "old"))
    try:
        for name, text in files.items():
            (draft / name).parent.mkdir(parents=True, exist_ok=True)
            (draft / name).write_text(text, encoding="utf-8")
        if target.exists():
            target.replace(replaced)
        draft.replace(target)
    except OSError as error:
        if replaced.exists() and not target.exists():
            replaced.replace(target)
        raise HolonomError(Failure.UNWRITABLE, path, error.strerror or str(error)) from None
    finally:
        shutil.rmtree(draft, ignore_errors=True)
        shutil.rmtree(replaced, ignore_errors=True)


def _replace(target: Path, data: bytes) -> None:
    draft = target.with_name(f".{target.name}.{os.getpid()}")
    try:
        draft.write_bytes(data)
        draft.replace(target)
    finally:
        draft.unlink(missing_ok=True)
