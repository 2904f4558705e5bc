"""How words, numbers and formulas are written on a console."""

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
    """A console that takes text for text: no markup, and nothing in it that steers a terminal."""

    def __init__(self, **options: Any) -> None:
        super().__init__(highlight=False, markup=False, emoji=False, **options)

    def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterable[Segment]:
        """Render as any console does, unseen characters by their codes."""
        for segment in super().render(renderable, options):
            yield segment if segment.control else segment._replace(text=visible(segment.text))


def html_of(show: Callable[[Console], None]) -> str:
    """Return what is shown on a console, as HTML for a notebook."""
    return _shown(show).export_html(inline_styles=True, code_format=HTML)


def text_of(show: Callable[[Console], None]) -> str:
    """Return what is shown on a console, as plain text."""
    return "\n".join(line.rstrip() for line in _shown(show).export_text().splitlines())


def styled(verdict: str) -> Text:
    """Return a verdict in its colour."""
    return Text(translated(verdict), style=STYLES[verdict])


def counted(count: int, what: str) -> str:
    """Return how many of what there are, in words."""
    return f"{count or 'no'} {what}{'' if count == 1 else 's'}"


def _shown(show: Callable[[Console], None]) -> Console:
    kept = io.StringIO()
    console = PlainConsole(record=True, width=CELL_WIDTH, file=kept, force_terminal=True, force_jupyter=False)
    show(console)
    return console
