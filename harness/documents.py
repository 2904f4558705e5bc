"""Documents that Maxima derives from a description."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from re import compile as pattern
from typing import NamedTuple

from .failures import ErrorKind, HolonomError
from .formats import Document
from .maxima import DEFAULT_LIMITS, NO_SETTINGS, run_batch, run_description
from .sandbox import Limits
from .source import Source, describe

NAME = pattern(r"[^\W\d]\w*")
NO_SCENE = frozenset({Document.ERRATA, Document.VERSIONS})  # the paper's file holds more than a system

Argument = None | int | Fraction | str | Sequence["Argument"]


class Question(NamedTuple):
    """A request for a document, with the arguments of its writer in Maxima.

    The arguments follow the name of the file that it writes.
    """

    document: Document
    arguments: tuple[Argument, ...] = ()

    def writer(self) -> str:
        """Return Maxima's function of the file name.

        Returns
        -------
        str
            A lambda expression in Maxima's notation.

        Raises
        ------
        HolonomError
            A string among the arguments is not a name.
        """
        call = ", ".join(["file", *map(_maxima_text, self.arguments)])
        return f"lambda([file], {self.document.writer}({call}))"


def ask(
    document: Document,
    file: Source | Path,
    *arguments: Argument,
    settings: Mapping[str, str] = NO_SETTINGS,
    limits: Limits = DEFAULT_LIMITS,
) -> str:
    """Ask Maxima for one document about a scene file.

    The file is run first unless it was before.

    Parameters
    ----------
    document : Document
        The document.
    file : Source or Path
        As for `ask_all`.
    *arguments : None, int, Fraction, str or sequence of these
        Arguments of the writer in Maxima, after the name of the file that it writes. A string is a name.
    settings, limits : mapping of str to str, Limits
        As for `ask_all`.

    Returns
    -------
    str
        The document.

    Raises
    ------
    HolonomError
        As `ask_all`, or there is no document.
    """
    question = Question(document, arguments)
    if document in NO_SCENE:
        return run_batch(file, question.writer(), limits, settings)
    if not isinstance(file, Source):
        return written(*ask_all([question], file, settings, limits))
    key = tuple(sorted(settings.items()))
    if (question.writer(), key) not in file.answers:
        questions = [question, *(each for each, given in file.waiting if given == settings)]
        file.waiting = [each for each in file.waiting if each[1] != settings]
        answers = ask_all(questions, file, settings, limits)
        file.answers |= {(each.writer(), key): answer for each, answer in zip(questions, answers, strict=True)}
    return written(file.answers.pop((question.writer(), key)))


def ask_later(document: Document, file: Source, *arguments: Argument, settings: Mapping[str, str]) -> None:
    """Ask for a document in the same run of Maxima as the next one.

    Parameters
    ----------
    document : Document
        The document, which `ask` returns.
    file : Source
        As for `ask_all`.
    *arguments : None, int, Fraction, str or sequence of these
        As for `ask`.
    settings : mapping of str to str
        As for `ask_all`.
    """
    file.waiting.append((Question(document, arguments), settings))


def ask_all(
    questions: Sequence[Question],
    file: Source | Path,
    settings: Mapping[str, str] = NO_SETTINGS,
    limits: Limits = DEFAULT_LIMITS,
) -> list[str | HolonomError]:
    """Ask one process for several documents. Return each text, or the error.

    Parameters
    ----------
    questions : sequence of Question
        The documents.
    file : Source or Path
        A path is run. A source reuses its earlier description and has its own limits.
    settings : mapping of str to str
        Numbers in Maxima's notation, for open names of the file and for parameters.
    limits : Limits
        Limits of a run of Maxima about a path.

    Returns
    -------
    list of str or HolonomError
        The text of each document, or the error.

    Raises
    ------
    HolonomError
        As `holonom.source.describe` and `holonom.maxima.run_description`, or a string is not a name.
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
    """Return a document, or raise its error.

    Parameters
    ----------
    answer : str or HolonomError
        An item of the result of `ask_all`.

    Returns
    -------
    str

    Raises
    ------
    HolonomError
        There is no document.
    """
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
            raise HolonomError(ErrorKind.NOT_A_SCENE_NAME, detail=argument)
        case _:
            return f"[{', '.join(map(_maxima_text, argument))}]"
