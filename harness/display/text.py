"""Format words, numbers and formulas for a console."""

import io
from collections.abc import Callable, Iterable
from typing import Any

from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment
from rich.text import Text

from ..hidden import visible
from ..language import translated

CELL_WIDTH = 110  # columns that fit a notebook's cell
HTML = '<pre style="white-space: pre; overflow-x: auto; line-height: normal">{code}</pre>'
STYLES = {
    "proved": "green",
    "agrees": "green",
    "agrees at points": "yellow",
    "disagrees": "bold red",
    "undecided": "yellow",
    "nothing to check": "dim",
    "left out": "yellow",
    "differs": "bold red",
    "present": "green",
    "absent by choice": "yellow",
    "absent by structure": "dim",
    "holds": "green",
    "loses it": "yellow",
    "fails": "bold red",
    "asymptotically stable": "green",
    "stable": "green",
    "unstable": "bold red",
}


class PlainConsole(Console):
    """A console that prints plain text, without markup or terminal control codes."""

    def __init__(self, **options: Any) -> None:
        super().__init__(highlight=False, markup=False, emoji=False, **options)

    def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterable[Segment]:
        """Render as any console does, with invisible characters as codes.

        Parameters
        ----------
        renderable : RenderableType
            Text, table or other object to print.
        options : ConsoleOptions or None
            None for the console's own.

        Yields
        ------
        Segment
            Part of a text with its style, or a control segment.
        """
        for segment in super().render(renderable, options):
            yield segment if segment.control else segment._replace(text=visible(segment.text))


def html_of(show: Callable[[Console], None]) -> str:
    """Return the console output as HTML for a notebook.

    Parameters
    ----------
    show : callable
        Prints on the console that it takes.

    Returns
    -------
    str
        One ``pre`` element with inline styles.
    """
    return _shown(show).export_html(inline_styles=True, code_format=HTML)


def text_of(show: Callable[[Console], None]) -> str:
    """Return the console output as plain text.

    Parameters
    ----------
    show : callable
        Prints on the console that it takes.

    Returns
    -------
    str
        Lines without trailing spaces.
    """
    return "\n".join(line.rstrip() for line in _shown(show).export_text().splitlines())


def styled(verdict: str) -> Text:
    """Return a verdict in its colour.

    Parameters
    ----------
    verdict : str
        A key of `STYLES`.

    Returns
    -------
    Text
        Translated into the current language.
    """
    return Text(translated(verdict), style=STYLES[verdict])


def counted(count: int, what: str) -> str:
    """Return a count with its noun.

    Parameters
    ----------
    count : int
        Number of things, not negative.
    what : str
        Singular noun whose plural ends with s.

    Returns
    -------
    str
    """
    return f"{count or 'no'} {what}{'' if count == 1 else 's'}"


def _shown(show: Callable[[Console], None]) -> Console:
    text = io.StringIO()
    console = PlainConsole(record=True, width=CELL_WIDTH, file=text, force_terminal=True, force_jupyter=False)
    show(console)
    return console
