"""The textbook companion: static pages whose results come from runs.

A chapter lists the runs that it needs, and computes its content from their results. A template turns that into a page.
Numbers, equations and verdicts on the pages come from the runs, and the Maxima lines from the source files, at every
build.
"""

import tomllib
from pathlib import Path
from typing import Any

TEMPLATES = Path(__file__).with_name("templates")


def table(name: str) -> dict[str, Any]:
    """Return the table of that name among the templates.

    Parameters
    ----------
    name : str
        Name of the table's file without its ending.

    Returns
    -------
    dict
        Content of the table.
    """
    return tomllib.loads((TEMPLATES / f"{name}.toml").read_text(encoding="utf-8"))
