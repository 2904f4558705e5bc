"""When the motion of the system is free."""

from collections.abc import Mapping
from pathlib import Path

from ..cards import derivation_cards, files_of
from ..chapter import Chapter, Page, Run
from ..paper import REPOSITORY
from ..runs import FileAnswers
from .scenes import scene_cards_of


def chapter(prefix: str, file: Path, study: Run) -> Chapter:
    """The chapter about a file, in whose pages' names the prefix comes first."""

    def page(results: Mapping[str, FileAnswers]) -> Page:
        found = results["study"]
        cards = derivation_cards(["10"], [found.derived], (), REPOSITORY)
        scenes = [
            {"name": name, "title": title, "answer": found.free[name], "cards": scene_cards_of(found, ["10"], name)}
            for name, title in found.titles.items()
        ]
        controlled = bool(found.derived.record.system.controls)
        return Page({"cards": cards, "scenes": scenes, "controlled": controlled}, sources=files_of(cards))

    return Chapter(
        slug=f"{prefix}free-motion",
        title="Free motion",
        aim="Whether the constraints push, and what it takes that they do not.",
        template="own_free_motion.html",
        runs={"study": study},
        page=page,
    )
