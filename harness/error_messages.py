"""Messages of errors for a catalog, with which pages show them in other languages."""

from functools import reduce
from string import Formatter

from .failures import ErrorKind, HolonomError, argument
from .language import Message, translatable


def translatable_error(error: HolonomError) -> Message:
    """Return the message of an error for a catalog: the place, the reason, the hints.

    Parameters
    ----------
    error : HolonomError
        An error.

    Returns
    -------
    Message
        Options are spelt as arguments in Python.
    """
    facts = {"detail": error.detail, **error.facts}
    found = Message(pattern_of(error.kind.reason), **facts)
    for place in filter(None, (argument(error.option), error.place)):
        found = translatable("%(place)s: %(reason)s", place=place, reason=found)
    hints = [Message(pattern_of(hint), **facts, **ARGUMENTS) for hint in error.kind.hints]
    return translatable("%(reason)s (%(hints)s)", reason=found, hints=reduce(_either, hints)) if hints else found


def pattern_of(text: str) -> str:
    """Return a reason or a hint as a message of a catalog.

    Parameters
    ----------
    text : str
        With placeholders such as ``{detail}``, ``{time:.10g}`` and ``{--until}``.

    Returns
    -------
    str
        With placeholders such as ``%(detail)s``, ``%(time).10g`` and ``%(__until)s``.
    """
    return "".join(
        before + (f"%({name.replace('-', '_')}){form or 's'}" if name else "")
        for before, name, form, _ in Formatter().parse(text)
    )


def _either(first: Message, last: Message) -> Message:
    return translatable("%(first)s, or %(last)s", first=first, last=last)


ARGUMENTS = {
    name.replace("-", "_"): argument(name)
    for kind in ErrorKind
    for hint in kind.hints
    for _, name, *_ in Formatter().parse(hint)
    if name and name.startswith("--")
}
"""Arguments in Python, by the placeholders of `pattern_of`."""
