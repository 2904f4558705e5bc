"""Excerpts of Maxima sources, by the name of the function that they define."""

import re
from dataclasses import dataclass

from ..failures import ErrorKind, HolonomError
from ..files import shared
from ..maxima import statement_ends


@dataclass(frozen=True)
class Excerpt:
    """A definition in a Maxima file, with the comment just above it."""

    file: str  # path of the file, relative to the root that it was asked of
    name: str  # what is defined
    text: str


def excerpt(file: str, name: str) -> Excerpt:
    """Find the definition of a Maxima function or variable in a file.

    Parameters
    ----------
    file : str
        Maxima file, relative to the root.
    name : str
        Name of the function or variable.

    Returns
    -------
    Excerpt
        Lines with their place.

    Raises
    ------
    HolonomError
        The file does not define it.
    """
    folder, _, rest = file.partition("/")
    text = (shared(folder) / rest).read_text(encoding="utf-8")
    found = re.search(rf"^{re.escape(name)}\s*(\([^()]*\)\s*:=|:)", text, re.MULTILINE)
    if found is None:
        raise HolonomError(ErrorKind.DEFINITION_MISSING, file, name)
    start = _with_comment(text, found.start())
    end = next(statement_ends(text, found.start()), len(text))
    return Excerpt(file, name, text[start:end])


def _with_comment(text: str, start: int) -> int:
    """Return the start of the comment that ends on the line above, or `start`."""
    if not text[:start].endswith("*/\n"):
        return start
    opening = text.rindex("/*", 0, start)
    return opening if text[:opening].endswith("\n\n") else start
