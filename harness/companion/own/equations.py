"""The equations of motion of the system, and the verdicts on them."""

from collections.abc import Mapping
from pathlib import Path

from ..cards import derivation_cards, files_of, missing
from ..chapter import Chapter, Page, Run
from ..paper import REPOSITORY
from ..runs import FileAnswers

NUMBERS = ("2", "3a", "3", "4", "5", "6", "7", "8", "9", "11")


def chapter(prefix: str, file: Path, study: Run) -> Chapter:
    """The chapter about a file, in whose pages' names the prefix comes first."""

    def page(results: Mapping[str, FileAnswers]) -> Page:
        derived = results["study"].derived
        cards = derivation_cards(NUMBERS, [derived], (), REPOSITORY)
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
        title="Equations of motion",
        aim="Equations (2) to (9) and (11), each with its verdict.",
        template="own_equations.html",
        runs={"study": study},
        page=page,
    )
