"""A sweep for the terminal: its progress, and what came of its rows."""

import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

    from ...sweeps.run import Sweep


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


def show_sweep(console: "Console", sweep: "Sweep", statuses: Mapping[str, int]) -> None:
    """Print where the rows are, and how many came about how."""
    from rich.table import Table

    document = sweep.document
    names = ", ".join(axis["asked"] for axis in document["parameters"])
    console.print(f"{document['scene']['name']}: {document['rows']} motions, {names}", soft_wrap=True, markup=False)
    table = Table()
    table.add_column("status")
    table.add_column("rows", justify="right")
    for status, rows in statuses.items():
        table.add_row(status, str(rows))
    console.print(table)
    console.print(f"kept in {sweep.path}: {', '.join(document['columns'])}", soft_wrap=True, markup=False)
