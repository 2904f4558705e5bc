"""When the motion of the system is free."""

from collections.abc import Mapping
from pathlib import Path

from harness.companion.cards import derivation_cards, files_of
from harness.companion.chapter import Chapter, Page, Run
from harness.companion.own.scenes import scene_cards_of
from harness.companion.paper import REPOSITORY
from harness.companion.runs import Study


def chapter(prefix: str, file: Path, study: Run) -> Chapter:
    """The chapter about a file, in whose pages' names the prefix comes first."""

    def page(results: Mapping[str, Study]) -> Page:
        found = results["study"]
        cards = derivation_cards(["10"], [found.derived], (), REPOSITORY)
        scenes = [
            {"name": name, "title": title, "answer": found.free[name], "cards": scene_cards_of(found, ["10"], name)}
            for name, title in found.titles.items()
        ]
        return Page({"cards": cards, "scenes": scenes}, sources=files_of(cards))

    return Chapter(
        slug=f"{prefix}free-motion",
        title="Free motion",
        aim="Under which controls the constraints push nobody.",
        template="own_free_motion.html",
        runs={"study": study},
        page=page,
    )
