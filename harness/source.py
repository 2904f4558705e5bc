"""Sources of descriptions: a scene file, or a stored description.

A scene file runs in the sandbox.
"""

import warnings
from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from pathlib import Path

from .description import Description, is_description, read_description
from .failures import ErrorKind, HolonomError, HolonomWarning
from .formats import Document
from .maxima import DEFAULT_LIMITS, NO_SETTINGS, read_maxima_text, run_scene
from .sandbox import Limits
from .temporary import OwnDirectory


class Source:
    """A scene file that is run once for each choice of settings, or a description.

    Parameters
    ----------
    file : Path
        A scene file in Maxima's language, or a description in JSON.
    limits : Limits
        Limits of each run of Maxima.
    directory : OwnDirectory or None
        The private directory of the file. It exists as long as the source does.
    """

    def __init__(self, file: Path, limits: Limits = DEFAULT_LIMITS, directory: OwnDirectory | None = None) -> None:
        self.file, self.limits, self.directory = file, limits, directory
        self._described: dict[tuple[tuple[str, str], ...], Description] = {}
        self.waiting: list[tuple[object, Mapping[str, str]]] = []  # questions of `documents.ask_later`
        self.answers: dict[object, object] = {}  # to these questions

    @cached_property
    def text(self) -> str:
        """Text of the file at its first use, which all results belong to."""
        return read_maxima_text(self.file)

    def description(self, settings: Mapping[str, str] = NO_SETTINGS) -> Description:
        """Return the description of the file under settings.

        Parameters
        ----------
        settings : mapping of str to str
            Numbers in Maxima's notation, for what the file leaves open and for parameters.

        Returns
        -------
        Description

        Raises
        ------
        HolonomError
            As `describe`, or the file has changed since its first use.
        """
        key = tuple(sorted(settings.items()))
        if key not in self._described:
            if read_maxima_text(self.file) != self.text:
                raise HolonomError(ErrorKind.FILE_CHANGED, self.file)
            self._described[key] = describe(self.file, settings, self.limits)
        return self._described[key]


def source_of(file: Source | Path, limits: Limits) -> Source:
    """Return the source of a file.

    Parameters
    ----------
    file : Source or Path
        A source is returned unchanged.
    limits : Limits
        Limits of each run of Maxima, for a path.

    Returns
    -------
    Source
    """
    return file if isinstance(file, Source) else Source(file, limits)


def describe(file: Path, settings: Mapping[str, str] = NO_SETTINGS, limits: Limits = DEFAULT_LIMITS) -> Description:
    """Run a scene file and read its description, or read a description.

    Settings are put into a description after it is read.

    Parameters
    ----------
    file : Path
        A scene file in Maxima's language, or a description in JSON.
    settings : mapping of str to str
        Numbers in Maxima's notation, for what the file leaves open and for parameters.
    limits : Limits
        Limits of the run, and its sandbox.

    Returns
    -------
    Description

    Raises
    ------
    HolonomError
        The file is missing or invalid, asks a question or exceeds a limit. Maxima is missing. The document is not a
        description.
    """
    text = read_maxima_text(file)
    if is_description(text):
        return read_description(text, file).with_settings(settings)
    described = read_description(run_scene(file, limits, settings, str(Document.DESCRIPTION)), file)
    for name in described.unused_parameters:
        warnings.warn(f"{file}: the parameter '{name}' is declared and not used", HolonomWarning, stacklevel=2)
    return replace(described, was_run=True)
