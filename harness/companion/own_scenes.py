"""Pages about any scene files: cards and answers, without the textbook.

Each file has the pages of the folder `own`, in whose names the file's prefix comes first.
"""

import re
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from ..sandbox import Limits
from .chapter import FILES, Chapter
from .motions import Motion, figures_of, motions
from .runs import Run, Settings, study

TEXTS = Path(__file__).with_name("own")
PAGES = ("the-system", "equations-of-motion", "free-motion", "initial-motion", "motion")
CONTENTS = """
```{{toctree}}
:caption: {file}

{names}
```
"""


def chapters_of_scenes(
    files: Sequence[Path], settings: Settings, limits: Limits, closed_form_size: int | None = None
) -> dict[str, Chapter]:
    """Return the chapters of the pages about scene files, by page name.

    Parameters
    ----------
    files : sequence of Path
        Scene files.
    settings : Settings
        Values of parameters.
    limits : Limits
        Limits of Maxima's runs.
    closed_form_size : int or None
        Number of terms beyond which closed forms are left out, or None for each file's own.

    Returns
    -------
    dict of str to Chapter
        Chapters by page.
    """
    found: dict[str, Chapter] = {}
    for prefix, file in _prefixed(files):
        asked = file, settings, limits
        runs = {"study": Run(study, (*asked, closed_form_size)), "motions": Run(motions, asked)}
        found |= {f"{prefix}{name}": Chapter(runs, partial(_page, prefix, file, name == "motion")) for name in PAGES}
    return found


def texts_of_scenes(files: Sequence[Path]) -> dict[str, str]:
    """Return the texts of these pages, by the names of their files.

    Parameters
    ----------
    files : sequence of Path
        Scene files.

    Returns
    -------
    dict of str to str
        Texts by file name.
    """
    texts = {"index.md": (TEXTS / "index.md").read_text(encoding="utf-8")}
    for prefix, file in _prefixed(files):
        texts["index.md"] += CONTENTS.format(file=file.name, names="\n".join(f"{prefix}{name}" for name in PAGES))
        texts |= {f"{prefix}{name}.md": (TEXTS / f"{name}.md").read_text(encoding="utf-8") for name in PAGES}
    return texts


def _prefixed(files: Sequence[Path]) -> list[tuple[str, Path]]:
    """Return files with the prefixes of their page names, empty for one file."""
    return [("" if len(files) == 1 else _prefix(file, place), file) for place, file in enumerate(files, 1)]


def _prefix(file: Path, place: int) -> str:
    """Return the unique prefix of the page names of a file."""
    return f"{place}-{re.sub(r'[^a-z0-9]+', '-', file.stem.lower())}-"


def _page(prefix: str, file: Path, drawn: bool, results: Mapping[str, Any]) -> dict[str, Any]:
    """Return the content of a page of a file, with the drawings of its motions."""
    names = {name: f"{prefix}scene-{place}" for place, name in enumerate(results["motions"], 1)}
    shown = [(names[name], found) for name, found in results["motions"].items() if isinstance(found, Motion)]
    text = file.read_text(encoding="utf-8", errors="replace")
    return {"figures": names, "file": file.name, "text": text, FILES: figures_of(shown) if drawn else {}}
