"""How far a long command has come: a bar on a terminal, nothing in a pipe."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def progress(title: str, steps: int) -> Iterator[Callable[[], None]]:
    """Show a progress bar while the block runs, on standard error if that is a terminal.

    Yields
    ------
    callable
        To be called after each step.
    """
    if not sys.stderr.isatty():
        yield lambda: None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as shown:
        task = shown.add_task(title, total=steps)
        yield lambda: shown.advance(task)


@contextmanager
def motion_progress(title: str) -> Iterator[Callable[[float], None] | None]:
    """Show a progress bar while the block runs, on standard error if that is a terminal.

    Yields
    ------
    callable or None
        Takes the fraction that is done; None in a pipe, where nothing is shown.
    """
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as shown:
        task = shown.add_task(title, total=1.0)
        yield lambda fraction: shown.update(task, completed=fraction)


@contextmanager
def sweep_progress(rows: int) -> Iterator[Callable[[int], None] | None]:
    """Show rows, rate and time left while the block runs, on standard error if that is a terminal.

    Parameters
    ----------
    rows : int
        All there are to be.

    Yields
    ------
    callable or None
        Takes the rows that are there; None in a pipe, where nothing is shown.
    """
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[rate]}"),
        TimeRemainingColumn(compact=True),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as shown:
        task = shown.add_task("rows", total=rows, rate="")

        def show(done: int) -> None:
            speed = shown.tasks[0].speed
            shown.update(task, completed=done, rate=f"{speed:.3g} motions/s" if speed else "")

        yield show
