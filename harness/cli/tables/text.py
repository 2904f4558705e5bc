"""The console, and how words, numbers and formulas are written on it."""

from rich.console import Console
from rich.text import Text

PIPE_WIDTH = 160  # columns where there is no terminal to ask
STYLES = {
    "proved": "green",
    "agrees": "green",
    "disagrees": "bold red",
    "differs": "bold red",
    "present": "green",
    "absent by choice": "yellow",
    "absent by structure": "dim",
    "holds": "green",
    "loses it": "yellow",
    "fails": "bold red",
}


def make_console() -> Console:
    """Console on standard output."""
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = PIPE_WIDTH
    return console


def formula(expression: object) -> str:
    """One line in the notation of the scene files."""
    return str(expression).replace("**", "^")


def styled(verdict: str) -> Text:
    """A verdict in its colour."""
    return Text(verdict, style=STYLES[verdict])


def counted(count: int, what: str) -> str:
    """How many of what there are, in words."""
    return f"{count or 'no'} {what}{'' if count == 1 else 's'}"
