"""Pages about any scene files: cards and answers, without the textbook.

Each file has the pages of the folder `own`, in whose names the file's prefix comes first.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..error_messages import translatable_error
from ..failures import HolonomError
from ..sandbox import Limits
from ..source import describe
from .chapter import Chapter
from .motions import motion
from .runs import NO_SETTINGS, Derived, Run, Settings, answer, derive

TEXTS = Path(__file__).with_name("own")
PAGES = ("the-system", "equations-of-motion", "free-motion", "initial-motion", "motion")
OPTIONS_OF_SERIES = (("order", 40),)
NOT_OF_NAMES = re.compile(r"[^a-z0-9]+")
CONTENTS = """
```{{toctree}}
:caption: {file}

{names}
```
"""


@dataclass(frozen=True)
class FileAnswers:
    """Answers about one scene file. A text is the reason for a missing one.

    Those about scenes are by the scenes' names.
    A scene that prescribes reactions is not in the record, but it has its free motion and its series.
    """

    name: str
    text: str
    derived: Derived
    titles: Mapping[str, str]
    free: Mapping[str, Any]
    series: Mapping[str, Any]
    motions: Mapping[str, Any]


def or_reason(compute: Callable[..., Any], *arguments: Any) -> Any:
    """Return the value of a function, or the reason for its error.

    Parameters
    ----------
    compute : callable
        Function to call.
    *arguments : Any
        Arguments of the function.

    Returns
    -------
    Any
        Result, or the message of the error.
    """
    try:
        return compute(*arguments)
    except HolonomError as error:
        return translatable_error(error)


def answers(file: Path, settings: Settings, limits: Limits) -> FileAnswers:
    """Return all answers about a scene file.

    Parameters
    ----------
    file : Path
        Scene file.
    settings : Settings
        Values of parameters.
    limits : Limits
        Limits of Maxima's runs.

    Returns
    -------
    FileAnswers
        Derivation, and free motion, series and motion by scene.
    """
    titles = {scene.name: scene.title for scene in describe(file, dict(settings), limits).scenes}
    return FileAnswers(
        file.name,
        file.read_text(encoding="utf-8", errors="replace"),
        derive(file, settings, limits),
        titles,
        {name: or_reason(answer, "free", file, name, NO_SETTINGS, settings, limits) for name in titles},
        {name: or_reason(answer, "series", file, name, OPTIONS_OF_SERIES, settings, limits) for name in titles},
        {name: or_reason(motion, file, name, None, settings, limits) for name in titles},
    )


def chapters_of_scenes(files: Sequence[Path], settings: Settings, limits: Limits) -> dict[str, Chapter]:
    """Return the chapters of the pages about scene files, by page name.

    Parameters
    ----------
    files : sequence of Path
        Scene files.
    settings : Settings
        Values of parameters.
    limits : Limits
        Limits of Maxima's runs.

    Returns
    -------
    dict of str to Chapter
        Chapters by page.
    """
    found: dict[str, Chapter] = {}
    for prefix, file in _prefixed(files):
        chapter = Chapter({"answers": Run(answers, (file, settings, limits))})
        found |= {f"{prefix}{name}": chapter for name in PAGES}
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
    """Return files with the unique prefixes of their page names, empty for one file."""
    if len(files) == 1:
        return [("", files[0])]
    return [(f"{place}-{NOT_OF_NAMES.sub('-', file.stem.lower())}-", file) for place, file in enumerate(files, 1)]
