"""Names as identifiers of C and of languages like it."""

import re
import unicodedata
from collections.abc import Sequence
from pathlib import Path

from ..failures import Failure, HolonomError

IDENTIFIER = re.compile(r"[A-Za-z]\w*", re.ASCII)


def require_identifier(name: str) -> None:
    """Refuse a name that is no identifier.

    Raises
    ------
    HolonomError
        It cannot name a function.
    """
    if not IDENTIFIER.fullmatch(name):
        raise HolonomError(Failure.NOT_AN_IDENTIFIER, detail=name)


def identifiers(names: Sequence[str]) -> list[str]:
    """Return names as ends of identifiers, each another: what C does not know becomes ``_``."""
    found: list[str] = []
    for name in names:
        plain = unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode()
        identifier = re.sub(r"\W", "_", plain)
        while identifier in found or not identifier:
            identifier += "_"
        found.append(identifier)
    return found


def default_name(scene_file: Path) -> str:
    """Return the name of a scene file as an identifier."""
    name = identifiers([scene_file.stem])[0]
    return name if IDENTIFIER.fullmatch(name) else f"scene_{name}"
