"""Show the progress of a long command as a bar on standard error.

Nothing is shown if standard error is not a terminal.
"""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from ..hidden import visible_line

if TYPE_CHECKING:
    from rich.progress import Progress


@contextmanager
def progress(title: str, steps: int) -> Iterator[Callable[[], None]]:
    """Show a bar while the block runs.

    Parameters
    ----------
    title : str
        Text in front of the bar.
    steps : int
        Number of steps.

    Yields
    ------
    callable
        Call it after each step, without arguments.
    """
    with _bar(title, steps) as bar:
        yield (lambda: None) if bar is None else lambda: bar.advance(bar.task_ids[0])


@contextmanager
def motion_progress(title: str) -> Iterator[Callable[[float], None] | None]:
    """Show a bar while the block runs.

    Parameters
    ----------
    title : str
        Text in front of the bar.

    Yields
    ------
    callable or None
        Takes the completed fraction, from 0 to 1, or None if no bar is shown.
    """
    with _bar(title, 1.0) as bar:
        yield bar and (lambda fraction: bar.update(bar.task_ids[0], completed=fraction))


@contextmanager
def sweep_progress(rows: int) -> Iterator[Callable[[int], None] | None]:
    """Show completed rows, rate and remaining time while the block runs.

    Parameters
    ----------
    rows : int
        Number of rows of the sweep.

    Yields
    ------
    callable or None
        Takes the number of completed rows, or None if no bar is shown.
    """
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn

    rate = TextColumn("{task.fields[rate]}")
    with _bar("rows", rows, BarColumn(), MofNCompleteColumn(), rate, TimeRemainingColumn(compact=True)) as bar:

        def show(done: int) -> None:
            speed = bar.tasks[0].speed
            bar.update(bar.task_ids[0], completed=done, rate=f"{speed:.3g} motions/s" if speed else "")

        yield bar and show


@contextmanager
def _bar(title: str, total: float, *columns: object) -> "Iterator[Progress | None]":
    """Yield a bar with one task, or None in a pipe.

    The columns are those of rich unless others are given.
    """
    if not sys.stderr.isatty():
        yield None
        return
    from rich.markup import escape
    from rich.progress import Progress

    from .text import PlainConsole

    with Progress(*columns, console=PlainConsole(stderr=True), transient=True) as bar:
        bar.add_task(escape(visible_line(title)), total=total, rate="")
        yield bar
