"""The commands about the installation: doctor, maxima-path."""

from pathlib import Path
from typing import TYPE_CHECKING

from .group import holonom
from .options import present, writes_json

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rich.console import Console

    from ..installation import Component

MISSING = 1


@holonom.command(examples=["doctor", "doctor --json -"])
@writes_json
def doctor(json_file: Path | None) -> int:
    """List what is installed and missing.

    The report names the command that installs each missing component.
    """
    from ..formats import Publication, published
    from ..installation import Installation, components

    found = list(components())
    document = published(Publication.DOCTOR, Installation(tuple(found)))
    present(document, json_file, _show_components, found)
    return MISSING if any(each.needed and each.version is None for each in found) else 0


def _show_components(console: "Console", components: "Iterable[Component]") -> None:
    """Print installed and missing components, and the commands that install them."""
    from rich.table import Table
    from rich.text import Text

    table = Table("", "version", "for")
    hints = []
    for component in components:
        if component.version is None:
            hints.append(component.hint)
            version = Text("missing", style="bold red" if component.needed else "yellow")
        else:
            version = Text(component.version or "found", style="green")
        table.add_row(component.name, version, component.purpose)
    console.print(table)
    for hint in dict.fromkeys(hints):
        console.print(f"to install what is missing: {hint}", soft_wrap=True)
    if not hints:
        console.print("Nothing is missing.")


@holonom.command("maxima-path", examples=["maxima-path"])
def maxima_path() -> int:
    """Let Maxima load the library anywhere.

    The command puts Holonom into Maxima's user directory. There load(holonom), `? holonomic_system`,
    example(holonomic_system) and demo(holonom) work. The demonstration waits for a `;` after each step.

    The directory is MAXIMA_USERDIR, or .maxima in the home directory. Other files there are not replaced.
    """
    from ..installation import put_into_maxima, user_directory
    from .console import make_console

    stub = put_into_maxima(user_directory())
    make_console().print(f"load(holonom) in Maxima loads {stub}", soft_wrap=True)
    return 0
