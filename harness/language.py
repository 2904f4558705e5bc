"""Translation of messages, which are written in English, by catalogs.

    with speaking("zh"):
        gettext("Chapter %(label)s", label=5)

Texts that are made before the language is known, such as a title or a reason in a result, are marked with
`translatable` and translated with `translated` when they are shown. Catalogs are
``locale/LANGUAGE/LC_MESSAGES/holonom.po``. `make catalog` collects their messages from the sources.
"""

from __future__ import annotations

import gettext as catalogs
import re
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import Any, ClassVar

from .extras import missing_package

ENGLISH = "en"
LANGUAGES = {ENGLISH: "English", "zh": "中文"}
PLACEHOLDER = re.compile(r"%\((\w+)\)s")
LOCALE, DOMAIN = Path(__file__).with_name("locale"), "holonom"
_spoken: ContextVar[str] = ContextVar("spoken", default=ENGLISH)


class Message(str):
    """A message in English with its parts, for later translation."""

    SHAPE: ClassVar = {"$ref": "#/$defs/Message"}
    DEFINITIONS: ClassVar = {
        "Message": {
            "description": "A message, or its pattern with a placeholder such as %(order)s for each value.",
            "anyOf": [
                {"type": "string"},
                {
                    "type": "object",
                    "properties": {
                        "pattern": {"description": "English message with placeholders.", "type": "string"},
                        "values": {
                            "description": "Texts or messages in the places of the placeholders, by name.",
                            "type": "object",
                            "additionalProperties": {"$ref": "#/$defs/Message"},
                        },
                    },
                    "required": ["pattern", "values"],
                    "additionalProperties": False,
                },
            ],
        }
    }

    pattern: str  # the message with its named placeholders, ``%(name)s``
    values: dict[str, Any]  # what stands in their places; messages among them are translated with it

    def __new__(cls, pattern: str, **values: Any) -> Message:
        """Return the English message, and its parts."""
        made = super().__new__(cls, pattern % values if values else pattern)
        made.pattern, made.values = pattern, values
        return made

    @staticmethod
    def of_document(content: str | dict[str, Any]) -> str:
        """Return a message of a document, given whole or as a pattern with values.

        Parameters
        ----------
        content : str or dict
            Part of the document. Values may be messages in their turn.

        Returns
        -------
        str

        Raises
        ------
        ValueError
            The pattern has a placeholder without a value, or of another form than ``%(name)s``.
        """
        if isinstance(content, str):
            return content
        pattern, values = content["pattern"], content["values"]
        if not set(PLACEHOLDER.findall(pattern)) <= values.keys() or "%" in PLACEHOLDER.sub("", pattern):
            raise ValueError(pattern)
        return Message(pattern, **{name: Message.of_document(value) for name, value in values.items()})

    def __reduce__(self) -> tuple[Any, ...]:
        return _message, (self.pattern, self.values)


def _message(pattern: str, values: dict[str, Any]) -> Message:
    return Message(pattern, **values)


translatable = Message
"""Marks a message, which is English until it is translated."""


@contextmanager
def speaking(language: str) -> Iterator[None]:
    """Translate into a language inside the block.

    Parameters
    ----------
    language : str
        A key of `LANGUAGES`.

    Yields
    ------
    None
    """
    token = _spoken.set(language)
    try:
        yield
    finally:
        _spoken.reset(token)


def spoken() -> str:
    """Return the current language of messages.

    Returns
    -------
    str
        A key of `LANGUAGES`.
    """
    return _spoken.get()


def gettext(message: str, **values: Any) -> str:
    """Return a message in the current language, with values in its placeholders.

    Parameters
    ----------
    message : str
        English message, with placeholders such as ``%(name)s``.
    **values : object
        Values of the placeholders, by name.

    Returns
    -------
    str
    """
    found = _catalog(spoken()).gettext(message) if message else message
    return found % values if values else found


def ngettext(singular: str, plural: str, count: int, **values: Any) -> str:
    """Return the form of a message that fits a count.

    Parameters
    ----------
    singular : str
        English message for one.
    plural : str
        English message for any other count.
    count : int
        It selects the form.
    **values : object
        Values of the placeholders, by name.

    Returns
    -------
    str
    """
    found = _catalog(spoken()).ngettext(singular, plural, count)
    return found % values if values else found


def translated(text: str) -> str:
    """Return a text in the current language.

    A `Message` keeps its values. Any other text is translated if the catalog has it.

    Parameters
    ----------
    text : str
        English text, perhaps a `Message`.

    Returns
    -------
    str
    """
    if not isinstance(text, Message):
        return gettext(str(text))
    values = {name: translated(each) if isinstance(each, str) else each for name, each in text.values.items()}
    return gettext(text.pattern, **values)


def catalog_file(language: str, name: str = DOMAIN) -> Path:
    """Return the path of a catalog of a language.

    Parameters
    ----------
    language : str
        A key of `LANGUAGES`.
    name : str, optional
        Name of the catalog. Messages of the program by default.

    Returns
    -------
    Path
    """
    return LOCALE / language / "LC_MESSAGES" / f"{name}.po"


@cache
def _catalog(language: str) -> catalogs.NullTranslations:
    """Return the messages of a language, or empty for English.

    Raises
    ------
    HolonomError
        Babel, which reads catalogs, is not installed.
    """
    if language == ENGLISH:
        return catalogs.NullTranslations()
    try:
        from babel.messages.mofile import write_mo
        from babel.messages.pofile import read_po
    except ImportError:
        raise missing_package("babel") from None
    compiled = BytesIO()
    with catalog_file(language).open("rb") as file:
        write_mo(compiled, read_po(file, locale=language))
    compiled.seek(0)
    return catalogs.GNUTranslations(compiled)
