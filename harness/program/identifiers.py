"""Names as identifiers of C and of languages like it."""

import re
import unicodedata
from collections.abc import Sequence
from pathlib import Path

from ..failures import ErrorKind, HolonomError

IDENTIFIER = re.compile(r"[A-Za-z]\w*", re.ASCII)


def require_identifier(name: str) -> None:
    """Reject an invalid identifier.

    Parameters
    ----------
    name : str
        Letters, digits and ``_`` of ASCII, a letter first.

    Raises
    ------
    HolonomError
        It cannot name a function.
    """
    if not IDENTIFIER.fullmatch(name):
        raise HolonomError(ErrorKind.NOT_AN_IDENTIFIER, detail=name)


def identifiers(names: Sequence[str]) -> list[str]:
    """Return distinct ends of identifiers for names.

    Characters that C does not allow become ``_``.

    Parameters
    ----------
    names : sequence of str
        Any names.

    Returns
    -------
    list of str
        One for each name, in order.
    """
    found: dict[str, None] = {}
    for name in names:
        plain = unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode()
        identifier = re.sub(r"\W", "_", plain)
        while identifier in found or not identifier:
            identifier += "_"
        found[identifier] = None
    return list(found)


def default_name(scene_file: Path) -> str:
    """Return the name of a scene file as an identifier.

    Parameters
    ----------
    scene_file : Path
        Path of the scene file. Only its name without suffix is used.

    Returns
    -------
    str
        An identifier of C.
    """
    name = identifiers([scene_file.stem])[0]
    return name if IDENTIFIER.fullmatch(name) else f"scene_{name}"
