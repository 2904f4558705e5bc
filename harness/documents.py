"""Documents that Maxima derives from a description."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from re import compile as pattern
from typing import NamedTuple

from .failures import Failure, HolonomError
from .formats import Document
from .maxima import DEFAULT_LIMITS, NO_SETTINGS, run_batch, run_description
from .sandbox import Limits
from .source import Source, describe

NAME = pattern(r"[^\W\d]\w*")
NO_SCENE = frozenset({Document.ERRATA, Document.VERSIONS})  # the paper's file holds more than a system

Argument = None | int | Fraction | str | Sequence["Argument"]


class Question(NamedTuple):
    """A document that is asked for, and what its writer in Maxima takes behind the name of the file that it writes."""

    document: Document
    arguments: tuple[Argument, ...] = ()

    def writer(self) -> str:
        """Maxima's function of the name of the file; raises where a string can be no name."""
        call = ", ".join(["file", *map(_maxima_text, self.arguments)])
        return f"lambda([file], {self.document.writer}({call}))"


def ask(
    document: Document,
    file: Source | Path,
    *arguments: Argument,
    settings: Mapping[str, str] = NO_SETTINGS,
    limits: Limits = DEFAULT_LIMITS,
) -> str:
    """Ask Maxima for a document about a scene file, which is run first unless it was before.

    Raises as `ask_all`, and where there is no document.

    Parameters
    ----------
    document : Document
        The document.
    file, settings, limits
        As for `ask_all`.
    *arguments : None, int, Fraction, str or sequence of these
        Arguments of the writer in Maxima, behind the name of the file that it writes; a string is a name.
    """
    question = Question(document, arguments)
    if document in NO_SCENE:
        return run_batch(file, question.writer(), limits, settings)
    return written(*ask_all([question], file, settings, limits))


def ask_all(
    questions: Sequence[Question],
    file: Source | Path,
    settings: Mapping[str, str] = NO_SETTINGS,
    limits: Limits = DEFAULT_LIMITS,
) -> list[str | HolonomError]:
    """Ask one process for several documents; of each, the text, or why there is none.

    Raises as `holonom.source.describe` and `holonom.maxima.run_description`; and where a string can be no name.

    Parameters
    ----------
    questions : sequence of Question
        The documents.
    file : Source or Path
        A path is run; of a source, what it has described before serves, and its limits hold.
    settings : mapping of str to str
        Numbers in Maxima's notation, for what the file leaves open and for parameters.
    limits : Limits
        Limits of a run of Maxima about a path.
    """
    if not questions:
        return []
    writers = [each.writer() for each in questions]
    if isinstance(file, Source):
        described, limits = file.description(settings), file.limits
    else:
        described = describe(file, settings, limits)
    repeated = settings if described.was_run else None
    return run_description(described.text, described.file, writers, limits, repeated)


def written(answer: str | HolonomError) -> str:
    """Return a document; raises where there is none."""
    if isinstance(answer, HolonomError):
        raise answer
    return answer


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
