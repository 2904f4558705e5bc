"""Pages about any scene files: cards and answers, without the textbook.

Each file has five chapters, in whose pages' names the file's prefix comes first.
"""

import re
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from ..language import gettext, translatable, translated
from ..sandbox import Limits
from .cards import Card, derivation_cards, files_of, missing, scene_cards
from .chapter import Chapter, Page
from .mathematics import description
from .motions import Motion, figures_of, motions
from .paper import REPOSITORY
from .runs import FileAnswers, Settings, study

EQUATIONS = ("2", "3a", "3", "4", "5", "6", "7", "8", "9", "11")
INITIAL_MOTION = ("12", "13", "18", "19")


PAGE = """# {title}

{{.subtitle}}
{aim}

```{{show}}
{{% include "{template}" %}}
```
"""
INDEX = """# {title}

```{{show}}
{{% include "own_foreword.html" %}}
```

"""
CONTENTS = """```{{toctree}}
:caption: {file}

{names}
```

"""


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
        asked = study(file, settings, limits)
        runs = {"study": asked, "motions": motions(*asked.arguments)}
        found |= {f"{prefix}{name}": Chapter(runs, partial(page, prefix, file)) for name, *_, page in CHAPTERS}
    return found


def texts_of_scenes(files: Sequence[Path]) -> dict[str, str]:
    """Return the texts of the pages in the current language, by file name.

    Parameters
    ----------
    files : sequence of Path
        Scene files.

    Returns
    -------
    dict of str to str
        Texts by file name.
    """
    texts = {"index.md": INDEX.format(title=gettext("A companion to systems of your own"))}
    for prefix, file in _prefixed(files):
        names = "\n".join(f"{prefix}{name}" for name, *_ in CHAPTERS)
        texts["index.md"] += CONTENTS.format(file=file.name, names=names)
        for name, title, aim, template, _ in CHAPTERS:
            page = PAGE.format(title=translated(title), aim=translated(aim), template=template)
            texts[f"{prefix}{name}.md"] = page
    return texts


def _prefixed(files: Sequence[Path]) -> list[tuple[str, Path]]:
    """Return files with the prefixes of their page names, empty for one file."""
    return [("" if len(files) == 1 else _prefix(file, place), file) for place, file in enumerate(files, 1)]


def _prefix(file: Path, place: int) -> str:
    """Return the unique prefix of the page names of a file."""
    return f"{place}-{re.sub(r'[^a-z0-9]+', '-', file.stem.lower())}-"


def system(prefix: str, file: Path, results: Mapping[str, FileAnswers]) -> Page:
    """Return the system as its file describes it.

    Parameters
    ----------
    prefix : str
        Beginning of the anchors.
    file : Path
        Scene file.
    results : mapping of str to FileAnswers
        Results of the run.

    Returns
    -------
    Page
        Content of the page.
    """
    derived = results["study"].derived
    cards = derivation_cards(["1"], [derived], (), REPOSITORY)
    return Page(
        {
            "record": derived.record,
            "description": description(derived.record.system),
            "cards": cards,
            "file": file.name,
            "text": file.read_text(encoding="utf-8", errors="replace"),
        },
        sources=files_of(cards),
    )


def _equations(prefix: str, file: Path, results: Mapping[str, FileAnswers]) -> Page:
    """Return the equations of motion of the system, and the verdicts on them."""
    derived = results["study"].derived
    cards = derivation_cards(EQUATIONS, [derived], (), REPOSITORY)
    closed = all(each.closed_form_operations is not None for each in derived.record.derivations)
    return Page({"cards": cards, "missing": missing(derived), "closed": closed}, sources=files_of(cards))


def _free_motion(prefix: str, file: Path, results: Mapping[str, FileAnswers]) -> Page:
    """Return the verdicts on free motion."""
    found = results["study"]
    cards = derivation_cards(["10"], [found.derived], (), REPOSITORY)
    scenes = [
        {"name": name, "title": title, "answer": found.free[name], "cards": _scene_cards(found, ["10"], name)}
        for name, title in found.titles.items()
    ]
    controlled = bool(found.derived.record.system.controls)
    return Page({"cards": cards, "scenes": scenes, "controlled": controlled}, sources=files_of(cards))


def _initial_motion(prefix: str, file: Path, results: Mapping[str, FileAnswers]) -> Page:
    """Return power series, radius and closed forms of each scene."""
    found = results["study"]
    scenes = [
        {"name": name, "title": title, "cards": _scene_cards(found, INITIAL_MOTION, name), "series": found.series[name]}
        for name, title in found.titles.items()
    ]
    return Page({"scenes": scenes}, sources=tuple(name for each in scenes for name in files_of(each["cards"])))


def motion(prefix: str, file: Path, results: Mapping[str, Any]) -> Page:
    """Return drawing and curves of the motion of each scene.

    Parameters
    ----------
    prefix : str
        Beginning of the anchors.
    file : Path
        Scene file.
    results : mapping
        Results of the runs by their names.

    Returns
    -------
    Page
        Content of the page.
    """
    found, titles = results["motions"], results["study"].titles
    scenes = [(f"{prefix}scene-{place}", titles[name], name, found[name]) for place, name in enumerate(found, 1)]
    shown = [(figure, moved) for figure, _, _, moved in scenes if isinstance(moved, Motion)]
    return Page({"scenes": scenes}, figures=figures_of(shown))


def _scene_cards(found: FileAnswers, numbers: Sequence[str], scene: str) -> list[Card]:
    """Return cards of a scene's equations, none for prescribed reactions."""
    if scene not in {each.name for each in found.record.scenes}:
        return []
    return scene_cards(numbers, [(found.derived, scene)], (), REPOSITORY, scene)


CHAPTERS = (  # slug, title, aim, template, and what makes the page
    (
        "the-system",
        translatable("The system"),
        translatable("What the file describes."),
        "own_system.html",
        system,
    ),
    (
        "equations-of-motion",
        translatable("Equations of motion"),
        translatable("Equations (2) to (9) and (11), each with its verdict."),
        "own_equations.html",
        _equations,
    ),
    (
        "free-motion",
        translatable("Free motion"),
        translatable("Whether the constraints push, and what it takes that they do not."),
        "own_free_motion.html",
        _free_motion,
    ),
    (
        "initial-motion",
        translatable("Initial motion"),
        translatable("Initial state, initial accelerations, and the power series of the motion."),
        "own_initial_motion.html",
        _initial_motion,
    ),
    (
        "motion",
        translatable("The motion"),
        translatable("How the system moves, and what its constraints have to do."),
        "own_motion.html",
        motion,
    ),
)
