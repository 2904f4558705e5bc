"""The book of somebody's own scene files: the same cards and answers, without the teaching.

Each file has five chapters, in whose pages' names the file's prefix comes first.
"""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ..confined import Limits
from ..language import translatable
from .book import Book
from .cards import Card, derivation_cards, files_of, missing, scene_cards
from .chapter import Chapter, Page, Run
from .mathematics import description
from .motions import Motion, figures_of, motions
from .paper import REPOSITORY
from .runs import FileAnswers, Settings, study

EQUATIONS = ("2", "3a", "3", "4", "5", "6", "7", "8", "9", "11")
INITIAL_MOTION = ("12", "13", "18", "19")


def book_of_scenes(files: Sequence[Path], settings: Settings, limits: Limits) -> Book:
    """The companion of scene files.

    Parameters
    ----------
    settings : tuple of (str, str)
        Numbers for what the files leave open.
    limits : Limits
        What each Maxima run may take.
    """
    prefixes = [""] if len(files) == 1 else [_prefix(file, place) for place, file in enumerate(files, 1)]
    return Book(
        title=translatable("A companion to systems of your own"),
        subtitle=", ".join(file.name for file in files),
        foreword="own_foreword.html",
        command=f"holonom companion {' '.join(map(str, files))}",
        root=REPOSITORY,
        parts=tuple(
            (file.name, tuple(each(prefix, file, study(file, settings, limits)) for each in CHAPTERS))
            for prefix, file in zip(prefixes, files, strict=True)
        ),
    )


def _prefix(file: Path, place: int) -> str:
    """What the names of a file's pages begin with: no two files have the same."""
    return f"{place}-{re.sub(r'[^a-z0-9]+', '-', file.stem.lower())}-"


def system(prefix: str, file: Path, study: Run) -> Chapter:
    """The system as its file describes it."""

    def page(results: Mapping[str, FileAnswers]) -> Page:
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

    return Chapter(
        slug=f"{prefix}the-system",
        title=translatable("The system"),
        aim=translatable("What the file describes."),
        template="own_system.html",
        runs={"study": study},
        page=page,
    )


def equations(prefix: str, file: Path, study: Run) -> Chapter:
    """The equations of motion of the system, and the verdicts on them."""

    def page(results: Mapping[str, FileAnswers]) -> Page:
        derived = results["study"].derived
        cards = derivation_cards(EQUATIONS, [derived], (), REPOSITORY)
        return Page(
            {
                "cards": cards,
                "missing": missing(derived),
                "closed": all(each.closed_form_operations is not None for each in derived.record.derivations),
            },
            sources=files_of(cards),
        )

    return Chapter(
        slug=f"{prefix}equations-of-motion",
        title=translatable("Equations of motion"),
        aim=translatable("Equations (2) to (9) and (11), each with its verdict."),
        template="own_equations.html",
        runs={"study": study},
        page=page,
    )


def free_motion(prefix: str, file: Path, study: Run) -> Chapter:
    """When the motion of the system is free."""

    def page(results: Mapping[str, FileAnswers]) -> Page:
        found = results["study"]
        cards = derivation_cards(["10"], [found.derived], (), REPOSITORY)
        scenes = [
            {"name": name, "title": title, "answer": found.free[name], "cards": _scene_cards(found, ["10"], name)}
            for name, title in found.titles.items()
        ]
        controlled = bool(found.derived.record.system.controls)
        return Page({"cards": cards, "scenes": scenes, "controlled": controlled}, sources=files_of(cards))

    return Chapter(
        slug=f"{prefix}free-motion",
        title=translatable("Free motion"),
        aim=translatable("Whether the constraints push, and what it takes that they do not."),
        template="own_free_motion.html",
        runs={"study": study},
        page=page,
    )


def initial_motion(prefix: str, file: Path, study: Run) -> Chapter:
    """The initial motion of each scene: the power series with its radius, and closed forms."""

    def page(results: Mapping[str, FileAnswers]) -> Page:
        found = results["study"]
        scenes = [
            {
                "name": name,
                "title": title,
                "cards": _scene_cards(found, INITIAL_MOTION, name),
                "series": found.series[name],
            }
            for name, title in found.titles.items()
        ]
        return Page({"scenes": scenes}, sources=tuple(name for each in scenes for name in files_of(each["cards"])))

    return Chapter(
        slug=f"{prefix}initial-motion",
        title=translatable("Initial motion"),
        aim=translatable("Initial state, initial accelerations, and the power series of the motion."),
        template="own_initial_motion.html",
        runs={"study": study},
        page=page,
    )


def motion(prefix: str, file: Path, study: Run) -> Chapter:
    """The motion of each scene: drawn, where the system says how it looks, and as curves."""

    def page(results: Mapping[str, Any]) -> Page:
        found = results["motions"]
        titles = results["study"].titles
        scenes = [(f"{prefix}scene-{place}", titles[name], name) for place, name in enumerate(found, 1)]
        shown = [(figure, found[name]) for figure, _, name in scenes if isinstance(found[name], Motion)]
        return Page(
            {"scenes": [(figure, title, name, found[name]) for figure, title, name in scenes]},
            figures=figures_of(shown),
        )

    return Chapter(
        slug=f"{prefix}motion",
        title=translatable("The motion"),
        aim=translatable("How the system moves, and what its constraints have to do."),
        template="own_motion.html",
        runs={"study": study, "motions": motions(*study.arguments)},
        page=page,
    )


def _scene_cards(found: FileAnswers, numbers: Sequence[str], scene: str) -> list[Card]:
    """Cards of a scene's equations; none where it prescribes reactions and so is not in the record."""
    if scene not in {each.name for each in found.record.scenes}:
        return []
    return scene_cards(numbers, [(found.derived, scene)], (), REPOSITORY, scene)


CHAPTERS = (system, equations, free_motion, initial_motion, motion)
