"""Documents that Maxima derives from a description."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from re import compile as pattern

from .failures import Failure, HolonomError
from .formats import SCHEMAS, VERSION, Document, Publication, is_document, published, read, require, schema
from .maxima import DEFAULT_LIMITS, NO_SETTINGS, run_batch, run_description
from .sandbox import Limits
from .source import Source, describe

__all__ = [
    "SCHEMAS",
    "VERSION",
    "Document",
    "Publication",
    "ask",
    "is_document",
    "published",
    "read",
    "require",
    "schema",
]

NAME = pattern(r"[^\W\d]\w*")
NO_SCENE = frozenset({Document.ERRATA, Document.VERSIONS})  # the paper's file holds more than a system

Argument = None | int | Fraction | str | Sequence["Argument"]


def ask(
    document: Document,
    file: Source | Path,
    *arguments: Argument,
    settings: Mapping[str, str] = NO_SETTINGS,
    limits: Limits = DEFAULT_LIMITS,
) -> str:
    """Ask Maxima for a document about a scene file, which is run first unless it was before.

    Raises as `holonom.source.describe` and `holonom.maxima.run_description`; and where a string can be no name.

    Parameters
    ----------
    file : Source or Path
        A path is run; of a source, what it has described before serves, and its limits hold.
    *arguments : None, int, Fraction, str or sequence of these
        What the writer in Maxima takes behind the name of the file that it writes; a string is a name.
    settings : mapping of str to str
        Numbers in Maxima's notation, for what the file leaves open and for parameters.
    """
    call = ", ".join(["file", *map(_maxima_text, arguments)])
    writer = f"lambda([file], {document.writer}({call}))"
    if document in NO_SCENE:
        return run_batch(file, writer, limits, settings)
    described = file.description(settings) if isinstance(file, Source) else describe(file, settings, limits)
    repeated = settings if described.was_run else None
    return run_description(described.text, described.file, writer, limits, repeated)


def _maxima_text(argument: Argument) -> str:
    match argument:
        case None:
            return "false"
        case int() | Fraction():
            return str(argument)
        case str() if NAME.fullmatch(argument):
            return f"'{argument}"
        case str():
            raise HolonomError(Failure.NOT_A_SCENE_NAME, detail=argument)
        case _:
            return f"[{', '.join(map(_maxima_text, argument))}]"
