"""The console on standard output."""

import click
from rich.console import Console

from ..display.text import PlainConsole

PIPE_WIDTH = 100_000  # columns where there is no terminal: no table is cut


def make_console() -> Console:
    """Return the console on standard output, silent under --quiet.

    Returns
    -------
    Console
    """
    ctx = click.get_current_context(silent=True)
    console = PlainConsole(quiet=ctx is not None and bool(ctx.find_root().params.get("quiet")))
    if not console.is_terminal:
        console.width = PIPE_WIDTH
    return console
