"""How far a long command has come: a bar on standard error if that is a terminal, nothing in a pipe."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from ..hidden import visible_line

if TYPE_CHECKING:
    from rich.progress import Progress


@contextmanager
def progress(title: str, steps: int) -> Iterator[Callable[[], None]]:
    """Show a bar while the block runs; what it gives is called after each step."""
    with _bar(title, steps) as bar:
        yield (lambda: None) if bar is None else lambda: bar.advance(bar.task_ids[0])


@contextmanager
def motion_progress(title: str) -> Iterator[Callable[[float], None] | None]:
    """Show a bar while the block runs; what it gives takes the fraction that is done, and is None in a pipe."""
    with _bar(title, 1.0) as bar:
        yield bar and (lambda fraction: bar.update(bar.task_ids[0], completed=fraction))


@contextmanager
def sweep_progress(rows: int) -> Iterator[Callable[[int], None] | None]:
    """Show rows, rate and time left while the block runs; what it gives takes the rows done, and is None in a pipe."""
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn

    rate = TextColumn("{task.fields[rate]}")
    with _bar("rows", rows, BarColumn(), MofNCompleteColumn(), rate, TimeRemainingColumn(compact=True)) as bar:

        def show(done: int) -> None:
            speed = bar.tasks[0].speed
            bar.update(bar.task_ids[0], completed=done, rate=f"{speed:.3g} motions/s" if speed else "")

        yield bar and show


@contextmanager
def _bar(title: str, total: float, *columns: object) -> "Iterator[Progress | None]":
    """Provide a bar with one task, its columns those of rich unless they are given; None in a pipe."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich.markup import escape
    from rich.progress import Progress

    from .text import PlainConsole

    with Progress(*columns, console=PlainConsole(stderr=True), transient=True) as bar:
        bar.add_task(escape(visible_line(title)), total=total, rate="")
        yield bar
