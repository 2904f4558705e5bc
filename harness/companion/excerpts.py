"""Statements of scene files, by the name that they define."""

from ..failures import ErrorKind, HolonomError
from ..files import shared
from ..maxima import statement_ends


def excerpt(file: str, name: str) -> str:
    """Return the statement of an example that assigns a name.

    Parameters
    ----------
    file : str
        Scene file, relative to the folder of the examples.
    name : str
        Name that the statement assigns, at the beginning of a line.

    Returns
    -------
    str
        Lines as they are in the file.

    Raises
    ------
    HolonomError
        The file does not assign the name.
    """
    text = "\n" + (shared("examples") / file).read_text(encoding="utf-8")
    start = text.find(f"\n{name} : ") + 1
    if not start:
        raise HolonomError(ErrorKind.DEFINITION_MISSING, file, name)
    return text[start : next(statement_ends(text, start), len(text))]
