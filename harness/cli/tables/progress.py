"""How far a long command has come: a bar on a terminal, nothing in a pipe."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import Progress


@contextmanager
def progress(title: str, steps: int) -> Iterator[Callable[[], None]]:
    """Show a progress bar while the block runs, on standard error if that is a terminal.

    Parameters
    ----------
    steps : int
        How many there are.

    Yields
    ------
    callable
        To be called after each step.
    """
    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda: None
        return
    with Progress(console=console, transient=True) as shown:
        task = shown.add_task(title, total=steps)
        yield lambda: shown.advance(task)
