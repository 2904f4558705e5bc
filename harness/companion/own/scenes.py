"""The cards of a scene in somebody's own file."""

from collections.abc import Sequence

from ..cards import Card, scene_cards
from ..paper import REPOSITORY
from ..runs import FileAnswers


def scene_cards_of(found: FileAnswers, numbers: Sequence[str], scene: str) -> list[Card]:
    """Cards of a scene's equations; none where it prescribes reactions and so is not in the record."""
    if scene not in {each.name for each in found.record.scenes}:
        return []
    return scene_cards(numbers, [(found.derived, scene)], (), REPOSITORY, scene)
