"""Snippets of Markdown that are run, and their printed results."""

import re
import subprocess
from pathlib import Path

import pytest

BLOCK = re.compile(r"^```([^\n]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
# Commands that other tests run; here, that they take their arguments.
LONG = ("companion", "accuracy", "stability", "errata", "sweep")


def snippets_of(file: Path) -> list[tuple[str, str]]:
    """Return language and text of each block of code of a file."""
    return BLOCK.findall(file.read_text(encoding="utf-8"))


def require_parts(output: str, printed: list[str]) -> None:
    """Find each part between dots in what a command prints."""
    for part in output.split("...\n"):
        wanted = part.split()
        starts = range(len(printed) - len(wanted) + 1)
        assert any(all(map(alike, wanted, printed[at:])) for at in starts), part


def alike(wanted: str, found: str) -> bool:
    """Return True for the same word, for numbers that differ by rounding alone, and for borders of their tables."""
    try:
        return float(found) == pytest.approx(float(wanted), rel=1e-9)
    except ValueError:
        return re.sub("─+", "─", wanted) == re.sub("─+", "─", found)


def in_a_process(*command: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
