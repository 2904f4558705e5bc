"""What is installed, as a table."""

from collections.abc import Iterable

from rich.console import Console
from rich.table import Table
from rich.text import Text

from ...installation import Component


def show_components(console: Console, components: Iterable[Component]) -> None:
    """Print what is installed and what is missing, and the commands that install it."""
    table = Table("", "version", "for")
    remedies = []
    for component in components:
        if component.version is None:
            remedies.append(component.remedy)
            version = Text("missing", style="bold red" if component.needed else "yellow")
        else:
            version = Text(component.version or "found", style="green")
        table.add_row(component.name, version, component.purpose)
    console.print(table)
    for remedy in dict.fromkeys(remedies):
        console.print(f"to install what is missing: {remedy}", soft_wrap=True, markup=False)
    if not remedies:
        console.print("Nothing is missing.")
