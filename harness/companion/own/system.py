"""The system as its file describes it."""

from collections.abc import Mapping
from pathlib import Path

from ..cards import derivation_cards, files_of
from ..chapter import Chapter, Page, Run
from ..description import description
from ..paper import REPOSITORY
from ..runs import FileAnswers


def chapter(prefix: str, file: Path, study: Run) -> Chapter:
    """The chapter about a file, in whose pages' names the prefix comes first."""

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
        title="The system",
        aim="What the file describes.",
        template="own_system.html",
        runs={"study": study},
        page=page,
    )
