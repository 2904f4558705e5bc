"""Files that appear whole or not at all."""

import os
from pathlib import Path

from harness.failures import Failure, HolonomError


def write_whole(path: Path, text: str) -> None:
    """Write a file so that nobody ever sees half of it.

    Parameters
    ----------
    path : Path
        The file; what it held is replaced. A device or a pipe is written to as it is.
    text : str
        Its new content.

    Raises
    ------
    HolonomError
        The file cannot be written; what it held is still there.
    """
    target = path.resolve()
    try:
        if target.exists() and not target.is_file():
            target.write_text(text, encoding="utf-8")
        else:
            _replace(target, text)
    except OSError as error:
        raise HolonomError(Failure.UNWRITABLE, path, error.strerror or str(error)) from None


def _replace(target: Path, text: str) -> None:
    draft = target.with_name(f".{target.name}.{os.getpid()}")
    try:
        draft.write_text(text, encoding="utf-8")
        draft.replace(target)
    finally:
        draft.unlink(missing_ok=True)
