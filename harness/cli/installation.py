"""The commands about the installation: doctor, maxima-path."""

from dataclasses import asdict
from pathlib import Path

from .group import holonom
from .options import STANDARD_OUTPUT, json_text, publish, writes_json

MISSING = 1


@holonom.command()
@writes_json
def doctor(json_file: Path | None) -> int:
    """Say what is installed, what is missing, and the command that installs it."""
    from ..documents import Publication, published
    from ..installation import components
    from .tables.installation import show_components
    from .tables.text import make_console

    found = list(components())
    publish(json_text(published(Publication.DOCTOR, {"components": [asdict(each) for each in found]})), json_file)
    if json_file != STANDARD_OUTPUT:
        show_components(make_console(), found)
    return MISSING if any(each.needed and each.version is None for each in found) else 0


@holonom.command("maxima-path")
def maxima_path() -> int:
    """Put Holonom into Maxima's user directory, where load(holonom) finds it from anywhere.

    Then `? holonomic_system`, example(holonomic_system) and demo(holonom) work in Maxima as well. The directory is the
    one that MAXIMA_USERDIR names, or .maxima in the home directory; no file of yours there is replaced.
    """
    from ..maxima_path import put_into_maxima, user_directory
    from .tables.text import make_console

    stub = put_into_maxima(user_directory())
    make_console().print(f"load(holonom) in Maxima loads {stub}", soft_wrap=True, markup=False)
    return 0
