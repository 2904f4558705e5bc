"""The initial motion of each scene: closed forms, and the power series with its radius."""

from collections.abc import Mapping
from pathlib import Path

from ..cards import files_of
from ..chapter import Chapter, Page, Run
from ..runs import FileAnswers
from .scenes import scene_cards_of

NUMBERS = ("12", "13", "18", "19")


def chapter(prefix: str, file: Path, study: Run) -> Chapter:
    """The chapter about a file, in whose pages' names the prefix comes first."""

    def page(results: Mapping[str, FileAnswers]) -> Page:
        found = results["study"]
        scenes = [
            {
                "name": name,
                "title": title,
                "cards": scene_cards_of(found, NUMBERS, name),
                "series": found.series[name],
            }
            for name, title in found.titles.items()
        ]
        return Page({"scenes": scenes}, sources=tuple(name for each in scenes for name in files_of(each["cards"])))

    return Chapter(
        slug=f"{prefix}initial-motion",
        title="Initial motion",
        aim="Initial state, initial accelerations, and the power series of the motion.",
        template="own_initial_motion.html",
        runs={"study": study},
        page=page,
    )
